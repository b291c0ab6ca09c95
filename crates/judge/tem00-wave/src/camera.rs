use glam::{DMat3, DVec2, DVec3};

use crate::{
    Refusal, RigidMotion, SamplePlane,
    length::{axes_from, checked_length, checked_position},
};

/// A camera with an ideal lens: a round pupil, and one plane of the scene in perfect focus.
///
/// The pupil plane is spanned by `right` and `up`; the third axis leads from the scene towards the
/// camera. Image coordinates refer to an upright picture, to the right and upwards, in metres on
/// the sensor: a point at the depth Z, seen at the offset (x, y) from the axis, appears at
///
/// ```text
/// u = (x, y) · pupil_to_image / Z
/// ```
///
/// # Examples
///
/// ```
/// use tem00_wave::{Camera, DVec2, DVec3, Lens};
///
/// let lens = Lens { pupil_diameter: 4e-3, focus_distance: 0.3, pupil_to_image: 0.06 };
/// let camera = Camera::look_at([DVec3::new(0.0, 0.0, 0.3), DVec3::ZERO], DVec3::Y, lens)?;
///
/// // A magnification of 0.2.
/// let image = camera.project(DVec3::new(1e-3, -2e-3, 0.0)).unwrap();
/// assert!((image - DVec2::new(0.2e-3, -0.4e-3)).length() < 1e-15);
/// # Ok::<(), tem00_wave::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pupil_centre: DVec3,
    axes: DMat3,
    lens: Lens,
}

/// The lens of a [`Camera`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Diameter D of the entrance pupil, in metres.
    pub pupil_diameter: f64,
    /// Depth at which the scene is in focus, from the pupil along the axis, in metres.
    pub focus_distance: f64,
    /// Distance from the pupil to the image, in metres.
    pub pupil_to_image: f64,
}

impl Lens {
    fn checked(self) -> Result<Self, Refusal> {
        checked_length(self.pupil_diameter, "pupil_diameter")?;
        checked_length(self.focus_distance, "focus_distance")?;
        checked_length(self.pupil_to_image, "pupil_to_image")?;
        Ok(self)
    }
}

impl Camera {
    /// Creates a camera from the centre of its pupil, in metres, and its axes: right, up, and from
    /// the scene towards the camera, as columns.
    ///
    /// # Errors
    ///
    /// Returns an error if a component of the centre is not finite or above 10 km, if the axes are
    /// not right-handed and orthonormal within 10⁻⁶, or if a length of the lens is not between 1 pm
    /// and 10 km.
    pub fn new(pupil_centre: DVec3, axes: DMat3, lens: Lens) -> Result<Self, Refusal> {
        let gram = axes.transpose() * axes;
        let orthonormal = gram.abs_diff_eq(DMat3::IDENTITY, 1e-6) && axes.determinant() > 0.0;
        let axes = orthonormal
            .then(|| axes_from(axes.x_axis, axes.z_axis))
            .flatten()
            .ok_or_else(|| {
                let allowed = "right-handed and orthonormal within 1e-6";
                Refusal::new("axes", axes.to_cols_array(), allowed)
            })?;
        Ok(Self {
            pupil_centre: checked_position(pupil_centre, "position")?,
            axes,
            lens: lens.checked()?,
        })
    }

    /// Creates a camera whose axis leads from the first point, the centre of the pupil, to the
    /// second, both in metres; `up` is upwards in the picture and may have any length.
    ///
    /// # Errors
    ///
    /// Returns an error if a component of the pupil's centre is not finite or above 10 km, if the
    /// two points coincide, if `up` is zero, not finite or parallel to the axis, or if a length of
    /// the lens is not between 1 pm and 10 km.
    pub fn look_at(
        [pupil_centre, target]: [DVec3; 2],
        up: DVec3,
        lens: Lens,
    ) -> Result<Self, Refusal> {
        let back = pupil_centre - target;
        let towards_camera = back.try_normalize().ok_or_else(|| {
            let allowed = "at a finite vector from the camera that is not zero, in metres";
            Refusal::new("target", back.to_array(), allowed)
        })?;
        let axes = axes_from(up.cross(towards_camera), towards_camera).ok_or_else(|| {
            let allowed = "finite, not zero and not along the view";
            Refusal::new("up", up.to_array(), allowed)
        })?;
        Self::new(pupil_centre, axes, lens)
    }

