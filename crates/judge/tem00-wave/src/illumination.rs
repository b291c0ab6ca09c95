use core::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DVec3};
use num_complex::Complex;
use tem00_numerics::{Shown, check};

use crate::{
    Refusal, RigidMotion,
    length::{axes_from, checked_direction, checked_length, checked_position, checked_wavelength},
    phasor::phasor,
};

/// Monochromatic light that illuminates a surface: a complex amplitude at every point of space.
///
/// The amplitude varies in time as `exp(−iωt)`, so that a wave that travels along z is `exp(+ikz)`
/// and a diverging wave `exp(+ikr)`. Irradiance is its squared magnitude, in a unit that the
/// following amplitudes define:
///
/// | wave | amplitude 1 |
/// |---|---|
/// | [`plane`](Self::plane) | everywhere |
/// | [`point`](Self::point) | 1 m from the source |
/// | [`gaussian_beam`](Self::gaussian_beam) | in the centre of the waist |
/// | [`fan`](Self::fan) | in the waist, where it lies 1 m from the apex |
///
/// # Validity
///
/// Plane and spherical waves are exact solutions of the wave equation, with exact distances: no
/// expansion about an axis. A beam is the paraxial TEM₀₀ mode, the accepted model of a laser.
/// Within one wavelength of a point source or an apex, the amplitude equals the amplitude at one
/// wavelength.
///
/// # Examples
///
/// A helium–neon beam one Rayleigh range from its waist: the field on the axis has fallen by √2.
///
/// ```
/// use tem00_wave::{BeamDescription, DVec3, Illumination};
///
/// let beam = Illumination::gaussian_beam(&BeamDescription {
///     wavelength: 632.8e-9,
///     waist: DVec3::ZERO,
///     direction: DVec3::Z,
///     waist_radius: 100e-6,
/// })?;
/// let rayleigh_range = 49.646e-3;
/// let amplitude = beam.amplitude_at(DVec3::new(0.0, 0.0, rayleigh_range));
/// assert!((amplitude.norm() - 0.5_f64.sqrt()).abs() < 1e-5);
/// # Ok::<(), tem00_wave::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    wavelength: f64,
    /// Source, waist or apex; for a plane wave, the point where its phase is zero.
    origin: DVec3,
    /// Columns x, y, z of the wave: it travels along z, and a fan opens along x.
    axes: DMat3,
    wave: Wave,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Wave {
    Plane,
    Point,
    Beam {
        rayleigh_range: f64,
    },
    Fan {
        half_angle_tangent: f64,
        rayleigh_range: f64,
        waist_distance: f64,
    },
}

/// A circular Gaussian beam with M² = 1, for [`Illumination::gaussian_beam`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamDescription {
    /// Wavelength λ, in metres.
    pub wavelength: f64,
    /// Centre of the waist, in metres.
    pub waist: DVec3,
    /// Direction of travel, of any length.
    pub direction: DVec3,
    /// Waist radius w₀ (1/e² of irradiance), in metres.
    pub waist_radius: f64,
}

/// A laser line: light fanned out from an apex, for [`Illumination::fan`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FanDescription {
    /// Wavelength λ, in metres.
    pub wavelength: f64,
    /// Apex of the fan, in metres.
    pub apex: DVec3,
    /// Central direction of travel, of any length.
    pub direction: DVec3,
    /// Direction along which the fan opens, of any length; its component perpendicular to
    /// `direction` is used.
    pub opening: DVec3,
    /// Half-angle of the fan at which irradiance has fallen to 1/e², in radians.
    pub half_angle: f64,
    /// Waist radius across the line (1/e² of irradiance), in metres.
    pub waist_radius: f64,
    /// Distance from the apex to the waist across the line, in metres.
    pub waist_distance: f64,
}

impl Illumination {
    /// Creates a plane wave from its wavelength, in metres, and its direction of travel, of any
    /// length.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not between 0.1 nm and 1 m, or if the direction is
    /// zero or not finite.
    pub fn plane(wavelength: f64, direction: DVec3) -> Result<Self, Refusal> {
        let z = checked_direction(direction, "direction")?;
        Ok(Self {
            wavelength: checked_wavelength(wavelength)?,
            origin: DVec3::ZERO,
            axes: axes_about(z),
            wave: Wave::Plane,
        })
    }

    /// Creates a spherical wave from its wavelength and the position of its source, both in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not between 0.1 nm and 1 m, or if a component of the
    /// position is not finite or above 10 km.
    pub fn point(wavelength: f64, position: DVec3) -> Result<Self, Refusal> {
        Ok(Self {
            wavelength: checked_wavelength(wavelength)?,
            origin: checked_position(position, "position")?,
            axes: DMat3::IDENTITY,
            wave: Wave::Point,
        })
    }

    /// Creates a circular Gaussian beam.
    ///
    /// ```text
    /// U = 1 / (1 + i z/z_R) · exp(ikz + ik r² / 2q)     q = z − i z_R,   z_R = π w₀² / λ
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not between 0.1 nm and 1 m, if the waist radius is not
    /// between the paraxial limit 2λ/π and 10 km, if a component of the waist's position is not
    /// finite or above 10 km, or if the direction is zero or not finite.
    pub fn gaussian_beam(beam: &BeamDescription) -> Result<Self, Refusal> {
        let wavelength = checked_wavelength(beam.wavelength)?;
        let z = checked_direction(beam.direction, "direction")?;
        Ok(Self {
            wavelength,
            origin: checked_position(beam.waist, "position")?,
            axes: axes_about(z),
            wave: Wave::Beam {
                rayleigh_range: rayleigh_range(wavelength, beam.waist_radius)?,
            },
        })
    }

