use core::f64::consts::{PI, SQRT_2};

use tem00_numerics::{
    Grid,
    cast::{to_f32, to_usize},
};

use crate::{SpeckleSize, StatisticsError, estimate::moments, laws::COHERENCE_AREA};

/// The inner radius of the first ring of lags, in speckle sizes, outside the speckle itself.
const FIRST_RING: f64 = 1.5;

/// Number of standard deviations that count as chance.
const SIGMAS: f64 = 4.5;

/// Autocovariance due to the side lobes of a pupil in the first ring; it falls with the radius. It
/// is 0.005 for a circle, 0.03 for an annulus with an opening of one half, and 0.07 for an opening
/// of nine tenths.
const SIDE_LOBES: f64 = 0.08;

/// Largest fraction of the variance that chance may hide for light to be called even: the value for
/// about a hundred speckles.
const HIDDEN: f64 = 0.25;

/// Lag at which finer grains are detected, in speckle sizes.
const FINE_LAG: f64 = 0.125;

/// Fraction of the variance above which grains are finer than the law of the speckle, which gives
/// 0.008 at most.
const FINE_SHARE: f64 = 0.02;

/// Evenness of the light over an image, judged by the autocovariance of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Evenness {
    /// The light is even: its shape contributes less than the fraction `limit` of the variance.
    Even {
        /// The fraction of the variance that side lobes and chance may hide.
        limit: f64,
    },
    /// The light is not even.
    Uneven(UnevenLight),
    /// There are too few speckles to distinguish their grains from the shape of the light, which
    /// may have determined the measured size.
    FewSpeckles {
        /// The width and the height of the image, in speckle sizes.
        across: [f64; 2],
    },
    /// There are grains much finer than the measured speckle size: noise, or the speckle itself if
    /// the light has determined the size.
    FinerGrains {
        /// The fraction of the variance due to the finer grains.
        share: f64,
        /// The lag within which they decorrelate, in pixels.
        lag: usize,
    },
}

/// Uneven light over an image: the autocovariance of the image does not fall to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnevenLight {
    /// The inner and the outer radius of the ring of lags with the strongest evidence, in speckle
    /// sizes.
    pub lags: [f64; 2],
    /// The mean autocovariance over this ring, in units of the variance of the image: about the
    /// fraction of the variance due to the shape of the light.
    pub covariance: f64,
    /// The largest covariance that even light may show in this ring, from side lobes and chance.
    pub limit: f64,
}

