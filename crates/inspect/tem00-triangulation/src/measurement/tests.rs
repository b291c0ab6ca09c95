use std::sync::atomic::{AtomicU64, Ordering};

use tem00_testkit::on_threads;
use tem00_uncertainty::PropagationOptions;

use super::*;
use crate::{SetupEnvironment, SimulationOptions, setup::tests::setup_of};

const HEIGHT: f64 = 4e-3;

/// A warm set-up whose laser plane stands next to the axis, and leans.
fn setup() -> Setup {
    setup_of(|d| {
        (d.laser.offset, d.laser.tilt) = (1e-3, -0.05);
        d.environment = SetupEnvironment {
            temperature_change: 5.0,
            base_expansion: 24e-6,
            mount_expansion: 12e-6,
        };
    })
}

fn input(setup: &Setup, quantity: SetupQuantity, relative: f64) -> (SetupQuantity, Input) {
    let estimate = quantity.value_in(setup.description());
    let input = Input::new(estimate, (relative * estimate).abs(), Distribution::Normal);
    (quantity, input.unwrap())
}

fn measurement(quantities: &[(SetupQuantity, f64)]) -> Measurement {
    let setup = setup();
    let quantities = quantities
        .iter()
        .map(|&(quantity, relative)| input(&setup, quantity, relative));
    let uncertainty = SetupUncertainty {
        height: Some(HEIGHT),
        quantities: quantities.collect(),
        ..SetupUncertainty::default()
    };
    Measurement::new(&setup, &uncertainty).unwrap()
}

/// Returns the height, in metres, at which the line of sight from the pupil C meets the plane of
/// the laser, in the plane x = 0:
///
/// ```text
/// C + t (sin(θ + φ), −cos(θ + φ))     tan φ = (v₀ − v) p / s     s = f L / (L − f)
/// y = y₀ + z tan τ                     s and y₀ with their expansions
/// ```
fn by_line_of_sight(values: [f64; 10], row: f64) -> f64 {
    let [distance, angle, focal_length, pitch, principal_row, ..] = values;
    let [.., offset, tilt, change, base, mount] = values;
    let in_focus = focal_length * distance / (distance - focal_length);
    let image_distance = in_focus * (1.0 + mount * change);
    let offset = offset + distance * libm::sin(angle) * base * change;
    let phi = libm::atan((principal_row - row) * pitch / image_distance);
    let (sin, cos) = (libm::sin(angle + phi), libm::cos(angle + phi));
    let [y, z] = [-distance * libm::sin(angle), distance * libm::cos(angle)];
    let t = (offset + z * libm::tan(tilt) - y) / (sin + cos * libm::tan(tilt));
    z - t * cos
}

const GEOMETRY: [SetupQuantity; 10] = [
    SetupQuantity::Distance,
    SetupQuantity::Angle,
    SetupQuantity::FocalLength,
    SetupQuantity::PixelPitch,
    SetupQuantity::PrincipalRow,
    SetupQuantity::LaserOffset,
    SetupQuantity::LaserTilt,
    SetupQuantity::TemperatureChange,
    SetupQuantity::BaseExpansion,
    SetupQuantity::MountExpansion,
];

#[test]
fn sensitivities_are_those_of_the_line_of_sight() {
    let measurement = measurement(&GEOMETRY.map(|quantity| (quantity, 1e-3)));
    let found = measurement.first_order().unwrap();
    let estimate = found.estimate();
    assert!((estimate - HEIGHT).abs() < 1e-12, "{estimate}");
    let row = measurement.setup.line_at(HEIGHT).unwrap().position;
    let values = GEOMETRY.map(|quantity| quantity.value_in(measurement.setup.description()));
    assert!(
        (by_line_of_sight(values, row) - HEIGHT).abs() < 1e-12,
        "the same height"
    );
    for (index, quantity) in GEOMETRY.into_iter().enumerate() {
        // A central difference, which errs by 10⁻⁸ of a function of powers and sines.
        let changed = |by: f64| {
            let mut values = values;
            values[index] *= 1.0 + by;
            by_line_of_sight(values, row)
        };
        let expected = (changed(1e-4) - changed(-1e-4)) / (2e-4 * values[index]);
        let sensitivity = found.contributions()[index].sensitivity;
        let error = (sensitivity / expected - 1.0).abs();
        assert!(error < 1e-6, "{quantity}: {sensitivity}, {expected}");
    }
}

#[test]
fn an_exact_set_up_has_the_uncertainty_of_its_budget() {
    let measurement = measurement(&[]);
    let budget = Budget::at_height(&measurement.setup, HEIGHT).unwrap();
    let found = measurement.first_order().unwrap();
    // The budget differentiates the position by the height, over 10⁻⁵ of the distance.
    let error = (found.combined() / budget.combined() - 1.0).abs();
    assert!(error < 1e-6, "{}, {}", found.combined(), budget.combined());
    let trials = measurement
        .propagation(PropagationOptions::default())
        .unwrap();
    // Two digits of u are stable.
    let error = (trials.uncertainty() - budget.combined()).abs();
    assert!(error < 1.65 * trials.tolerance(), "{error}");
}

