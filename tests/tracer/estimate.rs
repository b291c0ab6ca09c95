//! Means of estimators against what they estimate.

use tem00::statistics::t_test_mean;

/// A correct estimator fails a comparison with this probability at a given set of seeds.
const SIGNIFICANCE: f64 = 1e-4;

/// Returns the mean over an image.
pub(crate) fn mean(values: &[f32]) -> f64 {
    values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64
}

/// Asserts that renders with different seeds have the mean `expected`, and can tell by `precision`.
pub(crate) fn assert_mean(name: &str, values: &[f64], expected: f64, precision: f64) {
    let test = t_test_mean(values, expected).unwrap();
    assert!(
        test.p_value > SIGNIFICANCE,
        "{name}: p = {:e}, {values:?} | {expected}",
        test.p_value
    );
    let n = values.len() as f64;
    let average = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|v| (v - average).powi(2)).sum::<f64>();
    let error = (squares / (n * (n - 1.0))).sqrt();
    assert!(
        error <= precision,
        "{name}: the standard error {error:e} exceeds {precision:e}"
    );
}