impl Evenness {
    /// Judges the light by the autocovariance of a finite image, with zero lag at `(0, 0)`.
    ///
    /// The lags are averaged over rings from 1.5 to 3 speckle sizes, from 3 to 6, and so on up to
    /// half of the image. In even light this average is 0, with the standard deviation
    ///
    /// ```text
    /// √2 (4/π) / √(n a)         n the speckle sizes h² in the image, a the ring's area in h²
    /// ```
    ///
    /// and 4.5 standard deviations count as chance, in addition to the side lobes of a pupil, 0.08
    /// in the first ring and half as much in each further ring. `size` is the speckle size, or
    /// `None` if pixels are larger than speckles.
    ///
    /// If the light contributes more than half of the variance, it determines the measured speckle
    /// size itself, and no ring shows it. A smooth profile is then no more than a few such sizes
    /// wide: an image with fewer than six speckles along an axis, or a hundred in all, counts as
    /// having too few. With finer structure the speckle appears as a fall of the autocovariance c
    /// near zero lag, where speckle of the size h ≥ 8 pixels has a parabola:
    ///
    /// ```text
    /// share = 1 − (4 c(h/8) − c(h/4)) / 3        along x or y, the smaller
    /// ```
    ///
    /// # Validity
    ///
    /// The speckle must have one size all over the image.
    pub fn find(lags: &Grid<f32>, size: Option<SpeckleSize>) -> Self {
        // Independent pixels have a coherence area of one pixel.
        let size = size.map_or([COHERENCE_AREA.sqrt().recip(); 2], |s| [s.x(), s.y()]);
        // The grid of lags of a finite image is twice as large as the image.
        let image = [lags.width(), lags.height()].map(|lags| 0.5 * lags as f64);
        let speckles = image[0] * image[1] / (size[0] * size[1]);
        // At lags beyond half of the image the average contains only pixels near the edges.
        let farthest = (0.5 * image[0] / size[0]).min(0.5 * image[1] / size[1]);
        let across = [image[0] / size[0], image[1] / size[1]];
        let limit = |inner: f64| {
            let spread = SQRT_2 * COHERENCE_AREA / (speckles * 3.0 * PI * inner * inner).sqrt();
            SIGMAS * spread + SIDE_LOBES * FIRST_RING / inner
        };
        let radii = core::iter::successors(Some(FIRST_RING), |inner| Some(2.0 * inner));
        let rings = radii
            .take_while(|inner| 2.0 * inner <= farthest)
            .map(|inner| UnevenLight {
                lags: [inner, 2.0 * inner],
                // The mean that was taken from the image lowers all lags.
                covariance: mean_over_ring(lags, size, inner) + COHERENCE_AREA / speckles,
                limit: limit(inner),
            });
        let excess = |ring: &UnevenLight| ring.covariance - ring.limit;
        let uneven = rings
            .filter(|ring| excess(ring) > 0.0)
            .max_by(|a, b| excess(a).total_cmp(&excess(b)));
        let limit = limit(FIRST_RING);
        match (uneven, finer_grains(lags, size)) {
            (Some(uneven), _) => Self::Uneven(uneven),
            _ if farthest < 2.0 * FIRST_RING || limit > HIDDEN => Self::FewSpeckles { across },
            (None, Some((share, lag))) => Self::FinerGrains { share, lag },
            (None, None) => Self::Even { limit },
        }
    }
}

/// Returns the fraction of the variance in grains finer than the speckle size, and the lag within
/// which they decorrelate.
fn finer_grains(lags: &Grid<f32>, size: [f64; 2]) -> Option<(f64, usize)> {
    let lag = size.map(|size| FINE_LAG * size);
    if lag[0].min(lag[1]) < 1.0 {
        return None;
    }
    let [x, y] = lag.map(|lag| to_usize(lag.round()));
    let beyond = |near: f32, far: f32| 1.0 - (4.0 * f64::from(near) - f64::from(far)) / 3.0;
    let along_x = beyond(lags[(x, 0)], lags[(2 * x, 0)]);
    let along_y = beyond(lags[(0, y)], lags[(0, 2 * y)]);
    let share = along_x.min(along_y);
    (share > FINE_SHARE).then_some((share, x.max(y)))
}

/// Returns the mean over lags from `inner` to twice `inner`, in speckle sizes.
fn mean_over_ring(lags: &Grid<f32>, size: [f64; 2], inner: f64) -> f64 {
    let [reach_x, reach_y] = size.map(|size| whole(2.0 * inner * size));
    let (mut sum, mut cells) = (0.0, 0_u32);
    // Opposite lags have the same value: half of the ring suffices.
    for y in 0..=reach_y {
        for x in -reach_x..=reach_x {
            let radius = (f64::from(x) / size[0]).hypot(f64::from(y) / size[1]);
            if (inner..2.0 * inner).contains(&radius) {
                sum += f64::from(*lags.wrapped(x.into(), y.into()));
                cells += 1;
            }
        }
    }
    sum / f64::from(cells)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a lag is at most half the size of the image"
)]
const fn whole(lag: f64) -> i32 {
    lag as i32
}

