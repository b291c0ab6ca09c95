//! The uncertainty that a set-up gives.

use std::path::Path;

use tem00_triangulation::{
    Budget, LightLevel, Setup, SetupUncertainty, Simulation, SimulationOptions, TriangulationError,
    UncertaintySource, simulate,
};

use super::measured::Measured;
use crate::{
    args::BudgetArgs, failure::Failure, interrupt, progress::Progress, report::units::PERCENT,
};

/// The help for a file that is not a set-up.
pub(super) const HELP: &str =
    "setups/ has set-up files, and docs/setup_file.md explains how to write them";

/// A set-up that was looked at.
pub(super) struct Findings<'a> {
    /// The file that it was read from, and its text.
    pub(super) file: &'a Path,
    pub(super) text: String,
    pub(super) setup: Setup,
    /// The uncertainty of a height, or the reason why there is none.
    pub(super) answer: Result<Answer, Refusal>,
}

/// The uncertainty of a height.
pub(super) struct Answer {
    pub(super) budget: Budget,
    /// The result of trials, unless they were left out.
    pub(super) trials: Option<Simulation>,
    /// The heights that can be measured, and the combined standard uncertainty there, in metres; none where
    /// no line is found.
    pub(super) over_range: Vec<(f64, Option<f64>)>,
    /// What is measured with a set-up that is not known exactly.
    pub(super) measured: Option<Measured>,
}

/// The reason for which a set-up measures nothing.
pub(super) struct Refusal {
    pub(super) why: String,
    pub(super) advice: &'static str,
    /// The result of trials, if there were any.
    pub(super) trials: Option<Simulation>,
}

impl<'a> Findings<'a> {
    pub(super) fn new(
        args: &'a BudgetArgs,
        (setup, uncertainty): (Setup, &SetupUncertainty),
        text: String,
    ) -> Result<Self, Failure> {
        let answer = match Budget::new(&setup) {
            Ok(budget) => Answer::new(args, (&setup, uncertainty), budget)?,
            Err(TriangulationError::NothingMeasured { why, advice }) => Err(Refusal {
                why: why.to_owned(),
                advice,
                trials: None,
            }),
            Err(error) => {
                let message = format!("{}: {error}", args.common.setup.display());
                return Err(Failure::input(message, HELP));
            }
        };
        Ok(Self {
            file: &args.common.setup,
            text,
            setup,
            answer,
        })
    }
}

impl Answer {
    pub(super) fn new(
        args: &BudgetArgs,
        (setup, uncertainty): (&Setup, &SetupUncertainty),
        budget: Budget,
    ) -> Result<Result<Self, Refusal>, Failure> {
        let is_tried = args.trials > 0;
        let trials = is_tried.then(|| tried(args, setup)).transpose()?;
        if let Some(found) = trials.as_ref().filter(|found| found.total().is_none()) {
            return Ok(Err(Refusal {
                why: format!(
                    "{} of the columns have no line that can be trusted",
                    PERCENT.with_digits(2).text(found.invalid())
                ),
                advice: match setup.light_level() {
                    LightLevel::Good => "try another method or `window` in [detector]",
                    level => level.advice(),
                },
                trials,
            }));
        }
        Ok(Ok(Self {
            over_range: over_range(setup),
            measured: Measured::new(args, setup, uncertainty)?,
            budget,
            trials,
        }))
    }

    /// Returns the combined standard uncertainty that trials found, with the calibration, in metres.
    pub(super) fn combined_by_trials(&self) -> Option<f64> {
        let total = self.trials.as_ref()?.total()?.uncertainty;
        let calibration = self.budget.contribution(UncertaintySource::Calibration);
        Some(total.hypot(calibration))
    }
}

pub(super) fn tried(args: &BudgetArgs, setup: &Setup) -> Result<Simulation, Failure> {
    let bar = Progress::of(args.trials.into(), "trials");
    bar.name("trying".into());
    let options = SimulationOptions {
        trials: args.trials,
        seed: args.seed,
    };
    simulate(setup, options, |_| bar.advance(1), interrupt::flag()).map_err(|error| match error {
        TriangulationError::Cancelled => Failure::Interrupted,
        error => Failure::input(
            format!("{}: {error}", args.common.setup.display()),
            "smaller averages, or --trials 0",
        ),
    })
}

/// Returns the combined standard uncertainty at heights over the measuring range.
pub(super) fn over_range(setup: &Setup) -> Vec<(f64, Option<f64>)> {
    const HEIGHTS: u32 = 24;
    let range = setup.measuring_range();
    let step = range.length() / f64::from(HEIGHTS);
    let heights = (0..=HEIGHTS).map(|i| range.low + f64::from(i) * step);
    heights
        .map(|height| {
            let budget = Budget::at_height(setup, height).ok();
            (height, budget.map(|budget| budget.combined()))
        })
        .collect()
}
