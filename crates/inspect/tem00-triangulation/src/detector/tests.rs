//! Detectors against closed forms.
//!
//! Lines are Gaussians with the standard deviation σ = w/2, in pixels. Their pixels are `f32`: 6e−8
//! of the peak is rounding everywhere.

mod bias;
mod lines_of_an_image;
mod noise;
mod properties;
mod sensitivities;
mod speckle;

use core::f64::consts::{FRAC_1_SQRT_2, TAU};

use tem00_numerics::cast::to_f32;

use super::*;

/// Height of a line, in grey values.
const PEAK: f64 = 1000.0;

fn detector(method: LineMethod, window: usize) -> LineDetector {
    let usual = DetectorSettings::default();
    LineDetector::new(DetectorSettings {
        method,
        window,
        ..usual
    })
    .unwrap()
}

fn order(taps: usize) -> LineMethod {
    let order = FilterOrder::from_taps(taps).unwrap();
    LineMethod::BlaisRioux { order }
}

/// All methods, with all orders.
fn methods() -> Vec<LineMethod> {
    let mut methods = LineMethod::ALL.to_vec();
    methods.extend([order(2), order(8)]);
    methods
}

/// The density of a normal distribution about 0.
fn density(u: f64, sigma: f64) -> f64 {
    (-0.5 * (u / sigma).powi(2)).exp() / (TAU.sqrt() * sigma)
}

/// The fraction of a normal distribution about 0 below u.
fn cumulative(u: f64, sigma: f64) -> f64 {
    0.5 * libm::erfc(-u / sigma * FRAC_1_SQRT_2)
}

/// A line integrated over the pixels of a column.
fn integrated(length: usize, centre: f64, sigma: f64) -> Vec<f32> {
    let area = PEAK * TAU.sqrt() * sigma;
    let edge = |i: usize| cumulative(i as f64 - centre, sigma);
    let pixel = |i: usize| to_f32(area * (edge(i + 1) - edge(i)));
    (0..length).map(pixel).collect()
}

/// A line sampled in the middle of the pixels of a column.
fn sampled(length: usize, centre: f64, sigma: f64) -> Vec<f32> {
    let value = |i: usize| (-0.5 * ((i as f64 + 0.5 - centre) / sigma).powi(2)).exp();
    (0..length).map(|i| to_f32(PEAK * value(i))).collect()
}

/// The one line of a column.
fn only(detector: &LineDetector, column: &[f32]) -> LinePoint {
    let points = detector.detect_column(column);
    assert_eq!(points.len(), 1, "{:?}: {points:?}", detector.settings());
    points[0]
}

/// Distances of a line from the middle of its greatest pixel, not up to the edge: there two are
/// equal.
fn phases() -> impl Iterator<Item = f64> {
    (-9..=9).map(|i| f64::from(i) * 0.05)
}

/// The middle of the pixel in which the lines of these tests lie.
const MIDDLE: f64 = 200.5;
const LENGTH: usize = 401;
