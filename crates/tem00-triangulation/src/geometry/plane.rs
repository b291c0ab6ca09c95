use glam::DVec3;
use tem00_tracer::Laser;

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

    /// Returns the plane in which the line of a laser opens: through its aperture, along its axis and
    /// its line direction.
    ///
    /// A spot has a plane, too, that of its first axis; only a point of it is lit.
    ///
    /// # Errors
    ///
    /// Returns an error if the laser stands so far away that rounding leaves no direction.
    pub fn of_laser(laser: &Laser) -> Result<Self, TriangulationError> {
        let description = laser.description();
        let axis = description.look_at - description.position;
        let across = axis.normalize_or_zero();
        let along = description.line_direction.normalize_or_zero();
        Self::new(description.position, across.cross(along))
    }

    /// Returns a point of the plane, in metres.
    pub const fn point(&self) -> DVec3 {
        self.point
    }

    /// Returns the unit normal.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Returns the distance of a point from the plane, in metres, positive on the side of the normal.
    pub fn distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.point)
    }
}
