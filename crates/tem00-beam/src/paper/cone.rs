use core::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use crate::gaussian::is_coordinate;
use crate::{BeamError, GaussianBeam};

/// Returns the modified divergence `θ′`, in radians, that reaches down to the fraction `l` of the
/// peak.
///
/// ```text
/// θ′ = θ √(−½ ln l)
/// ```
///
/// At `l = 1/e²` it is the divergence itself. The formula is right; as an angle it is meaningful
/// while it stays small. The cone leaves out [`lost_by_cone`] of the power.
///
/// # Errors
///
/// Returns an error if `l` is not in the open interval (0, 1). The paper admits 1, which is a cone
/// without content.
pub fn modified_divergence(beam: &GaussianBeam, l: f64) -> Result<f64, BeamError> {
    if l > 0.0 && l < 1.0 {
        Ok(beam.divergence() * (-0.5 * l.ln()).sqrt())
    } else {
        Err(BeamError::CutoffFraction(l))
    }
}

/// Returns the fraction of the power of a circular beam outside the cone that reaches down to the
/// fraction `l` of the peak: `l` itself.
///
/// # Errors
///
/// Returns an error if `l` is not in the open interval (0, 1).
pub fn lost_by_cone(l: f64) -> Result<f64, BeamError> {
    if l > 0.0 && l < 1.0 {
        Ok(l)
    } else {
        Err(BeamError::CutoffFraction(l))
    }
}

/// Returns the fraction of the power of a laser line outside the wedge that reaches down to the
/// fraction `l` of the peak.
///
/// ```text
/// 1 − erf(√(−ln l))
/// ```
///
/// # Errors
///
/// Returns an error if `l` is not in the open interval (0, 1).
pub fn lost_by_fan_cone(l: f64) -> Result<f64, BeamError> {
    if l > 0.0 && l < 1.0 {
        Ok(libm::erfc((-l.ln()).sqrt()))
    } else {
        Err(BeamError::CutoffFraction(l))
    }
}

/// The printed sampler of rays: a uniform point of the aperture disc, a uniform direction of the
/// modified cone.
///
/// # Validity
///
/// It does not sample the beam. A radiance that arrives from one direction only cannot be hit by
/// independent points and directions. Taken literally, the mean of
/// `E / cos θ_s · cos θ / (pdf_position · pdf_direction)`, in W·sr, over the hits on a plane at the
/// distance z is
///
/// ```text
/// P · Ω_A     with Ω_A = π w_A² / z²
/// ```
///
/// instead of P, and that only where cone and disc together cover the beam. With the waist behind
/// or ahead of the aperture, up to 84 % of the light is missed at l = 0.01. The disc of radius `w_A`
/// alone holds `1 − e⁻² = 86.5 %` of the power. [`Emitter::sample_ray`](crate::Emitter::sample_ray)
/// has neither fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscConeSampler {
    aperture_radius: f64,
    half_angle: f64,
}

/// A ray of the printed sampler, in the frame of the aperture: +z travel, z = 0 the disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscConeRay {
    /// Point of the disc, in metres.
    pub origin: DVec3,
    /// Unit vector along the ray.
    pub direction: DVec3,
    /// Probability density of `origin`, per m² of the disc: `1 / (π w_A²)`.
    pub pdf_position: f64,
    /// Probability density of `direction`, per steradian: `1 / (2π (1 − cos θ′))`.
    pub pdf_direction: f64,
}

impl DiscConeSampler {
    /// Creates the sampler for a beam whose waist is at the signed distance `waist_distance`, in
    /// metres, from the aperture; the cone reaches down to the fraction `l` of the peak.
    ///
    /// # Errors
    ///
    /// Returns an error if `waist_distance` is not finite or beyond 1e30 m, if `l` is not in the
    /// open interval (0, 1), or if it is so small that the cone exceeds a half-space.
    pub fn new(beam: &GaussianBeam, waist_distance: f64, l: f64) -> Result<Self, BeamError> {
        if !is_coordinate(waist_distance) {
            return Err(BeamError::WaistDistance(waist_distance));
        }
        let half_angle = modified_divergence(beam, l)?;
        if half_angle > FRAC_PI_2 {
            return Err(BeamError::CutoffFraction(l));
        }
        Ok(Self {
            aperture_radius: beam.radius_at(waist_distance),
            half_angle,
        })
    }

    /// Returns the radius of the aperture disc, `w_A`, in metres.
    pub const fn aperture_radius(&self) -> f64 {
        self.aperture_radius
    }

    /// Returns the half-angle of the cone, `θ′`, in radians.
    pub const fn half_angle(&self) -> f64 {
        self.half_angle
    }

    /// Draws a ray from four uniform variates in [0, 1).
    pub fn sample(&self, u: [f64; 4]) -> DiscConeRay {
        let radius = self.aperture_radius * u[0].sqrt();
        let (sin, cos) = (TAU * u[1]).sin_cos();
        let origin = DVec3::new(radius * cos, radius * sin, 0.0);

        // 1 − cos θ′, without cancellation in a narrow cone.
        let height = 2.0 * (0.5 * self.half_angle).sin().powi(2);
        let drop = u[2] * height;
        let sin_theta = (drop * (2.0 - drop)).sqrt();
        let (sin, cos) = (TAU * u[3]).sin_cos();
        DiscConeRay {
            origin,
            direction: DVec3::new(sin_theta * cos, sin_theta * sin, 1.0 - drop),
            pdf_position: 1.0 / (PI * self.aperture_radius * self.aperture_radius),
            pdf_direction: 1.0 / (TAU * height),
        }
    }
}
