use glam::DVec3;
use tem00_decorrelation::RigidMotion;
use tem00_numerics::check;

use super::checks::{check_point, unit_vector};
use crate::Refusal;

/// An open tube: the curved side of a right circular cylinder, without its two ends.
///
/// Light meets it from outside and from inside; its normal points outward everywhere.
///
/// # Examples
///
/// A rod of 8 mm diameter and 50 mm length that stands upright:
///
/// ```
/// use glam::DVec3;
/// use tem00_geometry::Cylinder;
///
/// let rod = Cylinder::new(DVec3::ZERO, DVec3::Z, 4e-3, 50e-3)?;
/// assert!((rod.area() - 1.2566e-3).abs() < 1e-7); // m²
/// # Ok::<(), tem00_geometry::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    centre: DVec3,
    axis: DVec3,
    radius: f64,
    length: f64,
}

impl Cylinder {
    /// Creates a tube from the middle of its axis, the direction of the axis (of any length), its
    /// radius and its length, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the centre is not finite, the axis has no direction, or radius or length
    /// is not positive and finite.
    pub fn new(centre: DVec3, axis: DVec3, radius: f64, length: f64) -> Result<Self, Refusal> {
        check_point("centre", centre)?;
        let axis = unit_vector("axis", axis)?;
        for (parameter, value) in [("radius", radius), ("length", length)] {
            check::positive(parameter, value, "m")?;
        }
        Ok(Self {
            centre,
            axis,
            radius,
            length,
        })
    }

    /// Returns the middle of the axis, in metres.
    pub const fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Returns the direction of the axis, of unit length.
    pub const fn axis(&self) -> DVec3 {
        self.axis
    }

    /// Returns the radius, in metres.
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the length, in metres.
    pub const fn length(&self) -> f64 {
        self.length
    }

    /// Returns the area of the curved side, in m².
    pub const fn area(&self) -> f64 {
        core::f64::consts::TAU * self.radius * self.length
    }

    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        // Rounding may make 1 − a² negative where the axis is parallel to a coordinate.
        let across = (1.0 - self.axis * self.axis).max(DVec3::ZERO);
        let across = across.map(f64::sqrt);
        let reach = 0.5 * self.length * self.axis.abs() + self.radius * across;
        (self.centre - reach, self.centre + reach)
    }

    /// Returns the tube after a rigid motion.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        Self {
            centre: motion.point(self.centre),
            axis: motion.direction(self.axis).normalize(),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::refuses;

    use super::*;

    #[test]
    fn bounds_of_a_tilted_tube_are_those_of_its_end_circles() {
        let axis = DVec3::new(0.6, 0.0, 0.8);
        let tube = Cylinder::new(DVec3::ONE, axis, 0.1, 0.5).unwrap();
        let (low, high) = tube.bounds();
        // Half the length along the axis, and the radius times the sine of its tilt.
        let reach = DVec3::new(0.15 + 0.08, 0.1, 0.2 + 0.06);
        assert!(low.abs_diff_eq(DVec3::ONE - reach, 1e-15), "{low}");
        assert!(high.abs_diff_eq(DVec3::ONE + reach, 1e-15), "{high}");
    }

    #[test]
    fn impossible_tubes_are_refused() {
        refuses!(centre = DVec3::ZERO, axis = DVec3::Z, radius = 1.0, length = 1.0
            => Cylinder::new(centre, axis, radius, length);
            centre: [DVec3::NAN],
            axis: [DVec3::ZERO],
            radius: [0.0, -1.0, f64::NAN, f64::INFINITY],
            length: [0.0, -1.0, f64::NAN, f64::INFINITY],
        );
    }
}
