use glam::DVec3;

use super::checks::check_point;
use crate::{RigidMotion, TracerError};

/// A sphere.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_tracer::{Sphere, TracerError};
///
/// let flat = Sphere::new(DVec3::ZERO, 0.0);
/// assert!(matches!(flat, Err(TracerError::OutOfRange { parameter: "radius", .. })));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    pub(super) centre: DVec3,
    radius: f64,
}

impl Sphere {
    /// Creates a sphere from its centre and radius, both in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the centre is not finite or the radius not positive and finite.
    pub fn new(centre: DVec3, radius: f64) -> Result<Self, TracerError> {
        check_point("centre", centre)?;
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(TracerError::OutOfRange {
                parameter: "radius",
                value: radius,
                allowed: "positive and finite, in metres",
            });
        }
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

    /// Returns the sphere as a motion takes it.
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
    use super::*;

    #[test]
    fn impossible_spheres_are_refused() {
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let result = Sphere::new(DVec3::ZERO, radius);
            assert!(
                matches!(
                    result,
                    Err(TracerError::OutOfRange {
                        parameter: "radius",
                        ..
                    })
                ),
                "radius {radius}: {result:?}"
            );
        }
        let result = Sphere::new(DVec3::new(0.0, f64::INFINITY, 0.0), 1.0);
        assert!(
            matches!(
                result,
                Err(TracerError::Direction {
                    parameter: "centre",
                    ..
                })
            ),
            "{result:?}"
        );
    }
}
