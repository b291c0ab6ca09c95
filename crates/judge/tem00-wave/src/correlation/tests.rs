use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::random::{Purpose, Random};

/// Pairs of white fields with the correlation γ.
fn pair(random: &mut Random, gamma: f64, size: usize) -> [Grid<Complex<f64>>; 2] {
    let mut white = || {
        let values = (0..size).map(|_| random.complex_gaussian()).collect();
        Grid::from_vec(size, 1, values).expect("a row")
    };
    let (first, other) = (white(), white());
    let second = Grid::from_fn(size, 1, |x, y| {
        gamma.sqrt() * first[(x, y)] + (1.0 - gamma).sqrt() * other[(x, y)]
    });
    [first, second]
}

#[test]
fn correlation_and_its_two_errors_are_those_of_many_trials() {
    const SPECKLES: usize = 100;
    const REPETITIONS: usize = 8;
    const TRIALS: usize = 1_000;
    let mut random = Random::new(3, Purpose::Amplitudes);
    for gamma in [0.1, 0.5, 0.9] {
        let (mut values, mut jackknife, mut closed) = (Vec::new(), 0.0, 0.0);
        for _ in 0..TRIALS {
            let mut correlation = FieldCorrelation::default();
            for _ in 0..REPETITIONS {
                let [first, second] = pair(&mut random, gamma, SPECKLES);
                correlation.add(&first, &second);
            }
            let independent = (SPECKLES * REPETITIONS) as f64;
            let by_scatter = correlation.estimate().expect("eight repetitions");
            let by_count = correlation
                .estimate_from_speckles(independent)
                .expect("light");
            assert_absolute(by_scatter.value, by_count.value, 1e-15);
            values.push(by_scatter.value);
            jackknife += by_scatter.standard_error.powi(2) / TRIALS as f64;
            closed += by_count.standard_error.powi(2) / TRIALS as f64;
        }
        let count = (SPECKLES * REPETITIONS) as f64;
        let mean = Estimate::of_repetitions(&values).expect("trials");
        let bias = (1.0 - gamma).powi(2) / count;
        let off = (mean.value - gamma - bias) / mean.standard_error;
        assert!(off.abs() < 4.0, "γ = {gamma}: {off} standard errors off");
        let variance = mean.standard_error.powi(2) * TRIALS as f64;
        // The variance over 1000 trials scatters by √(2/1000) = 4.5 %; four of them. The jackknife
        // of 8 repetitions is biased upwards by 1/8 at most, the closed form of first order by 1/K.
        assert_relative(closed, variance, 0.18);
        let ratio = jackknife / variance;
        assert!(ratio > 0.82 && ratio < 1.31, "γ = {gamma}: {ratio}");
    }
}

#[test]
fn the_scale_of_a_field_does_not_matter() {
    let mut random = Random::new(4, Purpose::Amplitudes);
    let [first, second] = pair(&mut random, 0.5, 50);
    let mut plain = FieldCorrelation::default();
    plain.add(&first, &second);
    let mut scaled = FieldCorrelation::default();
    scaled.add(&first.map(|u| u * 1e-250), &second.map(|u| u * 1e250));
    let (a, b) = (plain.value().unwrap(), scaled.value().unwrap());
    assert!((a - b).abs() < 1e-14, "{a} {b}");
}

#[test]
fn darkness_and_too_few_repetitions_have_no_answer() {
    let dark = Grid::filled(4, 4, Complex::new(0.0, 0.0));
    let bright = Grid::filled(4, 4, Complex::new(1.0, 0.0));
    let mut correlation = FieldCorrelation::default();
    assert_eq!(correlation.value(), None);
    correlation.add(&dark, &bright);
    assert_eq!(correlation.value(), None);
    assert_eq!(correlation.estimate_from_speckles(16.0), None);
    let mut single = FieldCorrelation::default();
    single.add(&bright, &bright);
    assert_eq!(single.estimate(), None);
    assert_eq!(single.estimate_from_speckles(0.5), None);
    assert_eq!(Estimate::of_repetitions(&[1.0]), None);
}
