use crate::{
    StatisticsError,
    passage::{Passage, passage},
};

/// The law of the intensity of a sum of independent speckle patterns of any mean intensities.
///
/// ```text
/// I = Σ wⱼ Iⱼ / Σ wⱼ         Iⱼ independent, exponential, of mean 1
/// C = √(Σ wⱼ²) / Σ wⱼ
/// ```
///
/// Such are several lasers on one surface, a diffuser in some positions during an exposure, or the
/// uncorrelated parts of a partially coherent field: the weights are then the eigenvalues of its
/// coherence matrix. The law is the hypoexponential distribution, scaled to mean 1. Patterns of
/// equal mean have the [`GammaIntensity`](crate::GammaIntensity) law of that many degrees of
/// freedom, two unequal ones the [`PartiallyPolarised`](crate::PartiallyPolarised) one.
///
/// # Validity
///
/// Each pattern is fully developed. Weights may be equal, nearly equal or orders of magnitude
/// apart: density and distribution are exact to 10⁻¹² of themselves on either tail. Their time
/// grows with the cube of the number of patterns: some 20 µs for ten, 10 ms for a hundred.
///
/// # Examples
///
/// A second laser of half the power:
///
/// ```
/// use tem00_statistics::WeightedSum;
///
/// let law = WeightedSum::new(&[2.0, 1.0])?;
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
pub struct WeightedSum {
    /// The weights over their sum, the largest first.
    shares: Vec<f64>,
}

/// A pattern of a smaller share changes no digit and is left out.
const NEGLIGIBLE_SHARE: f64 = 1e-30;

impl WeightedSum {
    /// Creates the law from the mean intensities of the patterns, in any unit.
    ///
    /// # Errors
    ///
    /// Returns an error if a weight is negative or not finite, or if none is positive.
    pub fn new(weights: &[f64]) -> Result<Self, StatisticsError> {
        let bad = |&weight: &f64| !(weight >= 0.0 && weight.is_finite());
        if let Some(index) = weights.iter().position(bad) {
            return Err(StatisticsError::Weight {
                index,
                value: weights[index],
            });
        }
        let largest = weights.iter().fold(0.0_f64, |a, &b| a.max(b));
        if largest <= 0.0 {
            return Err(StatisticsError::NoWeight(weights.len()));
        }
        let total: f64 = weights.iter().map(|weight| weight / largest).sum();
        let mut shares: Vec<f64> = weights
            .iter()
            .map(|weight| weight / largest / total)
            .filter(|&share| share > NEGLIGIBLE_SHARE)
            .collect();
        shares.sort_unstable_by(|a, b| b.total_cmp(a));
        Ok(Self { shares })
    }

    /// Returns the contrast, standard deviation over mean: `√(Σ w²) / Σ w`.
    pub fn contrast(&self) -> f64 {
        let squares: f64 = self.shares.iter().map(|share| share * share).sum();
        squares.sqrt()
    }

    /// Returns the probability density of the intensity, in units of the mean of the sum.
    pub fn density(&self, intensity: f64) -> f64 {
        if intensity < 0.0 || self.is_beyond(intensity) {
            return 0.0;
        }
        let last = self.shares.last().map_or(1.0, |share| share.recip());
        self.passage(intensity).last * last
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
        let passage = self.passage(intensity);
        if passage.absorbed < 0.5 {
            passage.absorbed
        } else {
            1.0 - passage.surviving
        }
    }

    fn passage(&self, intensity: f64) -> Passage {
        let rates: Vec<f64> = self.shares.iter().map(|share| share.recip()).collect();
        passage(&rates, intensity)
    }

    /// Returns whether the law is 1 to all digits: n equal patterns as strong as the strongest
    /// exceed y strongest means with a probability below (ey/n)ⁿ e⁻ʸ, less than e⁻⁷⁴⁵ from
    /// y = 4n + 1600 on.
    fn is_beyond(&self, intensity: f64) -> bool {
        let patterns = self.shares.len() as f64;
        intensity / self.shares[0] >= 4.0 * patterns + 1_600.0
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::{prelude::*, test_runner::RngSeed};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::{GammaIntensity, PartiallyPolarised, exponential_density, kolmogorov_smirnov};

    /// (density, cumulative) for weights of sum 1 that are well apart, from partial fractions.
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
        let law = WeightedSum::new(&[1.5, 3.0, 0.5, 5.0]).unwrap();
        for x in [0.2, 0.9, 2.0, 9.0] {
            let (density, cumulative) = by_partial_fractions(&shares, x);
            // The fractions cancel four digits.
            assert_relative_eq!(
                law.density(x),
                density,
                epsilon = 1e-13,
                max_relative = 1e-12
            );
            assert_relative_eq!(law.cumulative(x), cumulative, epsilon = 1e-13);
        }
        assert_relative_eq!(law.contrast(), 0.365_f64.sqrt(), max_relative = 1e-15);
    }

