use num_complex::Complex;
use proptest::prelude::*;
use tem00_numerics::Grid;
use tem00_statistics::{
    GammaIntensity, PartiallyPolarised, WeightedSum, contrast_squared_spread, decorrelated_samples,
    kolmogorov_smirnov, pearson_correlation,
};

use super::*;
use crate::{Exposure, error::assert_refused};

/// Modes that fall by one ratio: the light of a Gaussian line on a relief.
fn modes() -> IncoherentSum {
    let powers = (0..20).map(|n| 0.5_f64.powi(n));
    IncoherentSum::weighted(&powers.collect::<Vec<_>>()).unwrap()
}

fn sums() -> Vec<IncoherentSum> {
    vec![
        IncoherentSum::equal(1).unwrap(),
        IncoherentSum::equal(5).unwrap(),
        IncoherentSum::weighted(&[3.0, 2.0, 0.5]).unwrap(),
        IncoherentSum::partially_polarised(0.4).unwrap(),
        modes(),
    ]
}

fn mean(values: &Grid<f32>, of: impl Fn(f64) -> f64) -> f64 {
    let sum: f64 = values.values().iter().map(|&i| of(f64::from(i))).sum();
    sum / values.values().len() as f64
}

const COUNT: &str = "count must be 1 to 1024 patterns";

#[test]
fn contrasts_are_those_of_the_laws() {
    for degree in [0.0, 1e-9, 0.3, 0.9, 1.0] {
        let sum = IncoherentSum::partially_polarised(degree).unwrap();
        let law = PartiallyPolarised::new(degree).unwrap();
        // Rounding.
        assert!(
            (sum.contrast() - law.contrast()).abs() < 1e-15,
            "P = {degree}"
        );
    }
    for weights in [&[1.0][..], &[2.0, 1.0], &[1e-3, 5.0, 0.0, 1e3]] {
        let sum = IncoherentSum::weighted(weights).unwrap();
        let law = WeightedSum::new(weights).unwrap();
        assert!(
            (sum.contrast() - law.contrast()).abs() < 1e-15,
            "{weights:?}"
        );
    }
    let equal = IncoherentSum::equal(9).unwrap();
    assert!((equal.contrast() - 1.0 / 3.0).abs() < 1e-15, "{equal:?}");
}

#[test]
fn polarised_light_is_one_pattern_and_unpolarised_two_equal_ones() {
    let weights = |degree| IncoherentSum::partially_polarised(degree).unwrap().weights;
    assert_eq!(weights(1.0), [1.0], "polarised");
    assert_eq!(weights(0.0), [0.5, 0.5], "unpolarised");
}

#[test]
fn means_are_one_and_contrasts_follow_the_shares() {
    const TILES: u64 = 16;
    const DIAMETER: usize = 32;
    let bias = 1.0 / PupilField::new(64, DIAMETER, 0).unwrap().phasor_count() as f64;
    for sum in sums() {
        let mut squared = 0.0;
        for seed in 0..TILES {
            let field = PupilField::new(64, DIAMETER, seed).unwrap();
            let pattern = sum
                .pattern(&field, PupilField::pattern)
                .unwrap()
                .into_values();
            // Parseval, for every pattern of the sum; rounding to f32.
            let mean_intensity = mean(&pattern, |i| i);
            assert!((mean_intensity - 1.0).abs() < 2e-6, "mean {mean_intensity}");
            squared += mean(&pattern, |i| (i - 1.0).powi(2)) / TILES as f64;
        }
        // One pattern's C² has the variance s², the mean product of two of them s²/4: together
        // Σw⁴ s² + 4 Σ_{i<j} wᵢ²wⱼ² s²/4. Four standard deviations, α = 6e−5.
        let [squares, fourths] = [2, 4].map(|power| {
            let powers = sum.weights().iter().map(|weight| weight.powi(power));
            powers.sum::<f64>()
        });
        let spread = contrast_squared_spread(DIAMETER as f64);
        let spread = spread * (0.5 * (squares * squares + fourths)).sqrt();
        let tolerance = 4.0 * spread / (TILES as f64).sqrt();
        let expected = squares * (1.0 - bias);
        assert!(
            (squared - expected).abs() < tolerance,
            "{squared} for {expected}"
        );
    }
}

#[test]
fn intensities_follow_the_laws_of_sums() {
    // Samples 5 apart at a speckle size of 4: beyond the first zero at 4.9.
    let samples = |sum: &IncoherentSum| -> Vec<f64> {
        let tile = |seed| {
            let field = PupilField::new(256, 64, seed).unwrap();
            let pattern = sum.pattern(&field, PupilField::pattern).unwrap();
            decorrelated_samples(pattern.values(), 5).unwrap()
        };
        [100, 200].into_iter().flat_map(tile).collect()
    };
    let check = |sum: &IncoherentSum, law: &dyn Fn(f64) -> f64| {
        let outcome = kolmogorov_smirnov(&samples(sum), law).unwrap();
        // α = 1e−4 each.
        assert!(outcome.p_value > 1e-4, "{:?}: {outcome:?}", sum.weights());
    };
    let gamma = GammaIntensity::new(3.0).unwrap();
    check(&IncoherentSum::equal(3).unwrap(), &|i| gamma.cumulative(i));
    let polarised = PartiallyPolarised::new(0.5).unwrap();
    let sum = IncoherentSum::partially_polarised(0.5).unwrap();
    check(&sum, &|i| polarised.cumulative(i));
    let sum = modes();
    let law = WeightedSum::new(sum.weights()).unwrap();
    check(&sum, &|i| law.cumulative(i));
}

