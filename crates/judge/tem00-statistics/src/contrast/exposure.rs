use core::f64::consts::PI;

use tem00_numerics::{disc_overlap, quadrature::integrate};

use crate::airy_autocovariance;

/// Returns the contrast of an exposure during which the pattern changes, where `correlation(t)` is
/// the correlation of the intensities at two times that differ by the fraction t of the exposure.
///
/// ```text
/// C² = 2 ∫₀¹ (1 − t) γ(t) dt
/// ```
///
/// # Validity
///
/// The speckle is fully developed, and motion and light are steady: γ depends only on the
/// difference of the two times. The quadrature has 1024 points; for a γ that falls within much less
/// than a hundredth of the exposure use [`boiling_contrast`] or [`translation_contrast`].
///
/// # Examples
///
/// A pattern that does not change keeps its contrast:
///
/// ```
/// use tem00_statistics::laws::contrast_of_exposure;
///
/// assert!((contrast_of_exposure(|_| 1.0) - 1.0).abs() < 1e-14);
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 4 (integrated speckle).
pub fn contrast_of_exposure(correlation: impl Fn(f64) -> f64) -> f64 {
    let weighted = |t: f64| 2.0 * (1.0 - t) * correlation(t);
    integrate(weighted, [0.0, 1.0], 1.0 / 64.0).max(0.0).sqrt()
}

/// Returns the contrast of an exposure during which speckle boils: the light moves across a
/// circular pupil by `drift` diameters while the image is at rest.
///
/// ```text
/// C² = 2 ∫₀¹ (1 − t) chat(t s)² dt          s = drift, chat the overlap of two discs
/// ```
///
/// A drift of one diameter lowers the contrast to 0.656. The function is even.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::boiling_contrast;
///
/// assert!((boiling_contrast(1.0) - 0.656).abs() < 5e-4);
/// ```
pub fn boiling_contrast(drift: f64) -> f64 {
    let drift = drift.abs();
    let weighted = |t: f64| 2.0 * (1.0 - t) * disc_overlap(t * drift).powi(2);
    // The pattern is completely decorrelated after one diameter.
    let end = drift.max(1.0).recip();
    integrate(weighted, [0.0, end], 0.25 * end).sqrt()
}

/// Returns the contrast of an exposure during which the pattern moves across the image by `drift`,
/// in units of the speckle size h.
///
/// ```text
/// C² = 2 ∫₀¹ (1 − t) c(t T) dt          T = drift, c the Airy autocovariance
/// ```
///
/// A drift of one speckle size lowers the contrast to 0.846. The function is even. It is also the
/// contrast of a pixel of this length and zero width.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::translation_contrast;
///
/// assert!((translation_contrast(1.0) - 0.846).abs() < 5e-4);
/// ```
pub fn translation_contrast(drift: f64) -> f64 {
    let drift = drift.abs();
    if drift > 64.0 {
        return contrast_of_long_drift(drift);
    }
    let weighted = |t: f64| 2.0 * (1.0 - t) * airy_autocovariance(t * drift);
    integrate(weighted, [0.0, 1.0], drift.max(1.0).recip()).sqrt()
}

/// The contrast for T → ∞, from the integrals of c and r c over all r and the integral of (r − T) c
/// beyond T, where c is 4/(π⁴ r³) on average. The omitted terms oscillate and are below 10⁻⁹ of C².
fn contrast_of_long_drift(drift: f64) -> f64 {
    let inverse = drift.recip();
    let line = 16.0 / (3.0 * PI * PI);
    let correction = (2.0 - 2.0 * inverse / (PI * PI)) * inverse / (PI * PI);
    (2.0 * (line - correction)).sqrt() * inverse.sqrt()
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    #[test]
    fn boiling_has_its_known_contrasts() {
        // Three digits, from an independent quadrature.
        for (drift, contrast) in [
            (0.0, 1.0),
            (0.1, 0.958),
            (0.5, 0.804),
            (1.0, 0.656),
            (2.0, 0.494),
        ] {
            assert_absolute(boiling_contrast(drift), contrast, 5e-4);
            assert_absolute(boiling_contrast(-drift), contrast, 5e-4);
        }
        // After complete decorrelation C² is 2/s ∫ chat² − 2/s² ∫ chat² ρ dρ, where the second
        // integral is 1/8 − 2/(3π²).
        let line = integrate(|rho| disc_overlap(rho).powi(2), [0.0, 1.0], 0.1);
        let kappa = 0.125 - 2.0 / (3.0 * PI * PI);
        for drift in [1.0, 3.0, 1e8] {
            let exact = 2.0 / drift * (line - kappa / drift);
            let squared = boiling_contrast(drift).powi(2);
            // chat² bends as (1 − ρ)³ at its end.
            assert_relative(squared, exact, 1e-8);
        }
        assert!(boiling_contrast(f64::INFINITY).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn translation_is_continuous_where_the_long_form_takes_over() {
        for drift in [60.0, 63.7, 64.0] {
            let exact = translation_contrast(drift);
            assert_relative(exact, contrast_of_long_drift(drift), 1e-9);
        }
        // √(32/3π²) / √T, and the next order is 1/T.
        let far = translation_contrast(1e30) * 1e15;
        assert_relative(far, (32.0 / 3.0_f64).sqrt() / PI, 1e-14);
        assert!(translation_contrast(f64::INFINITY).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn any_correlation_gives_the_contrast_of_its_exposure() {
        // γ = exp(−at): C² = 2 (a − 1 + e⁻ᵃ) / a².
        let a = 3.0_f64;
        let exact = (2.0 * (a - 1.0 + (-a).exp())).sqrt() / a;
        assert_absolute(contrast_of_exposure(|t| (-a * t).exp()), exact, 1e-14);
        let boiling = contrast_of_exposure(|t| disc_overlap(0.7 * t).powi(2));
        assert_absolute(boiling, boiling_contrast(0.7), 1e-14);
        let moving = contrast_of_exposure(|t| airy_autocovariance(5.0 * t));
        assert_absolute(moving, translation_contrast(5.0), 1e-14);
    }

    #[test]
    fn an_exposure_is_the_mean_over_pairs_of_moments() {
        const MOMENTS: u32 = 400;
        // Each of the two midpoint rules has an error of 1/24n² of γ″ < 8.
        for (drift, law) in [(0.8, true), (1.5, false)] {
            let gamma = |t: f64| {
                if law {
                    disc_overlap(t * drift).powi(2)
                } else {
                    airy_autocovariance(t * drift)
                }
            };
            let moment = |i: u32| (f64::from(i) + 0.5) / f64::from(MOMENTS);
            let mut sum = 0.0;
            for i in 0..MOMENTS {
                for j in 0..MOMENTS {
                    sum += gamma((moment(i) - moment(j)).abs());
                }
            }
            let squared = sum / f64::from(MOMENTS).powi(2);
            let contrast = if law {
                boiling_contrast(drift)
            } else {
                translation_contrast(drift)
            };
            // The cusp of γ at t = 0 adds 1/6n² of its slope.
            assert_absolute(contrast * contrast, squared, 2e-5);
        }
    }
}
