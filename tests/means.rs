//! Means over images and over renders, against what they estimate.

use tem00::{
    statistics::t_test_mean,
    tracer::{Frame, RenderOptions, Scene},
};

/// A correct renderer fails a comparison with this probability at a given set of seeds.
const SIGNIFICANCE: f64 = 1e-3;

/// The first frame without speckle.
pub(crate) fn render(scene: &Scene, options: &RenderOptions) -> Frame {
    crate::renders::frame(scene, None, 0, options)
}

/// The mean over an image.
pub(crate) fn mean(values: &[f32]) -> f64 {
    values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64
}

/// Asserts that values of renders with different seeds have the mean `expected`, and can tell by
/// `precision`.
#[track_caller]
pub(crate) fn assert_mean(name: &str, values: &[f64], expected: f64, precision: f64) {
    let test = t_test_mean(values, expected).expect("renders with noise");
    let p = test.p_value;
    assert!(
        p > SIGNIFICANCE,
        "{name}: p = {p:e}, {values:?} | {expected}"
    );
    let n = values.len() as f64;
    let average = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|v| (v - average).powi(2)).sum::<f64>();
    let error = (squares / (n * (n - 1.0))).sqrt();
    assert!(
        error <= precision,
        "{name}: a standard error of {error:e} exceeds {precision:e}"
    );
}
