use tem00_camera::Camera;
use tem00_geometry::Intersector;
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
    /// The maximum number of surfaces that light may meet between laser and camera; `None` for no
    /// limit.
    pub max_depth: Option<u32>,
    pub selection: LightSelection,
    /// The part of the image that is rendered.
    pub area: Crop,
}

/// The part of the light that is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightSelection {
    /// All light that reaches the camera from a rough surface.
    All,
    /// Light whose first hit is specular: exactly the light that the path tracer cannot find.
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