    /// Returns the centre of the pupil, in metres.
    pub const fn pupil_centre(&self) -> DVec3 {
        self.pupil_centre
    }

    /// Returns the axes: right, up, and from the scene towards the camera, as columns.
    pub const fn axes(&self) -> DMat3 {
        self.axes
    }

    /// Returns the lens.
    pub const fn lens(&self) -> Lens {
        self.lens
    }

    /// Returns the image of a point of the scene, in metres on the upright picture, or `None` if
    /// the point does not lie in front of the pupil.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let local = self.axes.transpose() * (point - self.pupil_centre);
        let image = local.truncate() * (self.lens.pupil_to_image / -local.z);
        (local.z < 0.0 && image.is_finite()).then_some(image)
    }

    /// Returns the point in focus whose image is at `image`, in metres.
    pub fn focus_point(&self, image: DVec2) -> DVec3 {
        let Lens {
            focus_distance,
            pupil_to_image,
            ..
        } = self.lens;
        let across = image * (focus_distance / pupil_to_image);
        self.pupil_centre + self.axes * across.extend(-focus_distance)
    }

    /// Returns a square of samples in the pupil plane about the pupil's centre, with steps to the
    /// right and upwards, for the speckle on the lens.
    ///
    /// # Errors
    ///
    /// Returns an error if the step, in metres, is not between 1 pm and 10 km, or if the number of
    /// samples along a side is zero or above 2¹⁴.
    pub fn pupil_plane(&self, step: f64, samples: usize) -> Result<SamplePlane, Refusal> {
        let steps = [self.axes.x_axis * step, self.axes.y_axis * step];
        SamplePlane::new(DVec3::ZERO, steps, [samples; 2])
            .map(|plane| plane.about(self.pupil_centre))
    }

    /// Returns the camera after a rigid motion.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        Self {
            pupil_centre: motion.point(self.pupil_centre),
            axes: motion.axes(self.axes),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENS: Lens = Lens {
        pupil_diameter: 4e-3,
        focus_distance: 0.3,
        pupil_to_image: 0.06,
    };

    #[test]
    fn right_and_up_of_the_scene_are_right_and_up_of_the_picture() {
        let eye = DVec3::new(1.0, 2.0, 3.0);
        let camera = Camera::look_at([eye, DVec3::ZERO], DVec3::Y, LENS).expect("a camera");
        let axes = camera.axes();
        assert!((axes.determinant() - 1.0).abs() < 1e-15, "right-handed");
        let point = eye - 0.5 * axes.z_axis + 0.01 * axes.x_axis + 0.02 * axes.y_axis;
        let image = camera.project(point).expect("in front");
        // The tolerance covers the rounding of coordinates of 3 m at a magnification of 0.12.
        assert!(
            (image - DVec2::new(1.2e-3, 2.4e-3)).length() < 1e-15,
            "{image}"
        );
        assert!(axes.y_axis.y > 0.0, "up is up");
        assert_eq!(camera.project(eye + axes.z_axis), None);
        assert_eq!(camera.project(eye), None);
    }

    #[test]
    fn a_point_in_focus_is_where_its_image_says() {
        let camera = Camera::look_at([DVec3::new(0.1, 0.0, 0.4), DVec3::ZERO], DVec3::X, LENS)
            .expect("a camera");
        let image = DVec2::new(3e-3, -7e-3);
        let back = camera.project(camera.focus_point(image)).expect("in front");
        assert!((back - image).length() < 1e-16, "{back}");
    }

    #[test]
    fn a_picture_does_not_change_when_scene_and_camera_move_together() {
        let camera = Camera::look_at([DVec3::Z, DVec3::ZERO], DVec3::Y, LENS).expect("a camera");
        let motion =
            RigidMotion::rotation(DVec3::new(1.0, -2.0, 0.3), 1.1, DVec3::Y).expect("a rotation");
        let point = DVec3::new(0.02, 0.01, -0.1);
        let still = camera.project(point).expect("in front");
        let moved = camera
            .moved(&motion)
            .project(motion.point(point))
            .expect("in front");
        // The tolerance covers the rounding of coordinates of 2 m at a magnification of 0.06.
        assert!((moved - still).length() < 1e-16, "{moved} {still}");
    }
}
