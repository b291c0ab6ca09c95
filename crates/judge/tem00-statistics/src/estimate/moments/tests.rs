use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use tem00_numerics::cast::to_f32;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::synthetic::{exponential_samples, speckle_tile};

#[test]
fn moments_of_small_integers_are_exact() {
    let moments = Moments::from_samples(&[2_u8, 4, 4, 4, 5, 5, 7, 9]).unwrap();
    assert_eq!(moments.count(), 8);
    // The sum of squares about 5 is 32.
    assert_relative(moments.mean(), 5.0, 1e-15);
    let variance = moments.standard_deviation().powi(2);
    assert_relative(variance, 32.0 / 7.0, 1e-15);
    assert_relative(moments.standard_error(), (4.0_f64 / 7.0).sqrt(), 1e-15);
}

#[test]
fn contrast_of_few_exponential_samples_is_biased_as_stated() {
    const BLOCKS: u32 = 20_000;
    const LENGTH: usize = 50;
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let contrasts: Vec<_> = (0..BLOCKS)
        .map(|_| Contrast::from_samples(&exponential_samples(LENGTH, &mut rng)).unwrap())
        .collect();
    let values: Vec<_> = contrasts.iter().map(Contrast::value).collect();
    let moments = Moments::from_samples(&values).unwrap();
    let length = LENGTH as f64;
    // 3.3 σ is α = 0.001; the next order in 1/n is 1/n² times a number of order one.
    let tolerance = 3.3 * moments.standard_error() + 3.0 / (length * length);
    assert_absolute(moments.mean(), 1.0 - 1.0 / length, tolerance);
    assert!(tolerance < 0.3 / length, "the bias would not be seen");
}

#[test]
fn standard_error_of_the_contrast_is_that_of_many_trials() {
    const TRIALS: u32 = 2_000;
    const LENGTH: usize = 500;
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let contrasts: Vec<_> = (0..TRIALS)
        .map(|_| Contrast::from_samples(&exponential_samples(LENGTH, &mut rng)).unwrap())
        .collect();
    let values: Vec<_> = contrasts.iter().map(Contrast::value).collect();
    let errors: f64 = contrasts.iter().map(|c| c.standard_error().powi(2)).sum();
    let estimated = (errors / f64::from(TRIALS)).sqrt();
    let spread = Moments::from_samples(&values).unwrap().standard_deviation();
    // 1/√n for exponential samples; a standard deviation from 2000 trials has a relative error of
    // 1/√4000 = 1.6 %, here 3.3 σ, and the first order in 1/n an error of about 10/n = 2 %.
    assert_relative(spread, 500.0_f64.sqrt().recip(), 0.072);
    assert_relative(spread, estimated, 0.072);
}

#[test]
fn speckle_size_widens_the_error_of_the_contrast_as_tiles_do() {
    const TILES: u64 = 300;
    for (size, diameter) in [(64, 32), (96, 24)] {
        let speckle_size = size as f64 / diameter as f64;
        let contrast = |seed| {
            let (tile, _) = speckle_tile(size, diameter, seed);
            let contrast = Contrast::from_samples(tile.values()).unwrap();
            contrast.with_speckle_size(speckle_size).unwrap()
        };
        let contrasts: Vec<_> = (0..TILES).map(contrast).collect();
        let values: Vec<_> = contrasts.iter().map(Contrast::value).collect();
        let errors: f64 = contrasts.iter().map(Contrast::standard_error).sum();
        let spread = Moments::from_samples(&values).unwrap().standard_deviation();
        // A spread from 300 tiles has a relative error of 1/√600 = 4.1 %, here 3.3 σ; the first
        // order in 1/C has an error of about 2/C.
        let tolerance = 3.3 * 0.041 + 2.0 / diameter as f64;
        assert_relative(spread, errors / TILES as f64, tolerance);
        assert_relative(
            spread,
            0.5 * crate::laws::contrast_squared_spread(diameter as f64),
            tolerance,
        );
    }
}

#[test]
fn correlation_of_two_waves_is_the_cosine_of_their_phase() {
    let wave = |phase: f64| {
        Grid::from_fn(32, 3, |x, _| {
            let argument = core::f64::consts::TAU * 3.0 * x as f64 / 32.0;
            to_f32(100.0 + (argument + phase).cos())
        })
    };
    for phase in [0.0_f64, 0.4, 1.5, 3.0] {
        let correlation = pearson_correlation(&wave(0.0), &wave(phase)).unwrap();
        // Values near 100 are stored to 4e−6, and 96 of them average it.
        assert_absolute(correlation, phase.cos(), 4e-6);
    }
}

#[test]
fn equal_samples_have_no_contrast_and_no_error() {
    let contrast = Contrast::from_samples(&[0.1, 0.1, 0.1]).unwrap();
    assert!(contrast.value().abs() < f64::MIN_POSITIVE, "{contrast:?}");
    assert!(contrast.standard_error().abs() < f64::MIN_POSITIVE);
}

proptest! {
    #[test]
    fn nothing_overflows(
        samples in proptest::collection::vec(-f64::MAX..f64::MAX, 2..9),
        exponent in -1_074..1,
    ) {
        let scaled: Vec<f64> = samples.iter().map(|&x| libm::ldexp(x, exponent)).collect();
        let moments = Moments::from_samples(&scaled).unwrap();
        prop_assert!(moments.mean().is_finite(), "{moments:?}");
        // √2 · f64::MAX is the largest standard deviation, of two opposite samples.
        prop_assert!(!moments.standard_deviation().is_nan(), "{moments:?}");
        if let Ok(contrast) = Contrast::from_samples(&scaled) {
            prop_assert!(contrast.value().is_finite(), "{contrast:?}");
            prop_assert!(contrast.standard_error().is_finite(), "{contrast:?}");
        }
    }

    #[test]
    fn contrast_does_not_depend_on_the_unit(exponent in -900_i32..900) {
        let samples = [0.3, 1.7, 0.2, 2.9];
        let scaled = samples.map(|x| libm::ldexp(x, exponent));
        // A power of two changes no bit.
        prop_assert_eq!(Contrast::from_samples(&samples), Contrast::from_samples(&scaled));
    }
}

#[test]
fn confidence_intervals_hold_the_contrast_as_often_as_stated() {
    const TRIALS: u32 = 1_500;
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    for (length, stated) in [(100, 0.90), (1_000, 0.94)] {
        let held = (0..TRIALS).filter(|_| {
            let contrast = Contrast::from_samples(&exponential_samples(length, &mut rng)).unwrap();
            let [low, high] = contrast.confidence_interval(0.95).unwrap();
            low <= 1.0 && 1.0 <= high
        });
        let share = held.count() as f64 / f64::from(TRIALS);
        // Binomial, 3.3 σ = 0.026, and half of the last digit.
        assert_absolute(share, stated, 0.026 + 0.005);
    }
}

#[test]
fn confidence_intervals_are_those_of_the_logarithm() {
    let contrast = Contrast::from_samples(&[1.0, 2.0, 4.0, 9.0]).unwrap();
    let [low, high] = contrast.confidence_interval(0.682_689_492_137_086).unwrap();
    // One standard error.
    let share = contrast.standard_error() / contrast.value();
    assert_relative(high, contrast.value() * share.exp(), 1e-12);
    assert_relative(low, contrast.value() / share.exp(), 1e-12);
    let none = Contrast::from_samples(&[2.0, 2.0])
        .unwrap()
        .confidence_interval(0.9);
    assert_eq!(none, Ok([0.0, 0.0]));
}
