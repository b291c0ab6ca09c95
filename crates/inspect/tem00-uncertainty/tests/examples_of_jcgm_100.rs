//! Worked examples of JCGM 100:2008, annex H, to the digits that the guide states.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

use tem00_uncertainty::{
    Correlation, CoverageProbability, Distribution, FirstOrder, Input, Inputs, coverage_factor,
};

fn input(estimate: f64, uncertainty: f64) -> Input {
    Input::new(estimate, uncertainty, Distribution::Normal).unwrap()
}

fn assert_within(what: &str, value: f64, stated: f64, tolerance: f64) {
    assert!(
        (value - stated).abs() <= tolerance,
        "{what}: {value}, stated {stated}"
    );
}

/// H.1: the length of a gauge block, in nm and °C.
#[test]
fn the_gauge_block_has_the_stated_uncertainty() {
    let inputs = [
        (50_000_623.0, 25.0, 18.0),
        (215.0, 5.8, 24.0),
        (0.0, 3.9, 5.0),
        (0.0, 6.7, 8.0),
        (11.5e-6, 1.2e-6, f64::INFINITY),
        (-0.1, 0.2, f64::INFINITY),
        (0.0, 0.35, f64::INFINITY),
        (0.0, 0.58e-6, 50.0),
        (0.0, 0.029, 2.0),
    ];
    let inputs =
        inputs.map(|(x, u, freedom)| input(x, u).with_degrees_of_freedom(freedom).unwrap());
    let model = |x: &[f64]| {
        let thermal = x[0] * (x[7] * (x[5] + x[6]) + x[4] * x[8]);
        x[0] + x[1] + x[2] + x[3] - thermal - 50_000_000.0
    };
    let inputs = Inputs::independent(inputs.to_vec()).unwrap();
    let found = FirstOrder::new(&inputs, model).unwrap();
    assert_within("l", found.estimate(), 838.0, 0.5);
    assert_within("u", found.combined(), 32.0, 0.5);
    // Table H.1: contributions to the last digit.
    for (index, stated, tolerance) in [(0, 25.0, 0.05), (7, 2.9, 0.05), (8, 16.6, 0.1)] {
        let found = found.contributions()[index].uncertainty;
        assert_within("contribution", found, stated, tolerance);
    }
    // 16.7 of contributions that are rounded to 0.1 nm; the guide goes on with 16 and u = 32 nm.
    assert_within("degrees of freedom", found.degrees_of_freedom(), 16.7, 0.2);
    let k = coverage_factor(16.0, CoverageProbability::P99);
    assert_within("U", k * found.combined().round(), 93.0, 0.5);
}

/// H.2: resistance, reactance and impedance of a circuit, in ohm, whose inputs are correlated.
#[test]
fn the_circuit_has_the_stated_uncertainties() {
    let inputs = vec![
        input(4.9990, 0.0032),
        input(19.6610e-3, 0.0095e-3),
        input(1.044_46, 0.000_75),
    ];
    let correlations =
        [([0, 1], -0.36), ([0, 2], 0.86), ([1, 2], -0.65)].map(|(between, coefficient)| {
            Correlation {
                between,
                coefficient,
            }
        });
    let inputs = Inputs::correlated(inputs, &correlations).unwrap();
    // Table H.4.
    for (name, model, value, uncertainty) in [
        (
            "R",
            (|x| x[0] / x[1] * libm::cos(x[2])) as fn(&[f64]) -> f64,
            127.732,
            0.071,
        ),
        ("X", |x| x[0] / x[1] * libm::sin(x[2]), 219.847, 0.295),
        ("Z", |x| x[0] / x[1], 254.260, 0.236),
    ] {
        let found = FirstOrder::new(&inputs, model).unwrap();
        assert_within(name, found.estimate(), value, 0.0005);
        // The guide rounds the coefficients to 0.01.
        let [a, b, c] = [0, 1, 2].map(|index: usize| found.contributions()[index].uncertainty);
        let left_open = 0.005 * (a * b + a * c + b * c) / found.combined();
        assert_within(name, found.combined(), uncertainty, 0.0005 + left_open);
    }
}
