use core::f64::consts::PI;

use statrs::function::{beta::beta_reg, gamma::gamma_ur};
use tem00_numerics::{Shown, check};

use crate::{
    StatisticsError,
    estimate::moments::{Scaled, check_samples},
};

/// Outcome of a test of a hypothesis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestOutcome {
    /// The test's statistic: the larger, the further from the hypothesis.
    pub statistic: f64,
    /// The probability of a statistic at least as far from the hypothesis if the hypothesis is
    /// true. It is then uniform in [0, 1].
    pub p_value: f64,
}

/// Tests whether `samples` follow the continuous distribution with the distribution function
/// `cumulative`, by the Kolmogorov–Smirnov test.
///
/// ```text
/// D = max |Fₙ(x) − F(x)|                                        the statistic
/// p = Q((√n + 0.12 + 0.11/√n) D),   Q(λ) = 2 Σₖ (−1)ᵏ⁻¹ exp(−2k²λ²)
/// ```
///
/// # Independence
///
/// The samples must be independent, and the distribution fixed beforehand, not fitted to them.
/// Neighbouring pixels of a speckle pattern share a speckle: applied to all pixels the test rejects
/// a third of all correct patterns at the 5 % level. Use
/// [`decorrelated_samples`](crate::estimate::decorrelated_samples).
///
/// # Validity
///
/// The p-value is the limit for many samples with Stephens' correction for few samples. Where it is
/// 0.01 the true p-value is smaller by the fraction 0.12 for five samples, 0.04 for ten and 0.01
/// for twenty: with few samples the test is conservative.
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
    T: Copy + Into<f64> + Sync,
{
    check_samples(samples, 1)?;
    let mut sorted: Vec<f64> = samples.iter().map(|&x| x.into()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let distance = largest_distance(&sorted, cumulative)?;
    let root = (sorted.len() as f64).sqrt();
    Ok(TestOutcome {
        statistic: distance,
        p_value: kolmogorov_survival((root + 0.12 + 0.11 / root) * distance),
    })
}

/// Checks the probability that a distribution function returned at a sample.
pub(crate) fn checked_probability(sample: f64, value: f64) -> Result<f64, StatisticsError> {
    if (0.0..=1.0).contains(&value) {
        Ok(value)
    } else {
        let allowed = format!("from 0 to 1 at {}", Shown(sample));
        Err(StatisticsError::refused("cumulative", value, allowed))
    }
}

/// Returns the largest distance between the empirical distribution of `sorted` and `cumulative`.
fn largest_distance(
    sorted: &[f64],
    cumulative: impl Fn(f64) -> f64,
) -> Result<f64, StatisticsError> {
    let count = sorted.len() as f64;
    let mut distance = 0.0_f64;
    for (index, &sample) in sorted.iter().enumerate() {
        let value = checked_probability(sample, cumulative(sample))?;
        // The empirical distribution jumps from one to the other at the sample.
        let (below, above) = (index as f64 / count, (index + 1) as f64 / count);
        distance = distance.max(value - below).max(above - value);
    }
    Ok(distance)
}

/// Returns the probability Q(λ) that √n times the distance exceeds λ, for n → ∞.
fn kolmogorov_survival(lambda: f64) -> f64 {
    // Both series are exact; on either side their first four terms are exact to 1e−17.
    if lambda < 1.0 {
        let term = |k: f64| (-(k * PI).powi(2) / (8.0 * lambda * lambda)).exp();
        let sum = term(1.0) + term(3.0) + term(5.0) + term(7.0);
        let below = (2.0 * PI).sqrt() / lambda.max(f64::MIN_POSITIVE) * sum;
        return 1.0 - below;
    }
    let term = |k: f64| (-2.0 * (k * lambda).powi(2)).exp();
    2.0 * (term(1.0) - term(2.0) + term(3.0) - term(4.0))
}

/// Tests whether counts `observed` in bins agree with the `expected` counts, by Pearson's χ² test.
///
/// ```text
/// χ² = Σ (O − E)² / E                 the statistic, over the merged bins
/// degrees of freedom = bins − constraints
/// ```
///
/// Bins are merged from the first to the last until each expects five counts or more; the remainder
/// joins the last bin. `constraints` is the number of fitted quantities of the expected values: 1
/// if they were scaled to the observed total (the usual case), plus 1 for each fitted parameter; 0
/// if the total was left free.
///
/// # Independence
///
/// The counted events must be independent: for pixels of a speckle pattern use
/// [`decorrelated_samples`](crate::estimate::decorrelated_samples).
///
/// # Validity
///
/// The p-value assumes the limiting distribution of χ² for many counts per bin; five expected
/// counts are the customary minimum.
///
/// # Errors
///
/// Returns an error if the slices differ in length, an expected count is negative or not finite, or
/// the merged bins do not outnumber the constraints.
///
/// # Examples
///
/// The counts of 120 throws of a die:
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

/// The customary minimum for which χ² nearly has its limiting distribution.
const FEWEST_EXPECTED: f64 = 5.0;

fn merge_sparse_bins(
    observed: &[u64],
    expected: &[f64],
) -> Result<Vec<(f64, f64)>, StatisticsError> {
    if observed.len() != expected.len() {
        let allowed = format!("as many as the {} observed counts", observed.len());
        return Err(StatisticsError::refused(
            "expected",
            expected.len(),
            allowed,
        ));
    }
    check::each(expected, |count| check::not_negative("expected", count, ""))?;
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

/// Tests whether the expectation of `samples` is `mean`, by Student's two-sided t-test.
///
/// ```text
/// t = |m − mean| / (s / √n)           the statistic, with n − 1 degrees of freedom
/// ```
///
/// # Independence
///
/// The samples must be independent, for example one per seed.
///
/// # Validity
///
/// The test is exact for normal samples, and accurate for others once their mean is nearly normal:
/// for exponential samples from a hundred on.
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
    T: Copy + Into<f64> + Sync,
{
    check::finite("mean", mean, "")?;
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
mod tests;
