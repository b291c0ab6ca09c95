use pyo3::prelude::*;
use tem00_decorrelation as physics;

use super::{
    frame::{CameraFrame, LineOfSight},
    illumination::Illumination,
    rigid::RigidMotions,
    vectors::{Array2, array2, shown, vec2, vec3},
};
use crate::{
    arrays::{Components, Vector, wavelength_of_light},
    error::OrRaise,
};

/// A point of a rough surface, its light and its camera, all in the world: one state of a scene.
///
/// One state is made with ``Configuration(…)``, the other from it, by moving the bodies or changing the light.
///
/// Parameters
/// ----------
/// wavelength : float
///     Vacuum wavelength of the light in metres.
/// point : array_like, shape (3,)
///     Position of the surface point in metres.
/// normal : array_like, shape (3,)
///     Normal of the surface, of any length and to either side.
/// illumination : Illumination
///     The light on the surface.
/// camera : CameraFrame
///     Orientation of the camera.
/// pupil : array_like, shape (3,)
///     Position of the centre of the entrance pupil in metres.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Configuration(pub(super) physics::Configuration);

#[pymethods]
impl Configuration {
    #[new]
    #[pyo3(signature = (*, wavelength, point, normal, illumination, camera, pupil))]
    fn new(
        wavelength: f64,
        point: Components<'_>,
        normal: Components<'_>,
        illumination: PyRef<'_, Illumination>,
        camera: PyRef<'_, CameraFrame>,
        pupil: Components<'_>,
    ) -> PyResult<Self> {
        let wavelength = wavelength_of_light("wavelength", wavelength)?;
        let state = physics::Configuration::new(physics::ConfigurationData {
            wavelength,
            point: vec3("point", &point)?,
            normal: vec3("normal", &normal)?,
            illumination: illumination.0,
            camera: camera.0,
            pupil: vec3("pupil", &pupil)?,
        });
        Ok(Self(state.or_raise_renamed(&["to_pupil"], "pupil")?))
    }

    /// Return the state after surface, camera and source have moved.
    fn moved(&self, motions: PyRef<'_, RigidMotions>) -> PyResult<Self> {
        let state = self.0.moved(&motions.0);
        Ok(Self(
            state.or_raise_renamed(&["to_pupil", "point"], "motions")?,
        ))
    }

    /// Return the state with other light on the surface.
    fn with_illumination(&self, illumination: PyRef<'_, Illumination>) -> PyResult<Self> {
        let state = self.0.with_illumination(illumination.0);
        Ok(Self(state.or_raise_renamed(&["point"], "illumination")?))
    }

    /// Return the state with another wavelength, in metres.
    fn with_wavelength(&self, wavelength: f64) -> PyResult<Self> {
        Ok(Self(self.0.with_wavelength(wavelength).or_raise()?))
    }

    /// Return where the speckle field after a change is what it was at a point of the pupil before.
    ///
    /// Parameters
    /// ----------
    /// after : Configuration
    ///     The state after the change.
    /// pupil_point : array_like, shape (2,)
    ///     Components along b1 and b2 from the centre of the pupil, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2,) or None
    ///     The same after the change; ``None`` where there is no such point.
    fn pupil_point_after<'py>(
        &self,
        py: Python<'py>,
        after: PyRef<'py, Self>,
        pupil_point: Components<'py>,
    ) -> PyResult<Option<Array2<'py>>> {
        let pupil_point = vec2("pupil_point", &pupil_point)?;
        let moved = self.0.pupil_point_after(&after.0, pupil_point);
        moved
            .map(|moved| array2(py, "pupil_point", moved))
            .transpose()
    }

    /// Return by how much a change alters the phase that a scatterer gains with its height.
    ///
    /// Returns
    /// -------
    /// float or None
    ///     Radians per metre of height; ``None`` where ``pupil_point_after`` has no point.
    fn height_phase_change(&self, after: PyRef<'_, Self>) -> Option<f64> {
        self.0.height_phase_change(&after.0)
    }

    fn __repr__(&self) -> String {
        let (point, pupil) = (shown(self.0.point()), shown(self.0.pupil()));
        format!(
            "<Configuration: wavelength={:?}, point={point}, pupil={pupil}>",
            self.0.wavelength()
        )
    }
}

methods! {
    impl Configuration as this: this.0;

    /// Vacuum wavelength in metres.
    get wavelength -> f64;

    /// Position of the surface point in metres, of shape (3,).
    get point -> Vector<3>;

    /// Unit normal of the surface, of shape (3,).
    get normal -> Vector<3>;

    /// Unit vector from the surface point to the light source, of shape (3,).
    get direction_to_source -> Vector<3>;

    /// Line of sight to the point.
    get sight -> LineOfSight = LineOfSight(*this.0.sight());

    /// Position of the centre of the entrance pupil in metres, of shape (3,).
    get pupil -> Vector<3>;
}
