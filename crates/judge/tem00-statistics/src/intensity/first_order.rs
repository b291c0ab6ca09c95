use core::f64::consts::TAU;

use statrs::function::gamma::{gamma_lr, ln_gamma};
use tem00_numerics::check;

use crate::StatisticsError;

/// Returns the probability density of the intensity of fully developed speckle.
///
/// ```text
/// p(I) = exp(−I)    I ≥ 0, in units of the mean intensity
/// ```
///
/// The field is a sum of many phasors of random phase, a circular complex Gaussian, and its squared
/// magnitude has this negative exponential distribution: mean 1, contrast 1, most probable value 0.
///
/// # References
///
/// - J. W. Goodman, *Statistical properties of laser speckle patterns*, in *Laser Speckle and
///   Related Phenomena*, ed. J. C. Dainty, 1975, §2.3.
pub fn exponential_density(intensity: f64) -> f64 {
    if intensity < 0.0 {
        0.0
    } else {
        (-intensity).exp()
    }
}

/// Returns the probability that the intensity of fully developed speckle is at most `intensity`.
///
/// ```text
/// F(I) = 1 − exp(−I)    I ≥ 0, in units of the mean intensity
/// ```
///
/// # Examples
///
/// A point of a speckle pattern is darker than the mean with the probability 1 − 1/e:
///
/// ```
/// use tem00_statistics::exponential_cumulative;
///
/// assert!((exponential_cumulative(1.0) - 0.632_120_558_828_558).abs() < 1e-15);
/// ```
pub fn exponential_cumulative(intensity: f64) -> f64 {
    if intensity < 0.0 {
        0.0
    } else {
        -(-intensity).exp_m1()
    }
}

/// Distribution of the intensity of averaged speckle: a Gamma distribution with mean 1.
///
/// ```text
/// p(I) = Mᴹ Iᴹ⁻¹ exp(−M I) / Γ(M)      contrast C = 1 / √M
/// ```
///
/// The shape M is the number of degrees of freedom. M = 1 is the exponential distribution.
///
/// # Validity
///
/// The distribution is exact for the sum of M independent speckle patterns of equal mean. For
/// speckle averaged over a pixel or an exposure it is the customary approximation with the correct
/// mean and contrast: for a square pixel of one speckle size the distribution functions differ by
/// up to 0.04.
///
/// # Examples
///
/// Four independent patterns halve the contrast:
///
/// ```
/// use tem00_statistics::GammaIntensity;
///
/// let law = GammaIntensity::new(4.0)?;
/// assert_eq!(law.contrast(), 0.5);
/// // 1 − e⁻⁴ (1 + 4 + 8 + 32/3) of the points are darker than the mean.
/// assert!((law.cumulative(1.0) - 0.566_529_879_633_291).abs() < 1e-14);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GammaIntensity {
    shape: f64,
}

/// The largest shape: for larger ones the rounding of `M ln M` would affect the ninth digit of the
/// law.
const MAXIMUM_SHAPE: f64 = 1e6;

/// The contrast of the largest shape.
const MINIMUM_CONTRAST: f64 = 1e-3;

impl GammaIntensity {
    /// Creates the law from its shape M, the number of degrees of freedom.
    ///
    /// # Errors
    ///
    /// Returns an error unless `1 ≤ shape ≤ 10⁶`. Averaging never removes a degree of freedom.
    pub fn new(shape: f64) -> Result<Self, StatisticsError> {
        let holds = (1.0..=MAXIMUM_SHAPE).contains(&shape);
        check::that(holds, "shape", shape, "", "from 1 to 1e6")?;
        Ok(Self { shape })
    }

    /// Creates the law with the contrast C: M = 1 / C².
    ///
    /// # Errors
    ///
    /// Returns an error unless `0.001 ≤ contrast ≤ 1`.
    pub fn from_contrast(contrast: f64) -> Result<Self, StatisticsError> {
        let contrast = check::range("contrast", contrast, [MINIMUM_CONTRAST, 1.0], "")?;
        let shape = (contrast * contrast).recip();
        Ok(Self { shape })
    }

    /// Returns the shape M, the number of degrees of freedom.
    pub const fn shape(&self) -> f64 {
        self.shape
    }

    /// Returns the contrast, standard deviation over mean: `1 / √M`.
    pub fn contrast(&self) -> f64 {
        self.shape.sqrt().recip()
    }

    /// Returns the probability density of the intensity, in units of the mean intensity.
    pub fn density(&self, intensity: f64) -> f64 {
        let m = self.shape;
        if intensity < 0.0 || intensity.is_infinite() {
            return 0.0;
        }
        if intensity == 0.0 {
            return if m > 1.0 { 0.0 } else { 1.0 };
        }
        let excess = intensity.ln() - (intensity - 1.0);
        peak_density(m) * (m * excess - intensity.ln()).exp()
    }

    /// Returns the probability that the intensity is at most `intensity`, in units of the mean.
    pub fn cumulative(&self, intensity: f64) -> f64 {
        let x = self.shape * intensity;
        if x <= 0.0 {
            0.0
        } else if x.is_infinite() {
            1.0
        } else {
            gamma_lr(self.shape, x)
        }
    }
}

