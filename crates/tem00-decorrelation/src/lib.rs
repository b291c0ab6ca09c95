//! How a speckle pattern moves and changes when the surface, the camera or the laser moves.

mod correlation;

pub use correlation::{
    axial_correlation, correlation, equivalent_pupil_shift, pupil_overlap_correlation,
    slice_coordinate,
};
