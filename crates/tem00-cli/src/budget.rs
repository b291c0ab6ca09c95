//! `tem00 budget`: what height uncertainty a set-up gives, and what dominates it.

mod drawings;
mod page;
mod record;
mod words;

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use tem00_triangulation::{
    Budget, Setup, Simulation, SimulationOptions, TriangulationError, UncertaintySource,
    read_setup, simulate,
};

use crate::{
    args::BudgetArgs, atomic::write_atomically, failure::Failure, interrupt, output,
    progress::Progress, table::write_columns,
};

const HELP: &str = "setups/ has set-up files, and docs/setup_file.md tells how to write them";

/// A set-up that was looked at.
struct Findings<'a> {
    /// The file that it was read from, and its text.
    file: &'a Path,
    text: String,
    setup: Setup,
    budget: Budget,
    /// What trials found, unless they were left out.
    trials: Option<Simulation>,
    /// The heights that can be measured, and the combined standard uncertainty there, in metres.
    over_range: Vec<(f64, f64)>,
}

/// Prints the budget of a set-up and writes its files.
///
/// # Errors
///
/// Returns a failure if the input is not valid, if there is no line to be found, if a file cannot be
/// written or the user ends it.
pub(crate) fn run(args: &BudgetArgs, out: &mut impl Write) -> Result<(), Failure> {
    let setup =
        read_setup(&args.setup).map_err(|error| Failure::file(&args.setup, &error, HELP))?;
    let folder = output::folder(args.output.as_deref(), &output::name(&args.setup, "set-up"));
    output::prepare(&folder)?;
    let pool = output::thread_pool(args.threads)?;
    let findings = pool.install(|| Findings::new(args, setup))?;
    let record = record::text(&findings)?;
    let written = write(&findings, &record, &folder)?;
    let printed = if args.json {
        writeln!(out, "{record}")
    } else {
        let mut paths = written.iter();
        print(&findings, out)
            .and_then(|()| paths.try_for_each(|path| writeln!(out, "{}", path.display())))
    };
    printed.map_err(|error| Failure::stdout(&error))
}

impl<'a> Findings<'a> {
    fn new(args: &'a BudgetArgs, setup: Setup) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(&args.setup)
            .map_err(|error| Failure::input(format!("{}: {error}", args.setup.display()), HELP))?;
        let budget = Budget::new(&setup).ok_or_else(|| no_line(args, &setup))?;
        let trials = (args.trials > 0).then(|| tried(args, &setup)).transpose()?;
        Ok(Self {
            file: &args.setup,
            text,
            over_range: over_range(&setup),
            setup,
            budget,
            trials,
        })
    }

    /// Returns the combined standard uncertainty that trials found, with the calibration, in metres.
    fn combined_by_trials(&self) -> Option<f64> {
        let total = self.trials.as_ref()?.total().uncertainty;
        let calibration = self.budget.contribution(UncertaintySource::Calibration);
        Some(total.hypot(calibration))
    }
}

fn no_line(args: &BudgetArgs, setup: &Setup) -> Failure {
    let name = args.setup.display();
    let level = setup.light_level();
    Failure::input(
        format!(
            "{name}: the detector finds no line even without noise; the light is {}",
            level.name()
        ),
        level.advice(),
    )
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
            format!("{}: {error}", args.setup.display()),
            "smaller averages, or --trials 0",
        ),
    })
}

/// Returns the combined standard uncertainty at heights over the measuring range.
fn over_range(setup: &Setup) -> Vec<(f64, f64)> {
    const HEIGHTS: u32 = 24;
    let range = setup.measuring_range();
    let step = range.length() / f64::from(HEIGHTS);
    let heights = (0..=HEIGHTS).map(|i| range.low + f64::from(i) * step);
    heights
        .filter_map(|height| Some((height, Budget::at(setup, height)?.combined())))
        .collect()
}

fn print(findings: &Findings<'_>, out: &mut impl Write) -> std::io::Result<()> {
    for (name, value) in words::facts(findings) {
        writeln!(out, "{name}: {value}")?;
    }
    writeln!(out)?;
    write_columns(&words::table(findings), out)?;
    writeln!(out)?;
    for line in words::verdicts(findings) {
        writeln!(out, "{line}")?;
    }
    writeln!(out)
}

/// Writes all files into the folder, and returns the names of those that one opens first.
fn write(findings: &Findings<'_>, record: &str, folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let path = |name: &str| folder.join(name);
    let json = path("budget.json");
    write_atomically(&json, |file| writeln!(file, "{record}"))
        .map_err(|error| Failure::writing(&json, error))?;
    let contributions = drawings::contributions(findings).save(folder, "contributions")?;
    let over_range = drawings::over_range(findings).save(folder, "over_range")?;
    let html = path("budget.html");
    page::report(findings, &contributions, &over_range).save(&html)?;
    Ok(vec![json, html])
}