/// An image divided by its mean over a square about each pixel, which removes uneven light from
/// speckle.
///
/// ```text
/// R(x) = I(x) / m(x)        m the mean over window × window pixels about x, as far as they exist
/// ```
///
/// # Bias
///
/// The local mean follows the pattern, the more the smaller the window is, and removes from the
/// variance the fraction
///
/// ```text
/// s = (4/π) h² ⟨1/n⟩        ⟨1/n⟩ the average over the image of 1 by the pixels in the window
/// ```
///
/// With δ = I − 1 and η = m − 1 for a sum of fully developed patterns, whose cumulants are ⟨δη⟩ =
/// ⟨η²⟩ = C² s and ⟨δ²η⟩ = 2 C⁴ s, the contrast of R is
///
/// ```text
/// C' = C (1 − (1 + C²) s / 2)        to first order in s
/// ```
///
/// and its autocovariance falls from 1 to −s, which makes the speckle size too small by the
/// fraction 0.675 s. [`contrast_before`](Self::contrast_before) and
/// [`speckle_size_before`](Self::speckle_size_before) undo both.
///
/// # Validity
///
/// Windows must be at least six speckle sizes wide, s ≤ 0.035, and the light must vary little over
/// a window: the effect of its curvature remains, `w² e″ / 24 e` along each axis for a light e and
/// a window of the width w.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatImage {
    values: Grid<f32>,
    /// The average of the reciprocal number of pixels in the window.
    inverse_count: f64,
    darkest: f64,
}

impl FlatImage {
    /// Divides `image` by its mean over `window` × `window` pixels; an even window counts as one
    /// pixel wider.
    ///
    /// # Errors
    ///
    /// Returns an error if the window is smaller than two pixels or larger than the image, a pixel
    /// is not finite, or a local mean is not positive.
    pub fn new(image: &Grid<f32>, window: usize) -> Result<Self, StatisticsError> {
        StatisticsError::check_window(window, image)?;
        let size = (image.width(), image.height());
        moments::check_finite(image.values())?;
        let means = local_means(image, window / 2);
        let of =
            |pick: fn(f64, f64) -> f64, start| means.values().iter().copied().fold(start, pick);
        let (lowest, highest) = (of(f64::min, f64::INFINITY), of(f64::max, 0.0));
        // A mean below the rounding of the sums is not reliable.
        if lowest <= f64::EPSILON * highest * (size.0 + size.1) as f64 {
            return Err(StatisticsError::refused(
                "samples",
                lowest,
                StatisticsError::MEAN,
            ));
        }
        let flat = |x, y| to_f32(f64::from(image[(x, y)]) / means[(x, y)]);
        Ok(Self {
            values: Grid::from_fn(size.0, size.1, flat),
            inverse_count: inverse_count(size.0, window / 2) * inverse_count(size.1, window / 2),
            darkest: lowest / highest,
        })
    }

    /// Returns the values R.
    pub const fn values(&self) -> &Grid<f32> {
        &self.values
    }

    /// Returns the smallest local mean divided by the largest.
    pub const fn darkest(&self) -> f64 {
        self.darkest
    }

    /// Returns the fraction s of the variance that was removed, for a speckle size in pixels.
    pub fn lost_share(&self, speckle_size: f64) -> f64 {
        COHERENCE_AREA * speckle_size * speckle_size * self.inverse_count
    }

    /// Returns the contrast of evenly lit speckle from the `contrast` of this image.
    pub fn contrast_before(&self, contrast: f64, speckle_size: f64) -> f64 {
        contrast * (1.0 + 0.5 * (1.0 + contrast * contrast) * self.lost_share(speckle_size))
    }

    /// Returns the speckle size of evenly lit speckle from the `speckle_size` of this image, along
    /// one axis or both.
    pub fn speckle_size_before(&self, speckle_size: f64) -> f64 {
        speckle_size * (1.0 + 0.675 * self.lost_share(speckle_size))
    }
}

/// Returns the means over squares that extend by `reach` pixels to each side.
fn local_means(image: &Grid<f32>, reach: usize) -> Grid<f64> {
    let (width, height) = (image.width(), image.height());
    let mut means = Grid::filled(width, height, 0.0);
    for y in 0..height {
        let row: Vec<f64> = image.row(y).iter().map(|&value| value.into()).collect();
        for (x, mean) in running_means(&row, reach).into_iter().enumerate() {
            means[(x, y)] = mean;
        }
    }
    for x in 0..width {
        let column: Vec<f64> = (0..height).map(|y| means[(x, y)]).collect();
        for (y, mean) in running_means(&column, reach).into_iter().enumerate() {
            means[(x, y)] = mean;
        }
    }
    means
}

