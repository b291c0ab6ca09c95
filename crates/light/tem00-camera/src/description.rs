use glam::{DVec2, DVec3};
use tem00_numerics::{Shown, check};

use crate::Refusal;

/// The maximum number of pixels of an image: 2²⁸, which is 16 384 × 16 384.
pub const MAXIMUM_PIXELS: usize = 1 << 28;

/// Parameters of a [`Camera`](crate::Camera).
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraDescription {
    /// The centre of the lens, which is its entrance pupil, in metres.
    pub position: DVec3,
    /// A point on the axis of the lens, in metres: it appears at the principal point.
    pub look_at: DVec3,
    /// A direction that points up in the image.
    pub up: DVec3,
    /// The focal length of the lens, in metres.
    pub focal_length: f64,
    /// The f-number: focal length divided by the diameter of the entrance pupil.
    pub f_number: f64,
    /// The distance from the lens, along its axis, to the point in focus, in metres.
    pub focus_distance: f64,
    /// The pixel pitch, in metres.
    pub pixel_pitch: f64,
    /// The numbers of pixel columns and rows.
    pub resolution: [usize; 2],
    /// The image point on the axis of the lens, in pixels; `None` for the middle of the image.
    pub principal_point: Option<DVec2>,
    /// The tilt of the sensor.
    pub tilt: SensorTilt,
    /// The distortion of the image by the lens.
    pub distortion: RadialDistortion,
    /// Whether objects out of focus are blurred. Without blur the camera is sharp everywhere, as if
    /// all light went through the centre of the lens; the speckle keeps its size.
    pub depth_of_field: bool,
}

/// A sensor tilted against the lens (Scheimpflug).
///
/// The sensor turns by `angle` about a line in it that goes through the principal point, at
/// `azimuth` from the right of the image towards its top. The turn is right-handed about that line
/// in the axes right, up and from the scene towards the camera.
///
/// With azimuth 0 and a positive angle, points higher in the image are in focus farther away, as on
/// a floor: the plane in focus turns the other way, by τ′ with
///
/// ```text
/// tan τ′ = (L / d_PI) tan τ      L, d_PI: distances of object and image along the axis
/// ```
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorTilt {
    /// The angle τ between the normal of the sensor and the axis of the lens, in radians.
    pub angle: f64,
    /// The direction of the line about which the sensor turns, in radians.
    pub azimuth: f64,
}

/// The radial distortion of a lens, in Brown's form with the signs of `OpenCV`.
///
/// ```text
/// t_image = t (1 + k₁ r² + k₂ r⁴ + k₃ r⁶)      r = |t|
/// ```
///
/// `t` is the tangent of the angle to the axis, as a vector: the undistorted image point divided by
/// the image distance. Negative coefficients make a barrel, positive ones a pincushion.
///
/// # References
///
/// - D. C. Brown, *Decentering Distortion of Lenses*, 1966.
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RadialDistortion {
    /// The coefficient k₁ of r².
    pub k1: f64,
    /// The coefficient k₂ of r⁴.
    pub k2: f64,
    /// The coefficient k₃ of r⁶.
    pub k3: f64,
}

impl Default for CameraDescription {
    /// A lens of 25 mm at f/8 and 640 × 480 pixels of 3.45 µm, placed 0.3 m above the origin, at
    /// which the camera looks and is focused.
    fn default() -> Self {
        Self {
            position: 0.3 * DVec3::Z,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            focal_length: 25e-3,
            f_number: 8.0,
            focus_distance: 0.3,
            pixel_pitch: 3.45e-6,
            resolution: [640, 480],
            principal_point: None,
            tilt: SensorTilt::default(),
            distortion: RadialDistortion::default(),
            depth_of_field: true,
        }
    }
}

impl CameraDescription {
    /// Checks all parameters that can be checked without the geometry.
    pub(crate) fn check(&self) -> Result<(), Refusal> {
        for (parameter, value, unit) in [
            ("focal_length", self.focal_length, "m"),
            ("f_number", self.f_number, ""),
            ("focus_distance", self.focus_distance, "m"),
            ("pixel_pitch", self.pixel_pitch, "m"),
        ] {
            check::positive(parameter, value, unit)?;
        }
        let allowed = "at least 0.5, the limit of an aplanatic lens";
        check::that(self.f_number >= 0.5, "f_number", self.f_number, "", allowed)?;
        let (distance, focal_length) = (self.focus_distance, self.focal_length);
        if distance <= focal_length {
            let allowed = format!("greater than the focal length of {} m", Shown(focal_length));
            return Err(Refusal::new("focus_distance", distance, allowed).in_unit("m"));
        }
        let [width, height] = self.resolution;
        let pixels = width.checked_mul(height);
        let holds = pixels.is_some_and(|pixels| (1..=MAXIMUM_PIXELS).contains(&pixels));
        let resolution = self.resolution.map(|count| count as f64);
        let allowed = "at least 1 × 1 and at most 2²⁸ pixels in all";
        check::that(holds, "resolution", resolution, "", allowed)?;
        let holds = self.position.is_finite() && self.look_at.is_finite();
        let allowed = "a finite point seen from a finite position";
        check::that(holds, "look_at", self.look_at.to_array(), "m", allowed)?;
        let point = self.axis_point();
        let allowed = "a finite image point, in pixels";
        check::that(
            point.is_finite(),
            "principal_point",
            point.to_array(),
            "",
            allowed,
        )?;
        let RadialDistortion { k1, k2, k3 } = self.distortion;
        check::each(&[k1, k2, k3], |k| check::finite("distortion", k, ""))?;
        let SensorTilt { angle, azimuth } = self.tilt;
        let holds = angle.abs() < core::f64::consts::FRAC_PI_2;
        check::that(holds, "tilt", angle, "rad", "below a right angle")?;
        check::that(
            azimuth.is_finite(),
            "tilt",
            azimuth,
            "rad",
            "at a finite azimuth",
        )
    }

    /// Returns the distance from the lens to the sensor along the axis, in metres.
    pub(crate) fn image_distance(&self) -> f64 {
        self.focal_length * self.focus_distance / (self.focus_distance - self.focal_length)
    }

    /// Returns the image point on the axis of the lens, in pixels.
    pub fn axis_point(&self) -> DVec2 {
        self.principal_point.unwrap_or(self.size() / 2.0)
    }

    /// Returns the width and the height of the image, in pixels.
    pub fn size(&self) -> DVec2 {
        DVec2::new(self.resolution[0] as f64, self.resolution[1] as f64)
    }
}
