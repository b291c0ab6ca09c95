use glam::{DVec2, DVec3};
use tem00_tracer::Camera;

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

    /// Returns a point of the plane, in metres.
    pub const fn point(&self) -> DVec3 {
        self.point
    }

    /// Returns the unit normal.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }
}

/// A camera and a laser plane: what turns a place in the image into a point in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangulator {
    camera: Camera,
    plane: LaserPlane,
}

impl Triangulator {
    /// Creates a triangulator.
    pub const fn new(camera: Camera, plane: LaserPlane) -> Self {
        Self { camera, plane }
    }

    /// Returns the camera.
    pub const fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the laser plane.
    pub const fn plane(&self) -> &LaserPlane {
        &self.plane
    }

    /// Returns the point of the laser plane, in metres, that is seen at an image point, or `None` if the
    /// line of sight does not meet the plane in front of the camera.
    pub fn point(&self, pixel: DVec2) -> Option<DVec3> {
        let ray = self.camera.ray(pixel);
        let along = ray.direction.dot(self.plane.normal);
        let distance = (self.plane.point - ray.origin).dot(self.plane.normal) / along;
        (distance > 0.0 && distance.is_finite()).then(|| ray.origin + distance * ray.direction)
    }
}
