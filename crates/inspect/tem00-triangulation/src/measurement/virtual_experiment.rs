use std::sync::atomic::AtomicBool;

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use tem00_uncertainty::{CoverageInterval, CoverageProbability, IntervalKind};

use super::{Measurement, MeasurementInput, height_at};
use crate::{
    MonteCarloEstimate, Setup, SimulationOptions, TriangulationError, UncertaintySource,
    budget::{Outcome, Simulator, estimate, in_parallel, invalid},
};

/// Heights that a set-up measures in a virtual experiment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualExperiment {
    /// The mean of the measured heights, in metres.
    pub mean: f64,
    /// The root mean square error of a height; `None` where fewer than half of the columns have a
    /// line that can be trusted.
    pub error: Option<MonteCarloEstimate>,
    /// The symmetric interval of 95 % of all measured heights, in metres; `None` as for the error.
    pub interval: Option<CoverageInterval>,
    /// The fraction of the columns in which the detector found no line that can be trusted, from 0
    /// to 1.
    pub invalid: f64,
}

/// The heights of one trial.
struct Heights {
    heights: Vec<f64>,
    outcome: Outcome,
}

impl Measurement {
    /// Measures the height many times with set-ups that differ from their description within its
    /// uncertainty.
    ///
    /// Each trial draws a true set-up, exposes simulated frames of the line at the height with all
    /// noise, has the detector find it, and evaluates the height with the set-up as it is
    /// described. `progress` receives the number of trials that are done; setting `cancel` ends the
    /// work. The same seed gives the same bits for any number of threads.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`simulate`](crate::simulate), and an error if a drawn set-up is not
    /// possible.
    pub fn virtual_experiment(
        &self,
        options: SimulationOptions,
        progress: &(dyn Fn(u64) + Sync),
        cancel: &AtomicBool,
    ) -> Result<VirtualExperiment, TriangulationError> {
        let trial = |index| self.trial(options.seed, index);
        let trials = in_parallel(options, trial, progress, cancel)?;
        let outcomes = trials.iter().map(|trial| trial.outcome);
        let (error, invalid) = (estimate(outcomes.clone(), 1.0), invalid(outcomes));
        let mut heights: Vec<f64> = trials.into_iter().flat_map(|trial| trial.heights).collect();
        heights.sort_by(f64::total_cmp);
        let interval = || {
            CoverageInterval::of_sorted(&heights, CoverageProbability::P95, IntervalKind::Symmetric)
        };
        Ok(VirtualExperiment {
            mean: heights.iter().sum::<f64>() / heights.len() as f64,
            error,
            interval: error.map(|_| interval()),
            invalid,
        })
    }

    fn trial(&self, seed: u64, index: u32) -> Result<Heights, TriangulationError> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(u64::from(index));
        let mut values = self.inputs.estimates();
        self.inputs.draw(&mut random, &mut values);
        let calibration = MeasurementInput::Term(UncertaintySource::Calibration);
        let calibration = self
            .sources
            .iter()
            .position(|source| *source == calibration);
        let calibration = calibration.map_or(0.0, |index| values[index]);
        let described = self.setup.description();
        let setup = Setup::new(self.with(&values)).map_err(|error| {
            let is_possible = |values: &[f64]| Setup::new(self.with(values)).is_ok();
            let found = self.inputs.impossible_draw(&values, is_possible);
            found.map_or(error, |found| self.named(found))
        })?;
        let line = setup
            .line_at(self.height)
            .ok_or(TriangulationError::NothingMeasured {
                why: "the camera does not see the line",
                advice: "take a smaller height",
            })?;
        let (deviations, invalid) = Simulator::new(&setup, &line)?.deviations(random.next_u64())?;
        // Corrected by the shift of the set-up as it is described.
        let (shift, _) = &self.shift;
        let height = |deviation: f64| height_at(described, line.position + deviation - shift);
        let heights: Vec<f64> = deviations
            .into_iter()
            .filter_map(height)
            .map(|height| height + calibration)
            .collect();
        let errors: Vec<f64> = heights.iter().map(|height| height - self.height).collect();
        Ok(Heights {
            outcome: Outcome::of(&errors, invalid),
            heights,
        })
    }
}
