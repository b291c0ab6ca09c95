use core::f64::consts::PI;

use num_complex::Complex64;
use tem00_beam::{GaussianBeam, LocatedBeam, Refusal};
use tem00_numerics::check;

/// The complex beam parameter `q` of a Gaussian beam in one plane.
///
/// ```text
/// q   = z + i z_R                 z: distance past the waist, z_R: Rayleigh range
/// 1/q = 1/R − i M² λ / (π w²)     R: radius of the wavefront, w: beam radius
/// ```
///
/// It contains neither wavelength nor M². With [`AbcdMatrix`](crate::AbcdMatrix) it gives the
/// position of the focus and the depth of focus, and together with the *effective wavelength*
/// `M² λ` also the beam radius. Both parts follow the convention exp(i (ω t − k z)) of the
/// references, where the imaginary part of q is positive.
///
/// # Validity
///
/// The paraxial limit cannot be checked without a wavelength; the conversion into a [`LocatedBeam`]
/// checks it. The distance lies within ±1e30 m, the Rayleigh range between 1e−100 m and 1e100 m, so
/// that their squares stay within the range of `f64`.
///
/// # Examples
///
/// One Rayleigh range past the waist the wavefront is curved most:
///
/// ```
/// use tem00_optics::Complex64;
/// use tem00_optics::ComplexBeamParameter;
///
/// let q = ComplexBeamParameter::new(0.05, 0.05)?;
///
/// assert!((q.curvature() - 10.0).abs() < 1e-12); // 1 / (2 z_R)
/// assert!((q.radius(632.8e-9)? / 100.36e-6 - std::f64::consts::SQRT_2).abs() < 1e-4);
/// assert_eq!(q.to_complex(), Complex64::new(0.05, 0.05));
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
///
/// # References
///
/// - H. Kogelnik and T. Li, *Laser Beams and Resonators*, 1966, eq. (17).
/// - A. E. Siegman, *Lasers*, 1986, ch. 17 and 20.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexBeamParameter {
    distance_from_waist: f64,
    rayleigh_range: f64,
}

impl ComplexBeamParameter {
    /// Creates the parameter `z + i z_R` from the signed distance past the waist (negative where
    /// the beam converges) and the Rayleigh range, both in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if `distance_from_waist` is not finite or beyond 1e30 m, or if
    /// `rayleigh_range` does not lie between 1e−100 m and 1e100 m.
    pub fn new(distance_from_waist: f64, rayleigh_range: f64) -> Result<Self, Refusal> {
        Ok(Self {
            distance_from_waist: check::coordinate("waist_distance", distance_from_waist)?,
            rayleigh_range: check::range("rayleigh_range", rayleigh_range, [1e-100, 1e100], "m")?,
        })
    }

    /// Returns the complex beam parameter of a beam in its reference plane.
    pub const fn of(beam: &LocatedBeam) -> Self {
        // The range is kept: a paraxial waist w₀ has z_R ≥ 2 w₀ ≥ 2e−30 m, and z_R ≤ π 1e60 / 1e−30
        // m.
        Self {
            distance_from_waist: -beam.waist_distance(),
            rayleigh_range: beam.beam().rayleigh_range(),
        }
    }

    /// Creates the parameter of a beam from its radius in one plane, in metres, its wavefront
    /// curvature `1/R` there, in m⁻¹ and positive where the beam diverges, and its effective
    /// wavelength `M² λ`, in metres.
    ///
    /// ```text
    /// a = M² λ / (π w²)      z + i z_R = (1/R + i a) / (1/R² + a²)
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if `radius` or `effective_wavelength` is not a length from 1e−30 m to
    /// 1e30 m, if `curvature` is not finite or beyond 1e30 m⁻¹, or if the resulting parameter is
    /// outside the range of [`new`](Self::new).
    ///
    /// # Examples
    ///
    /// A beam of 1 mm half-width, focused to a distance of 0.1 m:
    ///
    /// ```
    /// use tem00_optics::ComplexBeamParameter;
    ///
    /// let q = ComplexBeamParameter::from_radius_and_curvature(1e-3, -10.0, 650e-9)?;
    /// assert!((q.distance_from_waist() + 0.1).abs() < 1e-4);
    /// assert!((q.rayleigh_range() - 2.07e-3).abs() < 1e-5); // (λ/π) (f/w)²
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn from_radius_and_curvature(
        radius: f64,
        curvature: f64,
        effective_wavelength: f64,
    ) -> Result<Self, Refusal> {
        check::length("radius", radius)?;
        check::range("curvature", curvature, [-1e30, 1e30], "m⁻¹")?;
        check::length("wavelength", effective_wavelength)?;
        let spread = effective_wavelength / (PI * radius * radius);
        let modulus = spread.hypot(curvature);
        Self::new(curvature / modulus / modulus, spread / modulus / modulus)
    }

    /// Returns the signed distance past the waist, in metres; negative where the beam converges.
    pub const fn distance_from_waist(&self) -> f64 {
        self.distance_from_waist
    }

    /// Returns the Rayleigh range, in metres.
    pub const fn rayleigh_range(&self) -> f64 {
        self.rayleigh_range
    }

    /// Returns the wavefront curvature `1/R = z / (z² + z_R²)`, in m⁻¹, which is the real part of
    /// 1/q; positive where the beam diverges.
    pub fn curvature(&self) -> f64 {
        let modulus = self.modulus();
        self.distance_from_waist / modulus / modulus
    }

    /// Returns the Gouy phase `atan(z / z_R)`, in radians.
    pub fn gouy_phase(&self) -> f64 {
        self.distance_from_waist.atan2(self.rayleigh_range)
    }

    /// Returns the beam radius, in metres, for the effective wavelength `M² λ`, in metres.
    ///
    /// ```text
    /// w = |q| √(M² λ / (π z_R))
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if `effective_wavelength` is not a length from 1e−30 m to 1e30 m.
    pub fn radius(&self, effective_wavelength: f64) -> Result<f64, Refusal> {
        check::length("wavelength", effective_wavelength)?;
        Ok(self.modulus() * (effective_wavelength / (PI * self.rayleigh_range)).sqrt())
    }

    /// Returns the parameter as a complex number, in metres.
    pub const fn to_complex(&self) -> Complex64 {
        Complex64::new(self.distance_from_waist, self.rayleigh_range)
    }

    /// Returns the beam with this parameter, whose reference plane is the plane of the parameter.
    ///
    /// ```text
    /// w₀ = √(M² λ z_R / π)
    /// ```
    ///
    /// `wavelength` is the wavelength in the medium of propagation, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if `wavelength` is not a length from 1e−30 m to 1e30 m, if `m_squared` is
    /// not a finite number of at least 1, or if the resulting waist radius is below the paraxial
    /// limit or exceeds 1e30 m.
    pub fn to_located_beam(&self, wavelength: f64, m_squared: f64) -> Result<LocatedBeam, Refusal> {
        check::that(
            m_squared >= 1.0 && m_squared.is_finite(),
            "m_squared",
            m_squared,
            "",
            "finite and at least 1",
        )?;
        let waist_radius = (m_squared / PI * wavelength * self.rayleigh_range).sqrt();
        let beam = GaussianBeam::from_waist(wavelength, waist_radius)?.with_m_squared(m_squared)?;
        LocatedBeam::new(beam, -self.distance_from_waist)
    }

    fn modulus(&self) -> f64 {
        self.distance_from_waist.hypot(self.rayleigh_range)
    }
}

#[cfg(test)]
mod tests;
