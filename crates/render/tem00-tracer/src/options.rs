use tem00_camera::Camera;
use tem00_numerics::Crop;

use crate::{Filter, TracerError, error::check};

/// The method by which light is followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// From the camera; and from the lasers through mirrors and glass, where the scene has them.
    #[default]
    Path,
    /// From the lasers to the camera; lights as by the other method. Surfaces that the camera sees
    /// in mirrors and through glass have no light of lasers.
    Light,
}

impl Method {
    /// Both methods.
    pub const ALL: [Self; 2] = [Self::Path, Self::Light];

    /// Returns the name in scene files and arguments: `path`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Light => "light",
        }
    }
}

/// The way in which the light of a laser at a surface is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LaserEvents {
    /// From the one direction of the mean energy flow.
    #[default]
    Beam,
    /// From a direction drawn from the beam's phase-space density.
    Sampled,
}

/// The way in which area lights and the environment are sampled from a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightEvents {
    /// Sampling by a point of the light and by a direction of the material, combined by the power
    /// heuristic.
    #[default]
    Both,
    /// Sampling by a point of the light only: fewer rays, but noise where shiny surfaces reflect a
    /// light.
    NextEvent,
    /// Sampling by a direction of the material only: suitable for lights all around, not for small
    /// ones.
    Scattering,
}

/// Distribution of camera samples among the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sampling {
    /// Every pixel gets [`samples_per_pixel`](RenderOptions::samples_per_pixel) samples.
    #[default]
    Even,
    /// Pixels get at most [`samples_per_pixel`](RenderOptions::samples_per_pixel) samples on
    /// average, and more where samples differ: at edges, in the light of a narrow beam, where rare
    /// paths bring light.
    ///
    /// A pilot of a quarter of the samples, 8 at most, shows how much the samples of a pixel and
    /// its eight neighbours differ: the largest of their standard deviations σ. It takes 2 in every
    /// second pixel where a quarter is less than 2. Then the pixel gets a number of samples in
    /// proportion to σ^⅔, from half of `samples_per_pixel` to 32 times as many. The samples of the
    /// pilot are not used for the image, so that it is as unbiased as with even samples. Light that
    /// it cannot see, such as light that one path in a thousand finds, has up to twice the
    /// variance. Fewer than 4 samples per pixel are shared evenly.
    Adaptive,
    /// Every pixel gets enough samples for this relative standard error, positive.
    ///
    /// A pilot of 16 samples in a pixel and in each of its eight neighbours estimates the error of
    /// a mean of independent samples; the estimate is raised by a sixth, because it is uncertain.
    /// The pixel gets `samples_per_pixel` times a power of two, 64 at most, that brings it below
    /// this fraction of the pixel's radiance, or of a tenth of the mean radiance of the image where
    /// the pixel is darker. The samples of the pilot are not used for the image, so that it is as
    /// unbiased as with even samples. Light that is followed from the lasers does not count.
    TargetError(f64),
}

/// Options for rendering a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderOptions {
    /// The number of camera samples per pixel, at least 1.
    pub samples_per_pixel: u32,
    /// Distribution of samples among the pixels.
    pub sampling: Sampling,
    /// The seed of all random numbers: camera samples, and speckle where its plan takes the same
    /// seed.
    pub seed: u64,
    /// The maximum number of surfaces that light may meet between source and camera; `None` for no
    /// limit.
    pub max_depth: Option<u32>,
    /// The method by which light is followed.
    pub method: Method,
    /// The way in which the lasers are sampled from a surface.
    pub laser_events: LaserEvents,
    /// The way in which lights are sampled from a surface.
    pub light_events: LightEvents,
    /// The filter that weights the samples around a pixel. Light that is followed from the lasers
    /// is averaged over the square of the pixel instead.
    pub filter: Filter,
    /// The part of the image that is rendered; `None` for all. Its pixels have the same bits as in
    /// the whole image, unless their samples depend on the light.
    pub crop: Option<Crop>,
    /// True if the layer of speckle factors has speckle where a laser sends no light, too;
    /// otherwise camera samples that find no light of the laser count with a factor of 1 there.
    /// Radiances are the same either way; `false` takes less time.
    pub speckle_in_the_dark: bool,
    /// The radiance that previews show as white, in W/(m² sr); `None` to choose it from the first
    /// frame. No layer depends on it.
    pub white_level: Option<f64>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples_per_pixel: 16,
            sampling: Sampling::default(),
            seed: 0,
            max_depth: None,
            method: Method::default(),
            laser_events: LaserEvents::default(),
            light_events: LightEvents::default(),
            filter: Filter::default(),
            crop: None,
            speckle_in_the_dark: true,
            white_level: None,
        }
    }
}

impl RenderOptions {
    /// Returns whether directions towards lasers are drawn, and paths meet their beams by chance.
    pub fn samples_beams(&self) -> bool {
        self.laser_events == LaserEvents::Sampled
    }

    /// Checks the options and returns the part of the camera's image that is rendered.
    ///
    /// # Errors
    ///
    /// Returns an error if an option is out of its range.
    pub fn area(&self, camera: &Camera) -> Result<Crop, TracerError> {
        let samples = f64::from(self.samples_per_pixel);
        check("samples_per_pixel", samples, 1.0.., "at least 1")?;
        if let Sampling::TargetError(error) = self.sampling
            && !(error > 0.0 && error.is_finite())
        {
            return Err(TracerError::out_of_range(
                "target_error",
                error,
                "positive and finite",
            ));
        }
        let (x, y, width, height) = (0, 0, camera.width(), camera.height());
        let whole = Crop {
            x,
            y,
            width,
            height,
        };
        let crop = self.crop.unwrap_or(whole);
        check_range("crop (columns)", [crop.x, crop.width], width)?;
        check_range("crop (rows)", [crop.y, crop.height], height)?;
        Ok(crop)
    }
}

fn check_range(
    parameter: &'static str,
    [first, count]: [usize; 2],
    size: usize,
) -> Result<(), TracerError> {
    let end = first.saturating_add(count);
    if count == 0 || end > size {
        let allowed = "in the image, with at least one pixel";
        return Err(TracerError::out_of_range(parameter, end as f64, allowed));
    }
    Ok(())
}
