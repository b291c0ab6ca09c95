use core::f64::consts::{LN_2, PI};

use glam::DVec3;
use tem00_numerics::{Shown, check};

use crate::Refusal;

/// The largest divergence, in radians, for which the paraxial model is trusted.
const PARAXIAL_LIMIT: f64 = 0.5;

/// A circular Gaussian beam in a homogeneous medium: TEM₀₀, or partially coherent with M² > 1.
///
/// The beam travels along +z and its waist lies at z = 0. The wavelength `λ` in the medium of
/// propagation, the waist radius `w₀` and the beam quality factor `M²` determine everything else:
///
/// ```text
/// z_R  = π w₀² / (M² λ)           Rayleigh range
/// w(z) = w₀ √(1 + (z / z_R)²)     beam radius, where the irradiance has fallen to 1/e²
/// δ    = M² λ / (π w₀)            divergence, half-angle
/// ```
///
/// The beam carries no power of its own: irradiance is linear in power, so
/// [`irradiance_per_watt`](Self::irradiance_per_watt) leaves the factor to the caller.
///
/// # Validity
///
/// The beam solves the *paraxial* wave equation. Constructors reject waists below `2 M² λ / π`,
/// where the divergence reaches 0.5 rad and the model is no longer trustworthy. Lengths must lie
/// between 1e−30 m and 1e30 m, so that their squares stay within the range of `f64`.
///
/// # Examples
///
/// A helium–neon laser focused to a waist of 100 µm:
///
/// ```
/// use tem00_beam::GaussianBeam;
///
/// let beam = GaussianBeam::from_waist(632.8e-9, 100e-6)?;
///
/// assert!((beam.rayleigh_range() - 49.65e-3).abs() < 0.01e-3);
/// assert!((beam.radius_at(1.0) - 2.017e-3).abs() < 0.001e-3);
///
/// let power = 1e-3;
/// let peak_irradiance = power * beam.irradiance_per_watt(0.0, 0.0);
/// assert!((peak_irradiance - 63.66e3).abs() < 0.01e3); // W/m²
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
///
/// # References
///
/// - A. E. Siegman, *Lasers*, 1986, ch. 17.
/// - S. Bergmann et al., *A Phenomenological Approach to Integrating Gaussian Beam Properties and
///   Speckle into a Physically-Based Renderer*, 2016, eq. (1) and (2).
/// - ISO 11146-1, 2021, for M².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianBeam {
    wavelength: f64,
    waist_radius: f64,
    m_squared: f64,
}

impl GaussianBeam {
    /// Creates a diffraction-limited beam (M² = 1) from its wavelength and waist radius, both in
    /// metres.
    ///
    /// The wavelength is the one in the medium of propagation, `λ_vacuum / n`; in air and in vacuum
    /// it equals the vacuum wavelength.
    ///
    /// # Errors
    ///
    /// Returns an error if an argument is not a length from 1e−30 m to 1e30 m, or if `waist_radius`
    /// is below the paraxial limit `2λ/π`. The last check also catches swapped arguments.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::GaussianBeam;
    ///
    /// let swapped = GaussianBeam::from_waist(100e-6, 632.8e-9);
    /// assert_eq!(swapped.unwrap_err().parameter, "waist_radius");
    /// ```
    pub fn from_waist(wavelength: f64, waist_radius: f64) -> Result<Self, Refusal> {
        Self {
            wavelength: check::length("wavelength", wavelength)?,
            waist_radius: check::length("waist_radius", waist_radius)?,
            m_squared: 1.0,
        }
        .paraxial()
    }

