//! Trials with simulated frames, against the formulas of the budget.

use std::sync::atomic::AtomicBool;

use tem00::triangulation::{
    Budget, LineMethod, Setup, SetupDescription, Simulation, SimulationOptions, UncertaintySource,
    simulate,
};
use tem00_testkit::{assert_absolute, assert_relative};

fn setup_of(change: impl Fn(&mut SetupDescription)) -> Setup {
    let mut description = SetupDescription::default();
    description.sensor.quantum_efficiency = 0.6;
    description.sensor.exposure_time = 0.1e-3;
    description.detector.min_peak = 1.0;
    description.calibration_uncertainty = 1e-6;
    change(&mut description);
    Setup::new(description).unwrap()
}

fn simulated(setup: &Setup, trials: u32) -> Simulation {
    let options = SimulationOptions { trials, seed: 7 };
    simulate(setup, options, &|_| (), &AtomicBool::new(false)).unwrap()
}

#[test]
fn trials_in_light_of_a_linewidth_agree_with_first_order() {
    // Without a tilt there would be 1.9 times as much of the first, without heights 1.2 times of
    // the second. Rows that are averaged keep more of their noise than thin ones: 1.25 times. Of
    // the last there is a 75th, far below that of 1024 patterns.
    for (linewidth, half_angle, rms_height, correlation_length, columns) in [
        (20e-9, 0.0, 0.0, 0.0, 1),
        (10e-9, 0.0, 10e-6, 20e-6, 1),
        (0.0, 0.01, 0.0, 0.0, 1),
        (10e-9, 0.005, 1e-6, 0.0, 1),
        (0.0, 0.02, 0.0, 0.0, 16),
        (0.0, 0.3, 0.0, 0.0, 1),
    ] {
        let setup = setup_of(|d| {
            d.laser.light.linewidth = linewidth;
            d.laser.light.source_half_angle = half_angle;
            d.average.columns = columns;
            d.surface.relief.rms_height = rms_height;
            d.surface.relief.correlation_length = correlation_length;
        });
        let (budget, trials) = (Budget::new(&setup).unwrap(), simulated(&setup, 10));
        let speckle = trials.term(UncertaintySource::Speckle).unwrap();
        let left = setup.line().bandwidth.line_noise_ratio;
        assert!(left < 0.8, "{left}");
        let expected = budget.contribution(UncertaintySource::Speckle);
        let allowed = 0.05 * expected + 4.0 * speckle.standard_error;
        assert_absolute(speckle.uncertainty, expected, allowed);
    }
}

#[test]
fn trials_on_a_part_that_lets_light_in_agree_with_first_order() {
    // A diode, a wider one, and light of which the boundary reflects a tenth. Light of one
    // wavelength has too much speckle on the wide line: there the trials are quoted.
    for (linewidth, surface_fraction, method) in [
        (0.2e-9, 0.0, LineMethod::CentreOfGravity),
        (1e-9, 0.0, LineMethod::CentreOfGravity),
        (1e-9, 0.1, LineMethod::GaussianFit),
    ] {
        let setup = setup_of(|d| {
            d.laser.light.linewidth = linewidth;
            d.surface.subsurface.transport_length = 0.3e-3;
            d.surface.subsurface.absorption = 10.0;
            d.surface.subsurface.surface_fraction = surface_fraction;
            d.sensor.exposure_time = 0.2e-3;
            d.detector.method = method;
            d.detector.window = 21;
        });
        let (budget, trials) = (Budget::new(&setup).unwrap(), simulated(&setup, 20));
        for source in [UncertaintySource::Speckle, UncertaintySource::DetectorBias] {
            let found = trials.term(source).unwrap();
            let expected = budget.contribution(source);
            let allowed = 0.1 * expected + 4.0 * found.standard_error;
            assert_absolute(found.uncertainty, expected, allowed);
        }
    }
}

#[test]
fn trials_of_everything_at_once_are_the_sum_of_their_terms() {
    // Depolarised light of eight patterns, and so little of it that all terms count.
    let setup = setup_of(|d| {
        (d.surface.patterns, d.surface.polarisation) = (8, 0.0);
        d.laser.power *= 0.05;
        d.sensor.prnu = 0.05;
        d.detector.method = LineMethod::GaussianFit;
        d.detector.window = 15;
    });
    let trials = simulated(&setup, 40);
    let terms = UncertaintySource::ALL.map(|source| trials.term(source));
    let squares = terms.iter().flatten().map(|term| term.uncertainty.powi(2));
    let sum = squares.sum::<f64>().sqrt();
    let total = trials.total.unwrap();
    // Four standard errors of both, and 3 %: noise on top of speckle is not first order either.
    let allowed = 4.0 * 2.0_f64.sqrt() * total.standard_error + 0.03 * sum;
    assert_absolute(total.uncertainty, sum, allowed);
    assert!(trials.invalid < 0.01, "{}", trials.invalid);
    let first = Budget::new(&setup).unwrap();
    assert_relative(total.uncertainty, first.combined(), 0.1);
}
