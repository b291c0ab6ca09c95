use glam::DVec3;

use crate::TriangulationError;

/// The plane of a laser line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaserPlane {
    point: DVec3,
    normal: DVec3,
}

impl LaserPlane {
    /// Creates a plane through a point, in metres, with a normal of any length.
    ///
    /// # Errors
    ///
    /// Returns an error if the normal is zero or a number is not finite.
    pub fn new(point: DVec3, normal: DVec3) -> Result<Self, TriangulationError> {
        let unit = normal.try_normalize().filter(|_| point.is_finite());
        unit.map(|normal| Self { point, normal })
            .ok_or(TriangulationError::Direction {
                parameter: "normal",
                allowed: "a direction, at a finite point",
            })
    }

    /// Returns the plane in which a laser line opens: through its aperture, in metres, along its
    /// axis and its line direction, both of any length.
    ///
    /// # Errors
    ///
    /// Returns an error if the two directions are parallel, or a number is not finite.
    pub fn of_line(
        aperture: DVec3,
        axis: DVec3,
        line_direction: DVec3,
    ) -> Result<Self, TriangulationError> {
        let along = line_direction.normalize_or_zero();
        Self::new(aperture, axis.normalize_or_zero().cross(along))
    }

    /// Returns a point of the plane, in metres.
    pub const fn point(&self) -> DVec3 {
        self.point
    }

    /// Returns the unit normal.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Returns the distance of a point from the plane, in metres, positive on the side of the
    /// normal.
    pub fn distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.point)
    }
}
