//! The layers of a frame, and the sums over the samples of a pixel that fill them.

mod layout;
mod memory;
mod sample;
mod sums;

use tem00_numerics::{Grid, cast::to_f32};

pub use self::layout::FilmLayout;
pub use self::sample::{LaserSample, Sample, Seen};
pub use self::sums::{LaserSums, Moments, PixelSums};
use crate::TracerError;

/// The rendered layers of one frame, or of its cropped part.
///
/// All radiances are in W/(m² sr), averaged over the pixel (by the reconstruction filter), at the
/// wavelength of their source. The variances describe a pixel's value from render to render, in
/// (W/(m² sr))²; they are estimated from the pixel's samples as if these were independent. The
/// samples are spread more evenly than that, so the variances are upper bounds on average. A single
/// sample gives no estimate: its variance is infinite.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The layers of each laser, in the order of the scene.
    pub lasers: Vec<LaserLayers>,
    /// The radiance from incoherent lights and the environment.
    pub lights: Grid<f32>,
    /// The variance of `lights`.
    pub lights_variance: Grid<f32>,
    /// The distance from the camera to the surface seen, along the axis of the camera, in metres:
    /// the mean over the pixel's samples that meet something, and 0 where none does.
    pub depth: Grid<f32>,
    /// The components x, y and z of the unit normal of the surface seen, on the visible side and as
    /// it is shaded: the mean over the pixel's samples, with 0 for those that meet nothing.
    pub normal: [Grid<f32>; 3],
    /// The number of samples in the pixel, without the samples of a pilot.
    pub samples: Grid<f32>,
    /// The column and the row of the first pixel in the whole image.
    pub origin: [usize; 2],
    /// The number of rays that were followed from the camera and, as shadow rays, towards light.
    /// Paths from the lasers are not counted.
    pub rays: u64,
}

/// The layers of one laser.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserLayers {
    /// The vacuum wavelength, in metres.
    pub wavelength: f64,
    /// Radiance of the light that has met one rough surface, before speckle.
    pub single: Grid<f32>,
    /// Radiance of the light that has met more than one rough surface, before speckle.
    pub multiple: Grid<f32>,
    /// The speckle factor, averaged over the pixel without regard to the light; 1 where the pixel
    /// sees no rough surface. [`RenderOptions::speckle_in_the_dark`](crate::RenderOptions) can
    /// leave it at 1 for samples without light, too.
    pub speckle: Grid<f32>,
    /// Radiance of all light of the laser, each camera sample multiplied by its speckle factor.
    pub radiance: Grid<f32>,
    /// The variance of `radiance`.
    pub variance: Grid<f32>,
    /// The power that the laser brings to the surfaces seen in the image, in watts.
    ///
    /// It is estimated from the camera's samples: the irradiance at each hit times the area that
    /// the sample covers there. It is the laser's power when the whole footprint is in the image.
    /// Surfaces seen in a mirror or through glass do not count.
    pub power_on_target: f64,
    /// The standard error of `power_on_target`, as if the samples of a pixel were independent;
    /// infinite with one sample in a pixel. A spot that few samples hit has a large standard error,
    /// and a spot that no sample hits has none.
    pub power_error: f64,
}

/// The layers while they are rendered.
#[derive(Debug)]
pub struct Film {
    frame: Frame,
    /// The power on target and its variance by strip and laser, summed at the end in the order of
    /// the strips, so that the sum has the same bits for any number of threads.
    power: Vec<[f64; 2]>,
}

impl Film {
    /// Prepares a dark film.
    ///
    /// # Errors
    ///
    /// Returns an error if there is not enough memory for the layers.
    pub fn new(layout: &FilmLayout<'_>) -> Result<Self, TracerError> {
        let area = layout.area;
        memory::check(layout)?;
        let layer = || Grid::filled(area.width, area.height, 0.0_f32);
        let lasers = layout.wavelengths.iter().map(|&wavelength| LaserLayers {
            wavelength,
            single: layer(),
            multiple: layer(),
            speckle: layer(),
            radiance: layer(),
            variance: layer(),
            power_on_target: 0.0,
            power_error: 0.0,
        });
        Ok(Self {
            frame: Frame {
                lasers: lasers.collect(),
                lights: layer(),
                lights_variance: layer(),
                depth: layer(),
                normal: [layer(), layer(), layer()],
                samples: layer(),
                origin: [area.x, area.y],
                rays: 0,
            },
            power: vec![[0.0; 2]; layout.strips * layout.wavelengths.len()],
        })
    }

    /// Counts rays that were followed.
    pub const fn count_rays(&mut self, rays: u64) {
        self.frame.rays += rays;
    }

    /// Writes the results of the samples of a pixel in a strip.
    pub fn write(&mut self, strip: usize, at: [usize; 2], pixel: &PixelSums) {
        let at = at.into();
        for (layers, laser) in self.frame.lasers.iter_mut().zip(&pixel.lasers) {
            layers.single[at] = to_f32(pixel.mean(laser.single));
            layers.multiple[at] = to_f32(pixel.mean(laser.multiple));
            layers.speckle[at] = to_f32(pixel.mean(laser.speckle));
            layers.radiance[at] = to_f32(pixel.mean(laser.radiance.sum));
            layers.variance[at] = to_f32(pixel.variance(&laser.radiance));
        }
        self.frame.lights[at] = to_f32(pixel.mean(pixel.lights.sum));
        self.frame.lights_variance[at] = to_f32(pixel.variance(&pixel.lights));
        self.frame.samples[at] = to_f32(f64::from(pixel.samples));
        self.frame.depth[at] = to_f32(pixel.depth());
        for (layer, component) in self.frame.normal.iter_mut().zip(pixel.normal().to_array()) {
            layer[at] = to_f32(component);
        }
        let lasers = self.frame.lasers.len();
        let powers = self.power[strip * lasers..].iter_mut();
        for (power, laser) in powers.zip(&pixel.lasers) {
            power[0] += pixel.mean(laser.power.sum);
            power[1] += pixel.variance(&laser.power);
        }
    }

    /// Returns the finished frame.
    pub fn into_frame(mut self) -> Frame {
        let lasers = self.frame.lasers.len();
        for (index, layers) in self.frame.lasers.iter_mut().enumerate() {
            let strips = || self.power.iter().skip(index).step_by(lasers);
            layers.power_on_target = strips().map(|[power, _]| power).sum();
            layers.power_error = strips().map(|[_, variance]| variance).sum::<f64>().sqrt();
        }
        self.frame
    }
}
