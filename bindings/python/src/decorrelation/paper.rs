use numpy::PyArray2;
use pyo3::{prelude::*, types::PyAny};
use tem00_decorrelation::{DVec2, paper as physics};

use super::{
    frame::CameraFrame,
    geometry::{ImagingGeometry, check_pattern, coordinate_arguments},
    vectors::{Array2, Array3, array2, array3, array33, shown, vec2, vec3},
};
use crate::{
    arrays::{Count, Numbers, map, map_many},
    error::{OrRaise, refused},
};

/// Formulas as printed in Bergmann et al. 2016, where they differ from the rest of this package or
/// are a special case of it.
///
/// Vectors are in surface coordinates n1, n2, n3, with n3 the normal.
#[pymodule(submodule)]
pub(crate) mod paper {
    #[pymodule_export]
    use super::{
        Emitter, EulerAngles, axial_decorrelation_length, image_displacement, pattern_coordinate,
        pupil_displacement, relative_pupil_displacement, slice_coordinate,
    };
}

/// The two angles by which the paper relates the camera to the surface.
///
/// Parameters
/// ----------
/// q1 : float
///     Rotation about the second axis of the surface, in radians.
/// q2 : float
///     Rotation about the first axis of the intermediate system, in radians.
#[pyclass(frozen, eq, module = "tem00.decorrelation.paper")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EulerAngles(physics::EulerAngles);

#[pymethods]
impl EulerAngles {
    #[new]
    #[pyo3(signature = (*, q1, q2))]
    fn new(q1: f64, q2: f64) -> PyResult<Self> {
        check_finite("q1", q1)?;
        check_finite("q2", q2)?;
        Ok(Self(physics::EulerAngles { q1, q2 }))
    }

    /// Return the axes of a surface and the angles between it and a camera.
    ///
    /// Parameters
    /// ----------
    /// camera : CameraFrame
    ///     Orientation of the camera.
    /// normal : array of shape (3,)
    ///     Normal of the surface, of any length.
    ///
    /// Returns
    /// -------
    /// array of shape (3, 3)
    ///     n1, n2, n3 as columns: the transpose takes world vectors to surface coordinates.
    /// EulerAngles
    ///     The angles.
    #[staticmethod]
    fn between<'py>(
        py: Python<'py>,
        camera: PyRef<'py, CameraFrame>,
        normal: Numbers<'py>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Self)> {
        let between = physics::EulerAngles::between(&camera.0, vec3("normal", &normal)?);
        let (axes, angles) = between.or_raise()?;
        Ok((array33(py, axes)?, Self(angles)))
    }

    /// Rotation about the second axis of the surface, in radians.
    #[getter]
    fn q1(&self) -> f64 {
        self.0.q1
    }

    /// Rotation about the first axis of the intermediate system, in radians.
    #[getter]
    fn q2(&self) -> f64 {
        self.0.q2
    }

    /// Axes b1, b2, b3 of the camera in surface coordinates as the columns of a matrix (3, 3).
    #[getter]
    fn camera_axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array33(py, self.0.camera_axes())
    }

    fn __repr__(&self) -> String {
        format!("EulerAngles(q1={:?}, q2={:?})", self.0.q1, self.0.q2)
    }
}

/// Where the paper takes the light to come from.
///
/// Parameters
/// ----------
/// direction : array of shape (3,)
///     Unit vector from the surface to the laser emitter, in surface coordinates.
/// distance : float
///     Distance from the surface to the emitter, in metres; infinite for collimated light.
#[pyclass(frozen, eq, module = "tem00.decorrelation.paper")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Emitter(physics::Emitter);

#[pymethods]
impl Emitter {
    #[new]
    #[pyo3(signature = (*, direction, distance))]
    fn new(direction: Numbers<'_>, distance: f64) -> PyResult<Self> {
        let direction = vec3("direction", &direction)?;
        if distance.is_nan() {
            let message = "distance must be a number, got nan m".to_owned();
            return Err(refused("distance", message));
        }
        Ok(Self(physics::Emitter {
            direction,
            distance,
        }))
    }

    /// Unit vector from the surface to the laser emitter, of shape (3,).
    #[getter]
    fn direction<'py>(&self, py: Python<'py>) -> Array3<'py> {
        array3(py, self.0.direction)
    }

    /// Distance from the surface to the emitter, in metres.
    #[getter]
    fn distance(&self) -> f64 {
        self.0.distance
    }

    fn __repr__(&self) -> String {
        let direction = shown(self.0.direction);
        format!(
            "Emitter(direction={direction}, distance={:?})",
            self.0.distance
        )
    }
}

