//! `tem00 budget`: what height uncertainty a set-up gives, and what dominates it.

mod drawings;
mod report;
mod words;

use std::{io::Write, path::Path};

use tem00_triangulation::{
    Budget, LightLevel, Setup, Simulation, SimulationOptions, TriangulationError,
    UncertaintySource, read_setup_with, simulate,
};

use crate::{
    args::BudgetArgs,
    failure::Failure,
    interrupt,
    kind::{Kind, wrong_or},
    output,
    progress::Progress,
    report::units::PERCENT,
};

const HELP: &str = "setups/ has set-up files, and docs/setup_file.md explains how to write them";

/// A set-up that was looked at.
struct Findings<'a> {
    /// The file that it was read from, and its text.
    file: &'a Path,
    text: String,
    setup: Setup,
    /// The uncertainty of a height, or why there is none.
    answer: Result<Answer, Refusal>,
}

/// The uncertainty of a height.
struct Answer {
    budget: Budget,
    /// The result of trials, unless they were left out.
    trials: Option<Simulation>,
    /// The heights that can be measured, and the combined standard uncertainty there, in metres; none where
    /// no line is found.
    over_range: Vec<(f64, Option<f64>)>,
}

/// The reason for which a set-up measures nothing.
struct Refusal {
    why: String,
    advice: &'static str,
    /// The result of trials, if there were any.
    trials: Option<Simulation>,
}

/// Prints the budget of a set-up and writes its files.
///
/// # Errors
///
/// Returns a failure if the input is not valid, if a file cannot be written, if the user ends it, or, with
/// all files written, if the set-up measures nothing.
pub(crate) fn run(args: &BudgetArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (setup, text) = read_setup_with(
        &args.common.setup,
        args.common.files.reading(),
        |document, _| Ok(document.text().to_owned()),
    )
    .map_err(|error| {
        wrong_or(&args.common.setup, Kind::Setup, || {
            Failure::file(&args.common.setup, &error, HELP)
        })
    })?;
    let folder = output::folder(
        args.common.output.as_deref(),
        &output::name(&args.common.setup, "set-up"),
    );
    let _lock = output::prepare(&folder)?;
    let pool = output::thread_pool(args.common.threads)?;
    let findings = pool.install(|| Findings::new(args, setup, text))?;
    let report = report::report(&findings, draw(&findings, &folder)?);
    let files = ["budget.json", "budget.html"].map(|name| folder.join(name));
    report.save_json(&files[0])?;
    report.save_page(&files[1])?;
    report.print(args.common.json, &files, out)?;
    findings.answer.map(drop).map_err(|refusal| {
        let message = format!(
            "{}: no uncertainty: {}",
            args.common.setup.display(),
            refusal.why
        );
        Failure::no_result(message, refusal.advice)
    })
}

impl<'a> Findings<'a> {
    fn new(args: &'a BudgetArgs, setup: Setup, text: String) -> Result<Self, Failure> {
        let answer = match Budget::new(&setup) {
            Ok(budget) => Answer::new(args, &setup, budget)?,
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
    fn new(
        args: &BudgetArgs,
        setup: &Setup,
        budget: Budget,
    ) -> Result<Result<Self, Refusal>, Failure> {
        let trials = (args.trials > 0).then(|| tried(args, setup)).transpose()?;
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
            budget,
            trials,
        }))
    }

    /// Returns the combined standard uncertainty that trials found, with the calibration, in metres.
    fn combined_by_trials(&self) -> Option<f64> {
        let total = self.trials.as_ref()?.total()?.uncertainty;
        let calibration = self.budget.contribution(UncertaintySource::Calibration);
        Some(total.hypot(calibration))
    }
}

fn tried(args: &BudgetArgs, setup: &Setup) -> Result<Simulation, Failure> {
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
fn over_range(setup: &Setup) -> Vec<(f64, Option<f64>)> {
    const HEIGHTS: u32 = 24;
    let range = setup.measuring_range();
    let step = range.length() / f64::from(HEIGHTS);
    let heights = (0..=HEIGHTS).map(|i| range.low + f64::from(i) * step);
    heights
        .map(|height| {
            let budget = Budget::at(setup, height).ok();
            (height, budget.map(|budget| budget.combined()))
        })
        .collect()
}

/// Draws the budget into the folder, if there is one, and returns the drawings.
fn draw(findings: &Findings<'_>, folder: &Path) -> Result<Vec<String>, Failure> {
    match &findings.answer {
        Ok(answer) => Ok(vec![
            drawings::contributions(answer).save(folder, CONTRIBUTIONS)?,
            drawings::over_range(answer).save(folder, OVER_RANGE)?,
        ]),
        // Those of another run would be taken for those of this one.
        Err(_) => {
            output::remove(folder, &[CONTRIBUTIONS, OVER_RANGE], &["svg", "png"])?;
            Ok(Vec::new())
        }
    }
}

/// The names of the drawings.
const CONTRIBUTIONS: &str = "contributions";
const OVER_RANGE: &str = "over_range";
