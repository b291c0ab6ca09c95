use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, Normal, Poisson};

use super::*;

const COLUMNS: usize = 4000;

/// Compares the variance of the positions found in noisy columns with a law. The variance of n
/// Gaussian numbers has the relative standard error √(2/n), here 2.2 %; 3.3 of them are exceeded
/// once in 1000.
fn compare(detector: &LineDetector, variance: f64, mut column: impl FnMut(u64) -> Vec<f32>) {
    let positions: Vec<f64> = (0..COLUMNS as u64)
        .map(|seed| only(detector, &column(seed)).position - MIDDLE)
        .collect();
    let mean = positions.iter().sum::<f64>() / COLUMNS as f64;
    let squares = positions.iter().map(|position| (position - mean).powi(2));
    let ratio = squares.sum::<f64>() / (COLUMNS as f64 - 1.0) / variance;
    let error = (2.0 / COLUMNS as f64).sqrt();
    assert!(
        (ratio - 1.0).abs() < 3.3 * error,
        "variance {ratio} of the law"
    );
    let off = mean / (variance / COLUMNS as f64).sqrt();
    assert!(off.abs() < 3.3, "the mean is {off} standard errors off");
}

fn with_white_noise(line: &[f32], noise: f64, seed: u64) -> Vec<f32> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let law = Normal::new(500.0, noise).unwrap();
    let mut draw = |&value: &f32| value + to_f32(law.sample(&mut random));
    line.iter().map(&mut draw).collect()
}

#[test]
fn centre_of_gravity_is_as_good_as_photons_allow() {
    // The centre of gravity of N electrons scatters as the mean of N positions: σ²/N, the bound of
    // Cramér and Rao for a Gaussian; (w/2)/√N. Pixels add their own variance, 1/12.
    let (sigma, electrons) = (3.0, 10_000.0);
    let scale = electrons / (PEAK * TAU.sqrt() * sigma);
    let line = integrated(101, 50.5, sigma);
    let means: Vec<f64> = line.iter().map(|&value| f64::from(value) * scale).collect();
    let shot = |seed| {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut draw = |&mean: &f64| {
            let drawn: f64 = Poisson::new(mean).map_or(0.0, |law| law.sample(&mut random));
            to_f32(drawn)
        };
        let mut column = vec![0.0; LENGTH];
        column[150..251].copy_from_slice(&means.iter().map(&mut draw).collect::<Vec<f32>>());
        column
    };
    let detector = detector(LineMethod::CentreOfGravity, 31);
    let variance = (sigma * sigma + 1.0 / 12.0) / electrons;
    compare(&detector, variance, shot);
    let bound = sigma / electrons.sqrt();
    assert!(
        variance.sqrt() / bound < 1.005,
        "half a percent above the bound"
    );
}

#[test]
fn white_noise_moves_the_centre_of_gravity_by_its_lever_arms() {
    // δŷ = Σ (y_i − ŷ) δI_i / Σ I: over 31 pixels Σ y² = 15 · 16 · 31 / 3. The sum of the light is
    // 1 % uncertain, and that 31 pixels scatter moves the estimate in the second order, (31 s²)/(Σ
    // I)², too.
    let (sigma, noise) = (3.0, PEAK / 100.0);
    let line = integrated(LENGTH, MIDDLE, sigma);
    let light = PEAK * TAU.sqrt() * sigma;
    let variance = 15.0 * 16.0 * 31.0 / 3.0 * (noise / light).powi(2);
    let detector = detector(LineMethod::CentreOfGravity, 31);
    compare(&detector, variance, |seed| {
        with_white_noise(&line, noise, seed)
    });
}

#[test]
fn the_fit_is_as_good_as_white_noise_allows() {
    // The bound of Cramér and Rao is s²/Σ (∂I_i/∂c)² for white noise of the variance s². With ∂I/∂c
    // = P u/σ² e^{−u²/2σ²} the sum is P² √π/(2σ); the pixels, of 1/12 σ², take 1.5/12 σ² of it. The
    // second order of the fit is (s/P)² of the first.
    let (sigma, noise) = (3.0, PEAK / 100.0);
    let line = integrated(LENGTH, MIDDLE, sigma);
    let pixels = 1.0 + 0.125 / (sigma * sigma);
    let variance = 2.0 * sigma * (noise / PEAK).powi(2) / core::f64::consts::PI.sqrt() * pixels;
    let detector = detector(LineMethod::GaussianFit, 41);
    compare(&detector, variance, |seed| {
        with_white_noise(&line, noise, seed)
    });
}

#[test]
fn noise_alone_is_no_line() {
    // Six standard deviations, 1e−9 each, over 200 columns of some 100 independent positions.
    let settings = DetectorSettings {
        min_peak: 0.0,
        max_lines: 5,
        ..DetectorSettings::default()
    };
    let detector = LineDetector::new(settings).unwrap();
    let law = Normal::new(100.0, 4.0).unwrap();
    for seed in 0..200 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let draw = |_| to_f32(law.sample(&mut random));
        let column: Vec<f32> = (0..LENGTH).map(draw).collect();
        assert_eq!(detector.detect_column(&column), [], "seed {seed}");
    }
}
