mod plane;
mod profile;

use glam::{DVec2, DVec3};
use tem00_camera::Camera;

pub use self::{plane::LaserPlane, profile::ProfilePoint};

/// A camera and a laser plane, which turn a position in the image into a point in space.
///
/// ```text
/// P = O + s d        s = n·(Q − O) / (n·d)
/// ```
///
/// `O` is the centre of the pupil, `d` the direction of the chief ray of the image point, `Q` a
/// point of the plane and `n` its normal. Tilted sensors and distorting lenses are the camera's
/// own.
///
/// # Validity
///
/// The plane is thin and flat, and the image point of the line is the image point of its chief ray.
/// Effects that move the centre of a line of finite width, such as speckle or a change of
/// reflectance, are not part of the geometry.
///
/// # Examples
///
/// A camera that looks at a vertical laser plane at 30° from it sees half a millimetre per
/// millimetre of height, times the magnification:
///
/// ```
/// use tem00_camera::{Camera, CameraDescription};
/// use tem00_triangulation::{DVec2, DVec3, LaserPlane, Triangulator};
///
/// let camera = Camera::new(CameraDescription {
///     position: 0.3 * DVec3::new(0.0, -0.5, 0.75_f64.sqrt()),
///     up: DVec3::Z,
///     focal_length: 25e-3,
///     focus_distance: 0.3,
///     pixel_pitch: 3.45e-6,
///     resolution: [640, 480],
///     ..CameraDescription::default()
/// })?;
/// let plane = LaserPlane::new(DVec3::ZERO, DVec3::Y)?;
///
/// let pixel = DVec2::new(320.0, 240.0);
/// let triangulator = Triangulator::new(camera, plane);
/// let [_, down] = triangulator.derivatives(pixel).expect("the axis meets the plane");
///
/// // pitch / (m sin θ) with m = 1/11: 75.9 µm per pixel.
/// assert!((down.z + 3.45e-6 * 11.0 / 0.5).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangulator {
    camera: Camera,
    plane: LaserPlane,
}

/// A point of the laser plane and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UncertainPoint {
    /// The point, in metres.
    pub position: DVec3,
    /// The standard uncertainties of its coordinates, in metres. They are fully correlated: the
    /// point lies somewhere on a short piece of the line of sight's trace in the laser plane.
    pub uncertainty: DVec3,
    /// The standard uncertainty along that trace, in metres: the root of the sum of their squares.
    pub along: f64,
    /// The unit direction of that trace in space, towards higher points in the image.
    pub direction: DVec3,
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

    /// Returns the point of the laser plane, in metres, that is seen at an image point, or `None`
    /// if the line of sight does not meet the plane in front of the camera.
    pub fn point(&self, pixel: DVec2) -> Option<DVec3> {
        let ray = self.camera.ray(pixel);
        let distance = self.distance_along(ray.direction);
        (distance > 0.0 && distance.is_finite()).then(|| ray.origin + distance * ray.direction)
    }

    /// Returns the derivative of the point of the laser plane by the image point, in metres per
    /// pixel to the right and per pixel *down*, or `None` where there is no point.
    ///
    /// ```text
    /// ∂P = s (∂d − d n·∂d / n·d)
    /// ```
    pub fn derivatives(&self, pixel: DVec2) -> Option<[DVec3; 2]> {
        let (direction, derivatives) = self.camera.sight(pixel)?;
        let distance = self.distance_along(direction);
        let normal = self.plane.normal();
        let along = normal.dot(direction);
        let moved = |by: DVec3| distance * (by - direction * (normal.dot(by) / along));
        let moved = derivatives.map(moved);
        let finite = moved.iter().all(|by| by.is_finite());
        (distance > 0.0 && finite).then_some(moved)
    }

    /// Returns the point that is seen at an image point whose position along the column has the
    /// standard uncertainty `along_column`, in pixels, or `None` where there is no point.
    ///
    /// To first order. Only the uncertainty of the line's position counts; for camera and plane see
    /// the calibration.
    pub fn point_with_uncertainty(
        &self,
        pixel: DVec2,
        along_column: f64,
    ) -> Option<UncertainPoint> {
        let position = self.point(pixel)?;
        let [_, down] = self.derivatives(pixel)?;
        let length = down.length();
        Some(UncertainPoint {
            position,
            uncertainty: along_column * down.abs(),
            along: along_column * length,
            direction: (-down).try_normalize()?,
        })
    }

    /// Returns the distance of the plane along a direction from the pupil, in multiples of its
    /// length.
    fn distance_along(&self, direction: DVec3) -> f64 {
        let normal = self.plane.normal();
        (self.plane.point() - self.camera.position()).dot(normal) / direction.dot(normal)
    }
}

#[cfg(test)]
mod tests;
