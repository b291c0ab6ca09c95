use pyo3::prelude::*;
use tem00_decorrelation as physics;

use super::vectors::{Array3, array3, mat3, shown, shown33, vec3};
use crate::{
    arrays::{Components, Matrix, Table, Vector},
    error::{OrRaise, refused},
    pickling::{Recipe, by_constructor},
};

/// A rotation and a translation of a rigid body, in world coordinates: x' = R x + t.
///
/// Parameters
/// ----------
/// rotation : array_like, shape (3, 3)
///     Rotation matrix.
/// translation : array_like, shape (3,)
///     Translation in metres.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RigidMotion(pub(crate) physics::RigidMotion);

#[pymethods]
impl RigidMotion {
    /// Return the motion of a body that stands still.
    #[staticmethod]
    fn identity() -> Self {
        Self(physics::RigidMotion::IDENTITY)
    }

    #[new]
    fn new(rotation: Table<'_>, translation: Components<'_>) -> PyResult<Self> {
        let rotation = mat3("rotation", &rotation)?;
        let motion = physics::RigidMotion::new(rotation, vec3("translation", &translation)?);
        Ok(Self(motion.or_raise()?))
    }

    /// Return a translation of shape (3,), in metres.
    #[staticmethod]
    fn along(translation: Components<'_>) -> PyResult<Self> {
        let motion = physics::RigidMotion::along(vec3("translation", &translation)?);
        Ok(Self(motion.or_raise()?))
    }

    /// Return a rotation.
    ///
    /// Parameters
    /// ----------
    /// pivot : array_like, shape (3,)
    ///     A point on the axis, in metres.
    /// axis : array_like, shape (3,)
    ///     Direction of the axis, of any length.
    /// angle : float
    ///     Angle in radians, right-handed.
    #[staticmethod]
    fn about(pivot: Components<'_>, axis: Components<'_>, angle: f64) -> PyResult<Self> {
        let (pivot, axis) = (vec3("pivot", &pivot)?, vec3("axis", &axis)?);
        let motion = physics::RigidMotion::about(pivot, axis, angle);
        // Of finite arguments, one at the end of the range makes the translation overflow.
        Ok(Self(motion.or_raise_renamed(&["translation"], "pivot")?))
    }

    /// Return this motion followed by another.
    fn then(&self, next: PyRef<'_, Self>) -> PyResult<Self> {
        finite(self.0.then(&next.0), "next")
    }

    /// Return the motion back.
    fn inverse(&self) -> Self {
        Self(self.0.inverse())
    }

    /// Return where the motion takes a point of shape (3,), in metres.
    fn point<'py>(&self, py: Python<'py>, point: Components<'py>) -> PyResult<Array3<'py>> {
        let moved = self.0.point(vec3("point", &point)?);
        if moved.is_finite() {
            return Ok(array3(py, moved));
        }
        let message = format!("point must be less extreme: {} overflows", shown(moved));
        Err(refused("point", message))
    }

    /// Return where the motion turns a direction of shape (3,).
    fn direction<'py>(&self, py: Python<'py>, direction: Components<'py>) -> PyResult<Array3<'py>> {
        Ok(array3(py, self.0.direction(vec3("direction", &direction)?)))
    }

    pub(crate) fn __repr__(&self) -> String {
        let (rotation, translation) = (self.0.rotation(), self.0.translation());
        format!("RigidMotion({}, {})", shown33(rotation), shown(translation))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let rows = self.0.rotation().transpose().to_cols_array_2d();
        let rows = rows.map(Vec::from).to_vec();
        let translation = Vec::from(self.0.translation().to_array());
        by_constructor::<Self>(py, "__call__", (rows, translation))
    }
}

methods! {
    impl RigidMotion as this: this.0;

    /// Rotation matrix of shape (3, 3).
    get rotation -> Matrix;

    /// Translation in metres, of shape (3,).
    get translation -> Vector<3>;
}

/// Returns a motion whose translation has not overflowed.
fn finite(motion: physics::RigidMotion, name: &'static str) -> PyResult<RigidMotion> {
    if motion.translation().is_finite() {
        return Ok(RigidMotion(motion));
    }
    let message = format!("{name} must be less extreme: the translation overflows");
    Err(refused(name, message))
}

/// Motions of surface, camera and light source since the reference state, as rigid bodies.
///
/// Parameters
/// ----------
/// surface, camera, source : RigidMotion, optional
///     Motions of each; what is left out stands still.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RigidMotions(pub(super) physics::RigidMotions);

#[pymethods]
impl RigidMotions {
    #[new]
    #[pyo3(signature = (*, surface = None, camera = None, source = None))]
    fn new(
        surface: Option<PyRef<'_, RigidMotion>>,
        camera: Option<PyRef<'_, RigidMotion>>,
        source: Option<PyRef<'_, RigidMotion>>,
    ) -> Self {
        let of = |motion: Option<PyRef<'_, RigidMotion>>| {
            motion.map_or(physics::RigidMotion::IDENTITY, |motion| motion.0)
        };
        Self(physics::RigidMotions {
            surface: of(surface),
            camera: of(camera),
            source: of(source),
        })
    }

    fn __repr__(&self) -> String {
        let [surface, camera, source] =
            [self.0.surface, self.0.camera, self.0.source].map(|m| RigidMotion(m).__repr__());
        format!("RigidMotions(surface={surface}, camera={camera}, source={source})")
    }
}

methods! {
    impl RigidMotions as this: this.0;

    /// Motion of the surface.
    get surface -> RigidMotion = RigidMotion(this.0.surface);

    /// Motion of the camera.
    get camera -> RigidMotion = RigidMotion(this.0.camera);

    /// Motion of the light source and its wave.
    get source -> RigidMotion = RigidMotion(this.0.source);
}
