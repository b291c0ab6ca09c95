//! Noise for the tests of the fits, and statistics of repeated fits.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00_numerics::normal_quantile;

use super::positions::Estimate;

/// The standard normal variate that a correct value exceeds in magnitude with a probability of 1e−4.
const CRITICAL: f64 = 3.891;

/// Normal deviates of unit variance from a fixed seed.
pub(super) fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    move || normal_quantile(rng.random::<f64>())
}

/// The deviation of an estimate from the truth, in standard errors.
pub(super) fn pull(estimate: Estimate, truth: f64) -> f64 {
    (estimate.value - truth) / estimate.standard_error
}

/// Asserts that the values are independent draws from the standard normal distribution: their mean
/// and their sum of squares are rejected with a probability of 1e−4 each if so.
pub(super) fn assert_standard_normal(values: &[f64], what: &str) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    assert!(
        mean.abs() * count.sqrt() < CRITICAL,
        "{what}: mean {mean} of {count}"
    );
    assert_chi_squared(values.iter().map(|v| v * v).sum(), count, what);
}

/// Asserts that a value is drawn from the χ² distribution; rejected with a probability of 1e−4 if
/// it is (E. B. Wilson and M. M. Hilferty, PNAS 17, 684, 1931).
pub(super) fn assert_chi_squared(value: f64, freedom: f64, what: &str) {
    let variance = 2.0 / (9.0 * freedom);
    let normal = ((value / freedom).cbrt() - (1.0 - variance)) / variance.sqrt();
    assert!(
        normal.abs() < CRITICAL,
        "{what}: χ² = {value} for {freedom}, {normal} σ"
    );
}
