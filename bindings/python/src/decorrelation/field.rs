use pyo3::prelude::*;
use tem00_decorrelation::{self as physics, DVec3};

use super::{
    frame::CameraFrame,
    geometry::ImagingGeometry,
    motion::Motion,
    vectors::{orientation_name, orientation_of, shown, vec3},
};
use crate::{
    arrays::{Components, Named, Numbers, Values, Vector, fill},
    error::OrRaise,
};

/// Settings common to all points of a field: the camera and the pattern it looks up.
///
/// Parameters
/// ----------
/// geometry : ImagingGeometry
///     The lens, its pupil and the sensor.
/// camera : CameraFrame
///     The axes of the camera.
/// pupil_centre : array_like, shape (3,)
///     Centre of the pupil in world coordinates, in metres.
/// orientation : {"screen_upright", "sensor_inverted"}
///     Which way up image displacements are counted.
/// pattern_speckle_size : float
///     Speckle size of the pattern in samples.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FieldSetup {
    setup: physics::FieldSetup,
    geometry: ImagingGeometry,
}

#[pymethods]
impl FieldSetup {
    #[new]
    #[pyo3(signature = (
        *, geometry, camera, pupil_centre, orientation, pattern_speckle_size
    ))]
    fn new(
        geometry: PyRef<'_, ImagingGeometry>,
        camera: PyRef<'_, CameraFrame>,
        pupil_centre: Components<'_>,
        orientation: &str,
        pattern_speckle_size: f64,
    ) -> PyResult<Self> {
        let setup = physics::FieldSetup {
            geometry: geometry.geometry,
            camera: camera.0,
            pupil_centre: vec3("pupil_centre", &pupil_centre)?,
            orientation: orientation_of(orientation)?,
            pattern_speckle_size,
        };
        let geometry = *geometry;
        Ok(Self { setup, geometry })
    }

    fn __repr__(&self) -> String {
        let (geometry, camera) = (self.geometry.__repr__(), self.camera().__repr__());
        let centre = shown(self.setup.pupil_centre);
        format!(
            "FieldSetup(geometry={geometry}, camera={camera}, pupil_centre={centre}, \
             orientation={:?}, pattern_speckle_size={:?})",
            self.orientation(),
            self.setup.pattern_speckle_size
        )
    }
}

methods! {
    impl FieldSetup as this: this.setup;

    /// The lens, its pupil and the sensor.
    get geometry -> ImagingGeometry = this.geometry;

    /// The axes of the camera.
    get camera -> CameraFrame = CameraFrame(this.setup.camera);

    /// Centre of the pupil in metres, of shape (3,).
    field pupil_centre -> Vector<3>;

    /// Orientation in which image displacements are counted.
    get orientation -> &'static str = orientation_name(this.setup.orientation);

    /// Speckle size of the pattern in samples.
    field pattern_speckle_size -> f64;
}

/// The light on the points of a field, by the curvature of its wavefront there.
#[pyclass(frozen, module = "tem00.decorrelation")]
#[derive(Debug)]
pub(crate) struct FieldLight(Light);

#[derive(Debug)]
enum Light {
    Collimated,
    PointSource(DVec3),
    /// The components of the tensor, as they were given.
    Curvature([Py<PyAny>; 6]),
}

#[pymethods]
impl FieldLight {
    /// Return plane waves.
    #[staticmethod]
    fn collimated() -> Self {
        Self(Light::Collimated)
    }

    /// Return spherical waves that diverge from a point of shape (3,), in metres.
    #[staticmethod]
    fn point_source(position: Components<'_>) -> PyResult<Self> {
        Ok(Self(Light::PointSource(vec3("position", &position)?)))
    }

