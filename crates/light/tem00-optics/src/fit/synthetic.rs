//! Noise for the tests of the fits, and statistics of repeated fits.

use tem00_testkit::{Numbers, assert_absolute, chi_squared_survival};

use super::positions::Estimate;

/// The standard normal variate that a correct value exceeds in magnitude with a probability of
/// 1e−4.
const CRITICAL: f64 = 3.891;

/// Normal deviates of unit variance from a fixed seed.
pub(super) fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut numbers = Numbers::new(seed);
    move || numbers.normal()
}

/// The deviation of an estimate from the truth, in standard errors.
pub(super) fn pull(estimate: Estimate, truth: f64) -> f64 {
    (estimate.value - truth) / estimate.standard_error
}

/// Asserts that the values are independent draws from the standard normal distribution: if they
/// are, their mean and their sum of squares are each rejected with a probability of 1e−4.
#[track_caller]
pub(super) fn assert_standard_normal(values: &[f64], what: &str) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    assert_absolute(mean, 0.0, CRITICAL / count.sqrt());
    assert_chi_squared(values.iter().map(|v| v * v).sum(), values.len(), what);
}

/// Asserts that a value is drawn from the χ² distribution; if it is, it is rejected with a
/// probability of 1e−4.
#[track_caller]
pub(super) fn assert_chi_squared(value: f64, freedom: usize, what: &str) {
    let p = chi_squared_survival(value, freedom.try_into().unwrap());
    assert!((5e-5..1.0 - 5e-5).contains(&p), "{what}: p = {p}");
}
