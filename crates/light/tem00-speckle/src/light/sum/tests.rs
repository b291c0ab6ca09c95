use proptest::prelude::*;
use tem00_statistics::{
    GammaIntensity, IncoherentSum, PartiallyPolarised, estimate::decorrelated_samples,
    kolmogorov_smirnov, pearson_correlation,
};
use tem00_testkit::assert_absolute;

use super::*;
use crate::Exposure;

/// Fractions that fall by one ratio: the modes of a Gaussian line on a relief.
fn modes() -> Vec<f64> {
    let powers = (0..20).map(|n| 0.5_f64.powi(n));
    incoherent_fractions(1, 1.0, &powers.collect::<Vec<_>>()).unwrap()
}

fn equal(patterns: usize) -> Vec<f64> {
    incoherent_fractions(patterns, 1.0, &[1.0]).unwrap()
}

fn polarised(degree: f64) -> Vec<f64> {
    incoherent_fractions(1, degree, &[1.0]).unwrap()
}

fn pattern(fractions: &[f64], field: &PupilField) -> SpecklePattern {
    let fields = field.independent(fractions.len()).unwrap();
    let patterns = fields.iter().map(PupilField::pattern);
    SpecklePattern::weighted_mean(fractions, patterns).unwrap()
}

#[test]
fn contrasts_are_those_of_the_laws() {
    for degree in [0.0, 1e-9, 0.3, 0.9, 1.0] {
        let sum = IncoherentSum::new(&polarised(degree)).unwrap();
        let law = PartiallyPolarised::new(degree).unwrap();
        // Rounding.
        assert_absolute(sum.contrast(), law.contrast(), 1e-15);
    }
    for weights in [&[1.0][..], &[2.0, 1.0], &[1e-3, 5.0, 0.0, 1e3]] {
        let fractions = incoherent_fractions(9, 0.4, weights).unwrap();
        let sum = IncoherentSum::new(&fractions).unwrap().contrast();
        let weights = IncoherentSum::new(weights).unwrap().contrast();
        let law = PartiallyPolarised::new(0.4).unwrap().contrast() / 3.0 * weights;
        assert!((sum - law).abs() < 1e-15, "{weights:?}");
    }
}

#[test]
fn parts_without_light_are_left_out() {
    assert_eq!(polarised(1.0), [1.0], "polarised");
    assert_eq!(polarised(0.0), [0.5, 0.5], "unpolarised");
    let lasers = incoherent_fractions(1, 1.0, &[3.0, 0.0, 1.0]).unwrap();
    assert_eq!(lasers, [0.75, 0.25], "one laser is dark");
}

#[test]
fn intensities_follow_the_laws_of_sums() {
    // Samples 5 apart at a speckle size of 4: beyond the first zero at 4.9.
    let samples = |fractions: &[f64]| -> Vec<f64> {
        let tile = |seed| {
            let pattern = pattern(fractions, &PupilField::new(256, 64, seed).unwrap());
            decorrelated_samples(pattern.values(), 5).unwrap()
        };
        [100, 200].into_iter().flat_map(tile).collect()
    };
    let check = |fractions: &[f64], law: &dyn Fn(f64) -> f64| {
        let outcome = kolmogorov_smirnov(&samples(fractions), law).unwrap();
        // α = 1e−4 each.
        assert!(outcome.p_value > 1e-4, "{fractions:?}: {outcome:?}");
    };
    let gamma = GammaIntensity::new(3.0).unwrap();
    check(&equal(3), &|i| gamma.cumulative(i));
    let law = PartiallyPolarised::new(0.5).unwrap();
    check(&polarised(0.5), &|i| law.cumulative(i));
    let law = IncoherentSum::new(&modes()).unwrap();
    check(&modes(), &|i| law.cumulative(i));
}

#[test]
fn one_pattern_is_the_pattern_itself() {
    let field = PupilField::new(32, 16, 5).unwrap();
    assert_eq!(pattern(&[2.0], &field), field.pattern(), "bit for bit");
}

#[test]
fn parts_are_independent_of_each_other_and_of_neighbouring_seeds() {
    let patterns: Vec<_> = [7, 8]
        .into_iter()
        .flat_map(|seed| {
            let field = PupilField::new(128, 64, seed).unwrap();
            field.independent(3).unwrap()
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
fn means_take_whatever_makes_a_pattern_of_a_field() {
    let field = PupilField::new(32, 16, 5).unwrap();
    let exposure = Exposure::default().with_image_drift([3.0, 0.0]).unwrap();
    let fields = field.independent(2).unwrap();
    let parts: Vec<_> = fields.iter().map(|part| exposure.pattern(part)).collect();
    let mean = SpecklePattern::weighted_mean(&[3.0, 2.0], parts.clone()).unwrap();
    for at in [(0, 0), (7, 30), (31, 2)] {
        let [a, b] = [0, 1].map(|part: usize| f64::from(parts[part].values()[at]));
        // Rounding to f32 of values below ten.
        assert_absolute(0.6 * a + 0.4 * b, f64::from(mean.values()[at]), 2e-6);
    }
}

proptest! {
    #[test]
    fn fractions_of_any_weights_sum_to_one(
        exponents in prop::collection::vec(-300.0..300.0_f64, 1..20),
    ) {
        let weights: Vec<f64> = exponents.iter().map(|&e| 10.0_f64.powf(e)).collect();
        let total: f64 = incoherent_fractions(2, 0.3, &weights).unwrap().iter().sum();
        prop_assert!((total - 1.0).abs() < 1e-14, "{}", total);
    }
}
