use glam::{DMat3, DVec3};

use crate::{GRAZING_COSINE, Refusal};

/// Condition on axes and rotations, as messages state it.
pub(crate) const ORTHONORMAL: &str = "right-handed and orthonormal within 1e-6";

/// The orientation of a camera: three right-handed orthonormal axes in world coordinates.
///
/// ```text
///        b2 (up)
///         │
///         │              b1, b2 span the pupil plane;
///         └───── b1      b3 leads from the scene to the camera,
///        ╱     (right)   against the direction of view.
///      b3
/// ```
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::{CameraFrame, DVec3};
///
/// let camera = CameraFrame::look_at(DVec3::new(0.0, 0.0, 0.3), DVec3::ZERO, DVec3::Y)?;
/// assert_eq!(camera.right(), DVec3::X);
/// assert_eq!(camera.up(), DVec3::Y);
/// assert_eq!(camera.towards_camera(), DVec3::Z);
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraFrame {
    axes: DMat3,
}

impl CameraFrame {
    /// Creates a frame from a rotation matrix with the columns b1, b2 and b3.
    ///
    /// The axes are made orthonormal to rounding, so that matrices in single precision are
    /// accepted.
    ///
    /// # Errors
    ///
    /// Returns an error if the columns are not orthonormal within 10⁻⁶ or not right-handed.
    pub fn from_axes(axes: DMat3) -> Result<Self, Refusal> {
        orthonormal(axes)
            .map(|axes| Self { axes })
            .ok_or_else(|| Refusal::new("axes", axes.to_cols_array(), ORTHONORMAL))
    }

    /// Creates the frame of a camera at `position` that looks at `target`, both in metres, with b2
    /// as close to `up` as possible.
    ///
    /// # Errors
    ///
    /// Returns an error if the two points coincide, if `up` is zero or along the direction of view,
    /// or if a component is not finite.
    pub fn look_at(position: DVec3, target: DVec3, up: DVec3) -> Result<Self, Refusal> {
        let back = position - target;
        let towards_camera = back.try_normalize().ok_or_else(|| {
            let allowed = "finite and differ from the camera position";
            Refusal::new("target", target.to_array(), allowed).in_unit("m")
        })?;
        let right = up
            .try_normalize()
            .map(|up| up.cross(towards_camera))
            .filter(|right| right.length() > GRAZING_COSINE)
            .ok_or_else(|| {
                let allowed = "finite, not zero and not along the view";
                Refusal::new("up", up.to_array(), allowed)
            })?;
        Ok(Self::from_right(right.normalize(), towards_camera))
    }

    fn from_right(right: DVec3, towards_camera: DVec3) -> Self {
        Self {
            axes: from_right(right, towards_camera),
        }
    }

    /// The axes turned by a rotation.
    pub(crate) fn turned(&self, rotation: DMat3) -> Self {
        if rotation == DMat3::IDENTITY {
            return *self;
        }
        let axes = rotation * self.axes;
        let towards_camera = axes.z_axis.normalize();
        Self::from_right(
            axes.y_axis.cross(towards_camera).normalize(),
            towards_camera,
        )
    }

    /// Returns b1, the axis of the pupil plane to the right in the image.
    pub const fn right(&self) -> DVec3 {
        self.axes.x_axis
    }

    /// Returns b2, the axis of the pupil plane upwards in the image.
    pub const fn up(&self) -> DVec3 {
        self.axes.y_axis
    }

    /// Returns b3, the optical axis from the scene towards the camera.
    pub const fn towards_camera(&self) -> DVec3 {
        self.axes.z_axis
    }
}

/// Returns the rotation closest to a matrix whose columns are right-handed orthonormal axes within
/// 10⁻⁶.
pub(crate) fn orthonormal(axes: DMat3) -> Option<DMat3> {
    const TOLERANCE: f64 = 1e-6;
    let deviation = axes.transpose() * axes - DMat3::IDENTITY;
    let largest = deviation
        .to_cols_array()
        .iter()
        .fold(0.0_f64, |a, b| a.max(b.abs()));
    // A maximum drops NaN, but no NaN has a positive determinant.
    if !(largest <= TOLERANCE && axes.determinant() > 0.0) {
        return None;
    }
    let z_axis = axes.z_axis.normalize();
    Some(from_right(axes.y_axis.cross(z_axis).normalize(), z_axis))
}