    #[test]
    fn equal_weights_are_the_gamma_law() {
        for count in [1_u8, 2, 7, 60] {
            let law = WeightedSum::new(&vec![1e-200; usize::from(count)]).unwrap();
            let gamma = GammaIntensity::new(f64::from(count)).unwrap();
            for x in [1e-3, 0.3, 1.0, 2.5] {
                // Relative, from 1e−180 on: n k roundings of some 1e−16, and the exponent of Γ.
                assert_relative_eq!(
                    law.density(x),
                    gamma.density(x),
                    epsilon = 0.0,
                    max_relative = 1e-12
                );
                assert_relative_eq!(law.cumulative(x), gamma.cumulative(x), epsilon = 1e-13);
            }
            assert_relative_eq!(law.contrast(), gamma.contrast(), max_relative = 1e-14);
        }
    }

    #[test]
    fn two_weights_are_the_partially_polarised_law_however_close() {
        for degree in [0.0, 1e-15, 1e-8, 1e-3, 0.4, 1.0 - 1e-6] {
            let law = WeightedSum::new(&[1.0 + degree, 1.0 - degree]).unwrap();
            let polarised = PartiallyPolarised::new(degree).unwrap();
            for x in [1e-8, 0.1, 1.0, 12.0, 300.0] {
                // At P → 1 the rounding of 1 − P is 1e−16 / 1e−6.
                assert_relative_eq!(
                    law.density(x),
                    polarised.density(x),
                    epsilon = 0.0,
                    max_relative = 1e-10
                );
                assert_relative_eq!(law.cumulative(x), polarised.cumulative(x), epsilon = 1e-14);
            }
        }
    }

    #[test]
    fn one_pattern_and_negligible_others_are_the_exponential_law() {
        let law = WeightedSum::new(&[3.0, 0.0, 1e-40]).unwrap();
        for x in [0.0, 0.5, 700.0] {
            let exact = exponential_density(x);
            assert_relative_eq!(law.density(x), exact, epsilon = 0.0, max_relative = 1e-13);
        }
        // 1e−25 of another pattern bends only the first 1e−24.
        let law = WeightedSum::new(&[1.0, 1e-25]).unwrap();
        assert_relative_eq!(law.density(0.5), (-0.5_f64).exp(), max_relative = 1e-13);
    }

    #[test]
    fn drawn_sums_follow_the_law() {
        let weights = [1.0, 0.9, 0.9, 0.2, 0.01];
        let law = WeightedSum::new(&weights).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let total: f64 = weights.iter().sum();
        let mut draw = |weight: &f64| -weight * (1.0 - rng.random::<f64>()).ln() / total;
        let samples: Vec<f64> = (0..2_000)
            .map(|_| weights.iter().map(&mut draw).sum())
            .collect();
        let outcome = kolmogorov_smirnov(&samples, |x| law.cumulative(x)).unwrap();
        // α = 0.001.
        assert!(outcome.p_value > 1e-3, "p = {}", outcome.p_value);
    }

    #[test]
    fn weights_that_are_no_intensities_are_refused() {
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let refused = WeightedSum::new(&[1.0, bad]);
            assert!(
                matches!(refused, Err(StatisticsError::Weight { index: 1, .. })),
                "{bad}"
            );
        }
        assert_eq!(WeightedSum::new(&[]), Err(StatisticsError::NoWeight(0)));
        assert_eq!(
            WeightedSum::new(&[0.0; 2]),
            Err(StatisticsError::NoWeight(2))
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 128,
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(1),
            ..ProptestConfig::default()
        })]

        #[test]
        fn law_is_finite_and_a_probability(
            exponents in proptest::collection::vec(-300.0_f64..300.0, 1..8),
            exponent in -300.0_f64..300.0,
        ) {
            let weights: Vec<f64> = exponents.iter().map(|&e| 10.0_f64.powf(e)).collect();
            let law = WeightedSum::new(&weights).unwrap();
            for x in [10.0_f64.powf(exponent), exponent.abs(), 0.0, f64::INFINITY] {
                prop_assert!(law.density(x).is_finite() && law.density(x) >= 0.0, "{x}");
                prop_assert!((0.0..=1.0).contains(&law.cumulative(x)), "{x}");
            }
        }
    }
}
