use pyo3::prelude::*;
use tem00_decorrelation::{self as physics, DMat3};

use super::vectors::{mat3, shown, shown33, vec3};
use crate::{
    arrays::{Components, Table, Vector},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// The orientation of a camera: three right-handed orthonormal axes in world coordinates.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CameraFrame(pub(super) physics::CameraFrame);

impl CameraFrame {
    fn axes(&self) -> DMat3 {
        DMat3::from_cols(self.0.right(), self.0.up(), self.0.towards_camera())
    }
}

#[pymethods]
impl CameraFrame {
    /// Return the frame of a rotation matrix of shape (3, 3) with the columns b1, b2 and b3.
    #[staticmethod]
    fn from_axes(axes: Table<'_>) -> PyResult<Self> {
        let frame = physics::CameraFrame::from_axes(mat3("axes", &axes)?);
        Ok(Self(frame.or_raise()?))
    }

    /// Return the frame of a camera that looks from a position to a target, both in metres.
    ///
    /// Parameters
    /// ----------
    /// position, target : array_like, shape (3,)
    ///     Where the camera stands and where it looks, in metres.
    /// up : array_like, shape (3,)
    ///     Upward direction of any length, not along the view.
    #[staticmethod]
    fn look_at(
        position: Components<'_>,
        target: Components<'_>,
        up: Components<'_>,
    ) -> PyResult<Self> {
        let position = vec3("position", &position)?;
        let (target, up) = (vec3("target", &target)?, vec3("up", &up)?);
        let frame = physics::CameraFrame::look_at(position, target, up);
        Ok(Self(frame.or_raise()?))
    }

    pub(super) fn __repr__(&self) -> String {
        format!("CameraFrame.from_axes({})", shown33(self.axes()))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let rows = self.axes().transpose().to_cols_array_2d();
        by_constructor::<Self>(py, "from_axes", (rows.map(Vec::from).to_vec(),))
    }
}

methods! {
    impl CameraFrame as this: this.0;

    unmade "look_at or from_axes";

    /// b1, the axis of the pupil plane to the right in the image, of shape (3,).
    get right -> Vector<3>;

    /// b2, the axis of the pupil plane upwards in the image, of shape (3,).
    get up -> Vector<3>;

    /// b3, the optical axis from the scene towards the camera, of shape (3,).
    get towards_camera -> Vector<3>;
}

/// The line from a surface point to the centre of the pupil, in the frame of the camera.
///
/// Parameters
/// ----------
/// camera : CameraFrame
///     Orientation of the camera.
/// to_pupil : array_like, shape (3,)
///     Vector from the surface point to the centre of the pupil, in metres.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineOfSight(pub(super) physics::LineOfSight);

#[pymethods]
impl LineOfSight {
    #[new]
    fn new(camera: PyRef<'_, CameraFrame>, to_pupil: Components<'_>) -> PyResult<Self> {
        let sight = physics::LineOfSight::new(&camera.0, vec3("to_pupil", &to_pupil)?);
        Ok(Self(sight.or_raise()?))
    }

    pub(super) fn __repr__(&self) -> String {
        let direction = shown(self.0.direction());
        format!(
            "<LineOfSight: direction={direction}, distance={:?}>",
            self.0.distance()
        )
    }
}

methods! {
    impl LineOfSight as this: this.0;

    /// Frame of the camera.
    get camera -> CameraFrame = CameraFrame(*this.0.camera());

    /// Unit vector from the surface point to the centre of the pupil, of shape (3,).
    get direction -> Vector<3>;

    /// Distance from the surface point to the centre of the pupil, in metres.
    get distance -> f64;

    /// Depth of the surface point before the pupil plane, in metres.
    get depth -> f64;
}
