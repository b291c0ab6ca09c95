use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::{
    exponential_cumulative,
    synthetic::{exponential_sample, exponential_samples},
};

const ROUNDS: u32 = 2_000;

/// Asserts that the p-values of a true hypothesis are uniform, by their counts in ten bins.
fn assert_uniform(p_value: impl FnMut(u32) -> f64) {
    let mut p_values: Vec<f64> = (0..ROUNDS).map(p_value).collect();
    p_values.sort_unstable_by(f64::total_cmp);
    let below = |tenth: u32| {
        let limit = f64::from(tenth) / 10.0;
        p_values.partition_point(|&p| p < limit) as f64
    };
    let expected = f64::from(ROUNDS) / 10.0;
    let contribution = |tenth| {
        let count = if tenth == 9 {
            f64::from(ROUNDS) - below(9)
        } else {
            below(tenth + 1) - below(tenth)
        };
        (count - expected) * (count - expected) / expected
    };
    let distance: f64 = (0..10).map(contribution).sum();
    // Nine degrees of freedom exceed 27.877 with the probability 0.001 (Abramowitz & Stegun
    // 1964, table 26.8).
    assert!(distance < 27.877, "not uniform: χ² = {distance}");
}

/// A normal deviate by the Box–Muller method.
fn normal(rng: &mut ChaCha8Rng) -> f64 {
    (2.0 * exponential_sample(rng)).sqrt() * (2.0 * PI * rng.random::<f64>()).cos()
}

/// Samples whose empirical distribution has the distance `distance` from the uniform law.
fn samples_at_distance(count: u32, distance: f64) -> Vec<f64> {
    let shifted = |i| (f64::from(i) / f64::from(count) + distance).min(1.0);
    (0..count).map(shifted).collect()
}

#[test]
fn kolmogorov_distribution_has_the_tabulated_critical_values() {
    // Smirnov 1948, to the digits of the table: a step of 5e−5 in λ changes p by 4λ · 5e−5.
    for (lambda, p) in [(1.3581, 0.05), (1.6276, 0.01), (1.9495, 0.001)] {
        assert_relative(kolmogorov_survival(lambda), p, 4.0 * lambda * 5e-5);
    }
    // The median, where the other series is summed.
    assert_absolute(kolmogorov_survival(0.827_57), 0.5, 1e-5);
    let (below, above) = (1.0 - 1e-12, 1.0);
    assert_absolute(
        kolmogorov_survival(below),
        kolmogorov_survival(above),
        1e-11,
    );
    assert_absolute(kolmogorov_survival(0.0), 1.0, 1e-15);
}

#[test]
fn kolmogorov_smirnov_is_close_to_the_exact_table_for_few_samples() {
    // Count, critical distance (Miller 1956), exact p, accuracy stated in the documentation.
    let table = [
        (5, 0.563_28, 0.05, 0.03),
        (5, 0.668_53, 0.01, 0.14),
        (10, 0.409_25, 0.05, 0.02),
        (10, 0.488_93, 0.01, 0.05),
        (20, 0.294_08, 0.05, 0.015),
        (20, 0.352_41, 0.01, 0.015),
        (100, 0.134_03, 0.05, 0.015),
        (100, 0.160_81, 0.01, 0.015),
    ];
    for (count, distance, p, tolerance) in table {
        let samples = samples_at_distance(count, distance);
        let outcome = kolmogorov_smirnov(&samples, |x| x).unwrap();
        assert_absolute(outcome.statistic, distance, 1e-14);
        assert_relative(outcome.p_value, p, tolerance);
    }
}

#[test]
fn both_sides_of_a_step_count() {
    // One sample at 0.2: the empirical distribution jumps from 0 to 1 there.
    let outcome = kolmogorov_smirnov(&[0.2], |x| x).unwrap();
    assert_absolute(outcome.statistic, 0.8, 1e-15);
    let outcome = kolmogorov_smirnov(&[0.9], |x| x).unwrap();
    assert_absolute(outcome.statistic, 0.9, 1e-15);
}

#[test]
fn p_values_of_kolmogorov_and_smirnov_are_uniform() {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    assert_uniform(|_| {
        let samples = exponential_samples(100, &mut rng);
        let outcome = kolmogorov_smirnov(&samples, exponential_cumulative).unwrap();
        outcome.p_value
    });
}

#[test]
fn p_values_of_pearson_are_uniform() {
    let mut rng = ChaCha8Rng::seed_from_u64(22);
    // Three bins expect too little: 2 merge with 3, and 4 at the end joins 50.
    let expected = [2.0, 3.0, 100.0, 61.0, 80.0, 50.0, 4.0];
    assert_uniform(|_| {
        let mut observed = [0; 7];
        for _ in 0..300 {
            let mut left = 300.0 * rng.random::<f64>();
            let crossed = |e: &f64| {
                left -= e;
                left < 0.0
            };
            let bin = expected.iter().position(crossed).unwrap_or(6);
            observed[bin] += 1;
        }
        chi_squared(&observed, &expected, 1).unwrap().p_value
    });
}

