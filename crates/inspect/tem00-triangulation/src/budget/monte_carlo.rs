mod noise;

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use tem00_numerics::{Grid, cast::to_usize, parallel};
use tem00_uncertainty::CoverageProbability;

use self::noise::Frames;
use super::{
    UncertaintySource,
    first_order::{self, ColumnProfile, NoiseFreeColumn},
};
use crate::{
    DetectorSettings, ImagedLine, LineDetector, LineImage, Setup, TriangulationError, Validity,
    setup::within,
};

/// The minimum number of columns of a simulated frame.
const COLUMNS: usize = 128;

/// Options of the simulation of a set-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SimulationOptions {
    /// The number of trials, at least 10: each has its own position of the line within a pixel, its
    /// own speckle and camera, and as many frames as are averaged.
    pub trials: u32,
    /// The seed of all random numbers.
    pub seed: u64,
}

impl Default for SimulationOptions {
    /// 200 trials with the seed 0.
    fn default() -> Self {
        Self {
            trials: 200,
            seed: 0,
        }
    }
}

/// A standard uncertainty of a height that was found by trials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonteCarloEstimate {
    /// The root mean square error of the height, in metres.
    pub uncertainty: f64,
    /// Its standard error, from the scatter between the trials, in metres.
    pub standard_error: f64,
}

/// Uncertainty of a height from simulated trials.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// The options of the simulation.
    pub options: SimulationOptions,
    /// The standard uncertainty by all sources at once except the calibration; `None` where fewer
    /// than half of the columns have a line that can be trusted.
    pub total: Option<MonteCarloEstimate>,
    /// The expanded uncertainty of the height for a coverage of 95 %, in metres, by all sources at
    /// once with a normal calibration: 95 % of the errors are no larger. `None` as for the total.
    ///
    /// Errors of lines of few speckles are not normal: 1.96 standard uncertainties hold 94 to 97 %
    /// of them.
    pub expanded: Option<f64>,
    /// The fraction of the columns of all frames in which the detector found no line that can be
    /// trusted, from 0 to 1.
    pub invalid: f64,
    terms: Vec<(UncertaintySource, Option<MonteCarloEstimate>)>,
}

impl Simulation {
    /// The largest fraction of columns without a line that can be trusted from which an uncertainty
    /// is still estimated: those that are left are the dark half of the speckle.
    pub const MAX_INVALID: f64 = 0.5;

    /// Returns the standard uncertainty by one source alone, or `None` for the calibration, which
    /// is not simulated, and where fewer than half of the columns have a line that can be trusted.
    pub fn term(&self, source: UncertaintySource) -> Option<MonteCarloEstimate> {
        let found = self.terms.iter().find(|(of, _)| *of == source);
        found.and_then(|(_, estimate)| *estimate)
    }
}

/// Results of a trial.
struct Trial {
    /// Source by source; the last is all sources at once.
    outcomes: [Outcome; SIMULATED + 1],
    /// The errors of heights by all sources at once and the calibration, without their signs, in
    /// metres.
    errors: Vec<f64>,
}

/// Result of a trial with the noise of one source, or of all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outcome {
    /// The mean square deviation, in square pixels, or square metres of heights; `None` without a
    /// line that can be trusted.
    pub(crate) square: Option<f64>,
    /// The fraction of the columns without a trusted line.
    pub(crate) invalid: f64,
}

impl Outcome {
    /// Returns the mean square of deviations, each averaged over a group of columns and all frames;
    /// without any there is no line that can be trusted.
    pub(crate) fn of(deviations: &[f64], invalid: f64) -> Self {
        let sum: f64 = deviations.iter().map(|deviation| deviation.powi(2)).sum();
        Self {
            square: (!deviations.is_empty()).then(|| sum / deviations.len() as f64),
            invalid,
        }
    }
}

/// The number of the sources that are simulated: all but the last, the calibration.
const SIMULATED: usize = UncertaintySource::ALL.len() - 1;

/// Finds the uncertainty of a height at the reference plane by trials: frames with speckle, exposed
/// by the sensor, in which the detector finds the line; and frames with a single source of noise.
///
/// Errors of a single source are counted from the position without noise, errors of all sources at
/// once from the true position. Columns without a trusted line are left out and
/// [counted](Simulation::invalid); where these are more than half, there is no estimate. `progress`
/// receives the number of trials that are done; setting `cancel` ends the work.
///
/// The same seed gives the same bits for any number of threads.
///
/// # Errors
///
/// Returns an error if there are fewer than 10 trials or more than 10⁶, if the detector finds no
/// line even without noise, if averages are so large that their pattern has more than 2²⁵ samples,
/// or if the work was cancelled.
pub fn simulate(
    setup: &Setup,
    options: SimulationOptions,
    progress: &(dyn Fn(u64) + Sync),
    cancel: &AtomicBool,
) -> Result<Simulation, TriangulationError> {
    let simulator = Simulator::new(setup, setup.line())?;
    let trial = |index| simulator.trial(options.seed, index);
    let trials = in_parallel(options, trial, progress, cancel)?;
    Ok(simulator.summary(options, &trials))
}