    /// Return waves of any curvature tensor, in 1/m and world coordinates.
    ///
    /// Parameters
    /// ----------
    /// curvature : six floats or array_like
    ///     The components xx, xy, xz, yy, yz, zz, which broadcast with the points.
    #[staticmethod]
    fn curvature(curvature: [Bound<'_, PyAny>; 6]) -> PyResult<Self> {
        for component in &curvature {
            component.extract::<Numbers<'_>>()?;
        }
        Ok(Self(Light::Curvature(curvature.map(Bound::unbind))))
    }

    fn __repr__(&self) -> String {
        match &self.0 {
            Light::Collimated => "FieldLight.collimated()".to_owned(),
            Light::PointSource(position) => {
                format!("FieldLight.point_source({})", shown(*position))
            }
            Light::Curvature(_) => "<FieldLight: curvature tensors>".to_owned(),
        }
    }
}

methods! {
    impl FieldLight as this: this.0;

    unmade "collimated, point_source or curvature";
}

/// Effect of motions on the speckle at many surface points.
///
/// Numbers where points were numbers, arrays of the common shape where they were arrays.
#[pyclass(frozen, module = "tem00.decorrelation")]
#[derive(Debug)]
pub(crate) struct FieldSlices([Field; 7]);

/// A number for one point, an array for many.
type Field = Py<PyAny>;

impl FieldSlices {
    fn pair(&self, py: Python<'_>, first: usize) -> (Field, Field) {
        (self.0[first].clone_ref(py), self.0[first + 1].clone_ref(py))
    }
}

#[pymethods]
impl FieldSlices {
    /// Motion of the speckle in the image along b1 and b2, in metres on the sensor.
    #[getter]
    fn speckle_displacement(&self, py: Python<'_>) -> (Field, Field) {
        self.pair(py, 0)
    }

    /// Motion of the speckle field across the pupil along b1 and b2, in metres.
    ///
    /// Infinite where the pattern counts as decorrelated because the speckle left the pupil.
    #[getter]
    fn pupil_displacement(&self, py: Python<'_>) -> (Field, Field) {
        self.pair(py, 2)
    }

    /// Correlation of intensity with the pattern before, in [0, 1]; the slice to look up
    /// is ``SpeckleStack.coordinate_of`` of it.
    #[getter]
    fn correlation(&self, py: Python<'_>) -> Field {
        self.0[4].clone_ref(py)
    }

    /// Coordinates at which to look the pattern up, in pattern samples and not wrapped.
    ///
    /// They are those of the images of the points in the reference state from the optical axis, less what
    /// their speckle moves beside them out of focus; 0 out of sight.
    #[getter]
    fn pattern_coordinate(&self, py: Python<'_>) -> (Field, Field) {
        self.pair(py, 5)
    }

    fn __repr__(&self) -> String {
        format!("<FieldSlices: correlation={}>", self.0[4])
    }
}

methods! {
    impl FieldSlices as this: this.0;

    unmade "MotionField";
}

/// Effect of motions on the speckle at many surface points, such as those behind the pixels.
///
/// Parameters
/// ----------
/// setup : FieldSetup
///     What all points share; the surface moves alone.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MotionField {
    field: physics::MotionField,
    setup: FieldSetup,
}

#[pymethods]
impl MotionField {
    #[new]
    fn new(setup: PyRef<'_, FieldSetup>) -> PyResult<Self> {
        let field = physics::MotionField::new(setup.setup).or_raise()?;
        let setup = *setup;
        Ok(Self { field, setup })
    }

    /// Return the field with a motion of camera, source and all surfaces added to the points'.
    fn with_shared_motion(&self, motion: PyRef<'_, Motion>) -> Self {
        Self {
            field: self.field.with_shared_motion(&motion.0),
            setup: self.setup,
        }
    }

