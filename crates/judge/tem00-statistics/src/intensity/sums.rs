use tem00_numerics::{check, fractions};

use crate::{
    StatisticsError,
    intensity::descent::{Factor, inverse_laplace_transform},
};

/// Distribution of the intensity of a sum of independent speckle patterns with any mean
/// intensities.
///
/// ```text
/// I = Σ wⱼ Iⱼ / Σ wⱼ         Iⱼ independent, exponential, of mean 1
/// C = √(Σ wⱼ²) / Σ wⱼ
/// ```
///
/// Examples are several lasers on one surface, a diffuser in several positions during an exposure,
/// or the uncorrelated parts of a partially coherent field, whose weights are the eigenvalues of
/// its coherence matrix. The distribution is the hypoexponential distribution, scaled to mean 1.
/// For patterns of equal mean it is [`GammaIntensity`](crate::GammaIntensity) with one degree of
/// freedom per pattern, for two unequal patterns [`PartiallyPolarised`](crate::PartiallyPolarised).
///
/// # Validity
///
/// Each pattern is fully developed. Weights may be equal, nearly equal or orders of magnitude
/// apart: density and distribution function have relative errors of 10⁻¹² on both tails for up to a
/// thousand patterns, and of 10⁻⁹ for a million. The computing time of each value is about 10 µs
/// per different weight; up to [`MAX_DIFFERENT`](Self::MAX_DIFFERENT) different weights are
/// allowed.
///
/// # Examples
///
/// Two lasers, the second with half the power of the first:
///
/// ```
/// use tem00_statistics::IncoherentSum;
///
/// let law = IncoherentSum::new(&[2.0, 1.0])?;
/// assert!((law.contrast() - 5.0_f64.sqrt() / 3.0).abs() < 1e-15);
/// // F(x) = 1 − 2 exp(−3x/2) + exp(−3x)
/// assert!((law.cumulative(1.0) - 0.603_526_748_1).abs() < 1e-10);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (sums of speckle patterns).
#[derive(Clone, Debug, PartialEq)]
pub struct IncoherentSum {
    /// The weights divided by their sum, the largest first.
    shares: Vec<Share>,
}

/// Patterns of one weight.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Share {
    /// The weight of one pattern divided by the sum of all weights.
    value: f64,
    /// The number of patterns.
    count: f64,
}

/// A pattern with a smaller fraction changes no digit and is left out.
const NEGLIGIBLE_SHARE: f64 = 1e-30;

impl IncoherentSum {
    /// The largest number of different weights: each value then takes half a second.
    pub const MAX_DIFFERENT: usize = 1 << 16;

    /// Creates the law from the mean intensities of the patterns, in any unit.
    ///
    /// # Errors
    ///
    /// Returns an error if a weight is negative or not finite, if no weight is positive, or if more
    /// than [`MAX_DIFFERENT`](Self::MAX_DIFFERENT) weights differ.
    pub fn new(weights: &[f64]) -> Result<Self, StatisticsError> {
        let mut shares = fractions("weights", weights)?;
        shares.retain(|&share| share > NEGLIGIBLE_SHARE);
        shares.sort_unstable_by(|a, b| b.total_cmp(a));
        let alike = |a: &f64, b: &f64| a.to_bits() == b.to_bits();
        let shares: Vec<Share> = shares
            .chunk_by(alike)
            .map(|group| Share {
                value: group[0],
                count: group.len() as f64,
            })
            .collect();
        let (count, allowed) = (shares.len(), "of at most 65536 different values");
        check::that(count <= Self::MAX_DIFFERENT, "weights", count, "", allowed)?;
        Ok(Self { shares })
    }

    /// Returns the contrast, standard deviation over mean: `√(Σ w²) / Σ w`.
    pub fn contrast(&self) -> f64 {
        let squares = self.shares.iter().map(|s| s.count * s.value * s.value);
        squares.sum::<f64>().sqrt()
    }