/// Returns the means over neighbours within `reach`, as far as they exist.
fn running_means(values: &[f64], reach: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    sums.push(0.0);
    for value in values {
        sums.push(sums[sums.len() - 1] + value);
    }
    let mean = |index: usize| {
        let [start, end] = neighbours(index, values.len(), reach);
        (sums[end] - sums[start]) / (end - start) as f64
    };
    (0..values.len()).map(mean).collect()
}

fn neighbours(index: usize, length: usize, reach: usize) -> [usize; 2] {
    [index.saturating_sub(reach), (index + reach + 1).min(length)]
}

/// Returns the average of the reciprocal number of neighbours.
fn inverse_count(length: usize, reach: usize) -> f64 {
    let inverse = |index: usize| {
        let [start, end] = neighbours(index, length, reach);
        ((end - start) as f64).recip()
    };
    (0..length).map(inverse).sum::<f64>() / length as f64
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::{Boundary, Contrast, Moments, autocovariance, synthetic::speckle_tile};

    fn evenness(image: &Grid<f32>) -> Evenness {
        let lags = autocovariance(image, Boundary::Finite).unwrap();
        Evenness::find(&lags, SpeckleSize::from_autocovariance(&lags).ok())
    }

    fn found(image: &Grid<f32>) -> Option<UnevenLight> {
        match evenness(image) {
            Evenness::Uneven(light) => Some(light),
            _ => None,
        }
    }

    fn is_even(image: &Grid<f32>) -> bool {
        matches!(evenness(image), Evenness::Even { .. })
    }

    fn window(tile: &Grid<f32>, [width, height]: [usize; 2]) -> Grid<f32> {
        Grid::from_fn(width, height, |x, y| tile[(x, y)])
    }

    /// A Gaussian spot with the 1/e² radius `radius` in the middle.
    fn lit(image: &Grid<f32>, radius: f64) -> Grid<f32> {
        let middle = [image.width() as f64 / 2.0, image.height() as f64 / 2.0];
        Grid::from_fn(image.width(), image.height(), |x, y| {
            let distance = (x as f64 - middle[0]).hypot(y as f64 - middle[1]) / radius;
            image[(x, y)] * to_f32((-2.0 * distance * distance).exp())
        })
    }

    #[test]
    fn even_light_is_not_called_uneven() {
        for (size, diameter, part, seeds) in [
            (64, 8, [64, 64], 120),
            (128, 16, [128, 96], 60),
            (128, 32, [100, 120], 60),
            (128, 64, [128, 64], 60),
            (256, 128, [256, 256], 10),
        ] {
            for seed in 0..seeds {
                let (tile, _) = speckle_tile(size, diameter, seed);
                let light = evenness(&window(&tile, part));
                // 64 speckles are too few to judge their light.
                let is_right = match light {
                    Evenness::Even { limit } => diameter > 8 && limit < HIDDEN,
                    Evenness::FewSpeckles { .. } => diameter == 8,
                    _ => false,
                };
                assert!(is_right, "{size}, {diameter}, seed {seed}: {light:?}");
            }
        }
    }

    #[test]
    fn a_spot_is_found_with_the_share_of_variance_that_it_makes() {
        let (tile, _) = speckle_tile(512, 128, 1);
        let spot = lit(&window(&tile, [320, 240]), 53.0);
        let light = found(&spot).expect("a spot that is a sixth of the image wide");
        // ⟨e²⟩ = 17.4 ⟨e⟩², by ∫e² = π w²/4 and ∫e = π w²/2 over 320 × 240 pixels: the light makes
        // (17.4 − 1) of the variance of 2 · 17.4 − 1, times exp(−r²/w²) at the lag r.
        assert!((0.1..0.49).contains(&light.covariance), "{light:?}");
        assert!(light.covariance > 2.0 * light.limit, "{light:?}");
    }

    #[test]
    fn light_that_falls_off_to_one_side_is_found() {
        let (tile, _) = speckle_tile(256, 128, 2);
        // A ramp from 0.2 to 1 has a variance of 0.148 times the squared mean.
        let ramp = |x: usize| to_f32(0.2 + 0.8 * x as f64 / 256.0);
        let image = Grid::from_fn(256, 256, |x, y| tile[(x, y)] * ramp(x));
        let light = found(&image).expect("a ramp");
        assert!((0.02..0.15).contains(&light.covariance), "{light:?}");
    }

    #[test]
    fn pixels_larger_than_speckles_need_no_size() {
        let (tile, _) = speckle_tile(512, 256, 3);
        let sparse = Grid::from_fn(100, 100, |x, y| tile[(5 * x, 5 * y)]);
        assert!(is_even(&sparse), "{:?}", evenness(&sparse));
        assert!(found(&lit(&sparse, 40.0)).is_some(), "a spot");
    }

    #[test]
    fn light_that_sets_the_size_is_not_called_even() {
        const WIDTH: usize = 384;
        const HEIGHT: usize = 300;
        let (grains, _) = speckle_tile(384, 256, 4);
        let (texture, _) = speckle_tile(384, 12, 5);
        let shades = |name, light: &dyn Fn(f64, f64) -> f64| {
            let pixel = |x: usize, y: usize| light(x as f64 / 384.0 - 0.5, y as f64 / 300.0 - 0.5);
            (
                name,
                Grid::from_fn(WIDTH, HEIGHT, |x, y| to_f32(pixel(x, y))),
            )
        };
        let spot = |x: f64, y: f64, radius: f64| (-2.0 * (x * x + y * y) / (radius * radius)).exp();
        let lights = [
            shades("blob", &|x, y| 0.05 + spot(x, y, 0.4)),
            shades("vignette", &|x, y| (1.0 + x * x + y * y).powi(-4)),
            shades("three blobs", &|x, y| {
                spot(x - 0.2, y, 0.2) + spot(x + 0.3, y - 0.1, 0.2)
            }),
            (
                "texture",
                Grid::from_fn(WIDTH, HEIGHT, |x, y| 1.0 + 0.3 * texture[(x, y)]),
            ),
        ];
        for (name, light) in &lights {
            // Grains of 1.5 pixels, as weak as with flowing blood: they contribute 0.2 to 7 % of
            // the variance.
            let image = Grid::from_fn(WIDTH, HEIGHT, |x, y| {
                light[(x, y)] * (1.0 + 0.08 * (grains[(x, y)] - 1.0))
            });
            let lags = autocovariance(&image, Boundary::Finite).unwrap();
            let size = SpeckleSize::from_autocovariance(&lags).unwrap();
            assert!(size.mean() > 12.0, "the {name} sets the size: {size:?}");
            assert!(!is_even(&image), "{name}: {:?}", evenness(&image));
        }
        // The blob alone has the contrast of speckle.
        assert!(!is_even(&lights[0].1), "{:?}", evenness(&lights[0].1));
    }

    #[test]
    fn finer_grains_are_found_with_their_share() {
        let (tile, _) = speckle_tile(384, 20, 4);
        let (fine, _) = speckle_tile(384, 256, 5);
        for (part, found) in [(0.0, false), (0.01, false), (0.03, true), (0.2, true)] {
            // Two patterns of variance 1, the coarse one weighted with 1 − part.
            let [coarse, noise] = [1.0 - part, part].map(f64::sqrt).map(to_f32);
            let image = Grid::from_fn(384, 384, |x, y| {
                coarse * tile[(x, y)] + noise * fine[(x, y)]
            });
            match evenness(&image) {
                Evenness::FinerGrains { share, lag } => {
                    assert!(found && lag == 2, "{part}: {share} within {lag}");
                    // The variance of 20 speckles across has the standard deviation 1.53 / 20, here
                    // 3.3 σ; the speckles themselves contribute 0.0013 at two pixels.
                    let tolerance = 0.25 * part + 0.002;
                    assert!((share - part).abs() < tolerance, "{part}: {share}");
                }
                light => assert!(!found, "{part}: {light:?}"),
            }
        }
    }

    #[test]
    fn a_flat_image_has_lost_what_is_stated() {
        const TILES: u64 = 24;
        for (window_size, patterns) in [(24, 1), (40, 1), (24, 2)] {
            let mut changes = [Vec::new(), Vec::new()];
            for seed in 0..TILES {
                let tile = |k| speckle_tile(256, 64, 100 * seed + k).0;
                let tiles: Vec<_> = (0..patterns).map(tile).collect();
                let image = Grid::from_fn(256, 256, |x, y| tiles.iter().map(|t| t[(x, y)]).sum());
                let flat = FlatImage::new(&image, window_size).unwrap();
                let of = |image: &Grid<f32>, boundary| {
                    let contrast = Contrast::from_samples(image.values()).unwrap().value();
                    [
                        contrast,
                        SpeckleSize::from_image(image, boundary).unwrap().mean(),
                    ]
                };
                // For the whole tile the mean is exact.
                let [contrast, size] = of(&image, Boundary::Periodic);
                let [flat_contrast, flat_size] = of(flat.values(), Boundary::Finite);
                changes[0].push(flat.contrast_before(flat_contrast, size) / contrast - 1.0);
                changes[1].push(flat.speckle_size_before(flat_size) / size - 1.0);
                assert!(
                    flat_contrast < contrast && flat_size < size,
                    "both are lost"
                );
            }
            for change in changes {
                let change = Moments::from_samples(&change).unwrap();
                // Windows of 6 and 10 speckle sizes, cut at the edges: s is 0.045 and 0.019, and
                // the second order about 2 s².
                let second_order = if window_size == 24 { 4e-3 } else { 1.5e-3 };
                let tolerance = 4.0 * change.standard_error() + second_order;
                assert!(
                    change.mean().abs() < tolerance && tolerance < 9e-3,
                    "{window_size}: {} ± {tolerance}",
                    change.mean()
                );
            }
        }
    }

    #[test]
    fn a_flat_image_is_the_image_by_its_local_mean() {
        let image = Grid::from_fn(7, 5, |x, y| (1 + x * y) as f32);
        let flat = FlatImage::new(&image, 3).unwrap();
        let nine = [1, 2, 3, 2, 4, 6, 3, 6, 9].map(|xy| f64::from(1 + xy));
        let mean = nine.iter().sum::<f64>() / 9.0;
        assert_relative(f64::from(flat.values()[(2, 2)]), 5.0 / mean, 1e-6);
        // In the corner the window holds four pixels, all 1 except the last.
        assert_relative(flat.values()[(0, 0)].into(), 0.8, 1e-6);
        let ends = |n: f64| (2.0 / 2.0 + (n - 2.0) / 3.0) / n;
        assert_relative(
            flat.lost_share(1.0),
            COHERENCE_AREA * ends(7.0) * ends(5.0),
            1e-12,
        );
        assert_relative(flat.darkest(), 1.25 / 20.25, 1e-12);
    }

    #[test]
    fn uneven_light_is_taken_out() {
        let (tile, _) = speckle_tile(512, 256, 6);
        let uneven = lit(&window(&tile, [300, 300]), 300.0);
        assert!(found(&uneven).is_some(), "the light is not even");
        let flat = FlatImage::new(&uneven, 41).unwrap();
        assert!(is_even(flat.values()), "{:?}", evenness(flat.values()));
        // For speckle of two pixels the standard deviation is 0.77 / 150, here 4 σ.
        let contrast = Contrast::from_samples(flat.values().values())
            .unwrap()
            .value();
        let before = flat.contrast_before(contrast, 2.0);
        assert_absolute(before, 1.0, 0.02);
    }
}