/// Returns the density at the mean, Mᴹ e⁻ᴹ / Γ(M).
fn peak_density(m: f64) -> f64 {
    if m < STIRLING_LIMIT {
        return (m * m.ln() - m - ln_gamma(m)).exp();
    }
    // Stirling's series of ln Γ, without the large terms that cancel.
    let m2 = m * m;
    let series = (1.0 - (1.0 - 2.0 / (7.0 * m2)) / (30.0 * m2)) / (12.0 * m);
    (m / TAU).sqrt() * (-series).exp()
}

/// Shape from which Stirling's series is exact: its next term is 1 / (1680 M⁷) = 3e−14.
const STIRLING_LIMIT: f64 = 30.0;

/// Returns the contrast of the intensity of a sum of `count` phasors of equal length and random
/// phase.
///
/// ```text
/// C = √(1 − 1/N)
/// ```
///
/// A single phasor has no contrast; from about fifty phasors on speckle counts as fully developed.
/// A pattern computed from N unit phasors in the pupil has the same contrast, in the ensemble and
/// on average over the tile.
///
/// # Panics
///
/// Panics unless `count > 0`.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::contrast_of_phasor_sum;
///
/// assert_eq!(contrast_of_phasor_sum(1), 0.0);
/// assert!((contrast_of_phasor_sum(812) - 0.999_384).abs() < 1e-6);
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3.
pub fn contrast_of_phasor_sum(count: usize) -> f64 {
    assert!(count > 0, "a sum of no phasors has no contrast");
    ((count - 1) as f64 / count as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    /// ∫ f over [0, `end`] by the midpoint rule.
    fn integral(f: impl Fn(f64) -> f64, end: f64) -> f64 {
        const STEPS: u32 = 200_000;
        let h = end / f64::from(STEPS);
        (0..STEPS).map(|i| f((f64::from(i) + 0.5) * h)).sum::<f64>() * h
    }

    #[test]
    fn exponential_density_is_the_slope_of_its_distribution() {
        for intensity in [0.3, 1.0, 4.0] {
            // The midpoint rule has an error of h² f″ / 24 · length < 4 (4 / 2e5)² / 24 = 7e−11.
            let area = integral(exponential_density, intensity);
            assert_absolute(area, exponential_cumulative(intensity), 1e-10);
        }
        assert!(exponential_cumulative(-1.0).abs() < f64::MIN_POSITIVE);
        assert!(exponential_density(-1.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn gamma_density_has_mean_one_and_the_stated_contrast() {
        for shape in [1.0, 1.977, 4.0, 29.9, 30.1, 2_500.0] {
            let law = GammaIntensity::new(shape).unwrap();
            // The probability beyond 1 + 10/√M + 40/M is exp(−40) or less.
            let end = 1.0 + 10.0 / shape.sqrt() + 40.0 / shape;
            let moment = |k: i32| integral(|x| law.density(x) * x.powi(k), end);
            // M = 1.977 starts like a root, where the midpoint rule has an error of h^1.98 = 1e−7.
            assert_absolute(moment(0), 1.0, 1e-7);
            assert_absolute(moment(1), 1.0, 1e-7);
            let contrast = (moment(2) - 1.0).sqrt();
            assert_absolute(contrast, law.contrast(), 2e-6);
        }
    }

    #[test]
    fn gamma_distribution_is_the_closed_form_at_integer_shape() {
        for shape in [1_u32, 2, 3, 7] {
            let law = GammaIntensity::new(f64::from(shape)).unwrap();
            for intensity in [0.1, 0.9, 1.0, 2.5, 6.0] {
                let x = f64::from(shape) * intensity;
                // F = 1 − exp(−x) Σ xᵏ / k!, k < M.
                let terms = (1..shape).scan(1.0, |term, k| {
                    *term *= x / f64::from(k);
                    Some(*term)
                });
                let closed = 1.0 - (-x).exp() * (1.0 + terms.sum::<f64>());
                assert_absolute(law.cumulative(intensity), closed, 1e-13);
            }
        }
    }

    #[test]
    fn gamma_density_is_continuous_where_the_series_takes_over() {
        let (below, above) = (peak_density(29.999_999_97), peak_density(30.000_000_03));
        // The density at the mean grows by (1 / 2M + 1 / 12M²) dM. Before the switch ln Γ cancels
        // two numbers near 100, which leaves 100 · 2⁻⁵³ · some.
        let growth = 6e-8 * (1.0 / 60.0 + 1.0 / 10_800.0);
        assert_absolute(above / below, 1.0 + growth, 1e-12);
    }

    #[test]
    fn shape_one_is_the_exponential_law() {
        let law = GammaIntensity::from_contrast(1.0).unwrap();
        for intensity in [0.0, 1e-9, 0.5, 1.0, 30.0] {
            assert_relative(
                law.density(intensity),
                exponential_density(intensity),
                1e-13,
            );
            assert_relative(
                law.cumulative(intensity),
                exponential_cumulative(intensity),
                1e-13,
            );
        }
    }

    proptest! {
        #[test]
        fn gamma_law_is_finite_and_a_probability(
            shape in 1.0_f64..1e6,
            intensity in 0.0_f64..f64::MAX,
        ) {
            let law = GammaIntensity::new(shape).unwrap();
            for x in [intensity, intensity.ln().abs(), intensity.recip(), 0.0, f64::INFINITY] {
                prop_assert!(law.density(x).is_finite() && law.density(x) >= 0.0, "{x}");
                prop_assert!((0.0..=1.0).contains(&law.cumulative(x)), "{x}");
            }
        }
    }
}
