use tem00_testkit::{assert_absolute, correlation};

use super::*;

const SIDE: usize = 128;
const FRAMES: u64 = 24;

/// The mean image of a few frames, in DN, and the mean temporal variance of a pixel in it.
fn mean_image(sensor: &Sensor, electrons: f64, seed: u64) -> (Vec<f64>, f64) {
    let frame = |i| {
        sensor
            .uniform_frame([SIDE, SIDE], electrons, FRAMES * seed + i)
            .unwrap()
    };
    let frames: Vec<RawFrame> = (0..FRAMES).map(frame).collect();
    let n = FRAMES as f64;
    let of = |pixel: usize| {
        frames
            .iter()
            .map(move |f| f64::from(f.values.values()[pixel]))
    };
    let means: Vec<f64> = (0..SIDE * SIDE).map(|p| of(p).sum::<f64>() / n).collect();
    let variance: f64 = means
        .iter()
        .enumerate()
        .map(|(p, mean)| of(p).map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0))
        .sum();
    let pixels = means.len() as f64;
    (means, variance / pixels / n)
}

fn variance(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)
}

/// The variance between pixels, without what is left of the noise, and the standard error of it.
fn spatial(sensor: &Sensor, electrons: f64, seed: u64) -> (f64, f64) {
    let (means, left) = mean_image(sensor, electrons, seed);
    let measured = variance(&means);
    (
        measured - left,
        measured * (2.0 / means.len() as f64).sqrt(),
    )
}

#[test]
fn dsnu_and_prnu_come_back_from_stacks_of_frames() {
    let sensor = typical();
    let d = *sensor.description();
    let (dark, dark_error) = spatial(&sensor, 0.0, 1);
    let dsnu = d.gain * d.dsnu;
    // Four standard errors, α = 6e-5: 4.8 % of the variance, and what is left of the noise.
    assert_absolute(dark, dsnu * dsnu, 4.0 * dark_error);
    let electrons = 5_000.0;
    let (bright, error) = spatial(&sensor, electrons, 2);
    let prnu = d.prnu * d.gain * electrons;
    assert_absolute(bright - dark, prnu * prnu, 4.0 * error);
}

#[test]
fn the_pattern_belongs_to_the_camera_and_not_to_the_frame() {
    let one = typical();
    let other = one.with_serial_number(1);
    // Different noise, so that what agrees is the pattern.
    let with = |other: &Sensor| {
        correlation(
            &mean_image(&one, 5_000.0, 3).0,
            &mean_image(other, 5_000.0, 4).0,
        )
    };
    // A pattern of 9.6 DN over noise of 27 DN / √24: 0.75 of the variance.
    let same = with(&one);
    assert!((0.72..0.79).contains(&same), "the same camera: {same}");
    // Four standard errors of no correlation between 128² pixels.
    let different = with(&other);
    assert_absolute(different, 0.0, 4.0 / SIDE as f64);
}

#[test]
fn a_seed_that_is_the_serial_number_draws_other_numbers() {
    // Without electrons, noise takes one number per pixel and the pattern two: a response, an
    // offset.
    let offsets = sensor(|d| (d.dark_noise, d.dsnu, d.dark_current) = (0.0, 50.0, 0.0));
    let noise = sensor(|d| (d.dark_noise, d.dsnu, d.dark_current) = (50.0, 0.0, 0.0));
    let of = |sensor: &Sensor| {
        let camera = sensor.with_serial_number(5);
        camera.uniform_frame([SIDE, SIDE], 0.0, 5).unwrap().values
    };
    let (a, b) = (of(&offsets), of(&noise));
    let pairs = (0..SIDE).flat_map(|y| (0..SIDE / 2).map(move |x| [(x, y), (2 * x + 1, y)]));
    let [a, b] = [0, 1].map(|i| {
        let of_pair = |pair: [(usize, usize); 2]| f64::from([&a, &b][i][pair[i]]);
        pairs.clone().map(of_pair).collect::<Vec<_>>()
    });
    // Four standard errors of no correlation between half of 128² pixels.
    assert_absolute(correlation(&a, &b), 0.0, 4.0 * 2.0_f64.sqrt() / SIDE as f64);
}
