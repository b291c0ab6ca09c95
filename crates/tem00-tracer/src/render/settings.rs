use super::{Crop, Formulas, LampEvents, LaserEvents, Method, RenderOptions};
use crate::Filter;

/// Choices about the image; the command line may overrule them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// The number of camera samples per pixel.
    pub samples_per_pixel: u32,
    /// The seed of everything random: camera samples and speckle.
    pub seed: u64,
    /// The number of frames.
    pub frames: u32,
    /// The frame whose speckle the others' has moved and changed from.
    pub reference_frame: u32,
    /// The maximum number of surfaces that light may meet between source and camera; `None` for no limit.
    pub max_depth: Option<u32>,
    /// The method by which light is followed.
    pub method: Method,
    /// The way in which the lasers are sampled from a surface.
    pub laser_events: LaserEvents,
    /// The part of the image that is rendered; `None` for all.
    pub crop: Option<Crop>,
    /// The relative standard error of a pixel at which it gets no more samples.
    pub target_error: Option<f64>,
    /// The filter that weights the samples around a pixel.
    pub filter: Filter,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            samples_per_pixel: 16,
            seed: 0,
            frames: 1,
            reference_frame: 0,
            max_depth: None,
            method: Method::default(),
            laser_events: LaserEvents::default(),
            crop: None,
            target_error: None,
            filter: Filter::default(),
        }
    }
}

impl From<&RenderSettings> for RenderOptions {
    fn from(settings: &RenderSettings) -> Self {
        Self {
            samples_per_pixel: settings.samples_per_pixel,
            seed: settings.seed,
            formulas: Formulas::Derived,
            max_depth: settings.max_depth,
            method: settings.method,
            laser_events: settings.laser_events,
            lamp_events: LampEvents::default(),
            filter: settings.filter,
            crop: settings.crop,
            target_error: settings.target_error,
        }
    }
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self::from(&RenderSettings::default())
    }
}
