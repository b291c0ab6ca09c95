use tem00_statistics::chi_squared;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

/// The probability of `count` events with the mean `mean`, by logarithms.
fn poisson(count: u32, mean: f64) -> f64 {
    let log_factorial: f64 = (1..=count).map(|k| f64::from(k).ln()).sum();
    (f64::from(count) * mean.ln() - mean - log_factorial).exp()
}

/// The numbers of pixels for all counts of a range, and what theory says of them. The first and the
/// last count stand for all that lie beyond.
fn histogram(frame: &RawFrame, mean: f64, [min, max]: [u32; 2]) -> (Vec<u64>, Vec<f64>) {
    let values = frame.values.values();
    let bin = |value: u16| u32::from(value).clamp(min, max);
    let observed = (min..=max).map(|k| values.iter().filter(|&&v| bin(v) == k).count() as u64);
    let pixels = values.len() as f64;
    let mut expected: Vec<f64> = (min..=max).map(|k| pixels * poisson(k, mean)).collect();
    expected[0] += (0..min).map(|k| pixels * poisson(k, mean)).sum::<f64>();
    let rest = pixels - expected.iter().sum::<f64>();
    expected[(max - min) as usize] += rest;
    (observed.collect(), expected)
}

#[test]
fn electrons_are_poisson_distributed() {
    // Grey values are counts: no gain, offset, dark noise or pattern.
    let counter = sensor(|d| {
        (d.gain, d.black_level, d.dark_noise, d.dark_current) = (1.0, 0.0, 0.0, 0.0);
        (d.prnu, d.dsnu) = (0.0, 0.0);
    });
    // Below and above 12, where the sampler changes its algorithm.
    for (seed, mean, range) in [
        (1, 0.25, [0, 5]),
        (2, 3.0, [0, 12]),
        (3, 11.875, [0, 26]),
        (4, 12.125, [0, 26]),
        (5, 90.0, [52, 128]),
        (6, 900.0, [780, 1_020]),
    ] {
        let frame = counter.uniform_frame([256, 256], mean, seed).unwrap();
        let (counts, expected) = histogram(&frame, mean, range);
        let outcome = chi_squared(&counts, &expected, 1).unwrap();
        // Six tests at 1e-4 each.
        assert!(
            outcome.p_value > 1e-4,
            "mean {mean}: p = {:e}",
            outcome.p_value
        );
    }
}

#[test]
fn the_photon_transfer_line_has_the_slope_of_the_gain() {
    const SIDE: usize = 160;
    let pixels = (SIDE * SIDE) as f64;
    let sensor = typical();
    let gain = sensor.description().gain;
    let point = |electrons: f64, seed: u64| {
        let frame = |seed| sensor.uniform_frame([SIDE, SIDE], electrons, seed).unwrap();
        PhotonTransferPoint::of_pair(&frame(2 * seed), &frame(2 * seed + 1)).unwrap()
    };
    let dark = point(0.0, 0);
    let (mut xy, mut xx, mut variance) = (0.0, 0.0, 0.0);
    for step in 1..=12_u32 {
        let electrons = 600.0 * f64::from(step);
        let bright = point(electrons, step.into());
        let x = bright.mean - dark.mean;
        xy += x * (bright.variance - dark.variance);
        xx += x * x;
        // The variance of a variance estimated from N independent differences: 2 σ⁴ / N.
        let spread = sensor.temporal_variance(electrons);
        variance += x * x * 2.0 * spread * spread / pixels;
    }
    let (slope, error) = (xy / xx, variance.sqrt() / xx);
    // Four standard errors, α = 6e-5; here 1.4 %.
    assert!(error < 0.004 * gain, "the test can tell: {error}");
    assert_absolute(slope, gain, 4.0 * error);
}

#[test]
fn grey_values_have_the_mean_and_variance_of_the_model() {
    const SIDE: usize = 200;
    let pixels = (SIDE * SIDE) as f64;
    // A dark current of 20 electrons, to be seen.
    let bright = sensor(|d| d.dark_current = 2e4);
    // The dark noise is 0.46 DN, so that the 1/12 of rounding is a quarter of the variance.
    let rounding = sensor(|d| (d.gain, d.dsnu) = (0.2, 20.0));
    assert_absolute(rounding.temporal_variance(0.0), 0.295, 1e-3);
    for (sensor, seed, electrons) in [
        (&bright, 0, 0.0),
        (&bright, 1, 5.0),
        (&bright, 2, 200.0),
        (&bright, 3, 6_000.0),
        (&rounding, 4, 0.0),
    ] {
        let frame = |seed| sensor.uniform_frame([SIDE, SIDE], electrons, seed).unwrap();
        let point = PhotonTransferPoint::of_pair(&frame(10 + seed), &frame(20 + seed)).unwrap();
        let variance = sensor.temporal_variance(electrons);
        let spread = (variance / 2.0 + sensor.spatial_variance(electrons)) / pixels;
        // Four standard errors each, α = 6e-5.
        assert_absolute(
            point.mean,
            sensor.mean_grey_value(electrons),
            4.0 * spread.sqrt(),
        );
        assert_relative(point.variance, variance, 4.0 * (2.0 / pixels).sqrt());
    }
}
