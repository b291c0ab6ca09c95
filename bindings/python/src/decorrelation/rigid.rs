use tem00_decorrelation::{self as physics, DMat3, DVec3};

use crate::{
    arrays::{Array, Floats, Vectors, map_inner},
    error::{OrRaise, refused},
};

/// The largest component of a vector to move: within it no rotation overflows.
const LIMIT: f64 = 1e300;

class! {
    /// A rotation and a translation of a rigid body, in world coordinates: x' = R x + t.
    ///
    /// Parameters
    /// ----------
    /// rotation : array_like, shape (3, 3)
    ///     Rotation matrix.
    /// translation : array_like, shape (3,)
    ///     Translation in metres.
    "tem00.decorrelation" RigidMotion(physics::RigidMotion): Copy
}

methods! {
    impl RigidMotion as this: this.0;

    make new(rotation: DMat3, translation: DVec3);

    /// Return the motion of a body that stands still.
    make identity() = pyo3::PyResult::Ok(physics::RigidMotion::IDENTITY);

    /// Return a translation of shape (3,), in metres.
    make along(translation: DVec3);

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
    // Of finite arguments, a pivot at the end of the range makes the translation overflow.
    make about(pivot: DVec3, axis: DVec3, angle: f64) =
        physics::RigidMotion::about(pivot, axis, angle).or_raise_renamed(&["translation"], "pivot");

    /// Return this motion followed by another.
    try then(next: physics::RigidMotion) -> RigidMotion = {
        let motion = this.0.then(&next);
        finite("next", motion.translation()).map(|_| motion)
    };

    /// Return the motion back.
    fn inverse() -> RigidMotion = this.0.inverse();

    /// Return where the motion takes points.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (..., 3)
    ///     Points, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 3)
    ///     The points behind the motion, in metres.
    call point(py; points: Vectors<'py>) -> Array<'py> = {
        finite("points", 2.0 * this.0.translation())?;
        let points = columns!(LIMIT; points: 3);
        map_inner(py, points, &[3], |point| this.0.point(point.into()).to_array())
    };

    /// Return where the motion turns directions.
    ///
    /// Parameters
    /// ----------
    /// directions : array_like, shape (..., 3)
    ///     Directions, of any length.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 3)
    ///     The directions behind the motion.
    over direction(directions: 3) -> [3] =
        |direction| this.0.direction(direction.into()).to_array();

    /// Rotation matrix of shape (3, 3).
    get rotation -> Floats;

    /// Translation in metres, of shape (3,).
    get translation -> Floats;

    made_by new(rotation, translation);
}

/// Returns a vector that has not overflowed.
fn finite(name: &'static str, vector: DVec3) -> pyo3::PyResult<DVec3> {
    if vector.is_finite() {
        return Ok(vector);
    }
    let message = format!("{name} must be less extreme: the translation overflows");
    Err(refused(name, message))
}

class! {
    /// The orientation of a camera: three right-handed orthonormal axes in world coordinates.
    "tem00.decorrelation" CameraFrame(physics::CameraFrame): Copy
}

methods! {
    impl CameraFrame as this: this.0;

    unmade "look_at or from_axes";

    /// Return the frame of a rotation matrix of shape (3, 3) with the columns b1, b2 and b3.
    make from_axes(axes: DMat3);

    /// Return the frame of a camera that looks from a position to a target, both in metres.
    ///
    /// Parameters
    /// ----------
    /// position, target : array_like, shape (3,)
    ///     Where the camera stands and where it looks, in metres.
    /// up : array_like, shape (3,)
    ///     Upward direction of any length, not along the view.
    make look_at(position: DVec3, target: DVec3, up: DVec3);

    /// Rotation matrix of shape (3, 3), whose columns lead right in the image (b1), up in it (b2)
    /// and from the scene towards the camera (b3).
    get axes -> Floats =
        DMat3::from_cols(this.0.right(), this.0.up(), this.0.towards_camera());

    made_by from_axes(axes);
}
