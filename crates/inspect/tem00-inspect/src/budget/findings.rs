//! The uncertainty that a set-up gives.

use std::path::Path;

use tem00_report::{failure::Failure, interrupt, progress::Progress, report::units::PERCENT};
use tem00_triangulation::{
    Budget, BudgetTerm, LightLevel, MeasurementInput, Setup, SetupUncertainty, Simulation,
    SimulationOptions, TriangulationError, UncertaintySource, simulate,
};

use super::measured::{ThreeMethods, differs};
use crate::args::{BudgetArgs, SETUP_HELP};

/// The file of a set-up.
pub(super) struct SetupFile<'a> {
    pub(super) path: &'a Path,
    /// With the changes of the command line.
    pub(super) text: String,
    /// Title of the set-up.
    pub(super) title: Option<String>,
}

/// A set-up that was evaluated.
pub(super) struct Findings<'a> {
    pub(super) file: SetupFile<'a>,
    pub(super) setup: Setup,
    /// The uncertainty of a height, or the reason why there is none.
    pub(super) answer: Result<Answer, Refusal>,
}

/// The uncertainty of a height.
pub(super) struct Answer {
    pub(super) budget: Budget,
    /// The result of trials, unless they were left out.
    pub(super) trials: Option<Simulation>,
    /// The heights that can be measured, and the combined standard uncertainty there, in metres;
    /// `None` where no line is found.
    pub(super) over_range: Vec<(f64, Option<f64>)>,
    /// Results for a set-up with uncertain values.
    pub(super) measured: Option<ThreeMethods>,
}

/// The reason why a set-up measures nothing.
pub(super) struct Refusal {
    pub(super) why: String,
    pub(super) advice: &'static str,
    /// The result of trials, if there were any.
    pub(super) trials: Option<Simulation>,
}

impl<'a> Findings<'a> {
    pub(super) fn new(
        args: &BudgetArgs,
        (setup, uncertainty): (Setup, &SetupUncertainty),
        file: SetupFile<'a>,
    ) -> Result<Self, Failure> {
        let answer = match Budget::new(&setup) {
            Ok(budget) => Answer::new(args, (&setup, uncertainty), budget)?,
            Err(TriangulationError::NothingMeasured { why, advice }) => Err(Refusal {
                why: why.to_owned(),
                advice,
                trials: None,
            }),
            Err(error) => return Err(crate::measuring(&args.common.setup, &error, SETUP_HELP)),
        };
        Ok(Self {
            file,
            setup,
            answer,
        })
    }

    /// Returns the result of trials, if there were any.
    pub(super) fn trials(&self) -> Option<&Simulation> {
        let trials = match &self.answer {
            Ok(answer) => &answer.trials,
            Err(refusal) => &refusal.trials,
        };
        trials.as_ref()
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
        if let Some(found) = trials.as_ref().filter(|found| found.total.is_none()) {
            return Ok(Err(Refusal {
                why: format!(
                    "{} of the columns have no line that can be trusted",
                    PERCENT.with_digits(2).text(found.invalid)
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
            measured: ThreeMethods::new(args, setup, uncertainty)?,
            budget,
            trials,
        }))
    }

    /// Returns the combined standard uncertainty that trials found, with the calibration, in
    /// metres.
    pub(super) fn combined_by_trials(&self) -> Option<f64> {
        let total = self.trials.as_ref()?.total?.uncertainty;
        let calibration = self.budget.contribution(UncertaintySource::Calibration);
        Some(total.hypot(calibration))
    }

    /// Returns the ratio of the combined standard uncertainties by trials and by formulas, and its
    /// standard error.
    pub(super) fn ratio(&self) -> Option<[f64; 2]> {
        let error = self.trials.as_ref()?.total?.standard_error;
        let by_trials = self.combined_by_trials()?;
        Some([by_trials, error].map(|found| found / self.budget.combined()))
    }

    /// Returns whether the line is so thin that formulas do not hold.
    pub(super) fn is_thin(&self) -> bool {
        self.budget.speckles() < Budget::LEAST_SPECKLES
    }

    /// Returns the trials if they are to be quoted: where formulas do not hold, or both differ.
    pub(super) fn quoted_trials(&self) -> Option<&Simulation> {
        let is_quoted = self.is_thin() || self.ratio().is_some_and(differs);
        self.trials.as_ref().filter(|_| is_quoted)
    }

    /// Returns the combined and the expanded uncertainty to quote, in metres.
    pub(super) fn quoted(&self) -> [f64; 2] {
        let by_trials = || Some([self.combined_by_trials()?, self.quoted_trials()?.expanded?]);
        by_trials().unwrap_or_else(|| [self.budget.combined(), self.budget.expanded()])
    }

    /// Returns the input that contributes most to the variance of the answer to quote, and its
    /// fraction.
    pub(super) fn dominant(&self) -> (MeasurementInput, f64) {
        let parts = match &self.measured {
            Some(measured) => measured.parts(),
            None => self.parts(),
        };
        let larger = |a: (_, f64), b: (_, f64)| if b.1 > a.1 { b } else { a };
        let none = (MeasurementInput::Term(UncertaintySource::Speckle), 0.0);
        parts.into_iter().fold(none, larger)
    }

    /// Returns the fractions of the variance to quote that the terms contribute, each alone.
    fn parts(&self) -> Vec<(MeasurementInput, f64)> {
        let trials = self.quoted_trials();
        let square = |term: &BudgetTerm| {
            let by_trials = trials.and_then(|trials| trials.term(term.source));
            by_trials
                .map_or(term.contribution(), |found| found.uncertainty)
                .powi(2)
        };
        let terms = self.budget.terms();
        let sum: f64 = terms.iter().map(square).sum();
        // By trials, one alone may have more than all by chance.
        let variance = self.quoted()[0].powi(2).max(sum);
        let part =
            |term: &BudgetTerm| (MeasurementInput::Term(term.source), square(term) / variance);
        terms.iter().map(part).collect()
    }

    /// Returns the fraction of the variance that is quoted by trials and that no source has alone.
    pub(super) fn joint_part(&self) -> Option<f64> {
        self.quoted_trials()?;
        Some(1.0 - self.parts().iter().map(|(_, part)| part).sum::<f64>())
    }
}

pub(super) fn tried(args: &BudgetArgs, setup: &Setup) -> Result<Simulation, Failure> {
    let bar = Progress::of(args.trials.into(), "trials");
    bar.name("trying".into());
    let options = SimulationOptions {
        trials: args.trials,
        seed: args.seed,
    };
    simulate(setup, options, &|_| bar.advance(1), interrupt::flag()).map_err(|error| {
        let help = "smaller averages, or --trials 0";
        crate::measuring(&args.common.setup, &error, help)
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
