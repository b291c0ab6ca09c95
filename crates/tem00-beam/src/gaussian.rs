use core::f64::consts::PI;

use glam::DVec3;

use crate::BeamError;

/// The largest divergence, in radians, for which the paraxial model is trusted.
const PARAXIAL_LIMIT: f64 = 0.5;

/// A circular TEM₀₀ Gaussian beam in free space, or its partially coherent relative with M² > 1.
///
/// The beam travels along +z and its waist lies at z = 0. The wavelength `λ`, the waist radius `w₀`
/// and the beam quality factor `M²` determine everything else:
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
/// between 1e−30 m and 1e30 m, so that no square of them leaves the range of `f64`.
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
/// # Ok::<(), tem00_beam::BeamError>(())
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
    /// Creates a diffraction-limited beam (M² = 1) from its vacuum wavelength and waist radius,
    /// both in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if an argument is not a length from 1e−30 m to 1e30 m, or if `waist_radius`
    /// is below the paraxial limit `2λ/π`. The last check also catches swapped arguments.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::{BeamError, GaussianBeam};
    ///
    /// let swapped = GaussianBeam::from_waist(100e-6, 632.8e-9);
    /// assert!(matches!(swapped, Err(BeamError::NotParaxial { .. })));
    /// ```
    pub fn from_waist(wavelength: f64, waist_radius: f64) -> Result<Self, BeamError> {
        if !is_length(wavelength) {
            return Err(BeamError::Wavelength(wavelength));
        }
        if !is_length(waist_radius) {
            return Err(BeamError::WaistRadius(waist_radius));
        }
        Self {
            wavelength,
            waist_radius,
            m_squared: 1.0,
        }
        .paraxial()
    }

    /// Creates a diffraction-limited beam (M² = 1) from its vacuum wavelength, in metres, and its
    /// far-field divergence half-angle, in radians.
    ///
    /// ```text
    /// w₀ = λ / (π δ)
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if `wavelength` is not a length from 1e−30 m to 1e30 m, if `divergence` is
    /// not in the interval (0, 0.5], or if the waist that follows is beyond 1e30 m.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::GaussianBeam;
    ///
    /// let pointer = GaussianBeam::from_divergence(650e-9, 0.5e-3)?;
    /// assert!((pointer.waist_radius() - 0.414e-3).abs() < 0.001e-3);
    /// # Ok::<(), tem00_beam::BeamError>(())
    /// ```
    pub fn from_divergence(wavelength: f64, divergence: f64) -> Result<Self, BeamError> {
        if !is_length(wavelength) {
            return Err(BeamError::Wavelength(wavelength));
        }
        if !(divergence > 0.0 && divergence <= PARAXIAL_LIMIT) {
            return Err(BeamError::Divergence(divergence));
        }
        let waist_radius = wavelength / (PI * divergence);
        if !is_length(waist_radius) {
            return Err(BeamError::WaistRadius(waist_radius));
        }
        Ok(Self {
            wavelength,
            waist_radius,
            m_squared: 1.0,
        })
    }

    /// Returns this beam with another beam quality factor `M²` and the same waist radius.
    ///
    /// Divergence grows with M², so the depth of focus shrinks by it.
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
    /// # Ok::<(), tem00_beam::BeamError>(())
    /// ```
    pub fn with_m_squared(self, m_squared: f64) -> Result<Self, BeamError> {
        if !(m_squared >= 1.0 && m_squared.is_finite()) {
            return Err(BeamError::MSquared(m_squared));
        }
        Self { m_squared, ..self }.paraxial()
    }

    /// Returns the beam itself if its divergence is within the paraxial limit.
    fn paraxial(self) -> Result<Self, BeamError> {
        let minimum = self.m_squared * self.wavelength / (PI * PARAXIAL_LIMIT);
        if self.waist_radius < minimum {
            return Err(BeamError::NotParaxial {
                waist_radius: self.waist_radius,
                minimum,
            });
        }
        Ok(self)
    }

    /// Returns the vacuum wavelength `λ`, in metres.
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
    /// In the paraxial model angle and slope are one: δ is the slope of the asymptote of `w(z)`.
    pub const fn divergence(&self) -> f64 {
        self.m_squared * self.wavelength / (PI * self.waist_radius)
    }

    /// Returns the beam radius `w(z)`, in metres, at the signed distance `z` from the waist.
    pub fn radius_at(&self, z: f64) -> f64 {
        self.waist_radius * 1.0_f64.hypot(z / self.rayleigh_range())
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
    /// wavefront; the value is then that of its mean energy flow.
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
    /// Its integral over any plane of constant z is 1. On a surface of another orientation take
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
    /// A surface tilted by 60° receives half the irradiance, spread over twice the area:
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
    /// # Ok::<(), tem00_beam::BeamError>(())
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

/// The lengths whose squares, products and quotients stay within the range of `f64`.
pub(crate) fn is_length(x: f64) -> bool {
    (1e-30..=1e30).contains(&x)
}

/// The coordinates whose squares and products with lengths stay within the range of `f64`.
pub(crate) fn is_coordinate(x: f64) -> bool {
    x.abs() <= 1e30
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const HENE: f64 = 632.8e-9;

    fn beam() -> GaussianBeam {
        GaussianBeam::from_waist(HENE, 100e-6).unwrap()
    }

    /// ∫ f over [a, b] by Simpson's rule.
    fn integrate(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
        const INTERVALS: u32 = 2_000;
        let h = (b - a) / f64::from(INTERVALS);
        let weighted = |i: u32| {
            let weight = match i {
                0 | INTERVALS => 1.0,
                i if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            weight * f(a + f64::from(i) * h)
        };
        (0..=INTERVALS).map(weighted).sum::<f64>() * h / 3.0
    }

    #[test]
    fn every_cross_section_carries_the_full_power() {
        for m_squared in [1.0, 3.0] {
            let beam = beam().with_m_squared(m_squared).unwrap();
            let z_r = beam.rayleigh_range();
            for z in [-10.0 * z_r, -z_r, 0.0, 0.3 * z_r, 100.0 * z_r] {
                // exp(−2 · 4²) ≈ 1e−14 of the power lies beyond four beam radii.
                let cutoff = 4.0 * beam.radius_at(z);
                let ring = |r| beam.irradiance_per_watt(r, z) * 2.0 * PI * r;
                let power = integrate(ring, 0.0, cutoff);
                assert!((power - 1.0).abs() < 1e-10, "z = {z:e} m: P = {power}");
            }
        }
    }

    #[test]
    fn radius_approaches_the_divergence_cone() {
        let beam = beam().with_m_squared(2.0).unwrap();
        let z = 1e4 * beam.rayleigh_range();
        let half_angle = beam.radius_at(z) / z;
        // The relative deviation from the asymptote is (z_R / z)² / 2 = 5e−9.
        let deviation = half_angle / beam.divergence() - 1.0;
        assert!(deviation.abs() < 6e-9, "deviation {deviation:e}");
    }

    #[test]
    fn m_squared_scales_divergence_and_rayleigh_range_but_not_the_waist() {
        let ideal = beam();
        let real = ideal.with_m_squared(1.7).unwrap();
        let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-15;
        assert!(
            same(real.divergence(), 1.7 * ideal.divergence()),
            "{real:?}"
        );
        assert!(
            same(real.rayleigh_range(), ideal.rayleigh_range() / 1.7),
            "{real:?}"
        );
        assert!(same(real.radius_at(0.0), 100e-6), "{real:?}");
    }

    #[test]
    fn divergence_and_waist_determine_each_other() {
        let beam = GaussianBeam::from_divergence(HENE, 2.5e-3).unwrap();
        let again = GaussianBeam::from_waist(HENE, beam.waist_radius()).unwrap();
        assert!(
            (again.divergence() / 2.5e-3 - 1.0).abs() < 1e-15,
            "{again:?}"
        );
    }

    #[test]
    fn curvature_is_the_relative_growth_of_the_radius() {
        let beam = beam();
        let z_r = beam.rayleigh_range();
        for x in [-20.0, -1.0, -0.2, 0.0, 0.5, 1.0, 3.0] {
            let h = 1e-4 * z_r;
            let growth =
                (beam.radius_at(x * z_r + h) / beam.radius_at(x * z_r - h)).ln() / (2.0 * h);
            // (h / z_R)² / 6 times the third derivative of ln w, at most 3 / z_R³, is 5e−9 / z_R.
            let difference = (growth - beam.curvature_at(x * z_r)) * z_r;
            assert!(difference.abs() < 1e-8, "z = {x} z_R: {difference:e}");
        }
    }

    #[test]
    fn curvature_vanishes_at_the_waist_and_peaks_at_the_rayleigh_range() {
        let beam = beam();
        let z_r = beam.rayleigh_range();
        assert!(
            beam.curvature_at(0.0).abs() < f64::MIN_POSITIVE,
            "at the waist"
        );
        for sign in [-1.0, 1.0] {
            let peak = beam.curvature_at(sign * z_r) * z_r;
            assert!((peak - 0.5 * sign).abs() < 1e-15, "{peak}");
            let far = 1e6 * z_r;
            // 1/R = 1/z · (1 − (z_R / z)²)
            let radius = 1.0 / beam.curvature_at(sign * far);
            assert!((radius / (sign * far) - 1.0).abs() < 2e-12, "{radius}");
        }
    }

    #[test]
    fn gouy_phase_accumulates_the_transverse_momentum() {
        // ζ' = λ / (π w²): the spread of transverse wave numbers costs axial phase
        // (Feng and Winful 2001).
        let beam = beam();
        for x in [-5.0, -1.0, 0.1, 1.0, 4.0] {
            let z = x * beam.rayleigh_range();
            let rate = |z: f64| HENE / (PI * beam.radius_at(z).powi(2));
            let phase = integrate(rate, 0.0, z);
            let difference = phase - beam.gouy_phase_at(z);
            // Simpson: (5 / 2000)⁴ · 5 · max|f⁗| / 180 = 3e−11.
            assert!(difference.abs() < 1e-10, "z = {x} z_R: {difference:e}");
        }
        let limit = beam.gouy_phase_at(1e12);
        assert!((limit - PI / 2.0).abs() < 1e-12, "{limit}");
    }

    #[test]
    fn encircled_power_is_the_integral_of_the_irradiance() {
        let beam = beam();
        for z in [0.0, 0.2] {
            let w = beam.radius_at(z);
            for rho in [0.1, 0.5, 1.0, 2.0] {
                let ring = |r| beam.irradiance_per_watt(r, z) * 2.0 * PI * r;
                let power = integrate(ring, 0.0, rho * w);
                let closed = beam.encircled_power(rho * w, z);
                assert!(
                    (power - closed).abs() < 1e-11,
                    "ρ = {rho}: {power}, {closed}"
                );
            }
        }
        let within_w = beam.encircled_power(beam.radius_at(0.3), 0.3);
        assert!(
            (within_w - 0.864_664_716_763_387_3).abs() < 1e-14,
            "1 − e⁻²: {within_w}"
        );
    }

    #[test]
    fn flux_has_no_divergence() {
        let beam = beam();
        let (w0, z_r) = (beam.waist_radius(), beam.rayleigh_range());
        for z in [-2.0, -0.5, 0.3, 1.0, 5.0] {
            let w = beam.radius_at(z * z_r);
            let p = DVec3::new(0.6 * w, -0.4 * w, z * z_r);
            let (h, h_z) = (1e-4 * w0, 1e-4 * z_r);
            let slope = |axis: DVec3, h: f64| {
                let step = axis * h;
                let change = beam.flux_per_watt(p + step) - beam.flux_per_watt(p - step);
                change.dot(axis) / (2.0 * h)
            };
            let divergence = slope(DVec3::X, h) + slope(DVec3::Y, h) + slope(DVec3::Z, h_z);
            // The terms that cancel are of the size E/R; a central difference errs by h²/6 of the
            // third derivative, here at most 60 in units of w₀ and z_R: 1e−7 of E/z_R.
            let scale = beam.flux_per_watt(p).z / z_r;
            assert!(
                (divergence / scale).abs() < 2e-7,
                "z = {z} z_R: {:e}",
                divergence / scale
            );
        }
    }

    #[test]
    fn flux_is_zero_where_the_irradiance_vanishes() {
        // At the waist's side, x / R alone would overflow.
        let beam = GaussianBeam::from_waist(1e-29, 1e-29).unwrap();
        let far = DVec3::new(1e300, 0.0, beam.rayleigh_range());
        assert_eq!(beam.flux_per_watt(far), DVec3::ZERO, "{far}");
    }

    #[test]
    fn constructor_rejects_values_that_are_not_lengths() {
        for bad in [0.0, -1.0, 1e-31, 1e31, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(
                    GaussianBeam::from_waist(bad, 100e-6),
                    Err(BeamError::Wavelength(_))
                ),
                "wavelength {bad}"
            );
            assert!(
                matches!(
                    GaussianBeam::from_divergence(bad, 1e-3),
                    Err(BeamError::Wavelength(_))
                ),
                "wavelength {bad}"
            );
            assert!(
                matches!(
                    GaussianBeam::from_waist(HENE, bad),
                    Err(BeamError::WaistRadius(_))
                ),
                "waist {bad}"
            );
        }
    }

    #[test]
    fn constructor_rejects_impossible_divergence_and_quality() {
        for bad in [0.0, -1e-3, 0.500_001, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(
                    GaussianBeam::from_divergence(HENE, bad),
                    Err(BeamError::Divergence(_))
                ),
                "divergence {bad}"
            );
        }
        assert!(
            matches!(
                GaussianBeam::from_divergence(HENE, 1e-300),
                Err(BeamError::WaistRadius(_))
            ),
            "a waist beyond all lengths"
        );
        for bad in [0.999, -1.0, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(beam().with_m_squared(bad), Err(BeamError::MSquared(_))),
                "M² = {bad}"
            );
        }
    }

    #[test]
    fn paraxial_limit_follows_m_squared() {
        let tight = GaussianBeam::from_waist(HENE, 1.01 * 2.0 * HENE / PI).unwrap();
        assert!(tight.divergence() < 0.5, "{}", tight.divergence());
        let error = tight.with_m_squared(1.1).unwrap_err();
        let minimum = 1.1 * 2.0 * HENE / PI;
        assert!(
            matches!(error, BeamError::NotParaxial { minimum: m, .. } if (m / minimum - 1.0).abs() < 1e-12),
            "{error}"
        );
    }

    proptest! {
        #[test]
        fn no_query_yields_nan(
            wavelength in -29.0..5.0_f64,
            ratio in 0.0..20.0_f64,
            x in proptest::num::f64::NORMAL,
            y in proptest::num::f64::NORMAL,
            z in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        ) {
            let wavelength = 10_f64.powf(wavelength);
            let beam = GaussianBeam::from_waist(wavelength, wavelength * 10_f64.powf(ratio)).unwrap();
            let queries = [
                beam.radius_at(z),
                beam.curvature_at(z),
                beam.gouy_phase_at(z),
                beam.peak_irradiance_per_watt(z),
                beam.irradiance_per_watt(x, z),
                beam.encircled_power(x.abs(), z),
                beam.flux_per_watt(DVec3::new(x, y, z)).length(),
            ];
            prop_assert!(queries.iter().all(|q| !q.is_nan()), "{:?}: {:?}", beam, queries);
        }
    }
}
