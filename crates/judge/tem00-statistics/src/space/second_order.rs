use core::f64::consts::PI;

use tem00_numerics::{disc_overlap, jinc};

/// The lag at which the [`airy_autocovariance`] first vanishes, in units of the speckle size h.
///
/// It is the first zero 3.8317 of J₁ divided by π.
pub const AIRY_FIRST_ZERO: f64 = 1.219_669_891_266_504_5;

/// The lag at which the [`airy_autocovariance`] has fallen to one half, in units of h.
///
/// It is the half width at half maximum; the full width is 1.029 h.
pub const AIRY_HALF_WIDTH: f64 = 0.514_496_984_981_094;

/// The integral of the [`airy_autocovariance`] over the plane, in units of h²: the area of the
/// average speckle.
///
/// The mean intensity of a pattern of area A fluctuates like the mean of πA / 4h² independent
/// points.
pub const COHERENCE_AREA: f64 = 4.0 / PI;

/// Returns the normalised autocovariance of speckle behind a circular pupil, at a `lag` in units of
/// the speckle size h.
///
/// ```text
/// c(r) = ⟨ΔI(0) ΔI(r)⟩ / ⟨ΔI²⟩ = [2 J₁(πr/h) / (πr/h)]²
/// h    = λ d / D                  wavelength, distance from pupil to image, pupil diameter
/// ```
///
/// It is the intensity pattern of a point imaged by the same pupil. The function is even, and 0 at
/// infinity.
///
/// # Examples
///
/// ```
/// use tem00_statistics::{airy_autocovariance, laws::{AIRY_FIRST_ZERO, AIRY_HALF_WIDTH}};
///
/// assert!((airy_autocovariance(AIRY_HALF_WIDTH) - 0.5).abs() < 1e-12);
/// assert!(airy_autocovariance(AIRY_FIRST_ZERO) < 1e-30);
/// ```
///
/// # References
///
/// - J. W. Goodman, *Statistical properties of laser speckle patterns*, 1975, §2.4.
pub fn airy_autocovariance(lag: f64) -> f64 {
    jinc(PI * lag).powi(2)
}

/// Returns the power spectrum of speckle behind a circular pupil, at a `frequency` in cycles per
/// speckle size h.
///
/// ```text
/// S(f) = (4/π) chat(f h)        h² per unit variance of the intensity
/// ```
///
/// It is the Fourier transform of the [`airy_autocovariance`]: its integral over the frequency
/// plane is 1 and its value at zero the [`COHERENCE_AREA`]. It vanishes beyond one cycle per h, so
/// that two samples per speckle size capture the intensity completely. The mean intensity, a delta
/// peak at zero frequency, is not included.
pub fn airy_power_spectrum(frequency: f64) -> f64 {
    COHERENCE_AREA * disc_overlap(frequency)
}

/// Returns the standard deviation of the squared contrast of one finite pattern, from pattern to
/// pattern, where the pattern is `speckles_across` speckle sizes wide and high.
///
/// ```text
/// std(C²) = (8/π) √(2πκ) / n,    κ = ∫₀¹ chat(ρ)² ρ dρ = 1/8 − 2/(3π²)
///         = 1.530 / n            and std(C) = 0.765 / n
/// ```
///
/// A pattern computed from a pupil C lattice points across is n = C speckle sizes wide, for any
/// number of samples. For an image of area A, `n = √A / h`.
///
/// # Validity
///
/// The speckle is fully developed behind a circular pupil, and the result is of first order in 1/n.
/// It does not matter whether the mean over the pattern is fixed or fluctuates.
///
/// # Panics
///
/// Panics unless `speckles_across > 0`.
pub fn contrast_squared_spread(speckles_across: f64) -> f64 {
    assert!(
        speckles_across > 0.0,
        "a pattern {speckles_across} speckles across has no contrast"
    );
    2.0 * squared_airy_area().sqrt() / speckles_across
}

/// Returns ∫ c(r)² d²r = (32/π) κ in units of h²: the area of one independent sample of the
/// contrast.
///
/// The influence of one intensity on the contrast is the Laguerre polynomial 1 − 2I + I²/2, and the
/// covariance of two such values is the square of the autocovariance.
fn squared_airy_area() -> f64 {
    let kappa = 1.0 / 8.0 - 2.0 / (3.0 * PI * PI);
    32.0 / PI * kappa
}