/// Returns the results of the trials, which are done on all threads of the current pool.
///
/// `progress` receives, from any thread, the number of trials done.
pub(crate) fn in_parallel<T: Send>(
    options: SimulationOptions,
    trial: impl Fn(u32) -> Result<T, TriangulationError> + Sync,
    progress: &(dyn Fn(u64) + Sync),
    cancel: &AtomicBool,
) -> Result<Vec<T>, TriangulationError> {
    let count = f64::from(options.trials);
    within("trials", count, (10.0, 1e6), "from 10 to a million")?;
    let done = AtomicU64::new(0);
    let first_failed = AtomicU32::new(u32::MAX);
    let trial = |index: u32| {
        // What comes behind a trial that fails is not needed, and what comes before it is done.
        if cancel.load(Ordering::Relaxed) || index > first_failed.load(Ordering::Relaxed) {
            return Err(TriangulationError::Cancelled);
        }
        let result = trial(index);
        if result.is_err() {
            first_failed.fetch_min(index, Ordering::Relaxed);
        }
        progress(done.fetch_add(1, Ordering::Relaxed) + 1);
        result
    };
    let numbers = (0..options.trials).collect();
    let results = parallel::map_items_with(numbers, |(), _, number| trial(number));
    results.into_iter().collect()
}

const NO_LINE: TriangulationError = TriangulationError::TooFew {
    what: "lines that the detector finds without noise",
    got: 0,
    needed: 1,
};

/// Trials of a set-up with a line on a flat surface.
pub(crate) struct Simulator<'a> {
    setup: &'a Setup,
    line: ColumnProfile,
    /// The detector for noise without a sensor, which does not saturate.
    unlimited: LineDetector,
    image: LineImage,
    group: usize,
    /// The shift of the line by light from below the surface, which is corrected, in pixels.
    shift: f64,
}

impl<'a> Simulator<'a> {
    pub(crate) fn new(setup: &'a Setup, line: &ImagedLine) -> Result<Self, TriangulationError> {
        let group = setup.description().average.columns as usize;
        let columns = group * COLUMNS.div_ceil(group);
        let rows = first_order::rows(setup.description(), line);
        let simulator = Self {
            setup,
            line: ColumnProfile::new(setup, line),
            unlimited: LineDetector::new(DetectorSettings {
                saturation: f64::INFINITY,
                ..*setup.detector().settings()
            })?,
            image: LineImage::of_line(setup, line, [columns, rows])?,
            group,
            shift: first_order::subsurface_shift(setup, line).ok_or(NO_LINE)?,
        };
        simulator.noise_free_position(0.0).map(|_| simulator)
    }

    /// Returns the position at which the detector finds the line without noise.
    fn noise_free_position(&self, phase: f64) -> Result<f64, TriangulationError> {
        let column = NoiseFreeColumn::new(self.setup, &self.line, phase);
        let found = column.found(self.setup).map(|point| point.position);
        found.ok_or(NO_LINE)
    }