    /// Returns the probability density of the intensity, in units of the mean of the sum.
    pub fn density(&self, intensity: f64) -> f64 {
        if intensity < 0.0 || self.is_beyond(intensity) {
            return 0.0;
        }
        let factors: Vec<Factor> = self.factors().collect();
        inverse_laplace_transform(&factors, intensity)
    }

    /// Returns the probability that the intensity is at most `intensity`, in units of the mean of
    /// the sum.
    pub fn cumulative(&self, intensity: f64) -> f64 {
        if intensity <= 0.0 {
            return 0.0;
        }
        if self.is_beyond(intensity) {
            return 1.0;
        }
        // The integral of the density.
        let integral = Factor {
            pole: 0.0,
            scale: 1.0,
            count: 1.0,
        };
        let factors: Vec<Factor> = [integral].into_iter().chain(self.factors()).collect();
        // Rounding may end a unit above 1.
        inverse_laplace_transform(&factors, intensity).min(1.0)
    }

    /// The Laplace transform of the density: Π (1 + wⱼ p)⁻¹.
    fn factors(&self) -> impl Iterator<Item = Factor> {
        self.shares.iter().map(|share| Factor {
            pole: -share.value.recip(),
            scale: share.value.recip(),
            count: share.count,
        })
    }

    /// Returns whether the distribution function is 1 to all digits: n equal patterns as strong as
    /// the strongest exceed y times the strongest mean with a probability below (ey/n)ⁿ e⁻ʸ, less
    /// than e⁻⁷⁴⁵ from y = 4n + 1600 on.
    fn is_beyond(&self, intensity: f64) -> bool {
        let patterns: f64 = self.shares.iter().map(|share| share.count).sum();
        intensity / self.shares[0].value >= 4.0 * patterns + 1_600.0
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::{GammaIntensity, PartiallyPolarised, exponential_density};

    /// Density and cumulative probability for well separated weights of sum 1, from partial
    /// fractions.
    fn by_partial_fractions(shares: &[f64], x: f64) -> (f64, f64) {
        let coefficient = |j: usize| -> f64 {
            let others = shares.iter().enumerate().filter(|&(k, _)| k != j);
            others.map(|(_, w)| shares[j] / (shares[j] - w)).product()
        };
        let terms = shares.iter().enumerate().map(|(j, w)| {
            (
                coefficient(j) / w * (-x / w).exp(),
                coefficient(j) * (-x / w).exp(),
            )
        });
        terms.fold((0.0, 1.0), |(p, f), (density, tail)| {
            (p + density, f - tail)
        })
    }

    #[test]
    fn weights_far_apart_are_the_sum_of_partial_fractions() {
        let shares = [0.5, 0.3, 0.15, 0.05];
        let law = IncoherentSum::new(&[1.5, 3.0, 0.5, 5.0]).unwrap();
        for x in [0.2, 0.9, 2.0, 9.0] {
            let (density, cumulative) = by_partial_fractions(&shares, x);
            // Cancellation between the fractions costs four digits.
            assert_absolute(law.density(x), density, 1e-13 + 1e-12 * density);
            assert_absolute(law.cumulative(x), cumulative, 1e-13);
        }
        assert_relative(law.contrast(), 0.365_f64.sqrt(), 1e-15);
    }

    #[test]
    fn equal_weights_are_the_gamma_law() {
        for count in [1_u8, 2, 7, 60] {
            let law = IncoherentSum::new(&vec![1e-200; usize::from(count)]).unwrap();
            let gamma = GammaIntensity::new(f64::from(count)).unwrap();
            for x in [1e-3, 0.3, 1.0, 2.5] {
                // The relative error, from 1e−180 on, covers n k roundings of about 1e−16, and the
                // exponent of Γ.
                assert_relative(law.density(x), gamma.density(x), 1e-12);
                assert_absolute(law.cumulative(x), gamma.cumulative(x), 1e-13);
            }
            assert_relative(law.contrast(), gamma.contrast(), 1e-14);
        }
    }

    #[test]
    fn many_nearly_equal_weights_are_the_gamma_law() {
        for (count, tolerance) in [(1_000_u32, 1e-11), (5_000, 1e-10)] {
            // Weights that differ by 5e−11 change the law by less than 5e−11.
            let weights: Vec<f64> = (0..count).map(|i| 1.0 + 1e-14 * f64::from(i)).collect();
            let law = IncoherentSum::new(&weights).unwrap();
            let gamma = GammaIntensity::new(f64::from(count)).unwrap();
            for x in [0.93, 1.0, 1.04] {
                let (density, cumulative) = (gamma.density(x), gamma.cumulative(x));
                assert_relative(law.density(x), density, tolerance);
                assert_relative(law.cumulative(x), cumulative, tolerance);
            }
        }
    }

    #[test]
    fn a_million_equal_weights_are_one_factor() {
        let law = IncoherentSum::new(&vec![0.3; 1_000_000]).unwrap();
        // The density and the distribution function of the Gamma distribution, by SciPy 1.17:
        // `stats.gamma`.
        let reference = [
            (0.997, 4.405_267_011_036, 0.001_338_104_167_313_6),
            (1.0, 398.942_246_883_331_6, 0.500_132_980_760_872),
            (1.002, 54.026_860_182_309, 0.977_195_904_101_23),
        ];
        for (x, density, cumulative) in reference {
            assert_relative(law.density(x), density, 1e-9);
            assert_relative(law.cumulative(x), cumulative, 1e-9);
        }
    }

    #[test]
    fn weights_of_a_geometric_series_are_the_sum_of_partial_fractions() {
        // The coefficients stay below 12, and lose one digit.
        let weights: Vec<f64> = (0..60).map(|i| 0.5_f64.powi(i)).collect();
        let total: f64 = weights.iter().sum();
        let shares: Vec<f64> = weights.iter().map(|weight| weight / total).collect();
        let law = IncoherentSum::new(&weights).unwrap();
        for x in [0.3, 1.0, 1.7, 8.0, 40.0] {
            let (density, cumulative) = by_partial_fractions(&shares, x);
            assert_relative(law.density(x), density, 1e-12);
            assert_absolute(law.cumulative(x), cumulative, 1e-13);
        }
    }

    #[test]
    fn two_weights_are_the_partially_polarised_law_however_close() {
        for degree in [0.0, 1e-15, 1e-8, 1e-3, 0.4, 1.0 - 1e-6] {
            let law = IncoherentSum::new(&[1.0 + degree, 1.0 - degree]).unwrap();
            let polarised = PartiallyPolarised::new(degree).unwrap();
            for x in [1e-8, 0.1, 1.0, 12.0, 300.0] {
                // At P → 1 the rounding of 1 − P is 1e−16 / 1e−6.
                assert_relative(law.density(x), polarised.density(x), 1e-10);
                assert_absolute(law.cumulative(x), polarised.cumulative(x), 1e-14);
            }
        }
    }

    #[test]
    fn one_pattern_and_negligible_others_are_the_exponential_law() {
        let law = IncoherentSum::new(&[3.0, 0.0, 1e-40]).unwrap();
        for x in [0.0, 0.5, 700.0] {
            let exact = exponential_density(x);
            assert_relative(law.density(x), exact, 1e-13);
        }
        // A second pattern of the fraction 1e−25 changes only the first 1e−24.
        let law = IncoherentSum::new(&[1.0, 1e-25]).unwrap();
        assert_relative(law.density(0.5), (-0.5_f64).exp(), 1e-13);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn law_is_finite_and_a_probability(
            exponents in proptest::collection::vec(-300.0_f64..300.0, 1..8),
            exponent in -300.0_f64..300.0,
        ) {
            let weights: Vec<f64> = exponents.iter().map(|&e| 10.0_f64.powf(e)).collect();
            let law = IncoherentSum::new(&weights).unwrap();
            for x in [10.0_f64.powf(exponent), exponent.abs(), 0.0, f64::INFINITY] {
                prop_assert!(law.density(x).is_finite() && law.density(x) >= 0.0, "{x}");
                prop_assert!((0.0..=1.0).contains(&law.cumulative(x)), "{x}");
            }
        }
    }
}
