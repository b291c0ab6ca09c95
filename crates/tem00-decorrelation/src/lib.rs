//! How a speckle pattern moves and changes when the surface, the camera or the laser moves.

mod correlation;
mod error;
mod frame;
mod geometry;
mod motion;
mod wavefront;

pub use correlation::{
    axial_correlation, correlation, equivalent_pupil_shift, pupil_overlap_correlation,
    slice_coordinate,
};
pub use error::DecorrelationError;
pub use frame::{CameraFrame, LineOfSight};
pub use geometry::{ImagingGeometry, LensData};
pub use glam::{DMat3, DVec2, DVec3};
pub use motion::{ImageOrientation, Motion, SpeckleMotion, SurfacePoint};
pub use wavefront::Wavefront;

/// The smallest cosine between two directions that still counts as different from zero, `2⁻²⁶`.
///
/// It is the square root of the rounding unit: below it, the rounding of a cosine is a larger
/// fraction of the cosine than the cosine is of one.
const GRAZING_COSINE: f64 = 1.0 / 67_108_864.0;
