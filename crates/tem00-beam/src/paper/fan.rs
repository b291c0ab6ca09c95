use core::f64::consts::PI;

use glam::DVec3;

use crate::gaussian::is_coordinate;
use crate::{BeamError, GaussianBeam};

/// The laser fan as printed: the irradiance of the round beam, with x scaled to the line.
///
/// ```text
/// x′ = x w(z) / (T z)     with T = tan(α/2)
/// E(x, y, z) / P = 2 / (π w²) · exp(−2 (x′² + y²) / w²)
/// ```
///
/// The text writes one z for two distances. Here `w(z)` takes it from the waist, as eq. (1) does,
/// and `T z` from the emitter, as a line of the angle α must have it.
///
/// # Validity
///
/// The factor `w / (T z)` that a change of variable brings is missing, so that the power on a plane
/// is [`power_per_watt`](Self::power_per_watt) instead of 1, and z → 0 is singular.
/// [`LaserLine`](crate::LaserLine) has neither fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedFan {
    focus: GaussianBeam,
    half_slope: f64,
    focus_distance: f64,
}

impl PrintedFan {
    /// Creates the fan from the beam, the full fan angle in radians and the distance from the
    /// emitter to the waist in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if `fan_angle` is not in (0, π), or if `focus_distance` is not finite or
    /// beyond 1e30 m.
    pub fn new(
        focus: GaussianBeam,
        fan_angle: f64,
        focus_distance: f64,
    ) -> Result<Self, BeamError> {
        if !(fan_angle > 0.0 && fan_angle < PI) {
            return Err(BeamError::FanAngle(fan_angle));
        }
        if !is_coordinate(focus_distance) {
            return Err(BeamError::FocusDistance(focus_distance));
        }
        Ok(Self {
            focus,
            half_slope: (0.5 * fan_angle).tan(),
            focus_distance,
        })
    }

    /// Returns the printed irradiance per watt, in m⁻², of a plane of constant z at `point`; 0
    /// unless `point.z` is positive.
    ///
    /// The frame is that of the emitter: +z travel, z = 0 the emitter, the line along x.
    pub fn irradiance_per_watt(&self, point: DVec3) -> f64 {
        if point.z <= 0.0 {
            return 0.0;
        }
        let from_waist = point.z - self.focus_distance;
        let x = point.x * self.focus.radius_at(from_waist) / (self.half_slope * point.z);
        self.focus.irradiance_per_watt(x.hypot(point.y), from_waist)
    }

    /// Returns the power, per watt of the laser, that the printed irradiance adds up to on the plane
    /// at the distance `z`, in metres, from the emitter.
    ///
    /// ```text
    /// T z / w(z)
    /// ```
    ///
    /// It is the ratio of the half-length of the line to its half-thickness: hundreds, and 1 if all
    /// were right.
    pub fn power_per_watt(&self, z: f64) -> f64 {
        self.half_slope * z / self.focus.radius_at(z - self.focus_distance)
    }
}