/// Returns the number of pixels per independent sample of the contrast, for speckles of
/// `speckle_size` pixels: the sum of the squared Airy autocovariance over all pixels.
pub(crate) fn pixels_per_contrast_sample(speckle_size: f64) -> f64 {
    // c² has no frequencies beyond 2/h: the sum over a lattice finer than h/2 is the integral.
    if speckle_size >= 2.0 {
        return squared_airy_area() * speckle_size * speckle_size;
    }
    // c² falls as (r/h)⁻⁶: the part beyond 12 pixels adds 1e−5 at h = 2 and less below.
    let weight = |x: i32, y: i32| {
        let lag = f64::from(x).hypot(f64::from(y));
        airy_autocovariance(lag / speckle_size).powi(2)
    };
    (-12..=12)
        .flat_map(|y| (-12..=12).map(move |x| weight(x, y)))
        .sum()
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    /// ∫ f(r) 2πr dr over [0, `end`] by the midpoint rule.
    fn integral_over_plane(f: impl Fn(f64) -> f64, end: f64, steps: u32) -> f64 {
        let h = end / f64::from(steps);
        let radius = |i| (f64::from(i) + 0.5) * h;
        (0..steps)
            .map(|i| f(radius(i)) * 2.0 * PI * radius(i))
            .sum::<f64>()
            * h
    }

    #[test]
    fn airy_autocovariance_has_its_known_values() {
        // Summed from the power series of J₁ with 50 digits.
        let table = [
            (0.0, 1.0),
            (0.25, 0.855_347_958_844_704_5),
            (0.5, 0.520_854_996_341_716_3),
            (1.0, 0.032_830_452_075_419_52),
            (1.5, 0.014_289_651_218_299_62),
            (2.0, 0.004_570_227_665_524_384),
        ];
        for (lag, value) in table {
            assert_absolute(airy_autocovariance(lag), value, 1e-15);
            assert_absolute(airy_autocovariance(-lag), value, 1e-15);
        }
        assert!(airy_autocovariance(f64::INFINITY).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn half_width_and_first_zero_are_where_they_are_said_to_be() {
        assert_absolute(airy_autocovariance(AIRY_HALF_WIDTH), 0.5, 1e-14);
        assert!(airy_autocovariance(AIRY_FIRST_ZERO) < 1e-30, "no zero");
    }

    #[test]
    fn spectrum_and_autocovariance_are_a_fourier_pair() {
        for lag in [0.0, 0.25, AIRY_HALF_WIDTH, 1.0, 1.7] {
            // The Hankel transform of the spectrum; chat bends by −(4/π)(1−ρ²)^(½) only, and the
            // midpoint rule has an error of h² = 2.5e−9 times the slope 4/π at the origin.
            let transform = integral_over_plane(
                |f| airy_power_spectrum(f) * libm::j0(2.0 * PI * f * lag),
                1.0,
                20_000,
            );
            assert_absolute(transform, airy_autocovariance(lag), 1e-8);
        }
        assert!(airy_power_spectrum(1.0).abs() < f64::MIN_POSITIVE);
        assert_absolute(airy_power_spectrum(0.0), COHERENCE_AREA, 1e-15);
    }

    #[test]
    fn coherence_area_is_the_integral_of_the_autocovariance() {
        // c falls as 4/(π⁴ r³) on average, which gives 8/(π³ R) = 8.6e−4 beyond R = 300, plus an
        // oscillation of 4/(π⁴ R²) = 5e−7. The midpoint rule adds 2π h²/24 = 3e−7.
        let end = 300.0;
        let tail = 8.0 / (PI.powi(3) * end);
        let area = integral_over_plane(airy_autocovariance, end, 300_000) + tail;
        assert_absolute(area, COHERENCE_AREA, 1e-6);
    }

    #[test]
    fn contrast_sample_is_the_squared_autocovariance_summed_over_pixels() {
        // c² falls as r⁻⁶: 6e−8 lies beyond r = 10.
        let area = integral_over_plane(|r| airy_autocovariance(r).powi(2), 10.0, 20_000);
        assert_absolute(squared_airy_area(), area, 1e-6);
        // Compares both branches at the switch.
        assert_relative(
            pixels_per_contrast_sample(2.0 - 1e-12),
            pixels_per_contrast_sample(2.0),
            2e-5,
        );
        assert_absolute(pixels_per_contrast_sample(1e-3), 1.0, 1e-6);
    }

    #[test]
    fn spread_of_the_squared_contrast_is_1_530_over_the_width() {
        // κ = 0.0574525 by quadrature of chat².
        let kappa = integral_over_plane(|r| disc_overlap(r).powi(2), 1.0, 20_000) / (2.0 * PI);
        assert_absolute(kappa, 0.057_452_5, 1e-7);
        let spread = 8.0 / PI * (2.0 * PI * kappa).sqrt() / 64.0;
        assert_relative(contrast_squared_spread(64.0), spread, 1e-7);
        assert_absolute(contrast_squared_spread(1.0), 1.530, 5e-4);
    }
}