    /// Work out displacements, correlation and coordinates at many points.
    ///
    /// All arguments broadcast together. Arrays in float64 that lie row by row are not copied.
    ///
    /// Parameters
    /// ----------
    /// position : three floats or array_like
    ///     Positions x, y, z in the reference state, in metres.
    /// normal : three floats or array_like
    ///     Surface normals of any length, to either side.
    /// motion : three floats or array_like
    ///     Translations of the surface since the reference state, in metres.
    /// light : FieldLight
    ///     The light on the points.
    ///
    /// Returns
    /// -------
    /// FieldSlices
    ///     The results, in the common shape.
    #[pyo3(signature = (*, position, normal, motion, light))]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        position: [Numbers<'py>; 3],
        normal: [Numbers<'py>; 3],
        motion: [Numbers<'py>; 3],
        light: PyRef<'py, FieldLight>,
    ) -> PyResult<FieldSlices> {
        let points = [&position, &normal, &motion];
        let results = match &light.0 {
            Light::Collimated => self.run(py, points, physics::FieldLight::Collimated),
            Light::PointSource(source) => {
                self.run(py, points, physics::FieldLight::PointSource(*source))
            }
            Light::Curvature(tensor) => self.run_curved(py, points, tensor),
        };
        Ok(FieldSlices(results?.map(Bound::unbind)))
    }

    fn __repr__(&self) -> String {
        format!("MotionField({})", self.setup.__repr__())
    }
}

methods! {
    impl MotionField as this: this.setup;

    /// Settings common to all points.
    get setup -> FieldSetup = this.setup;
}

/// The arrays of the results.
type Results<'py> = [Values<'py>; 7];

impl MotionField {
    /// Evaluates in light that is the same for all points.
    fn run<'py>(
        &self,
        py: Python<'py>,
        points: [&[Numbers<'py>; 3]; 3],
        light: physics::FieldLight<'static>,
    ) -> PyResult<Results<'py>> {
        let named: [Named<'_, 'py>; 9] = named_points(points);
        fill(py, named, |columns, out| {
            let [px, py, pz, nx, ny, nz, ax, ay, az] = columns;
            let points = physics::FieldPoints {
                position: [px, py, pz],
                normal: [nx, ny, nz],
                motion: [ax, ay, az],
                light,
            };
            self.field.evaluate(&points, slices(out));
        })
    }

    /// Evaluates in light of any curvature.
    fn run_curved<'py>(
        &self,
        py: Python<'py>,
        points: [&[Numbers<'py>; 3]; 3],
        tensor: &[Py<PyAny>; 6],
    ) -> PyResult<Results<'py>> {
        let tensor: Vec<Numbers<'py>> = tensor
            .iter()
            .map(|component| component.bind(py).extract())
            .collect::<PyResult<_>>()?;
        let mut named: [Named<'_, 'py>; 15] = [("curvature", &tensor[0]); 15];
        named[..9].copy_from_slice(&named_points(points));
        for (named, component) in named[9..].iter_mut().zip(&tensor) {
            named.1 = component;
        }
        fill(py, named, |columns, out| {
            let [px, py, pz, nx, ny, nz, ax, ay, az, xx, xy, xz, yy, yz, zz] = columns;
            let points = physics::FieldPoints {
                position: [px, py, pz],
                normal: [nx, ny, nz],
                motion: [ax, ay, az],
                light: physics::FieldLight::Curvature([xx, xy, xz, yy, yz, zz]),
            };
            self.field.evaluate(&points, slices(out));
        })
    }
}

/// The components of points with their names, in order.
fn named_points<'a, 'py>(
    [position, normal, motion]: [&'a [Numbers<'py>; 3]; 3],
) -> [Named<'a, 'py>; 9] {
    let [[px, py, pz], [nx, ny, nz], [ax, ay, az]] = [position, normal, motion];
    [
        ("position", px),
        ("position", py),
        ("position", pz),
        ("normal", nx),
        ("normal", ny),
        ("normal", nz),
        ("motion", ax),
        ("motion", ay),
        ("motion", az),
    ]
}

/// Destination of the results of a block.
fn slices(out: [&mut [f64]; 7]) -> physics::FieldSlices<'_> {
    let [sx, sy, px, py, correlation, cx, cy] = out;
    physics::FieldSlices {
        speckle_displacement: [sx, sy],
        pupil_displacement: [px, py],
        correlation,
        pattern_coordinate: [cx, cy],
    }
}
