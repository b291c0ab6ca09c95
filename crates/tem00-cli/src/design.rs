//! `tem00 design`: the best set-up under constraints.

mod files;
mod listing;
mod page;
mod plots;
mod record;
mod units;

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use tem00_triangulation::{
    Candidate, DesignFigure, DesignOutcome, DesignSearch, TriangulationError, neighbours,
    read_design, read_setup_with,
};

use crate::{
    args::DesignArgs,
    failure::Failure,
    interrupt,
    kind::{Kind, wrong_or},
    output,
    progress::Progress,
};

/// By which part each parameter of the best set-up is changed.
const PART: f64 = 0.1;

/// A search that is done.
struct Design<'a> {
    /// The file that it was read from, and its text.
    file: &'a Path,
    text: String,
    search: DesignSearch,
    outcome: DesignOutcome,
    /// The most set-ups that are listed.
    most: usize,
}

/// Searches, prints the best and writes the files.
///
/// # Errors
///
/// Returns a failure if the input is not valid, no set-up is possible at all, a file cannot be written
/// or the user ends it.
pub(crate) fn run(args: &DesignArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (_, search) = read_setup_with(&args.setup, |document, setup| {
        read_design(document, setup.description())
    })
    .map_err(|error| {
        wrong_or(&args.setup, Kind::Setup, || {
            Failure::file(&args.setup, &error, HELP)
        })
    })?;
    let name = output::name(&args.setup, "design");
    let folder = output::folder(args.output.as_deref(), &name);
    output::prepare(&folder)?;
    let pool = output::thread_pool(args.threads)?;
    let design = pool.install(|| Design::search(args, search))?;
    let shown = design.shown()?.description;
    let near = pool.install(|| neighbours(&shown, PART));
    let written = files::write(&design, &near, &folder)?;
    if args.json {
        record::print(&design, out)
    } else {
        listing::print(&design, out)?;
        let line = |path: &PathBuf| writeln!(out, "{}", path.display());
        written
            .iter()
            .try_for_each(line)
            .map_err(|error| Failure::stdout(&error))
    }
}

const HELP: &str = "a set-up file for a search has a section [design]; setups/design.toml is one";

impl<'a> Design<'a> {
    fn search(args: &'a DesignArgs, search: DesignSearch) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(&args.setup)
            .map_err(|error| Failure::input(format!("{}: {error}", args.setup.display()), HELP))?;
        let bar = Progress::of(search.count() as u64, "set-ups");
        bar.name("searching".into());
        let outcome = search
            .run(|done| bar.advance(done), interrupt::flag())
            .map_err(|error| match error {
                TriangulationError::Cancelled => Failure::Interrupted,
                error => Failure::running(error.to_string()),
            })?;
        Ok(Self {
            file: &args.setup,
            text,
            search,
            outcome,
            most: args.best.into(),
        })
    }

    /// Returns the best set-up, or the nearest if none keeps every constraint.
    ///
    /// # Errors
    ///
    /// Returns a failure if none is possible at all.
    fn shown(&self) -> Result<&Candidate, Failure> {
        let best = self.outcome.best(1).into_iter().next();
        best.or_else(|| self.outcome.nearest()).ok_or_else(|| {
            let first = self.outcome.candidates().first();
            let why = first.and_then(|candidate| candidate.figures.as_ref().err());
            let why = why.map_or_else(String::new, |why| format!("; the first: {why}"));
            Failure::input(
                format!(
                    "none of the {} set-ups is possible{why}",
                    self.search.count()
                ),
                "change the values in [design.vary], or the set-up that the search begins with",
            )
        })
    }

    /// Returns the figure that is made small.
    fn objective(&self) -> DesignFigure {
        self.search.question().objective.figure()
    }
}
