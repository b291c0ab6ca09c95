//! From the camera and the motion in a scene to the speckle factor of a camera sample.

mod allocation;
mod bandwidth;
mod between_frames;
mod change;
mod crossing;
mod model;
mod multiple;
mod notes;
mod plan;
mod prescan;

pub use between_frames::{FollowedPoint, SpeckleChange};
pub(crate) use change::{Change, moves};
pub use crossing::CorrelationNote;
use glam::{DVec2, DVec3};
pub(crate) use model::SpeckleFrame;
pub use model::SpeckleModel;
pub(crate) use multiple::{CellGrid, LightKey, MultipleMap, MultiplePath, MultipleSums};
pub use notes::{CascadeNote, RoughnessNote, roughness_notes};
pub use plan::{PatternPlan, SpecklePlan};
use tem00_geometry::Hit;
use tem00_shading::SeenPoint;

/// A point of a surface that a path has met, and where in the image it is seen.
///
/// The point need not lie on the chief ray of its pixel: out of focus it is seen next to this ray,
/// and in a mirror somewhere else. Its speckle is taken to move as far as the point would move if
/// it were seen directly, which in a plane mirror is right except for the reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpecklePoint {
    /// The image point of the sample, in pixels.
    pub pixel: DVec2,
    /// The point of the surface, in metres.
    pub position: DVec3,
    /// The unit normal on the side that is seen.
    pub normal: DVec3,
    /// The index of the surface in the scene.
    pub surface: usize,
    /// A number between 0 and 1 that draws the wave number from the line of a laser.
    pub wave: f64,
}

impl SpecklePoint {
    /// Returns the point at which a ray of an image point meets a surface, in the mean wave number
    /// of each line.
    pub(crate) const fn of_hit(pixel: DVec2, hit: &Hit) -> Self {
        Self {
            pixel,
            position: hit.position,
            normal: hit.normal,
            surface: hit.surface,
            wave: 0.5,
        }
    }

    fn seen(&self) -> SeenPoint {
        SeenPoint {
            pixel: self.pixel,
            position: self.position,
            normal: self.normal,
        }
    }
}
