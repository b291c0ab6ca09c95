use core::f64::consts::PI;

use statrs::function::{beta::beta_reg, gamma::gamma_ur};

use crate::{
    StatisticsError,
    moments::{Scaled, check_finite},
};

/// What a test of a hypothesis found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestOutcome {
    /// The test's statistic: the larger, the further from the hypothesis.
    pub statistic: f64,
    /// The probability of a statistic at least as far from the hypothesis, were the hypothesis
    /// true. It is then uniform in [0, 1].
    pub p_value: f64,
}

/// Tests whether `samples` follow the continuous distribution whose distribution function is
/// `cumulative`, after Kolmogorov and Smirnov.
///
/// ```text
/// D = max |Fₙ(x) − F(x)|                                        the statistic
/// p = Q((√n + 0.12 + 0.11/√n) D),   Q(λ) = 2 Σₖ (−1)ᵏ⁻¹ exp(−2k²λ²)
/// ```
///
/// # Independence
///
/// The samples are independent and the distribution was fixed beforehand, not fitted to them.
/// Neighbouring pixels of a speckle pattern share a speckle: on all pixels the test rejects a
/// third of all correct patterns at the 5 % level. Take
/// [`decorrelated_samples`](crate::decorrelated_samples).
///
/// # Validity
///
/// The p-value is that of many samples with Stephens' correction for few. Where it is 0.01 the true
/// one is smaller by the share 0.12 for five samples, 0.04 for ten and 0.01 for twenty: with few
/// samples the test errs on the side of the hypothesis.
///
/// # Errors
///
/// Returns an error if there is no sample, one is not finite, or `cumulative` returns a value
/// outside [0, 1].
///
/// # Examples
///
/// ```
/// use tem00_statistics::{exponential_cumulative, kolmogorov_smirnov};
///
/// let samples: Vec<f64> = (1..=99).map(|i| -(f64::from(i) / 100.0).ln()).collect();
/// let outcome = kolmogorov_smirnov(&samples, exponential_cumulative)?;
/// assert!(outcome.p_value > 0.999);
///
/// let halved: Vec<f64> = samples.iter().map(|intensity| 0.5 * intensity).collect();
/// let outcome = kolmogorov_smirnov(&halved, exponential_cumulative)?;
/// assert!(outcome.p_value < 1e-4);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - N. Smirnov, *Table for estimating the goodness of fit of empirical distributions*, 1948.
/// - M. A. Stephens, *Use of the Kolmogorov–Smirnov, Cramér–von Mises and related statistics
///   without extensive tables*, 1970.
pub fn kolmogorov_smirnov<T>(
    samples: &[T],
    cumulative: impl Fn(f64) -> f64,
) -> Result<TestOutcome, StatisticsError>
where
    T: Copy + Into<f64>,
{
    if samples.is_empty() {
        return Err(StatisticsError::Samples {
            given: 0,
            needed: 1,
        });
    }
    check_finite(samples)?;
    let mut sorted: Vec<f64> = samples.iter().map(|&x| x.into()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let distance = largest_distance(&sorted, cumulative)?;
    let root = (sorted.len() as f64).sqrt();
    Ok(TestOutcome {
        statistic: distance,
        p_value: kolmogorov_survival((root + 0.12 + 0.11 / root) * distance),
    })
}

/// Returns the largest distance between the empirical distribution of `sorted` and `cumulative`.
fn largest_distance(
    sorted: &[f64],
    cumulative: impl Fn(f64) -> f64,
) -> Result<f64, StatisticsError> {
    let count = sorted.len() as f64;
    let mut distance = 0.0_f64;
    for (index, &sample) in sorted.iter().enumerate() {
        let value = cumulative(sample);
        if !(0.0..=1.0).contains(&value) {
            return Err(StatisticsError::Probability { sample, value });
        }
        // The empirical distribution jumps from one to the other at the sample.
        let (below, above) = (index as f64 / count, (index + 1) as f64 / count);
        distance = distance.max(value - below).max(above - value);
    }
    Ok(distance)
}

/// Returns the probability Q(λ) that √n times the distance exceeds λ, for n → ∞.
fn kolmogorov_survival(lambda: f64) -> f64 {
    // Both series are exact; their first four terms are, on either side, to 1e−17.
    if lambda < 1.0 {
        let term = |k: f64| (-(k * PI).powi(2) / (8.0 * lambda * lambda)).exp();
        let sum = term(1.0) + term(3.0) + term(5.0) + term(7.0);
        let below = (2.0 * PI).sqrt() / lambda.max(f64::MIN_POSITIVE) * sum;
        return 1.0 - below;
    }
    let term = |k: f64| (-2.0 * (k * lambda).powi(2)).exp();
    2.0 * (term(1.0) - term(2.0) + term(3.0) - term(4.0))
}

/// Tests whether counts `observed` in bins agree with the `expected` ones, after Pearson.
///
/// ```text
/// χ² = Σ (O − E)² / E                 the statistic, over the merged bins
/// degrees of freedom = bins − constraints
/// ```
///
/// Bins are merged from the first to the last until each expects five counts or more; what is left
/// over joins the last. `constraints` counts what the expected values were fitted to: 1 where they
/// were scaled to the observed total (the usual case) and 1 more for each fitted parameter; 0 where
/// the total was left free.
///
/// # Independence
///
/// The counted events are independent: for pixels of a speckle pattern take
/// [`decorrelated_samples`](crate::decorrelated_samples).
///
/// # Validity
///
/// The p-value takes χ² to have the law that it reaches for many counts per bin; five expected
/// counts are the customary least.
///
/// # Errors
///
/// Returns an error if the slices differ in length, an expected count is negative or not finite, or
/// the merged bins do not outnumber the constraints.
///
/// # Examples
///
/// Of 120 throws of a die:
///
/// ```
/// use tem00_statistics::chi_squared;
///
/// let outcome = chi_squared(&[15, 29, 14, 18, 20, 24], &[20.0; 6], 1)?;
/// assert!((outcome.statistic - 8.1).abs() < 1e-12);
/// assert!((outcome.p_value - 0.151).abs() < 1e-3);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
pub fn chi_squared(
    observed: &[u64],
    expected: &[f64],
    constraints: usize,
) -> Result<TestOutcome, StatisticsError> {
    let bins = merge_sparse_bins(observed, expected)?;
    if bins.len() <= constraints {
        return Err(StatisticsError::DegreesOfFreedom {
            bins: bins.len(),
            constraints,
        });
    }
    let contribution = |&(o, e): &(f64, f64)| (o - e) / e * (o - e);
    let statistic: f64 = bins.iter().map(contribution).sum();
    let freedom = (bins.len() - constraints) as f64;
    let p_value = if statistic <= 0.0 {
        1.0
    } else if statistic.is_infinite() {
        0.0
    } else {
        gamma_ur(0.5 * freedom, 0.5 * statistic)
    };
    Ok(TestOutcome { statistic, p_value })
}

/// The customary least for which χ² nearly has its limiting law.
const FEWEST_EXPECTED: f64 = 5.0;

fn merge_sparse_bins(
    observed: &[u64],
    expected: &[f64],
) -> Result<Vec<(f64, f64)>, StatisticsError> {
    if observed.len() != expected.len() {
        return Err(StatisticsError::Bins {
            observed: observed.len(),
            expected: expected.len(),
        });
    }
    let bad = |&(_, value): &(usize, &f64)| !(value.is_finite() && *value >= 0.0);
    if let Some((index, &value)) = expected.iter().enumerate().find(bad) {
        return Err(StatisticsError::ExpectedCount { index, value });
    }
    let mut bins = Vec::new();
    let mut open = (0.0, 0.0);
    for (&o, &e) in observed.iter().zip(expected) {
        open = (open.0 + o as f64, open.1 + e);
        if open.1 >= FEWEST_EXPECTED {
            bins.push(open);
            open = (0.0, 0.0);
        }
    }
    if let Some(last) = bins.last_mut() {
        *last = (last.0 + open.0, last.1 + open.1);
    }
    Ok(bins)
}

/// Tests whether the expectation of `samples` is `mean`, after Student; two-sided.
///
/// ```text
/// t = |m − mean| / (s / √n)           the statistic, with n − 1 degrees of freedom
/// ```
///
/// # Independence
///
/// The samples are independent, for example one per seed.
///
/// # Validity
///
/// Exact for normal samples, and good for others once their mean is nearly normal: for exponential
/// ones from a hundred on.
///
/// # Errors
///
/// Returns an error if there are fewer than two samples, one is not finite or all are the same, or
/// if `mean` is not finite.
///
/// # Examples
///
/// ```
/// use tem00_statistics::t_test_mean;
///
/// let powers = [0.98, 1.03, 1.01, 0.97, 1.00];
/// assert!(t_test_mean(&powers, 1.0)?.p_value > 0.8);
/// assert!(t_test_mean(&powers, 1.1)?.p_value < 0.001);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - Student, *The probable error of a mean*, Biometrika 6, 1908.
pub fn t_test_mean<T>(samples: &[T], mean: f64) -> Result<TestOutcome, StatisticsError>
where
    T: Copy + Into<f64>,
{
    if !mean.is_finite() {
        return Err(StatisticsError::TestedMean(mean));
    }
    let scaled = Scaled::new(samples)?;
    scaled.check_varies()?;
    let count = samples.len() as f64;
    let standard_error = scaled.standard_deviation / count.sqrt();
    let statistic = ((scaled.mean - mean / scaled.unit) / standard_error).abs();
    let freedom = count - 1.0;
    // P(|T| > t) = I_x(ν/2, 1/2) with x = ν / (ν + t²).
    let x = (1.0 + statistic * statistic / freedom).recip();
    Ok(TestOutcome {
        statistic,
        p_value: beta_reg(0.5 * freedom, 0.5, x),
    })
}

#[cfg(test)]
mod tests {
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::{
        GammaIntensity, decorrelated_samples, exponential_cumulative, synthetic::speckle_tile,
    };

    const ROUNDS: u32 = 2_000;

    /// Asserts that the p-values of a true hypothesis are uniform, by their counts in ten bins.
    fn assert_uniform(p_value: impl FnMut(u32) -> f64) {
        let mut p_values: Vec<f64> = (0..ROUNDS).map(p_value).collect();
        p_values.sort_unstable_by(f64::total_cmp);
        let below = |tenth: u32| {
            let limit = f64::from(tenth) / 10.0;
            p_values.partition_point(|&p| p < limit) as f64
        };
        let expected = f64::from(ROUNDS) / 10.0;
        let contribution = |tenth| {
            let count = if tenth == 9 {
                f64::from(ROUNDS) - below(9)
            } else {
                below(tenth + 1) - below(tenth)
            };
            (count - expected) * (count - expected) / expected
        };
        let distance: f64 = (0..10).map(contribution).sum();
        // Nine degrees of freedom exceed 27.877 with the probability 0.001 (Abramowitz & Stegun
        // 1964, table 26.8).
        assert!(distance < 27.877, "not uniform: χ² = {distance}");
    }

    fn exponential(rng: &mut ChaCha8Rng) -> f64 {
        -(1.0 - rng.random::<f64>()).ln()
    }

    /// A normal deviate after Box and Muller.
    fn normal(rng: &mut ChaCha8Rng) -> f64 {
        (2.0 * exponential(rng)).sqrt() * (2.0 * PI * rng.random::<f64>()).cos()
    }

    /// Samples of a uniform law whose empirical distribution is `distance` away from it.
    fn samples_at_distance(count: u32, distance: f64) -> Vec<f64> {
        let shifted = |i| (f64::from(i) / f64::from(count) + distance).min(1.0);
        (0..count).map(shifted).collect()
    }

    #[test]
    fn kolmogorov_distribution_has_the_tabulated_critical_values() {
        // Smirnov 1948, to the digits of the table: a step of 5e−5 in λ changes p by 4λ · 5e−5.
        for (lambda, p) in [(1.3581, 0.05), (1.6276, 0.01), (1.9495, 0.001)] {
            assert_relative_eq!(
                kolmogorov_survival(lambda),
                p,
                max_relative = 4.0 * lambda * 5e-5
            );
        }
        // The median, where the other series is summed.
        assert_relative_eq!(kolmogorov_survival(0.827_57), 0.5, epsilon = 1e-5);
        let (below, above) = (1.0 - 1e-12, 1.0);
        assert_relative_eq!(
            kolmogorov_survival(below),
            kolmogorov_survival(above),
            epsilon = 1e-11
        );
        assert_relative_eq!(kolmogorov_survival(0.0), 1.0, epsilon = 1e-15);
    }

    #[test]
    fn kolmogorov_smirnov_is_close_to_the_exact_table_for_few_samples() {
        // Count, critical distance (Miller 1956), exact p, accuracy stated in the documentation.
        let table = [
            (5, 0.563_28, 0.05, 0.03),
            (5, 0.668_53, 0.01, 0.14),
            (10, 0.409_25, 0.05, 0.02),
            (10, 0.488_93, 0.01, 0.05),
            (20, 0.294_08, 0.05, 0.015),
            (20, 0.352_41, 0.01, 0.015),
            (100, 0.134_03, 0.05, 0.015),
            (100, 0.160_81, 0.01, 0.015),
        ];
        for (count, distance, p, tolerance) in table {
            let samples = samples_at_distance(count, distance);
            let outcome = kolmogorov_smirnov(&samples, |x| x).unwrap();
            assert_relative_eq!(outcome.statistic, distance, epsilon = 1e-14);
            assert_relative_eq!(outcome.p_value, p, max_relative = tolerance);
        }
    }

    #[test]
    fn both_sides_of_a_step_count() {
        // One sample at 0.2: the empirical distribution jumps from 0 to 1 there.
        let outcome = kolmogorov_smirnov(&[0.2], |x| x).unwrap();
        assert_relative_eq!(outcome.statistic, 0.8, epsilon = 1e-15);
        let outcome = kolmogorov_smirnov(&[0.9], |x| x).unwrap();
        assert_relative_eq!(outcome.statistic, 0.9, epsilon = 1e-15);
    }

    #[test]
    fn p_values_of_kolmogorov_and_smirnov_are_uniform() {
        let mut rng = ChaCha8Rng::seed_from_u64(21);
        assert_uniform(|_| {
            let samples: Vec<f64> = (0..100).map(|_| exponential(&mut rng)).collect();
            let outcome = kolmogorov_smirnov(&samples, exponential_cumulative).unwrap();
            outcome.p_value
        });
    }

    #[test]
    fn p_values_of_pearson_are_uniform() {
        let mut rng = ChaCha8Rng::seed_from_u64(22);
        // Three bins expect too little: 2 merge with 3, and 4 at the end joins 50.
        let expected = [2.0, 3.0, 100.0, 61.0, 80.0, 50.0, 4.0];
        assert_uniform(|_| {
            let mut observed = [0; 7];
            for _ in 0..300 {
                let mut left = 300.0 * rng.random::<f64>();
                let crossed = |e: &f64| {
                    left -= e;
                    left < 0.0
                };
                let bin = expected.iter().position(crossed).unwrap_or(6);
                observed[bin] += 1;
            }
            chi_squared(&observed, &expected, 1).unwrap().p_value
        });
    }

    #[test]
    fn p_values_of_student_are_uniform() {
        let mut rng = ChaCha8Rng::seed_from_u64(23);
        assert_uniform(|_| {
            let samples: Vec<f64> = (0..6).map(|_| 4.0 + 3.0 * normal(&mut rng)).collect();
            t_test_mean(&samples, 4.0).unwrap().p_value
        });
    }

    #[test]
    fn chi_squared_has_its_closed_forms() {
        // Bins of 100 expected, one pair of which is off by ±d: χ² = 2d²/100.
        for off in [0_u64, 3, 9, 20, 60] {
            let statistic = 2.0 * (off * off) as f64 / 100.0;
            let p = |bins: usize, constraints| {
                let mut observed = vec![100; bins];
                observed[0] += off;
                observed[1] -= off;
                let outcome = chi_squared(&observed, &vec![100.0; bins], constraints).unwrap();
                assert_relative_eq!(outcome.statistic, statistic, max_relative = 1e-14);
                outcome.p_value
            };
            let half = 0.5 * statistic;
            // One, two and four degrees of freedom; exp loses 36 · 2⁻⁵³ in its argument.
            let closed = [
                (p(2, 1), libm::erfc(half.sqrt())),
                (p(2, 0), (-half).exp()),
                (p(5, 1), (-half).exp() * (1.0 + half)),
            ];
            for (value, exact) in closed {
                assert_relative_eq!(value, exact, epsilon = 0.0, max_relative = 1e-12);
            }
        }
    }

    #[test]
    fn chi_squared_has_its_tabulated_values() {
        // Degrees of freedom, 10⁵ χ², p: Abramowitz & Stegun 1964, table 26.8.
        let table = [
            (1, 384_146_u64, 0.05),
            (5, 1_508_630, 0.01),
            (10, 1_830_700, 0.05),
            (30, 5_970_300, 0.001),
            (100, 12_434_200, 0.05),
        ];
        for (freedom, statistic, p) in table {
            let bins = freedom + 1;
            // χ² = 2 off² / 10¹².
            let off = (5_000_000 * statistic).isqrt();
            let mut observed = vec![1_000_000_000_000; bins];
            observed[0] += off;
            observed[1] -= off;
            let outcome = chi_squared(&observed, &vec![1e12; bins], 1).unwrap();
            // Half of the table's last digit, 5e−4 at most, and p falls as exp(−χ²/2) or slower.
            assert_relative_eq!(outcome.p_value, p, max_relative = 3e-4);
        }
    }

    #[test]
    fn sparse_bins_are_merged_until_they_expect_five() {
        let observed = [1, 2, 3, 4, 5, 6];
        let merged = merge_sparse_bins(&observed, &[3.0, 2.0, 7.0, 0.0, 4.9, 0.2]).unwrap();
        assert_eq!(merged, [(3.0, 5.0), (3.0, 7.0), (15.0, 4.9 + 0.2)]);
        let merged = merge_sparse_bins(&observed, &[3.0, 2.0, 7.0, 0.0, 4.0, 0.5]).unwrap();
        assert_eq!(merged, [(3.0, 5.0), (18.0, 11.5)]);
        assert_eq!(
            chi_squared(&[3, 4], &[2.0, 2.0], 1),
            Err(StatisticsError::DegreesOfFreedom {
                bins: 0,
                constraints: 1
            })
        );
    }

    #[test]
    fn student_has_its_tabulated_critical_values() {
        // Degrees of freedom, two-sided critical t, p: Abramowitz & Stegun 1964, table 26.10.
        let table = [
            (1_u32, 12.706, 0.05),
            (4, 4.604, 0.01),
            (10, 2.228, 0.05),
            (30, 3.646, 0.001),
        ];
        for (freedom, t, p) in table {
            let samples: Vec<f64> = (0..=freedom).map(|i| f64::from(i * i)).collect();
            let moments = crate::Moments::of(&samples).unwrap();
            let mean = moments.mean() + t * moments.standard_error();
            let outcome = t_test_mean(&samples, mean).unwrap();
            assert_relative_eq!(outcome.statistic, t, max_relative = 1e-13);
            // Half of the table's last digit, 5e−4, over t and a power of −31 at most.
            assert_relative_eq!(outcome.p_value, p, max_relative = 2e-3);
        }
    }

    #[test]
    fn student_becomes_normal_for_many_samples() {
        let samples: Vec<f64> = (0..200_001).map(|i| f64::from(i % 7)).collect();
        let moments = crate::Moments::of(&samples).unwrap();
        for t in [0.1, 1.0, 3.0] {
            let mean = moments.mean() - t * moments.standard_error();
            let p = t_test_mean(&samples, mean).unwrap().p_value;
            // The next order is t(t² + 1) / 4n of a density, below 4e−5.
            let normal = libm::erfc(t / core::f64::consts::SQRT_2);
            assert_abs_diff_eq!(p, normal, epsilon = 4e-5);
        }
    }

    #[test]
    fn speckle_passes_and_averaged_speckle_fails() {
        // The first zero of the autocovariance lies at 1.22 · 4 = 4.88 pixels.
        let stride = 5;
        for seed in 0..8 {
            let samples = |seed| {
                let (tile, _) = speckle_tile(320, 80, seed);
                decorrelated_samples(&tile, stride).unwrap()
            };
            let first = samples(seed);
            let outcome = kolmogorov_smirnov(&first, exponential_cumulative).unwrap();
            assert!(outcome.p_value > 1e-3, "seed {seed}: {outcome:?}");

            let pairs = first.iter().zip(samples(seed + 100));
            let averaged: Vec<f64> = pairs.map(|(a, b)| 0.5 * (a + b)).collect();
            let outcome = kolmogorov_smirnov(&averaged, exponential_cumulative).unwrap();
            assert!(outcome.p_value < 1e-3, "seed {seed}: {outcome:?}");
            let law = GammaIntensity::new(2.0).unwrap();
            let outcome = kolmogorov_smirnov(&averaged, |x| law.cumulative(x)).unwrap();
            assert!(outcome.p_value > 1e-3, "seed {seed}: {outcome:?}");
        }
    }

    #[test]
    fn wrong_counts_and_wrong_means_are_rejected() {
        let outcome = chi_squared(&[120, 80, 100, 100], &[100.0; 4], 1).unwrap();
        // χ² = 8 at three degrees of freedom: p = erfc(2) + √(2·8/π) e⁻⁴.
        let p = libm::erfc(2.0) + (16.0 / PI).sqrt() * (-4.0_f64).exp();
        assert_relative_eq!(outcome.p_value, p, max_relative = 1e-12);
        let mut rng = ChaCha8Rng::seed_from_u64(24);
        let samples: Vec<f64> = (0..100).map(|_| 1.0 + normal(&mut rng)).collect();
        // The mean is off by ten standard errors.
        let outcome = t_test_mean(&samples, 0.0).unwrap();
        assert!(outcome.p_value < 1e-6, "{outcome:?}");
    }

    #[test]
    fn extreme_input_gives_a_probability() {
        let outcome = chi_squared(&[u64::MAX, 0], &[5.0, 1e300], 1).unwrap();
        assert!((0.0..=1e-300).contains(&outcome.p_value), "{outcome:?}");
        let outcome = chi_squared(&[7, 7], &[7.0, 7.0], 1).unwrap();
        assert_relative_eq!(outcome.p_value, 1.0, epsilon = 1e-15);
        let tiny = [5e-324, 0.0, 1e-323];
        let outcome = t_test_mean(&tiny, f64::MAX).unwrap();
        assert!((0.0..=1e-3).contains(&outcome.p_value), "{outcome:?}");
        let outcome = t_test_mean(&tiny, 5e-324).unwrap();
        assert_relative_eq!(outcome.p_value, 1.0, epsilon = 1e-15);
    }

    #[test]
    fn input_that_determines_nothing_is_refused() {
        let none: [f64; 0] = [];
        assert_eq!(
            kolmogorov_smirnov(&none, |x| x),
            Err(StatisticsError::Samples {
                given: 0,
                needed: 1
            })
        );
        assert_eq!(
            kolmogorov_smirnov(&[0.5, 2.0], |x| x),
            Err(StatisticsError::Probability {
                sample: 2.0,
                value: 2.0
            })
        );
        assert!(
            kolmogorov_smirnov(&[0.5], |_| f64::NAN).is_err(),
            "a distribution function of NaN"
        );
        assert!(
            kolmogorov_smirnov(&[f64::NAN], |x| x).is_err(),
            "a sample of NaN"
        );
        assert_eq!(
            chi_squared(&[9, 9], &[9.0], 1),
            Err(StatisticsError::Bins {
                observed: 2,
                expected: 1
            })
        );
        for value in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(
                    chi_squared(&[9, 9], &[9.0, value], 1),
                    Err(StatisticsError::ExpectedCount { index: 1, .. })
                ),
                "{value}"
            );
        }
        assert_eq!(
            t_test_mean(&[1.0, 1.0], 1.0),
            Err(StatisticsError::Constant(1.0))
        );
        assert_eq!(
            t_test_mean(&[1.0, 2.0], f64::INFINITY),
            Err(StatisticsError::TestedMean(f64::INFINITY))
        );
    }
}
