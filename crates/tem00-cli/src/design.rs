//! `tem00 design`: the best set-up under constraints.

mod files;
mod plots;
mod report;
mod units;
mod words;

use std::{io::Write, path::Path};

use tem00_triangulation::{
    Candidate, DesignFigure, DesignOutcome, DesignSearch, Setup, TriangulationError, neighbours,
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
/// Returns a failure if the input is not valid, a file cannot be written, the user ends it, or if no set-up
/// keeps every constraint; all files but `best.toml` are written then, if any set-up is possible.
pub(crate) fn run(args: &DesignArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (_, (search, text)) = read_setup_with(
        &args.common.setup,
        args.common.files.reading(),
        |document, setup| {
            let search = read_design(document, setup.description())?;
            Ok((search, document.text().to_owned()))
        },
    )
    .map_err(|error| {
        wrong_or(&args.common.setup, Kind::Setup, || {
            Failure::file(&args.common.setup, &error, HELP)
        })
    })?;
    let name = output::name(&args.common.setup, "design");
    let folder = output::folder(args.common.output.as_deref(), &name);
    let _lock = output::prepare(&folder)?;
    let pool = output::thread_pool(args.common.threads)?;
    let design = pool.install(|| Design::search(args, search, text))?;
    if design.winner().is_none() {
        // That of another search would be taken for the winner of this one.
        output::remove(&folder, &["best"], &["toml"])?;
    }
    let shown = *design.shown_setup()?.description();
    let near = pool.install(|| neighbours(&shown, PART));
    let (report, written) = files::write(&design, &near, &folder)?;
    report.print(args.common.json, &written, out)?;
    design.winner().map(|_| ()).ok_or_else(|| design.nothing())
}

const HELP: &str = "a set-up file for a search has a section [design]; setups/design.toml is one";

impl<'a> Design<'a> {
    fn search(args: &'a DesignArgs, search: DesignSearch, text: String) -> Result<Self, Failure> {
        let bar = Progress::of(search.count() as u64, "set-ups");
        bar.name("searching".into());
        let outcome = search
            .run(|done| bar.advance(done), interrupt::flag())
            .map_err(|error| match error {
                TriangulationError::Cancelled => Failure::Interrupted,
                error => Failure::running(error.to_string()),
            })?;
        Ok(Self {
            file: &args.common.setup,
            text,
            search,
            outcome,
            most: args.best.into(),
        })
    }

    /// Returns the best set-up that keeps every constraint.
    fn winner(&self) -> Option<&Candidate> {
        self.outcome.best(1).into_iter().next()
    }

    /// Returns the best set-up, or the nearest if none keeps every constraint.
    ///
    /// # Errors
    ///
    /// Returns a failure if none is possible at all.
    fn shown(&self) -> Result<&Candidate, Failure> {
        let shown = self.winner().or_else(|| self.outcome.nearest());
        shown.ok_or_else(|| self.nothing())
    }

    /// Returns the set-up that is shown, with an exposure that the light chooses as it is then.
    fn shown_setup(&self) -> Result<Setup, Failure> {
        Setup::new(self.shown()?.description).map_err(|error| Failure::running(error.to_string()))
    }

    /// Returns why the search has no result.
    fn nothing(&self) -> Failure {
        let name = self.file.display();
        let why = words::hindrances(self).join("; ");
        let (possible, _) = self.outcome.counts();
        if possible == 0 {
            return Failure::no_result(
                format!(
                    "{name}: none of the {} set-ups is possible: {why}",
                    self.search.count()
                ),
                "change the values in [design.vary], or the set-up that the search begins with",
            );
        }
        Failure::no_result(
            format!(
                "{name}: none of the {possible} set-ups that are possible keeps every constraint: {why}"
            ),
            "relax [design.require] or widen [design.vary]; design.html shows the set-up that comes nearest",
        )
    }

    /// Returns the figure that is made small.
    fn objective(&self) -> DesignFigure {
        self.search.question().objective.figure()
    }
}