fn from_right(x_axis: DVec3, z_axis: DVec3) -> DMat3 {
    DMat3::from_cols(x_axis, z_axis.cross(x_axis), z_axis)
}

/// The line from a surface point to the centre of the pupil, in the frame of the camera.
///
/// It follows the optical axis only at the middle of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOfSight {
    camera: CameraFrame,
    direction: DVec3,
    distance: f64,
}

impl LineOfSight {
    /// Creates a line of sight from the vector that leads from the surface point to the centre of
    /// the pupil, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the vector is zero or not finite, or if the point does not lie in front
    /// of the camera.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_decorrelation::{CameraFrame, DVec3, LineOfSight};
    ///
    /// let eye = DVec3::new(0.0, 0.0, 0.4);
    /// let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y)?;
    /// let sight = LineOfSight::new(&camera, eye - DVec3::new(0.3, 0.0, 0.0))?;
    /// assert!((sight.distance() - 0.5).abs() < 1e-12);
    /// assert!((sight.depth() - 0.4).abs() < 1e-12);
    ///
    /// let behind = DVec3::new(0.0, 0.0, 1.0);
    /// assert!(LineOfSight::new(&camera, eye - behind).is_err());
    /// # Ok::<(), tem00_decorrelation::Refusal>(())
    /// ```
    pub fn new(camera: &CameraFrame, to_pupil: DVec3) -> Result<Self, Refusal> {
        to_pupil
            .try_normalize()
            .map(|direction| Self {
                camera: *camera,
                direction,
                distance: to_pupil.length(),
            })
            .filter(|sight| sight.axis_cosine() > GRAZING_COSINE)
            .ok_or_else(|| {
                let allowed = "finite, and lead from a point in front of the camera";
                Refusal::new("to_pupil", to_pupil.to_array(), allowed).in_unit("m")
            })
    }

    /// Returns the frame of the camera.
    pub const fn camera(&self) -> &CameraFrame {
        &self.camera
    }

    /// Returns the unit vector `l` from the surface point to the centre of the pupil.
    pub const fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Returns the distance `d` from the surface point to the centre of the pupil, in metres.
    pub const fn distance(&self) -> f64 {
        self.distance
    }

    /// Returns the depth `Z = d (l·b3)` of the surface point before the pupil plane, in metres.
    pub fn depth(&self) -> f64 {
        self.distance * self.axis_cosine()
    }

    fn axis_cosine(&self) -> f64 {
        self.direction.dot(self.camera.towards_camera())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deviation(camera: &CameraFrame, axes: DMat3) -> f64 {
        let got = DMat3::from_cols(camera.right(), camera.up(), camera.towards_camera());
        let squares = (got - axes).to_cols_array().map(|x| x * x);
        squares.iter().sum::<f64>().sqrt()
    }

    #[test]
    fn look_at_and_rotation_matrix_agree() {
        let camera =
            CameraFrame::look_at(DVec3::new(1.0, 0.0, 1.0), DVec3::X, DVec3::NEG_X).unwrap();
        // Seen from above with −x up, +y is to the right.
        let axes = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
        assert!(deviation(&camera, axes) < 1e-15, "{camera:?}");
        let again = CameraFrame::from_axes(axes).unwrap();
        assert!(deviation(&again, axes) < 1e-15, "{again:?}");
    }

    #[test]
    fn axes_in_single_precision_become_orthonormal() {
        let exact = DMat3::from_euler(glam::EulerRot::YXZ, 0.4, -0.6, 1.1);
        let camera = CameraFrame::from_axes(exact.as_mat3().as_dmat3()).unwrap();
        let got = DMat3::from_cols(camera.right(), camera.up(), camera.towards_camera());
        assert!(
            deviation(&camera, exact) < 3e-7,
            "not the axes given: {got}"
        );
        let identity = CameraFrame {
            axes: got.transpose() * got,
        };
        assert!(
            deviation(&identity, DMat3::IDENTITY) < 1e-15,
            "not orthonormal: {got}"
        );
    }
}
