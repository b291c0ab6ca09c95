use glam::{DMat3, DVec3};
use tem00_numerics::check;

use crate::{
    Refusal,
    length::{checked_direction, checked_position},
};

/// A rigid motion: a rotation about a point, then a translation.
///
/// ```text
/// x' = Ω (x − c) + c + t
/// ```
///
/// Surfaces, illuminations and cameras can be [`moved`](crate::RoughSurface::moved), alone or
/// together. No motion is assumed to be small.
///
/// # Examples
///
/// ```
/// use tem00_wave::{DVec3, RigidMotion};
///
/// let quarter = core::f64::consts::FRAC_PI_2;
/// let turn = RigidMotion::rotation(DVec3::Z, quarter, DVec3::X)?;
/// assert!((turn.point(DVec3::ZERO) - DVec3::new(1.0, -1.0, 0.0)).length() < 1e-15);
///
/// let lifted = turn.then(&RigidMotion::translation(DVec3::Z)?);
/// assert!((lifted.point(DVec3::X) - DVec3::new(1.0, 0.0, 1.0)).length() < 1e-15);
/// # Ok::<(), tem00_wave::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    rotation: DMat3,
    /// Image of the origin.
    translation: DVec3,
}

impl RigidMotion {
    /// The identity motion.
    pub const IDENTITY: Self = Self {
        rotation: DMat3::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// Creates a translation, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if a component is not finite or above 10 km.
    pub fn translation(by: DVec3) -> Result<Self, Refusal> {
        Ok(Self {
            translation: checked_position(by, "translation")?,
            ..Self::IDENTITY
        })
    }

    /// Creates a rotation about an axis of any length through the point `centre`, by an angle in
    /// radians, counter-clockwise when seen against the axis.
    ///
    /// # Errors
    ///
    /// Returns an error if the axis is zero or not finite, if the angle is not finite, or if a
    /// component of the centre is not finite or above 10 km.
    pub fn rotation(axis: DVec3, angle: f64, centre: DVec3) -> Result<Self, Refusal> {
        let unit = checked_direction(axis, "axis")?;
        check::that(angle.is_finite(), "angle", angle, "", "finite, in radians")?;
        let centre = checked_position(centre, "centre")?;
        let rotation = DMat3::from_axis_angle(unit, angle);
        Ok(Self {
            rotation,
            translation: centre - rotation * centre,
        })
    }

    /// Returns this motion followed by another.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self {
            rotation: next.rotation * self.rotation,
            translation: next.point(self.translation),
        }
    }

    /// Returns the position of a point after the motion, in metres.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// Returns a direction after the rotation.
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.rotation * direction
    }

    /// Returns a set of axes, the columns of a matrix, after the rotation.
    pub fn axes(&self, axes: DMat3) -> DMat3 {
        self.rotation * axes
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_absolute;

    use super::*;

    #[test]
    fn a_motion_after_another_is_one_motion() {
        let first = RigidMotion::rotation(DVec3::new(1.0, 2.0, -0.5), 0.7, DVec3::splat(0.3))
            .expect("a rotation");
        let second = RigidMotion::translation(DVec3::new(0.1, -0.2, 0.4)).expect("a translation");
        let third = RigidMotion::rotation(DVec3::Y, -2.0, DVec3::X).expect("a rotation");
        let point = DVec3::new(0.4, 1.5, -0.8);
        let apart = third.point(second.point(first.point(point)));
        let together = first.then(&second).then(&third).point(point);
        // The tolerance covers a dozen roundings of numbers of order one.
        assert!((apart - together).length() < 4e-15, "{apart} {together}");
        let (a, b) = (DVec3::X, DVec3::new(0.0, 0.6, 0.8));
        assert_absolute(first.direction(a).dot(first.direction(b)), a.dot(b), 1e-15);
    }

    #[test]
    fn a_rotation_keeps_its_centre() {
        let centre = DVec3::new(0.3, -0.2, 5.0);
        let turn = RigidMotion::rotation(DVec3::ONE, 1.0, centre).expect("a rotation");
        // The tolerance covers the rounding of coordinates of up to 5 m.
        assert!((turn.point(centre) - centre).length() < 4e-15, "moved");
    }
}
