use crate::Pose;

/// The motion of a body, the camera and the laser from the reference state to now.
///
/// Only differences count: if all three move as one, nothing changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// The number of the body. Bodies that move apart have numbers of their own, and speckle of
    /// their own: what one of them uncovers does not show the speckle that it took with it.
    pub body: usize,
    /// The pose of the body whose surface is looked at.
    pub surface: Pose,
    /// The pose of the camera.
    pub camera: Pose,
    /// The pose of the laser.
    pub laser: Pose,
}

impl Motion {
    /// Tells whether nothing has moved.
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
