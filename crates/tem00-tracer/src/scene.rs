use glam::DVec3;

use crate::{Camera, Lamp, Laser, Material, Shape};

/// An object: a shape made of a material, perhaps moving from frame to frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The name by which reports call it.
    pub name: String,
    /// The shape, in world coordinates, in the first frame.
    pub shape: Shape,
    /// The material.
    pub material: Material,
    /// How far it moves from each frame to the next, in metres.
    pub displacement_per_frame: DVec3,
}

/// Choices about the speckle patterns; what is `None` is chosen from camera, image and motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckleSettings {
    /// The pattern size Q, in samples.
    pub size: Option<usize>,
    /// The diameter C of the random pupil field, in samples; at most half the size.
    pub diameter: Option<usize>,
    /// Half the number of slices, M.
    pub half_period: Option<usize>,
    /// The memory that the patterns of all lasers may take together, in bytes.
    pub memory: u64,
}

impl Default for SpeckleSettings {
    fn default() -> Self {
        Self {
            size: None,
            diameter: None,
            half_period: None,
            memory: 1 << 30,
        }
    }
}

/// Choices about the image; the command line may overrule them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderSettings {
    /// The number of camera samples per pixel.
    pub samples_per_pixel: u32,
    /// The seed of everything random: camera samples and speckle.
    pub seed: u64,
    /// The number of frames.
    pub frames: u32,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            samples_per_pixel: 16,
            seed: 0,
            frames: 1,
        }
    }
}

/// Everything that is rendered, validated.
///
/// The first frame is the reference: the speckle of later frames has moved and changed by what has
/// moved since.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The camera in the first frame.
    pub camera: Camera,
    /// How far the camera moves from each frame to the next, in metres.
    pub camera_displacement_per_frame: DVec3,
    /// The lasers.
    pub lasers: Vec<Laser>,
    /// The objects.
    pub surfaces: Vec<Surface>,
    /// The incoherent lights.
    pub lamps: Vec<Lamp>,
    /// Choices about the speckle patterns.
    pub speckle: SpeckleSettings,
    /// Choices about the image.
    pub render: RenderSettings,
}
