//! First- and second-order statistics of generated patterns against the theory of fully developed
//! speckle (Goodman 1975, §2.3; Duncan & Kirkpatrick 2008).
//!
//! The tests are statistical but not flaky: all seeds are fixed. A correct generator fails at a
//! given seed with the stated probability at most.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

use proptest::{prelude::*, test_runner::RngSeed};
use tem00::{
    numerics::Grid,
    speckle::{Complex, Phasors, Pupil, PupilField, Transmission},
    statistics::{
        AIRY_FIRST_ZERO, Boundary, Contrast, autocovariance, contrast_of_phasor_sum,
        contrast_squared_spread, decorrelated_samples, exponential_cumulative, kolmogorov_smirnov,
    },
};

/// The Kolmogorov–Smirnov test assumes independent samples, but neighbouring pixels share a
/// speckle: only every so many pixels, beyond the first zero of the autocovariance, are taken.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a stride is a few pixels"
)]
fn independent_samples(field: &PupilField, offset: [f64; 2], defocus: f64) -> Vec<f64> {
    // An apodised pupil acts like one two thirds as wide.
    let width = match field.pupil() {
        Pupil::Gaussian { .. } | Pupil::Sampled(_) => 1.5,
        _ => 1.0,
    };
    let stride = (width * AIRY_FIRST_ZERO * field.speckle_size()).ceil() as usize;
    let pattern = field.pattern_at(offset, defocus);
    decorrelated_samples(pattern.values(), stride).expect("a finite pattern")
}

/// A pupil without symmetry, with aberrations.
fn aberrated(phase: f32) -> Pupil {
    let grid = Grid::from_fn(31, 33, |x, y| {
        let place = (x + y * y) as f32;
        Complex::from_polar(1.0 / (1.0 + 0.001 * place), phase * place)
    });
    Pupil::Sampled(Transmission::from_complex(grid).expect("a transmission below 1"))
}

fn pupils() -> impl Strategy<Value = Pupil> {
    prop_oneof![
        Just(Pupil::Circle),
        (0.1_f64..0.6).prop_map(|inner| Pupil::Annulus { inner }),
        (0.6_f64..1.0).prop_map(|height| Pupil::Rectangle { height }),
        (0.4_f64..2.0).prop_map(|radius| Pupil::Gaussian { radius }),
        (0.0_f32..1.0).prop_map(aberrated),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn intensity_is_negative_exponential(
        seed in any::<u64>(),
        size in [300_usize..500, 300_usize..500],
        speckle_size in 2.0_f64..4.0,
        pupil in pupils(),
        offset in [-1e3_f64..1e3, -1e3_f64..1e3],
        defocus in -5.0_f64..5.0,
    ) {
        let field = PupilField::from_speckle_size(size, speckle_size, seed)
            .and_then(|field| field.with_pupil(pupil))
            .expect("a valid field");
        let samples = independent_samples(&field, offset, defocus);
        let test = kolmogorov_smirnov(&samples, exponential_cumulative).expect("enough samples");
        // 24 cases: a correct generator fails one of them with a probability of 2.4e−6.
        prop_assert!(test.p_value > 1e-7, "p = {:e} for {:?}", test.p_value, field.pupil());
    }

    #[test]
    fn mean_intensity_is_one_for_every_realization(
        seed in any::<u64>(),
        diameter in 16_usize..64,
        speckle_size in 2_usize..5,
        pupil in pupils(),
    ) {
        let field = PupilField::new(diameter * speckle_size, diameter, seed)
            .and_then(|field| field.with_pupil(pupil))
            .expect("a valid field");
        let pattern = field.pattern();
        let values = pattern.values().values();
        let mean = values.iter().map(|&i| f64::from(i)).sum::<f64>() / values.len() as f64;
        // Parseval fixes the mean exactly, so the tolerance covers rounding to single precision.
        prop_assert!((mean - 1.0).abs() < 1e-5, "mean = {mean}");
    }
}

#[test]
fn contrast_is_that_of_a_sum_of_finitely_many_phasors() {
    const PATTERNS: u64 = 24;
    for diameter in [16, 32, 64] {
        let field = PupilField::new(4 * diameter, diameter, 0).expect("a valid field");
        let expected = contrast_of_phasor_sum(field.phasor_count()).powi(2);
        let mean = (0..PATTERNS)
            .map(|seed| {
                let pattern = field.clone().with_seed(seed).pattern();
                let contrast = Contrast::of(pattern.values().values()).expect("a bright pattern");
                contrast.value().powi(2)
            })
            .sum::<f64>()
            / PATTERNS as f64;
        // The contrast² of one pattern spreads by 1.53/C; four standard errors of the mean.
        let spread = contrast_squared_spread(field.effective_diameter()) / (PATTERNS as f64).sqrt();
        assert!(
            (mean - expected).abs() < 4.0 * spread,
            "C = {diameter}: {mean} | {expected}"
        );
    }
}

#[test]
fn autocovariance_is_that_of_the_pupil() {
    const PATTERNS: u64 = 60;
    let field = PupilField::new(128, 32, 0)
        .expect("a valid field")
        .with_phasors(Phasors::Gaussian);
    let lags = [[1, 0], [2, 0], [4, 0], [0, 3], [3, 3], [6, 0], [0, 8]];
    let mut sums = [0.0; 7];
    let mut squares = [0.0; 7];
    for seed in 0..PATTERNS {
        let pattern = field.clone().with_seed(seed).pattern();
        let covariance =
            autocovariance(pattern.values(), Boundary::Periodic).expect("a bright pattern");
        for (index, [x, y]) in lags.into_iter().enumerate() {
            let value = f64::from(*covariance.wrapped(x, y));
            sums[index] += value;
            squares[index] += value * value;
        }
    }
    for (index, [x, y]) in lags.into_iter().enumerate() {
        let mean = sums[index] / PATTERNS as f64;
        let variance = squares[index] / PATTERNS as f64 - mean * mean;
        let expected = field.amplitude_correlation([x as f64, y as f64]).norm_sqr();
        // Four standard errors, and the 1/N ≈ 1.2e−3 by which a sample mean lowers all lags.
        let tolerance = 4.0 * (variance / PATTERNS as f64).sqrt() + 2e-3;
        assert!(
            (mean - expected).abs() < tolerance,
            "lag ({x}, {y}): {mean} | {expected}"
        );
    }
}
