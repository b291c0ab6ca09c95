//! How often intervals of 95 % hold the true height, over measurements with set-ups that are drawn from what is known.

use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use tem00_numerics::cast::to_usize;
use tem00_uncertainty::{CoverageInterval, CoverageProbability, IntervalKind};

use super::*;

const MEASUREMENTS: usize = 10_000;

/// Heights at which intervals are computed; between them they change evenly.
const NODES: usize = 9;

/// An uncertain set-up and the true height.
struct Case {
    angle: f64,
    height: f64,
    quantities: Vec<(SetupQuantity, Input)>,
}

fn uncertain(
    quantity: SetupQuantity,
    estimate: f64,
    u: f64,
    shape: Distribution,
) -> (SetupQuantity, Input) {
    (quantity, Input::new(estimate, u, shape).unwrap())
}

impl Case {
    fn setup(&self) -> Setup {
        let mut description = description();
        description.camera.angle = self.angle.to_radians();
        Setup::new(description).unwrap()
    }

    fn measurement(&self, setup: &Setup, height: f64) -> Measurement {
        let uncertainty = SetupUncertainty {
            height: Some(height),
            quantities: self.quantities.clone(),
            ..SetupUncertainty::default()
        };
        Measurement::new(setup, &uncertainty).unwrap()
    }

    /// Heights that set-ups measure, each drawn, all evaluated with the one that is described.
    fn measured(&self, setup: &Setup) -> Vec<f64> {
        let measurement = self.measurement(setup, self.height);
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut values = measurement.inputs().estimates();
        let measure = |_| {
            measurement.inputs().draw(&mut random, &mut values);
            let (quantities, errors) = values.split_at(self.quantities.len());
            let drawn = Setup::new(measurement.with(quantities)).unwrap();
            let mut row = drawn.line_at(self.height).unwrap().position;
            let mut calibration = 0.0;
            for (source, error) in measurement.sources()[quantities.len()..].iter().zip(errors) {
                match source {
                    MeasurementInput::Term(UncertaintySource::Calibration) => calibration = *error,
                    _ => row += error,
                }
            }
            setup.height_at(row).unwrap() + calibration
        };
        (0..MEASUREMENTS).map(measure).collect()
    }

    /// The intervals about a measured height: by the law of propagation and by that of distributions.
    fn intervals(&self, setup: &Setup, height: f64) -> [CoverageInterval; 2] {
        let measurement = self.measurement(setup, height);
        let half = measurement
            .first_order()
            .unwrap()
            .expanded(CoverageProbability::P95);
        let options = PropagationOptions {
            max_trials: 100_000,
            digits: 4,
            ..PropagationOptions::default()
        };
        let (low, high) = (-half, half);
        let trials = measurement.propagation(options).unwrap().interval();
        let trials = CoverageInterval {
            low: trials.low - height,
            high: trials.high - height,
        };
        [CoverageInterval { low, high }, trials]
    }

    /// The fractions of measurements whose intervals hold the true height: by the law of propagation, by the propagation of
    /// distributions, and where the errors of all measurements stand about each, as a virtual experiment has them but without
    /// frames.
    fn coverage(&self) -> [f64; 3] {
        let setup = self.setup();
        let mut measured = self.measured(&setup);
        measured.sort_by(f64::total_cmp);
        let (first, last) = (measured[0], measured[MEASUREMENTS - 1]);
        let step = (last - first) / (NODES - 1) as f64;
        let nodes: Vec<_> = (0..NODES)
            .map(|i| self.intervals(&setup, first + step * i as f64))
            .collect();
        let virtual_experiment = CoverageInterval::of_sorted(
            &measured,
            CoverageProbability::P95,
            IntervalKind::Symmetric,
        );
        let mut held = [0; 3];
        for height in measured {
            let at = ((height - first) / step).min((NODES - 1) as f64 - 1e-9);
            let (node, t) = (to_usize(at), at.fract());
            let between = |method: usize, end: fn(&CoverageInterval) -> f64| {
                (1.0 - t) * end(&nodes[node][method]) + t * end(&nodes[node + 1][method])
            };
            let error = self.height - height;
            for (method, held) in held.iter_mut().take(2).enumerate() {
                let [low, high] = [between(method, |i| i.low), between(method, |i| i.high)];
                *held += usize::from((low..=high).contains(&error));
            }
            let about =
                virtual_experiment.low - self.height..=virtual_experiment.high - self.height;
            held[2] += usize::from(about.contains(&error));
        }
        held.map(|count| count as f64 / MEASUREMENTS as f64)
    }
}

#[test]
fn intervals_hold_the_true_height_as_often_as_they_say() {
    use Distribution::{Arcsine, Normal, Rectangular};
    let geometry = vec![
        uncertain(SetupQuantity::Angle, 30_f64.to_radians(), 1e-3, Normal),
        uncertain(SetupQuantity::Distance, 0.3, 1e-4, Normal),
        uncertain(SetupQuantity::PixelPitch, 3.45e-6, 2e-9, Rectangular),
    ];
    let limits = vec![
        uncertain(SetupQuantity::Angle, 30_f64.to_radians(), 4e-3, Rectangular),
        uncertain(SetupQuantity::LaserOffset, 0.0, 2e-5, Arcsine),
    ];
    let (quantity, angle) = uncertain(SetupQuantity::Angle, 30_f64.to_radians(), 2e-3, Normal);
    let few = vec![(quantity, angle.with_degrees_of_freedom(4.0).unwrap())];
    let steep = vec![
        uncertain(SetupQuantity::Angle, 8_f64.to_radians(), 0.04, Rectangular),
        uncertain(SetupQuantity::FocalLength, 25e-3, 1e-4, Normal),
    ];
    let case = |angle, height, quantities| Case {
        angle,
        height,
        quantities,
    };
    for (name, linear, case) in [
        ("data sheet", true, case(30.0, 4e-3, geometry)),
        ("limits", true, case(30.0, 4e-3, limits)),
        ("four degrees of freedom", false, case(30.0, 4e-3, few)),
        ("not linear", false, case(8.0, 5e-3, steep)),
    ] {
        let coverage = case.coverage();
        let [first_order, propagation, virtual_experiment] = coverage;
        for held in [propagation, virtual_experiment] {
            assert!((held - 0.95).abs() < 0.005, "{name}: {coverage:?}");
        }
        let is_linear = (first_order - 0.95).abs() < 0.005;
        assert_eq!(is_linear, linear, "{name}: {coverage:?}");
    }
}
