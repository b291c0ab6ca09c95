use tem00_testkit::assert_absolute;

use super::*;
use crate::{Correlation, Distribution};

fn input(estimate: f64, uncertainty: f64) -> Input {
    Input::new(estimate, uncertainty, Distribution::Normal).unwrap()
}

fn independent(inputs: &[Input]) -> Inputs {
    Inputs::independent(inputs.to_vec()).unwrap()
}

#[test]
fn sensitivities_are_the_derivatives() {
    let uncertainties = [0.02, 1.0, 0.05];
    let inputs = [0.7, -2.0, 1e5].into_iter().zip(uncertainties);
    let inputs: Vec<Input> = inputs.map(|(estimate, u)| input(estimate, u)).collect();
    let inputs = independent(&inputs);
    let model = |x: &[f64]| libm::sin(x[0]) * libm::exp(x[1]) + 1e-3 * x[2] / x[0];
    let found = FirstOrder::new(&inputs, model).unwrap();
    let exp = libm::exp(-2.0);
    let expected = [
        libm::cos(0.7) * exp - 1e2 / 0.49,
        libm::sin(0.7) * exp,
        1e-3 / 0.7,
    ];
    let found = found.contributions().iter().zip(expected);
    for ((contribution, c), u) in found.zip(uncertainties) {
        // Rounding of values of 140 over steps of at least 1/20 of 0.02; over one of 1/20 the
        // second would err by 4e-5 without extrapolation.
        assert_absolute(contribution.sensitivity, c, 1e-9);
        assert_absolute(contribution.uncertainty, c.abs() * u, 1e-9);
    }
}

#[test]
fn a_falling_model_has_a_sensitivity_between_the_numbers_there_are() {
    // Numbers lie 1.5e-8 apart, which is 1.5 % of the uncertainty, and differences are exact.
    let sensitivity = |x: f64, u: f64, model: fn(f64) -> f64| {
        let found = FirstOrder::new(&independent(&[input(x, u)]), |x| model(x[0]));
        found.unwrap().contributions()[0].sensitivity
    };
    assert_absolute(sensitivity(1e8, 1e-6, |x| -4.0 * x), -4.0, 1e-12);
    assert_absolute(
        sensitivity(0.5, 0.1, |x| -libm::exp(x)),
        -libm::exp(0.5),
        1e-9,
    );
}

#[test]
fn fractions_of_the_variance_add_up_to_one() {
    let correlation = Correlation {
        between: [0, 1],
        coefficient: -0.8,
    };
    let all = vec![input(1.0, 0.3), input(2.0, 0.1), input(3.0, 0.2)];
    let inputs = Inputs::correlated(all, &[correlation]).unwrap();
    let found = FirstOrder::new(&inputs, |x| x[0] + 2.0 * x[1] + x[2]).unwrap();
    // 0.3² + 0.2² + 0.2² − 2 · 0.8 · 0.3 · 0.2
    let variance: f64 = 0.09 + 0.04 + 0.04 - 0.096;
    assert_absolute(found.combined(), variance.sqrt(), 1e-12);
    let expected = [0.042, -0.008, 0.04].map(|part| part / variance);
    for (found, part) in found.contributions().iter().zip(expected) {
        assert_absolute(found.variance_fraction, part, 1e-11);
    }
}

#[test]
fn what_is_fully_correlated_cancels() {
    let correlation = Correlation {
        between: [0, 1],
        coefficient: 1.0,
    };
    let inputs = Inputs::correlated(vec![input(5.0, 0.1); 2], &[correlation]).unwrap();
    let found = FirstOrder::new(&inputs, |x| x[0] - x[1]).unwrap();
    // The root of the rounding error of a variance of 0.01 · 10⁻¹⁶ · 10².
    assert!(found.combined() < 1e-8, "{found:?}");
    assert!(found.expanded(CoverageProbability::P95) < 2e-8, "{found:?}");
    // x₂ is made of both others: rounding leaves a variance of some 1e-16, of either sign.
    for turn in 1..12 {
        let (sin, cos) = (0.13 * f64::from(turn)).sin_cos();
        let with_last = |(input, coefficient)| Correlation {
            between: [input, 2],
            coefficient,
        };
        let given = [(0, sin), (1, cos)].map(with_last);
        let inputs = Inputs::correlated(vec![input(0.0, 1.0); 3], &given).unwrap();
        let found = FirstOrder::new(&inputs, |x| sin * x[0] + cos * x[1] - x[2]).unwrap();
        assert!(found.combined() < 1e-7, "{turn}: {found:?}");
    }
}

#[test]
fn a_model_with_a_stationary_point_has_no_first_order() {
    let inputs = independent(&[input(0.0, 0.005), input(0.0, 0.005)]);
    let found = FirstOrder::new(&inputs, |x| x[0] * x[0] + x[1] * x[1]).unwrap();
    // JCGM 101, table 6: the first order is 0 with an interval of no length.
    assert!(found.combined() == 0.0, "{found:?}");
    assert!(found.degrees_of_freedom().is_infinite(), "{found:?}");
    for part in found.contributions() {
        assert!(part.variance_fraction == 0.0, "{part:?}");
    }
}

#[test]
fn models_that_are_not_smooth_are_refused() {
    let inputs = independent(&[input(1.0, 0.1), input(0.3, 0.1)]);
    let step = |x: f64| if x < 0.302 { 0.0 } else { 1.0 };
    let kink = |x: f64| (x - 0.301).abs();
    for rough in [step as fn(f64) -> f64, kink] {
        // What is left open is a fraction: the unit of the result does not matter.
        let open = [1.0, 1000.0].map(|unit| {
            let found = FirstOrder::new(&inputs, |x| unit * (x[0] + rough(x[1])));
            match found {
                Err(UncertaintyError::NotDifferentiable { input: 1, open }) => open,
                found => panic!("{found:?}"),
            }
        });
        assert!((open[1] / open[0] - 1.0).abs() < 1e-6, "{open:?}");
    }
}

#[test]
fn values_that_are_not_finite_are_refused_with_the_inputs() {
    let inputs = independent(&[input(0.1, 0.2)]);
    let found = FirstOrder::new(&inputs, |x| x[0].sqrt());
    match found {
        Err(UncertaintyError::NotFinite { value, inputs }) => {
            assert!(value.is_nan() && inputs[0] < 0.0, "{value}, {inputs:?}");
        }
        found => panic!("{found:?}"),
    }
}
