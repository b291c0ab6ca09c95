use glam::DVec3;
use tem00_decorrelation::RigidMotion;
use tem00_numerics::check;

use super::checks::check_point;
use crate::Refusal;

/// A sphere.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_geometry::Sphere;
///
/// let flat = Sphere::new(DVec3::ZERO, 0.0);
/// assert_eq!(flat.unwrap_err().parameter, "radius");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    centre: DVec3,
    radius: f64,
}

impl Sphere {
    /// Creates a sphere from its centre and radius, both in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the centre is not finite or the radius not positive and finite.
    pub fn new(centre: DVec3, radius: f64) -> Result<Self, Refusal> {
        check_point("centre", centre)?;
        check::positive("radius", radius, "m")?;
        Ok(Self { centre, radius })
    }

    /// Returns the centre, in metres.
    pub const fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Returns the radius, in metres.
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        (self.centre - self.radius, self.centre + self.radius)
    }

    /// Returns the sphere after a rigid motion.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        Self {
            centre: motion.point(self.centre),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::refuses;

    use super::*;

    #[test]
    fn impossible_spheres_are_refused() {
        refuses!(centre = DVec3::ZERO, radius = 1.0 => Sphere::new(centre, radius);
            centre: [DVec3::new(0.0, f64::INFINITY, 0.0)],
            radius: [0.0, -1.0, f64::NAN, f64::INFINITY],
        );
    }
}
