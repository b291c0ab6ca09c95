mod configuration;
mod correlations;
mod frame;
mod geometry;
mod illumination;
mod lens;
mod rigid;
mod speckle_motion;
mod vectors;
mod wavefront;

use pyo3::prelude::*;

pub(crate) use self::rigid::RigidMotion;

/// Imaging geometry, and how speckle moves and changes.
///
/// Vectors are arrays of shape (3,) in world coordinates or of shape (2,) along b1 (to the right)
/// and b2 (up) of the camera. Directions lead away from the surface. Correlations are those of the
/// intensity.
#[pymodule(submodule)]
pub(crate) mod decorrelation {
    #[pymodule_export]
    use super::{
        configuration::Configuration,
        correlations::{
            CorrelationLaw, axial_correlation, equivalent_axial_shift, equivalent_pupil_shift,
            pupil_overlap_correlation,
        },
        frame::{CameraFrame, LineOfSight},
        geometry::ImagingGeometry,
        illumination::Illumination,
        lens::{Focus, LensData, PupilDistances, ThickLensData},
        rigid::{RigidMotion, RigidMotions},
        speckle_motion::SpeckleMotion,
        wavefront::Wavefront,
    };
}
