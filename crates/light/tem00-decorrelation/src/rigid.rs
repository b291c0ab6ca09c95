use glam::{DMat3, DVec3};

use tem00_numerics::check;

use crate::{
    Refusal,
    frame::{ORTHONORMAL, orthonormal},
    vector::{finite, unit},
};

/// A rotation and a translation of a rigid body, in world coordinates.
///
/// ```text
/// x' = R x + t
/// ```
///
/// # Examples
///
/// A turntable that turns by 90° about a vertical axis through x = 1 m:
///
/// ```
/// use tem00_decorrelation::{DVec3, RigidMotion};
///
/// let turn = RigidMotion::about(DVec3::X, DVec3::Y, 90_f64.to_radians())?;
/// let moved = turn.point(DVec3::new(1.0, 0.0, 0.2));
/// assert!((moved - DVec3::new(1.2, 0.0, 0.0)).length() < 1e-15);
/// # Ok::<(), tem00_decorrelation::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    rotation: DMat3,
    translation: DVec3,
}

impl RigidMotion {
    /// The identity motion, of a body at rest.
    pub const IDENTITY: Self = Self {
        rotation: DMat3::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// Creates the motion `x' = R x + t` from a rotation matrix and a translation, in metres.
    ///
    /// The matrix is made orthonormal to rounding, so that matrices in single precision are
    /// accepted.
    ///
    /// # Errors
    ///
    /// Returns an error if the columns of the matrix are not orthonormal within 10⁻⁶ or not
    /// right-handed, or if the translation is not finite.
    pub fn new(rotation: DMat3, translation: DVec3) -> Result<Self, Refusal> {
        let columns = rotation.to_cols_array();
        Ok(Self {
            rotation: orthonormal(rotation)
                .ok_or_else(|| Refusal::new("rotation", columns, ORTHONORMAL))?,
            translation: finite("translation", translation)?,
        })
    }

    /// Creates a translation, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the translation is not finite.
    pub fn along(translation: DVec3) -> Result<Self, Refusal> {
        Self::new(DMat3::IDENTITY, translation)
    }

    /// Creates a rotation about an axis of any length through `pivot`, in metres, by `angle`, in
    /// radians, right-handed.
    ///
    /// # Errors
    ///
    /// Returns an error if the axis is zero, or if an argument is not finite.
    pub fn about(pivot: DVec3, axis: DVec3, angle: f64) -> Result<Self, Refusal> {
        check::finite("angle", angle, "rad")?;
        finite("pivot", pivot)?;
        let rotation = DMat3::from_axis_angle(unit("axis", axis)?, angle);
        Self::new(rotation, pivot - rotation * pivot)
    }

    /// Returns this motion followed by another.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self {
            rotation: next.rotation * self.rotation,
            translation: next.point(self.translation),
        }
    }

    /// Returns the inverse motion.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self {
            rotation,
            translation: -(rotation * self.translation),
        }
    }

    /// Returns the rotation matrix R.
    pub const fn rotation(&self) -> DMat3 {
        self.rotation
    }

    /// Returns the translation t, in metres.
    pub const fn translation(&self) -> DVec3 {
        self.translation
    }

    /// Returns the position of a point after the motion, in metres.
    #[inline(always)]
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// Returns a direction rotated by the motion.
    #[inline(always)]
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.rotation * direction
    }
}

impl Default for RigidMotion {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// Motions of surface, camera and light source since the reference state, each as a rigid body.
///
/// Only relative motions matter: if all three move as one, nothing changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidMotions {
    /// Motion of the surface.
    pub surface: RigidMotion,
    /// Motion of the camera.
    pub camera: RigidMotion,
    /// Motion of the light source and its wave.
    pub source: RigidMotion,
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn vectors(size: f64) -> impl Strategy<Value = DVec3> {
        [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
    }

    prop_compose! {
        fn motions()(
            pivot in vectors(2.0),
            axis in vectors(1.0).prop_filter("an axis", |v| v.length() > 1e-3),
            angle in -10.0_f64..10.0,
            translation in vectors(2.0),
        ) -> RigidMotion {
            let turn = RigidMotion::about(pivot, axis, angle).unwrap();
            turn.then(&RigidMotion::along(translation).unwrap())
        }
    }

    proptest! {
        #[test]
        fn points_on_the_axis_stay(
            pivot in vectors(2.0),
            axis in vectors(1.0).prop_filter("an axis", |v| v.length() > 1e-3),
            angle in -10.0_f64..10.0,
            along in -2.0_f64..2.0,
        ) {
            let turn = RigidMotion::about(pivot, axis, angle).unwrap();
            let point = pivot + axis.normalize() * along;
            // The tolerance covers the rounding of lengths of a few metres.
            prop_assert!((turn.point(point) - point).length() < 1e-14);
        }

        #[test]
        fn motions_in_turn_and_back_are_as_one_at_a_time(
            one in motions(),
            two in motions(),
            point in vectors(2.0),
        ) {
            let in_turn = two.point(one.point(point));
            prop_assert!((one.then(&two).point(point) - in_turn).length() < 1e-13);
            prop_assert!((one.inverse().point(one.point(point)) - point).length() < 1e-13);
            let tip = one.point(point + DVec3::Y) - one.point(point);
            prop_assert!((one.direction(DVec3::Y) - tip).length() < 1e-13);
        }
    }
}