#[test]
fn one_pattern_is_the_pattern_itself() {
    let field = PupilField::new(32, 16, 5).unwrap();
    let sum = IncoherentSum::equal(1).unwrap();
    let offset = |part: &PupilField| part.pattern_at([0.3, 0.1], 0.5);
    assert_eq!(
        sum.pattern(&field, offset).unwrap(),
        offset(&field),
        "bit for bit"
    );
}

#[test]
fn parts_are_independent_of_each_other_and_of_neighbouring_seeds() {
    let sum = IncoherentSum::equal(3).unwrap();
    let patterns: Vec<_> = [7, 8]
        .into_iter()
        .flat_map(|seed| {
            sum.fields(&PupilField::new(128, 64, seed).unwrap())
                .unwrap()
        })
        .map(|field| field.pattern())
        .collect();
    for (i, a) in patterns.iter().enumerate() {
        for b in &patterns[..i] {
            // The mean product of two patterns has half the spread of C², 0.765/C; five of them.
            let correlation = pearson_correlation(a.values(), b.values()).unwrap();
            assert!(correlation.abs() < 5.0 * 0.765 / 64.0, "{correlation}");
        }
    }
}

#[test]
fn both_together_split_every_pattern() {
    let lasers = IncoherentSum::weighted(&[2.0, 1.0]).unwrap();
    let polarised = IncoherentSum::partially_polarised(0.6).unwrap();
    let both = lasers.split_by(&polarised).unwrap();
    assert_eq!(both.weights().len(), 4, "{both:?}");
    let product = lasers.contrast() * polarised.contrast();
    assert!((both.contrast() - product).abs() < 1e-15, "{both:?}");
    let many = IncoherentSum::equal(100).unwrap();
    assert_refused(many.split_by(&many), COUNT, 10_000);
}

#[test]
fn sums_take_whatever_makes_a_pattern_of_a_field() {
    let field = PupilField::new(32, 16, 5).unwrap();
    let exposure = Exposure::default().with_image_drift([3.0, 0.0]).unwrap();
    let sum = IncoherentSum::partially_polarised(0.2).unwrap();
    let pattern = sum.pattern(&field, |part| exposure.pattern(part)).unwrap();
    let parts = sum.fields(&field).unwrap();
    let parts: Vec<_> = parts.iter().map(|part| exposure.pattern(part)).collect();
    for (x, y) in [(0, 0), (7, 30), (31, 2)] {
        let intensity = sum.intensity(|part| f64::from(parts[part].values()[(x, y)]));
        // Rounding to f32 of values below ten.
        let difference = intensity - f64::from(pattern.values()[(x, y)]);
        assert!(difference.abs() < 2e-6, "{difference} at {x}, {y}");
    }
}

#[test]
fn external_samples_make_one_pattern_only() {
    let samples = Grid::from_fn(20, 20, |x, y| Complex::cis((x * x + 3 * y) as f32));
    let field = PupilField::from_samples(samples, [40, 40], 2.5).unwrap();
    let one = IncoherentSum::equal(1).unwrap();
    assert_eq!(
        one.pattern(&field, PupilField::pattern),
        Ok(field.pattern())
    );
    let two = IncoherentSum::equal(2).unwrap();
    assert_eq!(
        two.pattern(&field, PupilField::pattern),
        Err(SpeckleError::NoSeed)
    );
}

#[test]
fn numbers_outside_their_range_are_refused() {
    for count in [0, 1025, usize::MAX] {
        assert_refused(IncoherentSum::equal(count), COUNT, count as f64);
    }
    assert_refused(IncoherentSum::weighted(&[]), COUNT, 0);
    assert_refused(IncoherentSum::weighted(&[0.0]), COUNT, 0);
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let weights = IncoherentSum::weighted(&[1.0, bad]);
        assert!(
            matches!(weights, Err(SpeckleError::Weight { index: 1, .. })),
            "{bad}"
        );
        let polarised = IncoherentSum::partially_polarised(bad);
        assert_refused(polarised, "degree must be between 0 and 1", bad);
    }
}

proptest! {
    #[test]
    fn shares_of_any_weights_sum_to_one(exponents in prop::collection::vec(-300.0..300.0_f64, 1..20)) {
        let weights: Vec<f64> = exponents.iter().map(|&e| 10.0_f64.powf(e)).collect();
        let sum = IncoherentSum::weighted(&weights).unwrap();
        let total: f64 = sum.weights().iter().sum();
        prop_assert!((total - 1.0).abs() < 1e-14, "{}", total);
        prop_assert!(sum.contrast() <= 1.0 + 1e-15, "{}", sum.contrast());
    }
}