    fn trial(&self, seed: u64, index: u32) -> Result<Trial, TriangulationError> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(u64::from(index));
        let phase = phase(&mut random);
        let position = self.noise_free_position(phase)?;
        let frames = self.frames(phase, random.next_u64());
        let centre = frames.column.centre + self.shift;
        let bias = Outcome::of(&[position - centre], 0.0);
        let mut outcomes = [bias; SIMULATED + 1];
        let simulated = UncertaintySource::ALL.into_iter().take(SIMULATED);
        for (outcome, source) in outcomes.iter_mut().zip(simulated) {
            let reference = match source {
                UncertaintySource::DetectorBias => continue,
                UncertaintySource::Quantisation => positions(&self.unlimited, &frames.unrounded()),
                _ => Positions::uniform(position),
            };
            let found = positions(&self.unlimited, &frames.of(source)?);
            *outcome = Outcome::of(&self.group_deviations(&found, &reference), found.invalid());
        }
        let found = positions(self.setup.detector(), &frames.exposed()?);
        let deviations = self.group_deviations(&found, &Positions::uniform(centre));
        outcomes[SIMULATED] = Outcome::of(&deviations, found.invalid());
        let per_pixel = self.setup.line().height_per_pixel;
        let calibration = self.setup.description().calibration_uncertainty;
        let error = |deviation: f64| {
            let of_calibration: f64 = StandardNormal.sample(&mut random);
            (per_pixel * deviation + calibration * of_calibration).abs()
        };
        Ok(Trial {
            outcomes,
            errors: deviations.into_iter().map(error).collect(),
        })
    }

    /// Returns how far the positions that are found in exposed frames are from the place where the
    /// line enters the part, averaged over columns and frames, in pixels, and the fraction of the
    /// columns without a line that can be trusted.
    pub(crate) fn deviations(&self, seed: u64) -> Result<(Vec<f64>, f64), TriangulationError> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let frames = self.frames(phase(&mut random), random.next_u64());
        let found = positions(self.setup.detector(), &frames.exposed()?);
        let reference = Positions::uniform(frames.column.centre);
        Ok((self.group_deviations(&found, &reference), found.invalid()))
    }

    fn frames(&self, phase: f64, seed: u64) -> Frames<'_> {
        Frames {
            setup: self.setup,
            image: &self.image,
            column: NoiseFreeColumn::new(self.setup, &self.line, phase),
            seed,
        }
    }

    /// Returns the deviations of groups of columns over all frames; groups without a line are left
    /// out.
    fn group_deviations(&self, positions: &Positions, reference: &Positions) -> Vec<f64> {
        let columns = positions.0.first().map_or(0, Vec::len);
        let of_group = |first: usize| {
            let (mut deviation, mut members) = (0.0, 0.0);
            for frame in 0..positions.0.len() {
                for column in first..first + self.group {
                    let pair = positions.at(frame, column).zip(reference.at(frame, column));
                    if let Some((position, reference)) = pair {
                        deviation += position - reference;
                        members += 1.0;
                    }
                }
            }
            (members > 0.0).then(|| deviation / members)
        };
        (0..columns)
            .step_by(self.group)
            .filter_map(of_group)
            .collect()
    }

    fn summary(&self, options: SimulationOptions, trials: &[Trial]) -> Simulation {
        let per_pixel = self.setup.line().height_per_pixel.abs();
        let of = |index: usize| trials.iter().map(move |trial| trial.outcomes[index]);
        let estimate = |index: usize| estimate(of(index), per_pixel);
        let total = estimate(SIMULATED);
        let mut errors: Vec<f64> = trials
            .iter()
            .flat_map(|trial| &trial.errors)
            .copied()
            .collect();
        errors.sort_unstable_by(f64::total_cmp);
        let held = to_usize((CoverageProbability::P95.value() * errors.len() as f64).ceil());
        Simulation {
            options,
            terms: UncertaintySource::ALL
                .into_iter()
                .zip((0..SIMULATED).map(estimate))
                .collect(),
            total,
            expanded: total.and_then(|_| errors.get(held.max(1) - 1).copied()),
            invalid: invalid(of(SIMULATED)),
        }
    }
}

/// Draws a position within a pixel, of 2²⁰ that are possible.
fn phase(random: &mut ChaCha8Rng) -> f64 {
    f64::from(random.next_u32() >> 12) / f64::from(1_u32 << 20)
}

/// Positions of a line, by frame and column; a single position stands for all.
struct Positions(Vec<Vec<Option<f64>>>);

impl Positions {
    fn uniform(position: f64) -> Self {
        Self(vec![vec![Some(position)]])
    }

    fn at(&self, frame: usize, column: usize) -> Option<f64> {
        let of_frame = &self.0[frame.min(self.0.len() - 1)];
        of_frame[column.min(of_frame.len() - 1)]
    }

    fn invalid(&self) -> f64 {
        let all = self.0.iter().flatten();
        let missing = all.clone().filter(|position| position.is_none()).count();
        missing as f64 / all.count() as f64
    }
}

/// Returns the positions of the line in all columns of all frames.
fn positions(detector: &LineDetector, frames: &[Grid<f32>]) -> Positions {
    let position = |points| {
        let point = first_order::brightest(points)?;
        (point.validity == Validity::Valid).then_some(point.position)
    };
    let of_frame = |frame| detector.detect(frame).into_iter().map(position).collect();
    Positions(frames.iter().map(of_frame).collect())
}

/// Returns the mean fraction of columns without a line that can be trusted.
pub(crate) fn invalid(outcomes: impl Iterator<Item = Outcome> + Clone) -> f64 {
    let trials = outcomes.clone().count() as f64;
    outcomes.map(|outcome| outcome.invalid).sum::<f64>() / trials
}

/// Returns the root of the mean of independent mean squares, and its standard error by the scatter;
/// `None` where fewer than half of the columns have a line that can be trusted.
pub(crate) fn estimate(
    outcomes: impl Iterator<Item = Outcome> + Clone,
    per_pixel: f64,
) -> Option<MonteCarloEstimate> {
    let squares = outcomes.clone().filter_map(|outcome| outcome.square);
    let count = squares.clone().count() as f64;
    // A scatter needs two values.
    if count < 2.0 || invalid(outcomes) > Simulation::MAX_INVALID {
        return None;
    }
    let mean = squares.clone().sum::<f64>() / count;
    let scatter = squares.map(|square| (square - mean).powi(2)).sum::<f64>();
    let error_of_mean = (scatter / (count * (count - 1.0))).sqrt();
    let root = mean.sqrt();
    Some(MonteCarloEstimate {
        uncertainty: per_pixel * root,
        // δ√m = δm / (2√m)
        standard_error: if root > 0.0 {
            per_pixel * error_of_mean / (2.0 * root)
        } else {
            0.0
        },
    })
}