/// Return the displacement of the speckle on the sensor: eq. (5) as printed.
///
/// Parameters
/// ----------
/// magnification : float
///     Magnification of the camera.
/// angles : EulerAngles
///     Angles between surface and camera.
/// a : array of shape (3,)
///     Displacement of the object, in metres and surface coordinates.
///
/// Returns
/// -------
/// array of shape (2,)
///     Metres on the sensor.
#[pyfunction]
pub(super) fn image_displacement<'py>(
    py: Python<'py>,
    magnification: f64,
    angles: PyRef<'py, EulerAngles>,
    a: Numbers<'py>,
) -> PyResult<Array2<'py>> {
    check_finite("magnification", magnification)?;
    let displacement = physics::image_displacement(magnification, angles.0, vec3("a", &a)?);
    array2(py, "a", displacement)
}

/// Return the displacement of the speckle across the pupil: the pair of §6.4 as printed.
///
/// Parameters
/// ----------
/// angles : EulerAngles
///     Angles between surface and camera.
/// emitter : Emitter
///     Where the light comes from.
/// surface_to_pupil : float
///     Distance in metres.
/// a : array of shape (3,)
///     Displacement of the object, in metres and surface coordinates.
///
/// Returns
/// -------
/// array of shape (2,) or None
///     Metres in the pupil; `None` where the printed fractions have no value.
#[pyfunction]
pub(super) fn pupil_displacement<'py>(
    py: Python<'py>,
    angles: PyRef<'py, EulerAngles>,
    emitter: PyRef<'py, Emitter>,
    surface_to_pupil: f64,
    a: Numbers<'py>,
) -> PyResult<Option<Array2<'py>>> {
    check_finite("surface_to_pupil", surface_to_pupil)?;
    let a = vec3("a", &a)?;
    physics::pupil_displacement(angles.0, emitter.0, surface_to_pupil, a)
        .map(|displacement| array2(py, "a", displacement))
        .transpose()
}

/// Return the sum of a camera motion and the displacement of the speckle, as §6.4 combines them.
///
/// Parameters
/// ----------
/// camera, surface : array of shape (2,)
///     Both in metres in the pupil plane.
#[pyfunction]
pub(super) fn relative_pupil_displacement<'py>(
    py: Python<'py>,
    camera: Numbers<'py>,
    surface: Numbers<'py>,
) -> PyResult<Array2<'py>> {
    let (camera, surface) = (vec2("camera", &camera)?, vec2("surface", &surface)?);
    let sum = physics::relative_pupil_displacement(camera, surface);
    array2(py, "camera", sum)
}

/// Return the axial displacement in metres at which §6.4 takes the pattern for decorrelated.
#[pyfunction]
pub(super) fn axial_decorrelation_length(geometry: PyRef<'_, ImagingGeometry>) -> f64 {
    physics::axial_decorrelation_length(&geometry.geometry)
}

/// Return the slice coordinate of §6.4, without wrapping.
///
/// Parameters
/// ----------
/// geometry : ImagingGeometry
///     The camera.
/// pupil_displacement : pair of floats or arrays
///     Displacement in the pupil in metres.
/// axial_displacement : float or array
///     Displacement along the axis in metres.
/// half_period : int
///     Half the number of slices of the stack.
#[pyfunction]
pub(super) fn slice_coordinate<'py>(
    py: Python<'py>,
    geometry: PyRef<'py, ImagingGeometry>,
    pupil_displacement: [Numbers<'py>; 2],
    axial_displacement: Numbers<'py>,
    half_period: Count,
) -> PyResult<Bound<'py, PyAny>> {
    let half_period = half_period.value("half_period")?;
    let geometry = geometry.geometry;
    let [x, y] = &pupil_displacement;
    let named = [
        ("pupil_displacement", x),
        ("pupil_displacement", y),
        ("axial_displacement", &axial_displacement),
    ];
    map(py, named, |[x, y, axial]| {
        physics::slice_coordinate(&geometry, DVec2::new(x, y), axial, half_period)
    })
}

/// Return the pattern coordinate of §6.3, in pattern samples, without wrapping.
///
/// Parameters
/// ----------
/// geometry : ImagingGeometry
///     The camera.
/// pixel : pair of floats or arrays
///     Place in pixels.
/// image_displacement : pair of floats or arrays
///     Motion of the speckle in metres on the sensor.
/// pattern_speckle_size : float
///     Speckle size of the pattern in samples.
#[pyfunction]
pub(super) fn pattern_coordinate<'py>(
    py: Python<'py>,
    geometry: PyRef<'py, ImagingGeometry>,
    pixel: [Numbers<'py>; 2],
    image_displacement: [Numbers<'py>; 2],
    pattern_speckle_size: f64,
) -> PyResult<[Bound<'py, PyAny>; 2]> {
    check_pattern(pattern_speckle_size)?;
    let geometry = geometry.geometry;
    let named = coordinate_arguments(&pixel, &image_displacement);
    map_many(py, named, |[x, y, ax, ay]| {
        let (pixel, displacement) = (DVec2::new(x, y), DVec2::new(ax, ay));
        physics::pattern_coordinate(&geometry, pixel, displacement, pattern_speckle_size).to_array()
    })
}

fn check_finite(name: &'static str, value: f64) -> PyResult<()> {
    if value.is_finite() {
        return Ok(());
    }
    Err(refused(name, format!("{name} must be finite, got {value}")))
}
