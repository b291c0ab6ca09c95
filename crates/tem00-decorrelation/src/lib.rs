//! How a speckle pattern moves and changes when the surface, the camera or the laser moves.

mod correlation;
mod error;
mod geometry;

pub use correlation::{
    axial_correlation, correlation, equivalent_pupil_shift, pupil_overlap_correlation,
    slice_coordinate,
};
pub use error::DecorrelationError;
pub use geometry::{ImagingGeometry, LensData};
