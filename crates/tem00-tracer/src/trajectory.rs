use glam::DVec3;
use tem00_decorrelation::RigidMotion;

use crate::TracerError;

/// How something moves from frame to frame.
///
/// The pose of a frame takes the thing from its place in the scene description to its place in that
/// frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    displacement_per_frame: DVec3,
}

impl Trajectory {
    /// Creates a steady motion without rotation, `displacement` metres from each frame to the next.
    ///
    /// # Errors
    ///
    /// Returns an error if the displacement is not finite.
    pub fn steady(displacement: DVec3) -> Result<Self, TracerError> {
        if !displacement.is_finite() {
            return Err(TracerError::Direction {
                parameter: "displacement_per_frame",
                allowed: "a finite displacement",
            });
        }
        Ok(Self {
            displacement_per_frame: displacement,
        })
    }

    /// Returns the pose in `frame`.
    pub fn pose_at(&self, frame: u32) -> RigidMotion {
        RigidMotion::along(f64::from(frame) * self.displacement_per_frame).unwrap_or_default()
    }

    /// Returns whether the pose is the same in every frame.
    pub fn is_still(&self) -> bool {
        self.displacement_per_frame == DVec3::ZERO
    }
}
