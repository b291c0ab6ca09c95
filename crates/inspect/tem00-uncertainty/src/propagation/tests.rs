use tem00_testkit::{assert_absolute, assert_relative, on_threads, refuses};

use super::*;
use crate::{Decomposition, DecompositionOptions, Distribution, Input};

fn normal() -> Inputs {
    Inputs::independent(vec![Input::new(3.0, 2.0, Distribution::Normal).unwrap()]).unwrap()
}

fn propagated(options: PropagationOptions) -> Result<Propagation, UncertaintyError> {
    Propagation::new(&normal(), |x| x[0], options)
}

#[test]
fn tolerances_are_half_a_unit_of_the_last_digit() {
    // The examples of JCGM 101, § 7.9.2, and numbers that gain a digit when they are rounded.
    for (number, digits, expected) in [
        (0.000_35, 2, 0.000_005),
        (0.000_35, 1, 0.000_05),
        (2.0, 2, 0.05),
        (0.0996, 2, 0.005),
        (9.6, 1, 5.0),
        (35.0, 3, 0.05),
        (0.0, 2, 0.0),
    ] {
        let found = numerical_tolerance(number, digits);
        assert_relative(found, expected, 1e-15);
    }
}

#[test]
fn trials_end_once_their_results_are_stable() {
    let found = propagated(PropagationOptions::default()).unwrap();
    assert!(found.is_stable(), "{}", found.largest_error());
    let interval = found.interval();
    // The tolerance bounds two standard deviations; of three results and a seed none leaves 3.3.
    for (value, expected) in [
        (found.estimate(), 3.0),
        (found.uncertainty(), 2.0),
        (interval.low, 3.0 - 2.0 * 1.959_964),
        (interval.high, 3.0 + 2.0 * 1.959_964),
    ] {
        let error = (value - expected).abs();
        assert!(error < 1.65 * found.tolerance(), "{value}, {expected}");
    }
    // The ends of a normal quantity's interval scatter by 2.67 u/√M: 2 · 2.67 · 2/√M = 0.05.
    let trials = found.values().len();
    assert!((20_000..80_000).contains(&trials), "{trials} trials");
    assert!(found.values().is_sorted(), "values are sorted");
}

#[test]
fn a_normal_input_of_few_readings_has_the_interval_of_students_t() {
    let normal = Input::new(3.0, 2.0, Distribution::Normal).unwrap();
    let options = PropagationOptions {
        tolerance_divisor: 5.0,
        digits: 1,
        ..PropagationOptions::default()
    };
    // The 0.975 quantiles of scipy.stats.t; a rectangular input keeps its limits, the others the
    // standard deviation u √(ν / (ν − 2)).
    let rectangular = Input::new(3.0, 2.0, Distribution::Rectangular).unwrap();
    for (input, freedom, quantile, deviation) in [
        (normal, 4.0, 2.776_445, 2_f64.sqrt()),
        (normal, 8.0, 2.306_004, (8_f64 / 6.0).sqrt()),
        (rectangular, 4.0, 0.95 * 3_f64.sqrt(), 1.0),
    ] {
        let input = input.with_degrees_of_freedom(freedom).unwrap();
        let inputs = Inputs::independent(vec![input]).unwrap();
        let found = Propagation::new(&inputs, |x| x[0], options).unwrap();
        let (interval, tolerance) = (found.interval(), 1.65 * found.tolerance());
        for (value, expected) in [
            (found.uncertainty(), 2.0 * deviation),
            (interval.low, 3.0 - 2.0 * quantile),
            (interval.high, 3.0 + 2.0 * quantile),
        ] {
            assert_absolute(value, expected, tolerance);
        }
        let first_order = FirstOrder::new(&inputs, |x| x[0]).unwrap();
        let is_t = input.distribution() == Distribution::StudentT;
        let validation = found.validate(&first_order);
        assert_eq!(validation.is_valid(), is_t, "{input:?}");
        // Half of 10⁰ of 2 or 3, and a fifth of it for the trials.
        let tolerances = [validation.tolerance, found.tolerance()];
        assert!((tolerances[0] - 0.5).abs() < 1e-15, "{tolerances:?}");
        assert!((tolerances[1] - 0.1).abs() < 1e-15, "{tolerances:?}");
    }
}

#[test]
fn a_first_order_is_valid_if_both_ends_agree() {
    for (low, high, is_valid) in [(1.0, 1.0, true), (0.0, 1.1, false), (1.1, 0.0, false)] {
        let found = Validation {
            low,
            high,
            tolerance: 1.0,
        };
        assert_eq!(found.is_valid(), is_valid, "{found:?}");
    }
}

