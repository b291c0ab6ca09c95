//! Bindings of `tem00-decorrelation`, the module `tem00.decorrelation`.

mod configuration;
mod correlations;
mod geometry;
mod light;
mod rigid;

use pyo3::prelude::*;

pub(crate) use self::rigid::RigidMotion;

/// Imaging geometry, and how speckle moves and changes.
///
/// Vectors are arrays of shape (3,) in world coordinates or of shape (2,) along b1 (to the right)
/// and b2 (up) of the camera. Directions lead away from the surface. Correlations are those of the
/// intensity.
#[pymodule(submodule)]
pub(crate) mod decorrelation {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::{
        configuration::{Configuration, speckle_motion},
        correlations::{
            axial_correlation, correlation_at_image_displacement, correlation_at_peak,
            equivalent_axial_shift, equivalent_pupil_shift, pupil_overlap_correlation,
        },
        geometry::ImagingGeometry,
        light::{Illumination, Wavefront},
        rigid::{CameraFrame, RigidMotion},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::arrays::add_named(module, &["SpeckleMotion"])
    }
}