    /// Creates the fan of a laser line.
    ///
    /// The wave is cylindrical about the apex line, which runs across the fan. Its amplitude along
    /// the line is Gaussian in the tangent of the fan angle; across the line, it is a Gaussian beam
    /// along the slant distance ρ:
    ///
    /// ```text
    /// U = ρ^(−½) exp(−tan²θ / tan²θ₀) (1 + iζ/z_R)^(−½) exp(ikρ + ik y² / 2q)
    ///     ρ = √(x² + z²),   tan θ = x/z,   ζ = ρ − waist distance,   q = ζ − i z_R
    /// ```
    ///
    /// There is no light behind the apex, at z ≤ 0.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not between 0.1 nm and 1 m, if the waist radius is not
    /// between the paraxial limit 2λ/π and 10 km, if a component of the apex is not finite or above
    /// 10 km, if a direction is zero or not finite, if the opening is parallel to the direction, if
    /// the half-angle is not between 0 and π/2, or if the waist distance is not finite or above 10
    /// km in magnitude.
    pub fn fan(fan: &FanDescription) -> Result<Self, Refusal> {
        let wavelength = checked_wavelength(fan.wavelength)?;
        checked_direction(fan.direction, "direction")?;
        let holds = fan.half_angle > 0.0 && fan.half_angle < FRAC_PI_2;
        let allowed = "between 0 and π/2, in radians";
        check::that(holds, "half_angle", fan.half_angle, "", allowed)?;
        let waist = DVec3::new(0.0, 0.0, fan.waist_distance);
        checked_position(waist, "waist_distance").map_err(|_| {
            let allowed = "finite and at most 1e4 in magnitude, in metres";
            Refusal::new("waist_distance", fan.waist_distance, allowed)
        })?;
        Ok(Self {
            wavelength,
            origin: checked_position(fan.apex, "position")?,
            axes: axes_from(fan.opening, fan.direction).ok_or_else(|| {
                let allowed = "finite, not zero and not along the direction of the fan";
                Refusal::new("opening", fan.opening.to_array(), allowed)
            })?,
            wave: Wave::Fan {
                half_angle_tangent: fan.half_angle.tan(),
                rayleigh_range: rayleigh_range(wavelength, fan.waist_radius)?,
                waist_distance: fan.waist_distance,
            },
        })
    }

    /// Returns the wavelength λ, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the complex amplitude at a point, in metres.
    ///
    /// It is zero at points so far away that the square of their distance overflows.
    pub fn amplitude_at(&self, point: DVec3) -> Complex<f64> {
        let local = self.axes.transpose() * (point - self.origin);
        if !local.length_squared().is_finite() {
            return Complex::new(0.0, 0.0);
        }
        match self.wave {
            Wave::Plane => phasor(local.z / self.wavelength),
            Wave::Point => {
                let distance = local.length();
                phasor(distance / self.wavelength) / distance.max(self.wavelength)
            }
            Wave::Beam { rayleigh_range } => {
                let r2 = local.x * local.x + local.y * local.y;
                let mode = self.mode(r2, local.z, rayleigh_range);
                Complex::from_polar(mode.relative_amplitude, -mode.gouy_phase)
                    * mode.transverse
                    * phasor(local.z / self.wavelength)
            }
            Wave::Fan {
                half_angle_tangent,
                rayleigh_range,
                waist_distance,
            } if local.z > 0.0 => {
                let slant = local.x.hypot(local.z);
                let across = self.mode(local.y * local.y, slant - waist_distance, rayleigh_range);
                let along = (-(local.x / local.z / half_angle_tangent).powi(2)).exp();
                let spread = across.relative_amplitude / slant.max(self.wavelength);
                Complex::from_polar(along * spread.sqrt(), -0.5 * across.gouy_phase)
                    * across.transverse
                    * phasor(slant / self.wavelength)
            }
            Wave::Fan { .. } => Complex::new(0.0, 0.0),
        }
    }

    /// Returns the light after a rigid motion of its source.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        Self {
            origin: motion.point(self.origin),
            axes: motion.axes(self.axes),
            ..*self
        }
    }

    /// The Gaussian mode at `z` from its waist and `√r2` from its axis.
    fn mode(&self, r2: f64, z: f64, rayleigh_range: f64) -> Mode {
        let length2 = z * z + rayleigh_range * rayleigh_range;
        // 1/q = (z + i z_R) / (z² + z_R²).
        let decay = (-PI / self.wavelength * r2 * (rayleigh_range / length2)).exp();
        let turns = 0.5 / self.wavelength * r2 * (z / length2);
        Mode {
            relative_amplitude: rayleigh_range / length2.sqrt(),
            gouy_phase: z.atan2(rayleigh_range),
            transverse: decay * phasor(turns),
        }
    }
}

/// The factors of a Gaussian mode at a point.
struct Mode {
    /// `|1 / (1 + i z/z_R)|`.
    relative_amplitude: f64,
    /// Minus the phase of `1 / (1 + i z/z_R)`, in radians.
    gouy_phase: f64,
    /// `exp(ik r² / 2q)`.
    transverse: Complex<f64>,
}

fn rayleigh_range(wavelength: f64, waist_radius: f64) -> Result<f64, Refusal> {
    let radius = checked_length(waist_radius, "waist_radius")?;
    let minimum = 2.0 * wavelength / PI;
    if radius < minimum {
        let allowed = format!("at least the paraxial limit of {} m", Shown(minimum));
        return Err(Refusal::new("waist_radius", waist_radius, allowed));
    }
    Ok(0.5 * TAU * radius * radius / wavelength)
}

/// Any right-handed axes about a unit vector z.
fn axes_about(z: DVec3) -> DMat3 {
    let (x, y) = z.any_orthonormal_pair();
    DMat3::from_cols(x, y, z)
}

#[cfg(test)]
mod tests;