#[test]
fn inputs_without_a_variance_are_refused_by_trials_alone() {
    let normal = Input::new(3.0, 2.0, Distribution::Normal).unwrap();
    for freedom in [1.0, 2.0] {
        let input = normal.with_degrees_of_freedom(freedom).unwrap();
        let inputs = Inputs::independent(vec![input]).unwrap();
        let trials = Propagation::new(&inputs, |x| x[0], PropagationOptions::default());
        let parts = Decomposition::new(&inputs, |x| x[0], DecompositionOptions::default());
        for refused in [trials.map(drop), parts.map(drop)] {
            assert_eq!(refused.unwrap_err().parameter(), "degrees_of_freedom");
        }
        let first_order = FirstOrder::new(&inputs, |x| x[0]).unwrap();
        assert!((first_order.combined() - 2.0).abs() < 1e-9, "{freedom}");
    }
}

#[test]
fn trials_that_are_not_enough_say_so() {
    let options = PropagationOptions {
        digits: 4,
        max_trials: 59_999,
        ..PropagationOptions::default()
    };
    let found = propagated(options).unwrap();
    assert!(!found.is_stable(), "{}", found.largest_error());
    assert_eq!(found.values().len(), 50_000, "whole blocks only");
}

#[test]
fn a_model_without_uncertainty_is_stable_at_once() {
    let found = Propagation::new(&normal(), |_| 7.0, PropagationOptions::default()).unwrap();
    assert!(
        found.is_stable() && found.uncertainty() == 0.0,
        "{}",
        found.uncertainty()
    );
    assert_eq!(found.values().len(), 20_000, "two blocks");
}

#[test]
fn options_outside_their_range_are_refused() {
    let min = PropagationOptions {
        max_trials: 20_000,
        ..PropagationOptions::default()
    };
    refuses!(options = min => propagated(options);
        options.digits: [0, 5],
        options.tolerance_divisor: [0.9, f64::NAN, f64::INFINITY],
        options.max_trials: [19_999],
    );
    assert_eq!(propagated(min).unwrap().values().len(), 20_000);
    let rare = propagated(PropagationOptions {
        probability: CoverageProbability::new(0.9999).unwrap(),
        max_trials: 1_999_999,
        ..min
    });
    assert_eq!(rare.unwrap_err().parameter(), "max_trials", "blocks of 10⁶");
}

#[test]
fn values_without_a_finite_variance_are_refused() {
    let options = PropagationOptions::default();
    let found = Propagation::new(&normal(), |x| 1e200 * x[0], options);
    assert_eq!(found.unwrap_err().parameter(), "model", "overflow");
}

#[test]
fn inputs_that_leave_what_is_possible_are_named() {
    let input = |estimate, shape| Input::new(estimate, 1.0, shape).unwrap();
    let of = |shape: Distribution| {
        let inputs = vec![input(9.0, Distribution::Normal), input(1.5, shape)];
        Inputs::independent(inputs).unwrap()
    };
    let root = |x: &[f64]| x[0] + x[1].sqrt();
    for shape in [
        Distribution::Normal,
        Distribution::Rectangular,
        Distribution::Triangular,
    ] {
        let propagated = Propagation::new(&of(shape), root, PropagationOptions::default());
        let parts = Decomposition::new(&of(shape), root, DecompositionOptions::default());
        for found in [propagated.map(drop), parts.map(drop)] {
            match found {
                Err(UncertaintyError::ImpossibleDraw {
                    input: 1,
                    distribution,
                    value,
                }) => {
                    assert!(distribution == shape && value < 0.0, "{shape} {value}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
    // An arcsine distribution ends before, and of two inputs that only together reach impossible
    // values neither is named.
    let arcsine = of(Distribution::Arcsine);
    assert!(Propagation::new(&arcsine, root, PropagationOptions::default()).is_ok());
    let both = |x: &[f64]| (12.0 - x[0] - x[1]).sqrt();
    let found = Propagation::new(&arcsine, both, PropagationOptions::default());
    assert!(
        matches!(found, Err(UncertaintyError::NotFinite { .. })),
        "{found:?}"
    );
}

#[test]
fn the_same_seed_gives_the_same_bits_for_any_number_of_threads() {
    let of_threads = |threads| {
        on_threads(threads, || {
            propagated(PropagationOptions::default()).unwrap()
        })
    };
    let single = of_threads(1);
    for threads in [2, 7] {
        assert_eq!(of_threads(threads), single, "{threads} threads");
    }
    let other = PropagationOptions {
        seed: 1,
        ..PropagationOptions::default()
    };
    assert_ne!(
        propagated(other).unwrap().values(),
        single.values(),
        "another seed"
    );
}