    /// Creates a diffraction-limited beam (M² = 1) from its wavelength in the medium of
    /// propagation, in metres, and its far-field divergence half-angle, in radians.
    ///
    /// ```text
    /// w₀ = λ / (π δ)
    /// ```
    ///
    /// Where a data sheet gives the divergence *and* an M², create the beam with the divergence
    /// `δ / M²` and then set its M²: [`with_m_squared`](Self::with_m_squared) keeps the waist, so
    /// that the divergence becomes `δ`.
    ///
    /// # Errors
    ///
    /// Returns an error if `wavelength` is not a length from 1e−30 m to 1e30 m, if `divergence` is
    /// not in the interval (0, 0.5], or if the resulting waist radius exceeds 1e30 m.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::GaussianBeam;
    ///
    /// let pointer = GaussianBeam::from_divergence(650e-9, 0.5e-3)?;
    /// assert!((pointer.waist_radius() - 0.414e-3).abs() < 0.001e-3);
    ///
    /// let worse = GaussianBeam::from_divergence(650e-9, 0.5e-3 / 1.5)?.with_m_squared(1.5)?;
    /// assert!((worse.divergence() - 0.5e-3).abs() < 1e-15);
    /// assert!((worse.waist_radius() - 0.621e-3).abs() < 0.001e-3);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn from_divergence(wavelength: f64, divergence: f64) -> Result<Self, Refusal> {
        check::length("wavelength", wavelength)?;
        check::that(
            divergence > 0.0 && divergence <= PARAXIAL_LIMIT,
            "divergence",
            divergence,
            "rad",
            "in (0, 0.5] rad",
        )?;
        let waist_radius = wavelength / (PI * divergence);
        check::length("waist_radius", waist_radius)?;
        Ok(Self {
            wavelength,
            waist_radius,
            m_squared: 1.0,
        })
    }

    /// Returns this beam with another beam quality factor `M²` and the same waist radius.
    ///
    /// The divergence is multiplied by M² and the depth of focus divided by it.
    ///
    /// # Errors
    ///
    /// Returns an error if `m_squared` is not a finite number of at least 1, or if the waist is
    /// below the paraxial limit `2 M² λ / π`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::GaussianBeam;
    ///
    /// let ideal = GaussianBeam::from_waist(650e-9, 50e-6)?;
    /// let diode = ideal.with_m_squared(1.3)?;
    /// assert!((diode.divergence() / ideal.divergence() - 1.3).abs() < 1e-12);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn with_m_squared(self, m_squared: f64) -> Result<Self, Refusal> {
        check::that(
            m_squared >= 1.0 && m_squared.is_finite(),
            "m_squared",
            m_squared,
            "",
            "finite and at least 1",
        )?;
        Self { m_squared, ..self }.paraxial()
    }

    /// Returns the beam itself if its divergence is within the paraxial limit.
    fn paraxial(self) -> Result<Self, Refusal> {
        let minimum = self.m_squared * self.wavelength / (PI * PARAXIAL_LIMIT);
        let allowed = || format!("at least 2 M² λ / π = {} m to be paraxial", Shown(minimum));
        if self.waist_radius >= minimum {
            Ok(self)
        } else {
            Err(Refusal::new("waist_radius", self.waist_radius, allowed()).in_unit("m"))
        }
    }

    /// Returns the wavelength `λ` in the medium of propagation, in metres.
    ///
    /// It is the vacuum wavelength divided by the refractive index.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the waist radius `w₀`, in metres.
    pub const fn waist_radius(&self) -> f64 {
        self.waist_radius
    }

    /// Returns the beam quality factor `M²`, which is 1 for a diffraction-limited beam.
    pub const fn m_squared(&self) -> f64 {
        self.m_squared
    }

    /// Returns the Rayleigh range `z_R = π w₀² / (M² λ)`, in metres.
    ///
    /// At this distance from the waist the beam radius has grown by √2.
    pub const fn rayleigh_range(&self) -> f64 {
        PI * self.waist_radius * self.waist_radius / (self.m_squared * self.wavelength)
    }

    /// Returns the far-field divergence half-angle `δ = M² λ / (π w₀)`, in radians.
    ///
    /// The paraxial model does not distinguish angle and slope: δ is the slope of the asymptote of
    /// `w(z)`.
    pub const fn divergence(&self) -> f64 {
        self.m_squared * self.wavelength / (PI * self.waist_radius)
    }

    /// Returns the confocal parameter `2 z_R`, in metres: the length over which the beam radius
    /// stays within √2 of the waist.
    pub const fn confocal_parameter(&self) -> f64 {
        2.0 * self.rayleigh_range()
    }

    /// Returns the depth of focus, in metres: the full length, half of it on either side of the
    /// waist, over which the beam radius does not exceed `growth` times the waist radius.
    ///
    /// ```text
    /// 2 z_R √(growth² − 1)
    /// ```
    ///
    /// Conventions differ. With `growth = √2`, where the irradiance on the axis has halved, it is
    /// the confocal parameter `2 z_R`; makers of optics also quote a growth by 5 %, which gives
    /// `0.64 z_R`.
    ///
    /// # Errors
    ///
    /// Returns an error if `growth` is not a finite number greater than 1.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::GaussianBeam;
    ///
    /// let beam = GaussianBeam::from_waist(1064e-9, 10e-6)?;
    /// assert!((beam.rayleigh_range() - 295e-6).abs() < 1e-6);
    /// assert!((beam.depth_of_focus(1.05)? - 189e-6).abs() < 1e-6);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn depth_of_focus(&self, growth: f64) -> Result<f64, Refusal> {
        check::that(
            growth > 1.0 && growth.is_finite(),
            "growth",
            growth,
            "",
            "finite and greater than 1",
        )?;
        // √(growth² − 1), in a form in which neither the square overflows nor the difference loses
        // digits.
        let lengths = (growth - 1.0).sqrt() * (growth + 1.0).sqrt();
        Ok(self.confocal_parameter() * lengths)
    }

    /// Returns the beam parameter product `w₀ δ = M² λ / π`, in m·rad.
    ///
    /// No lens or mirror changes it. Data sheets give it in mm·mrad, which is 1e−6 m·rad.
    ///
    /// # Examples
    ///
    /// A diffraction-limited beam at 1064 nm has 0.339 mm·mrad:
    ///
    /// ```
    /// use tem00_beam::GaussianBeam;
    ///
    /// let beam = GaussianBeam::from_waist(1064e-9, 10e-6)?;
    /// assert!((beam.beam_parameter_product() / 1e-6 - 0.339).abs() < 0.001);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub const fn beam_parameter_product(&self) -> f64 {
        self.m_squared * self.wavelength / PI
    }

    /// Returns the beam radius `w(z)`, in metres, at the signed distance `z` from the waist.
    pub fn radius_at(&self, z: f64) -> f64 {
        self.waist_radius.hypot(self.divergence() * z)
    }

    /// Returns the full width at half maximum `√(2 ln 2) w(z)`, in metres, of the irradiance at the
    /// signed distance `z` from the waist.
    pub fn fwhm_at(&self, z: f64) -> f64 {
        (2.0 * LN_2).sqrt() * self.radius_at(z)
    }

    /// Returns the D4σ width `2 w(z)`, in metres, at the signed distance `z` from the waist: four
    /// times the standard deviation of the irradiance, a diameter.
    pub fn d4_sigma_at(&self, z: f64) -> f64 {
        2.0 * self.radius_at(z)
    }

    /// Returns the wavefront curvature `1/R(z)`, in m⁻¹, at the signed distance `z` from the waist.
    ///
    /// ```text
    /// 1/R(z) = z / (z² + z_R²)
    /// ```
    ///
    /// It is positive where the beam diverges (z > 0), negative where it converges and 0 at the
    /// waist, where the radius of curvature itself would be infinite. Its largest magnitude is
    /// `1 / (2 z_R)`, one Rayleigh range from the waist. A beam with M² > 1 has no single
    /// wavefront; the value then describes its mean energy flow.
    pub fn curvature_at(&self, z: f64) -> f64 {
        let z_r = self.rayleigh_range();
        1.0 / (z + z_r / z * z_r)
    }

    /// Returns the Gouy phase `atan(z / z_R)`, in radians, at the signed distance `z` from the
    /// waist.
    ///
    /// It is the phase by which the beam runs ahead of a plane wave, 0 at the waist and ±π/2 far
    /// from it.
    pub fn gouy_phase_at(&self, z: f64) -> f64 {
        (z / self.rayleigh_range()).atan()
    }

    /// Returns the irradiance on the axis per watt of beam power, `2 / (π w²(z))`, in m⁻², at the
    /// signed distance `z` from the waist.
    pub fn peak_irradiance_per_watt(&self, z: f64) -> f64 {
        let w = self.radius_at(z);
        2.0 / (PI * w * w)
    }

    /// Returns the irradiance per watt of beam power, in m⁻², at the distance `r` from the axis and
    /// the signed distance `z` from the waist.
    ///
    /// ```text
    /// E(r, z) / P = 2 / (π w²) · exp(−2 r² / w²)     with w = w(z)
    /// ```
    ///
    /// Its integral over any plane of constant z is 1. For a surface of another orientation use
    /// [`flux_per_watt`](Self::flux_per_watt).
    pub fn irradiance_per_watt(&self, r: f64, z: f64) -> f64 {
        let rho = r / self.radius_at(z);
        self.peak_irradiance_per_watt(z) * (-2.0 * rho * rho).exp()
    }

    /// Returns the energy-flow vector per watt of beam power, in m⁻², at `point` in the beam frame
    /// (waist at the origin, travel along +z).
    ///
    /// ```text
    /// F / P = E(r, z) / P · (x / R(z), y / R(z), 1)
    /// ```
    ///
    /// The bracket is *not* normalised: its z-component is 1, so that F has no divergence and its
    /// integral over any surface that cuts the whole beam is 1. A surface whose normal `n` lies on
    /// the lit side receives the irradiance `max(0, −F·n)`.
    ///
    /// # Examples
    ///
    /// A surface tilted by 60° receives half the irradiance, since the power spreads over twice the
    /// area:
    ///
    /// ```
    /// use tem00_beam::{DVec3, GaussianBeam};
    ///
    /// let beam = GaussianBeam::from_waist(650e-9, 50e-6)?;
    /// let (sin, cos) = 60_f64.to_radians().sin_cos();
    /// let normal = DVec3::new(sin, 0.0, -cos);
    /// let on_axis = DVec3::new(0.0, 0.0, 0.3);
    ///
    /// let irradiance = -beam.flux_per_watt(on_axis).dot(normal);
    /// let upright = beam.irradiance_per_watt(0.0, 0.3);
    /// assert!((irradiance / upright - 0.5).abs() < 1e-12);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn flux_per_watt(&self, point: DVec3) -> DVec3 {
        let irradiance = self.irradiance_per_watt(point.x.hypot(point.y), point.z);
        if irradiance > 0.0 {
            let curvature = self.curvature_at(point.z);
            irradiance * DVec3::new(point.x * curvature, point.y * curvature, 1.0)
        } else {
            DVec3::ZERO
        }
    }

    /// Returns the fraction of the power within `radius` of the axis, a number from 0 to 1, at the
    /// signed distance `z` from the waist; both lengths in metres.
    ///
    /// ```text
    /// 1 − exp(−2 radius² / w²(z))
    /// ```
    pub fn encircled_power(&self, radius: f64, z: f64) -> f64 {
        let rho = radius / self.radius_at(z);
        -(-2.0 * rho * rho).exp_m1()
    }
}

#[cfg(test)]
mod tests;
