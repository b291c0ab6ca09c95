use tem00_numerics::cast::to_f32;
use tem00_tracer::{Crop, LaserLayers};

/// Radiance that light paths bring to one pixel, in W/(m² sr).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Splat {
    /// The number of the pixel in the part of the image that is rendered.
    pub pixel: usize,
    pub single: f64,
    pub multiple: f64,
    pub radiance: f64,
}

/// Contribution of a group of light paths to the image.
#[derive(Clone, Debug, Default)]
pub(super) struct Splats {
    /// Splats, in the end sorted by pixel, one for each.
    list: Vec<Splat>,
    /// The power on the first rough surface where this surface is seen, in watts.
    pub power: f64,
}

impl Splats {
    pub(super) fn push(&mut self, splat: Splat) {
        self.list.push(splat);
    }

    /// Adds up the splats of each pixel.
    pub(super) fn merge(&mut self) {
        // A stable sort: the sums are formed in the order of the paths.
        self.list.sort_by_key(|splat| splat.pixel);
        self.list.dedup_by(|next, sum| {
            let same = next.pixel == sum.pixel;
            if same {
                sum.single += next.single;
                sum.multiple += next.multiple;
                sum.radiance += next.radiance;
            }
            same
        });
    }
}

/// The image during light tracing: 32 bytes per pixel.
#[derive(Debug)]
pub(super) struct SplatFilm {
    pixels: Vec<PixelSums>,
    /// The sums over groups of the power and of its square.
    power: [f64; 2],
}

#[derive(Clone, Copy, Debug, Default)]
struct PixelSums {
    single: f64,
    multiple: f64,
    radiance: f64,
    /// The sum over groups of the square of the group's contribution.
    squares: f64,
}

impl SplatFilm {
    pub(super) fn new(area: Crop) -> Self {
        Self {
            pixels: vec![PixelSums::default(); area.width * area.height],
            power: [0.0; 2],
        }
    }

    /// Adds the contribution of one group.
    pub(super) fn add(&mut self, splats: &Splats) {
        for splat in &splats.list {
            let pixel = &mut self.pixels[splat.pixel];
            pixel.single += splat.single;
            pixel.multiple += splat.multiple;
            pixel.radiance += splat.radiance;
            pixel.squares += splat.radiance.powi(2);
        }
        self.power[0] += splats.power;
        self.power[1] += splats.power.powi(2);
    }

    /// Adds the means over `groups` groups and `paths` paths, each of which stood for the whole
    /// laser, to the layers of the laser.
    ///
    /// The means are averages over the square of the pixel: a light path reaches its image point by
    /// chance, so that no other reconstruction filter applies. The variance is unbiased, from
    /// groups that are independent of each other, and infinite for a single group.
    pub(super) fn add_to(&self, layers: &mut LaserLayers, groups: u64, paths: u64) {
        let (groups, paths) = (groups as f64, paths.max(1) as f64);
        let variance = |[sum, squares]: [f64; 2]| {
            if groups < 2.0 {
                return f64::INFINITY;
            }
            // Rounding alone can make it negative.
            let scatter = (squares - sum * sum / groups).max(0.0);
            groups / (groups - 1.0) * scatter / (paths * paths)
        };
        for (index, pixel) in self.pixels.iter().enumerate() {
            let variance = variance([pixel.radiance, pixel.squares]);
            layers.single.values_mut()[index] += to_f32(pixel.single / paths);
            layers.multiple.values_mut()[index] += to_f32(pixel.multiple / paths);
            layers.radiance.values_mut()[index] += to_f32(pixel.radiance / paths);
            layers.variance.values_mut()[index] += to_f32(variance);
        }
        layers.power_on_target += self.power[0] / paths;
        layers.power_error = layers.power_error.hypot(variance(self.power).sqrt());
    }
}
