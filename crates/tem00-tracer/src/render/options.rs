use tem00_camera::Camera;

use crate::{Filter, TracerError};

/// The formulas that a render uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulas {
    /// The physics as it was derived and checked for this project.
    #[default]
    Derived,
    /// The formulas as printed in Bergmann et al. 2016, with their errors, for comparison.
    AsPrinted,
}

/// The method by which light is followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// From the camera; and from the lasers through mirrors and glass, where the scene has them.
    #[default]
    Path,
    /// From the lasers to the camera; lights as by the other method. What the camera sees in mirrors
    /// and through glass has no light of lasers.
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
    /// By a point of the light and by a direction of the material, each weighted by how likely it is to
    /// find what the other finds.
    #[default]
    Both,
    /// By a point of the light only: fewer rays, but noise where shiny surfaces mirror a light.
    NextEvent,
    /// By a direction of the material only: right for lights all around, hopeless for small ones.
    Scattering,
}

/// A rectangle of pixels: the part of an image that is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// The first column.
    pub x: usize,
    /// The first row.
    pub y: usize,
    /// The number of columns, at least 1.
    pub width: usize,
    /// The number of rows, at least 1.
    pub height: usize,
}

/// Options for rendering a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderOptions {
    /// The number of camera samples per pixel, at least 1.
    pub samples_per_pixel: u32,
    /// The seed of everything random: camera samples, and speckle where its plan takes the same.
    pub seed: u64,
    /// The formulas.
    pub formulas: Formulas,
    /// The maximum number of surfaces that light may meet between source and camera; `None` for no limit.
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
    /// The part of the image that is rendered; `None` for all. Its pixels have the same bits as in the
    /// whole image, unless a target error asks for more samples.
    pub crop: Option<Crop>,
    /// The relative standard error of a pixel at which it gets no more samples.
    ///
    /// Every pixel first gets `samples_per_pixel` samples, of which 16 or more tell its error well enough.
    /// Then it gets as many again, up to 63 times, until the standard error of its total radiance,
    /// estimated from its samples and raised by 2/√n for the uncertainty of that estimate, is below
    /// this fraction of that radiance, or of a tenth of the mean radiance of the image where the pixel
    /// is darker. Light that is followed from the lasers is added afterwards: neither its error nor
    /// its radiance counts.
    ///
    /// A pixel whose samples happen to miss bright light stops early, which darkens the image a
    /// little: in a closed sphere of reflectance ½ under a narrow beam, with 16 first samples and a target
    /// of 0.2, by less than 0.4 %. The error there is 0.15.
    pub target_error: Option<f64>,
    /// True if the layer of speckle factors has speckle where a laser sends no light, too; otherwise
    /// camera samples that find no light of the laser count with a factor of 1 there. Radiances
    /// are the same, and take less time without.
    pub speckle_in_the_dark: bool,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples_per_pixel: 16,
            seed: 0,
            formulas: Formulas::default(),
            max_depth: None,
            method: Method::default(),
            laser_events: LaserEvents::default(),
            light_events: LightEvents::default(),
            filter: Filter::default(),
            crop: None,
            target_error: None,
            speckle_in_the_dark: true,
        }
    }
}

impl RenderOptions {
    /// Tells whether directions towards lasers are drawn, and paths meet their beams by chance; the
    /// printed formulas have no such directions.
    pub(crate) fn samples_beams(&self) -> bool {
        self.formulas == Formulas::Derived && self.laser_events == LaserEvents::Sampled
    }

    /// Checks the options and returns the part of the camera's image that is rendered.
    pub(super) fn area(&self, camera: &Camera) -> Result<Crop, TracerError> {
        if self.samples_per_pixel == 0 {
            return Err(out_of_range("samples_per_pixel", 0.0, "at least 1"));
        }
        if let Some(error) = self.target_error
            && !(error > 0.0 && error.is_finite())
        {
            return Err(out_of_range("target_error", error, "positive and finite"));
        }
        let [width, height] = [camera.width(), camera.height()];
        let whole = Crop {
            x: 0,
            y: 0,
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
        return Err(out_of_range(parameter, end as f64, allowed));
    }
    Ok(())
}

const fn out_of_range(parameter: &'static str, value: f64, allowed: &'static str) -> TracerError {
    TracerError::OutOfRange {
        parameter,
        value,
        allowed,
    }
}
