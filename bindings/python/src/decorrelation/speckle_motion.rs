use pyo3::prelude::*;
use tem00_decorrelation as physics;

use super::{
    configuration::Configuration,
    geometry::ImagingGeometry,
    motion::{Motion, SurfacePoint},
    vectors::{Array2, array2, numbers, orientation_of},
};
use crate::error::refused;

/// Effect of a motion on the speckle at one surface point.
///
/// Parameters
/// ----------
/// geometry : ImagingGeometry
///     The camera.
/// point : SurfacePoint
///     The surface point in the reference state.
/// motion : Motion
///     What moved since.
/// orientation : {"screen_upright", "sensor_inverted"}
///     Which way up image displacements are counted.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpeckleMotion(physics::SpeckleMotion);

#[pymethods]
impl SpeckleMotion {
    #[new]
    fn new(
        geometry: PyRef<'_, ImagingGeometry>,
        point: PyRef<'_, SurfacePoint>,
        motion: PyRef<'_, Motion>,
        orientation: &str,
    ) -> PyResult<Self> {
        let orientation = orientation_of(orientation)?;
        let speckle =
            physics::SpeckleMotion::new(&geometry.geometry, &point.0, &motion.0, orientation);
        checked(speckle, "motion")
    }

    /// Return the motion of the speckle between two states of the same surface point.
    ///
    /// Parameters
    /// ----------
    /// geometry : ImagingGeometry
    ///     The camera in both states; its wavelength does not count here.
    /// before, after : Configuration
    ///     The states, however far apart.
    /// orientation : {"screen_upright", "sensor_inverted"}
    ///     Which way up image displacements are counted.
    #[staticmethod]
    fn between(
        geometry: PyRef<'_, ImagingGeometry>,
        before: PyRef<'_, Configuration>,
        after: PyRef<'_, Configuration>,
        orientation: &str,
    ) -> PyResult<Self> {
        let orientation = orientation_of(orientation)?;
        let speckle =
            physics::SpeckleMotion::between(&geometry.geometry, &before.0, &after.0, orientation);
        checked(speckle, "after")
    }

    /// Motion of the image of the surface along b1 and b2, in metres on the sensor.
    #[getter]
    fn image_displacement<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        array2(py, "motion", self.0.image_displacement)
    }

    /// Additional displacement of the speckle of a point out of focus, in metres on the sensor.
    #[getter]
    fn defocus_displacement<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        array2(py, "motion", self.0.defocus_displacement)
    }

    /// Motion of the speckle in the image, the sum of both, in metres on the sensor.
    #[getter]
    fn speckle_displacement<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        array2(py, "motion", self.0.speckle_displacement())
    }

    /// Motion of the speckle field across the pupil along b1 and b2, in metres.
    ///
    /// ``None`` if it left the pupil in a grazing view.
    #[getter]
    fn pupil_displacement<'py>(&self, py: Python<'py>) -> PyResult<Option<Array2<'py>>> {
        self.0
            .pupil_displacement
            .map(|displacement| array2(py, "motion", displacement))
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

    /// Correlation of intensity with the pattern before, in [0, 1].
    ///
    /// It is that of the pattern looked up at the ``speckle_displacement``: by the law
    /// ``CorrelationLaw.at_image_displacement()`` of ``SpeckleMotion(…)``,
    /// ``CorrelationLaw.at_peak()`` of ``between``.
    field correlation -> f64;
}

/// Refuses what moved so far that the result is NaN.
fn checked(speckle: physics::SpeckleMotion, name: &'static str) -> PyResult<SpeckleMotion> {
    numbers(name, speckle.speckle_displacement())?;
    if speckle.axial_displacement.is_nan() || speckle.correlation.is_nan() {
        let message = format!("{name} must be less extreme to have a result");
        return Err(refused(name, message));
    }
    Ok(SpeckleMotion(speckle))
}
