use glam::{DVec2, DVec3};

use crate::CameraDescription;

/// The sensor in the axes of the camera: right, up and along the view, from the centre of the lens.
///
/// It is placed *before* the lens by a point reflection, so that the image is upright and each
/// image point lies on its chief ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sensor {
    /// To the right and to the top of the image, of unit length.
    right: DVec3,
    up: DVec3,
    /// The unit normal, away from the lens.
    pub normal: DVec3,
    /// The intersection of the lens's axis with the sensor: the distance in metres and the image
    /// point.
    pub distance: f64,
    axis_point: DVec2,
    pitch: f64,
}

impl Sensor {
    pub(super) fn new(description: &CameraDescription) -> Self {
        let (sin, cos) = libm::sincos(description.tilt.angle);
        let (y, x) = libm::sincos(description.tilt.azimuth);
        let turned = 1.0 - cos;
        // Rodrigues' rotation about (x, y, 0); the view points against the third right-handed axis.
        Self {
            right: DVec3::new(1.0 - y * y * turned, x * y * turned, y * sin),
            up: DVec3::new(x * y * turned, 1.0 - x * x * turned, -x * sin),
            normal: DVec3::new(-y * sin, x * sin, cos),
            distance: description.image_distance(),
            axis_point: description.axis_point(),
            pitch: description.pixel_pitch,
        }
    }

    /// Returns the position of an image point, in metres.
    #[inline(always)]
    pub(super) fn point(&self, pixel: DVec2) -> DVec3 {
        let offset = (pixel - self.axis_point) * self.pitch;
        offset.x * self.right - offset.y * self.up + self.distance * DVec3::Z
    }

    /// Returns the displacements of the position per pixel to the right and per pixel down, in
    /// metres.
    pub(super) fn steps(&self) -> [DVec3; 2] {
        [self.pitch * self.right, -self.pitch * self.up]
    }

    /// Returns the image point in the direction of a tangent, or `None` if the sensor is not there.
    pub(super) fn pixel(&self, tangent: DVec2) -> Option<DVec2> {
        let depth = self.depth(tangent)?;
        let offset = (depth * tangent).extend(depth - self.distance);
        let pixel = DVec2::new(offset.dot(self.right), -offset.dot(self.up));
        Some(self.axis_point + pixel / self.pitch).filter(|pixel| pixel.is_finite())
    }

    /// Returns the depth of the sensor along the axis in the direction of a tangent, in metres.
    pub(super) fn depth(&self, tangent: DVec2) -> Option<f64> {
        let depth = self.distance / (1.0 + self.distance * self.slope().dot(tangent));
        (depth > 0.0 && depth.is_finite()).then_some(depth)
    }

    /// Returns `w`, in 1/m, with which the depth `s` in the direction of a tangent is
    ///
    /// ```text
    /// 1/s = 1/d_PI + w·t
    /// ```
    #[inline(always)]
    pub(super) fn slope(&self) -> DVec2 {
        self.normal.truncate() / (self.distance * self.normal.z)
    }

    /// Returns the area in tangents that one pixel covers where the sensor has the given depth.
    ///
    /// ```text
    /// d²t = pitch² d_PI cos τ / s³
    /// ```
    #[inline(always)]
    pub(super) fn tangents_per_pixel(&self, depth: f64) -> f64 {
        let side = self.pitch / self.distance;
        side * side * (self.normal.z * (self.distance / depth).powi(3))
    }
}
