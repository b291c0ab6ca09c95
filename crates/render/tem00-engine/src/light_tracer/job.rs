use tem00_camera::Camera;
use tem00_geometry::Intersector;
use tem00_numerics::Grid;
use tem00_tracer::{Crop, Scene};

use crate::speckle::SpeckleFrame;

/// Follows light from the lasers to the camera, in one frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightTracer<'a> {
    pub scene: &'a Scene,
    /// The camera as it stands in the frame.
    pub camera: &'a Camera,
    /// The surfaces as they stand in the frame, and the area lights behind them.
    pub intersector: &'a Intersector,
    pub speckle: Option<&'a SpeckleFrame<'a>>,
    pub frame: u32,
    /// The maximum number of surfaces that light may meet between laser and camera; `None` for no limit.
    pub max_depth: Option<u32>,
    pub selection: LightSelection,
    /// The part of the image that is rendered.
    pub area: Crop,
}

/// The part of the light that is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightSelection {
    /// All that reaches the camera from a rough surface.
    All,
    /// That of it which a mirror or glass was the first to meet: all that the path tracer misses.
    SpecularFirst,
}

/// Task of a light tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LightJob {
    /// The index of the laser in the scene.
    pub laser: usize,
    /// The number of light paths. The same number gives the same bits in every part of the image.
    pub paths: u64,
    pub seed: u64,
}

/// The layers that light paths add to those of a laser.
///
/// Radiances in W/(m² sr), averaged over the square of the pixel: a light path comes upon its image
/// point by chance, so that no other reconstruction filter applies.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LightLayers {
    /// Radiance of the light that has met one rough surface, before speckle.
    pub single: Grid<f32>,
    /// Radiance of the light that has met more than one, before speckle.
    pub multiple: Grid<f32>,
    /// Radiance of both, each path multiplied by its speckle factor.
    pub radiance: Grid<f32>,
    /// The variance of that, without bias: from groups of paths that are independent of each other.
    pub variance: Grid<f32>,
    /// The power that the light paths bring to the first rough surface where that is seen in the
    /// image, in watts.
    pub power_on_target: f64,
    /// The standard error of that, from the groups; infinite for a single one.
    pub power_error: f64,
}