#[test]
fn p_values_of_student_are_uniform() {
    let mut rng = ChaCha8Rng::seed_from_u64(23);
    assert_uniform(|_| {
        let samples: Vec<f64> = (0..6).map(|_| 4.0 + 3.0 * normal(&mut rng)).collect();
        t_test_mean(&samples, 4.0).unwrap().p_value
    });
}

#[test]
fn chi_squared_has_its_closed_forms() {
    // Bins of 100 expected, one pair of which is off by ±d: χ² = 2d²/100.
    for off in [0_u64, 3, 9, 20, 60] {
        let statistic = 2.0 * (off * off) as f64 / 100.0;
        let p = |bins: usize, constraints| {
            let mut observed = vec![100; bins];
            observed[0] += off;
            observed[1] -= off;
            let outcome = chi_squared(&observed, &vec![100.0; bins], constraints).unwrap();
            assert_relative(outcome.statistic, statistic, 1e-14);
            outcome.p_value
        };
        let half = 0.5 * statistic;
        // One, two and four degrees of freedom; exp loses 36 · 2⁻⁵³ in its argument.
        let closed = [
            (p(2, 1), libm::erfc(half.sqrt())),
            (p(2, 0), (-half).exp()),
            (p(5, 1), (-half).exp() * (1.0 + half)),
        ];
        for (value, exact) in closed {
            assert_relative(value, exact, 1e-12);
        }
    }
}

#[test]
fn chi_squared_has_its_tabulated_values() {
    // Degrees of freedom, 10⁵ χ², p: Abramowitz & Stegun 1964, table 26.8.
    let table = [
        (1, 384_146_u64, 0.05),
        (5, 1_508_630, 0.01),
        (10, 1_830_700, 0.05),
        (30, 5_970_300, 0.001),
        (100, 12_434_200, 0.05),
    ];
    for (freedom, statistic, p) in table {
        let bins = freedom + 1;
        // χ² = 2 off² / 10¹².
        let off = (5_000_000 * statistic).isqrt();
        let mut observed = vec![1_000_000_000_000; bins];
        observed[0] += off;
        observed[1] -= off;
        let outcome = chi_squared(&observed, &vec![1e12; bins], 1).unwrap();
        // Half of the table's last digit, 5e−4 at most, and p falls as exp(−χ²/2) or slower.
        assert_relative(outcome.p_value, p, 3e-4);
    }
}

#[test]
fn sparse_bins_are_merged_until_they_expect_five() {
    let observed = [1, 2, 3, 4, 5, 6];
    let merged = merge_sparse_bins(&observed, &[3.0, 2.0, 7.0, 0.0, 4.9, 0.2]).unwrap();
    assert_eq!(merged, [(3.0, 5.0), (3.0, 7.0), (15.0, 4.9 + 0.2)]);
    let merged = merge_sparse_bins(&observed, &[3.0, 2.0, 7.0, 0.0, 4.0, 0.5]).unwrap();
    assert_eq!(merged, [(3.0, 5.0), (18.0, 11.5)]);
    assert_eq!(
        chi_squared(&[3, 4], &[2.0, 2.0], 1),
        Err(StatisticsError::DegreesOfFreedom {
            bins: 0,
            constraints: 1
        })
    );
}

#[test]
fn student_has_its_tabulated_critical_values() {
    // Degrees of freedom, two-sided critical t, p: Abramowitz & Stegun 1964, table 26.10.
    let table = [
        (1_u32, 12.706, 0.05),
        (4, 4.604, 0.01),
        (10, 2.228, 0.05),
        (30, 3.646, 0.001),
    ];
    for (freedom, t, p) in table {
        let samples: Vec<f64> = (0..=freedom).map(|i| f64::from(i * i)).collect();
        let moments = crate::Moments::from_samples(&samples).unwrap();
        let mean = moments.mean() + t * moments.standard_error();
        let outcome = t_test_mean(&samples, mean).unwrap();
        assert_relative(outcome.statistic, t, 1e-13);
        // Half of the table's last digit, 5e−4, over t and a power of −31 at most.
        assert_relative(outcome.p_value, p, 2e-3);
    }
}

#[test]
fn extreme_input_gives_a_probability() {
    let outcome = chi_squared(&[u64::MAX, 0], &[5.0, 1e300], 1).unwrap();
    assert!((0.0..=1e-300).contains(&outcome.p_value), "{outcome:?}");
    let outcome = chi_squared(&[7, 7], &[7.0, 7.0], 1).unwrap();
    assert_absolute(outcome.p_value, 1.0, 1e-15);
    let tiny = [5e-324, 0.0, 1e-323];
    let outcome = t_test_mean(&tiny, f64::MAX).unwrap();
    assert!((0.0..=1e-3).contains(&outcome.p_value), "{outcome:?}");
    let outcome = t_test_mean(&tiny, 5e-324).unwrap();
    assert_absolute(outcome.p_value, 1.0, 1e-15);
}
