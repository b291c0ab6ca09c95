use crate::Pose;

/// The motion of a body, the camera and the laser from the reference state to the current frame.
///
/// Only relative motions matter: if all three move as one, nothing changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// The number of the body. Bodies with different motions have different numbers and independent
    /// speckle: a surface that a moving body uncovers does not show the speckle of that body.
    pub body: usize,
    /// The pose of the body whose surface is shaded.
    pub surface: Pose,
    /// The pose of the camera.
    pub camera: Pose,
    /// The pose of the laser.
    pub laser: Pose,
}

impl Motion {
    /// Returns whether nothing has moved.
    pub(crate) fn is_still(&self) -> bool {
        [self.surface, self.camera, self.laser] == [Pose::IDENTITY; 3]
    }
}

impl From<Pose> for Motion {
    /// The motion of body 0 alone.
    fn from(surface: Pose) -> Self {
        Self {
            surface,
            ..Self::default()
        }
    }
}