#[test]
fn light_changes_noise_and_no_height() {
    let measurement = measurement(&[(SetupQuantity::Power, 0.01)]);
    let found = measurement.first_order().unwrap();
    assert!(found.contributions()[0].uncertainty < 1e-15, "{found:?}");
    let shot = MeasurementInput::Term(UncertaintySource::ShotNoise);
    let shot = measurement
        .sources()
        .iter()
        .position(|source| *source == shot)
        .unwrap();
    let mut values = measurement.inputs().estimates();
    values[shot] = 1e-3;
    let before = measurement.height_of(&values) - HEIGHT;
    values[0] *= 1.02;
    let after = measurement.height_of(&values) - HEIGHT;
    // Shot noise falls with the root of the power: 0.99 for 1.02, to first order; dark electrons
    // and the difference over ± 1 % leave 10⁻⁴.
    assert!((after / before - 0.99).abs() < 2e-4, "{before}, {after}");
}

#[test]
fn a_virtual_experiment_agrees_with_the_propagation_of_distributions() {
    let measurement = measurement(&[
        (SetupQuantity::Angle, 0.01),
        (SetupQuantity::Distance, 0.003),
    ]);
    let run = |trials, threads| {
        let options = SimulationOptions { trials, seed: 2 };
        let run = || measurement.virtual_experiment(options, &|_| (), &false.into());
        on_threads(threads, run).unwrap()
    };
    let found = run(300, 2);
    let error = found.error.unwrap();
    let expected = measurement
        .propagation(PropagationOptions::default())
        .unwrap();
    let deviation = (error.uncertainty - expected.uncertainty()).abs();
    // Of 300 independent set-ups; speckle's part is first order to some percent.
    assert!(
        deviation < 3.3 * error.standard_error,
        "{error:?}, {}",
        expected.uncertainty()
    );
    assert!(error.standard_error < 0.06 * error.uncertainty, "{error:?}");
    // The mean of 300 scatters by u/√300.
    let mean = (found.mean - HEIGHT).abs();
    assert!(mean < 3.3 * error.uncertainty / 300.0_f64.sqrt(), "{mean}");
    let interval = found.interval.unwrap();
    let ratio = interval.length() / expected.interval().length();
    // An end of 300 values scatters by 0.15 u: both by 6 % of the length.
    assert!((ratio - 1.0).abs() < 0.2, "{ratio}");
    assert_eq!(
        run(40, 1),
        run(40, 2),
        "the same bits for any number of threads"
    );
}

#[test]
fn an_input_whose_tail_is_not_possible_is_named() {
    // One standard uncertainty is possible, three or four are not.
    for (quantity, relative) in [
        (SetupQuantity::FocalLength, 0.4),
        (SetupQuantity::Distance, 0.4),
        (SetupQuantity::PixelPitch, 0.3),
    ] {
        let measurement = measurement(&[(SetupQuantity::PrincipalRow, 1e-3), (quantity, relative)]);
        let options = SimulationOptions {
            trials: 2_000,
            seed: 1,
        };
        let done = AtomicU64::new(0);
        let count = |trials| {
            done.fetch_max(trials, Ordering::Relaxed);
        };
        let refused = [
            measurement
                .propagation(PropagationOptions::default())
                .map(drop),
            measurement
                .decomposition(DecompositionOptions::default())
                .map(drop),
            measurement
                .virtual_experiment(options, &count, &false.into())
                .map(drop),
        ];
        let done = done.into_inner();
        assert!(
            done < 1_500,
            "{done} trials, of which one of the first 1,000 fails"
        );
        let start = format!(
            "the distribution of `{quantity}` must reach possible values only: it is normal"
        );
        for refused in refused {
            let told = refused.unwrap_err().to_string();
            assert!(told.starts_with(&start), "{told}");
        }
    }
}

#[test]
fn impossible_measurements_are_refused() {
    let setup = setup();
    let usual = SetupUncertainty::default();
    let angle = |relative| vec![input(&setup, SetupQuantity::Angle, relative)];
    let with_itself = Correlation {
        between: [0, 0],
        coefficient: 1.0,
    };
    let correlations = vec![with_itself];
    for (uncertainty, name) in [
        (
            SetupUncertainty {
                height: Some(1.0),
                ..usual.clone()
            },
            "height",
        ),
        // More than 89°.
        (
            SetupUncertainty {
                quantities: angle(3.0),
                ..usual.clone()
            },
            "angle",
        ),
        (
            SetupUncertainty {
                quantities: angle(0.01),
                correlations,
                ..usual
            },
            "between",
        ),
    ] {
        let refused = Measurement::new(&setup, &uncertainty).unwrap_err();
        assert_eq!(refused.parameter(), Some(name), "{refused}");
    }
}

#[test]
fn trials_can_be_cancelled() {
    let found =
        measurement(&[]).virtual_experiment(SimulationOptions::default(), &|_| (), &true.into());
    assert_eq!(found, Err(TriangulationError::Cancelled));
}
