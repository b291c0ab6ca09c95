use pyo3::prelude::*;
use tem00_decorrelation as physics;

use super::{
    configuration::Configuration,
    geometry::ImagingGeometry,
    vectors::{Array2, array2, numbers},
};
use crate::error::refused;

/// Change of the speckle at one surface point between two states.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpeckleMotion(physics::SpeckleMotion);

#[pymethods]
impl SpeckleMotion {
    /// Return the motion of the speckle between two states of the same surface point.
    ///
    /// Parameters
    /// ----------
    /// geometry : ImagingGeometry
    ///     The camera in both states; its wavelength does not count here.
    /// before, after : Configuration
    ///     The states, however far apart.
    #[staticmethod]
    fn between(
        geometry: PyRef<'_, ImagingGeometry>,
        before: PyRef<'_, Configuration>,
        after: PyRef<'_, Configuration>,
    ) -> PyResult<Self> {
        let speckle = physics::SpeckleMotion::between(&geometry.geometry, &before.0, &after.0);
        // Refuses what moved so far that the result is NaN.
        numbers("after", speckle.speckle_displacement())?;
        if speckle.axial_displacement.is_nan() || speckle.correlation.is_nan() {
            let message = "after must be less extreme to have a result".to_owned();
            return Err(refused("after", message));
        }
        Ok(Self(speckle))
    }

    /// Motion of the image of the surface along b1 and b2, in metres on the sensor, upright.
    #[getter]
    fn image_displacement<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        array2(py, "after", self.0.image_displacement)
    }

    /// Additional displacement of the speckle of a point out of focus, in metres on the sensor.
    #[getter]
    fn defocus_displacement<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        array2(py, "after", self.0.defocus_displacement)
    }

    /// Motion of the speckle in the image, the sum of both, in metres on the sensor.
    #[getter]
    fn speckle_displacement<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        array2(py, "after", self.0.speckle_displacement())
    }

    /// Motion of the speckle field across the pupil along b1 and b2, in metres.
    ///
    /// ``None`` where the pattern is decorrelated, as in a grazing view.
    #[getter]
    fn pupil_displacement<'py>(&self, py: Python<'py>) -> PyResult<Option<Array2<'py>>> {
        self.0
            .pupil_displacement
            .map(|displacement| array2(py, "after", displacement))
            .transpose()
    }

    fn __repr__(&self) -> String {
        let displacement = self.0.speckle_displacement().to_array();
        let correlation = self.0.correlation;
        format!(
            "<SpeckleMotion: speckle_displacement={displacement:?}, correlation={correlation:?}>"
        )
    }
}

methods! {
    impl SpeckleMotion as this: this.0;

    /// Motion of the surface towards the camera along the optical axis, in metres.
    field axial_displacement -> f64;

    /// Correlation of intensity with the pattern before, in [0, 1], looked up at the
    /// ``speckle_displacement``: ``CorrelationLaw.at_peak()``.
    field correlation -> f64;

    unmade "between";
}
