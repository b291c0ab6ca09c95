//! `tem00-inspect design`: the best set-up under constraints.

mod files;
mod plots;
mod report;
mod search;
mod words;

use std::io::Write;

use tem00_report::{failure::Failure, output};
use tem00_triangulation::{neighbours, read_design, read_uncertainty};

use self::search::Design;
use crate::args::DesignArgs;

/// Relative change of each parameter of the best set-up.
const PART: f64 = 0.1;

/// Searches, prints the best set-up and writes the files.
///
/// # Errors
///
/// Returns a failure if the input is not valid, a file cannot be written, the user interrupts it,
/// or if no set-up keeps every constraint; all files but `best.toml` are written then, if any
/// set-up is possible.
pub(crate) fn run(args: &DesignArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (_, (search, uncertainty, text)) = args.common.read(HELP, |document, setup| {
        let search = read_design(document, setup.description())?;
        let uncertainty = read_uncertainty(document, setup)?;
        Ok((search, uncertainty, document.text().to_owned()))
    })?;
    let (folder, _lock) = args.common.folder("design")?;
    let pool = output::thread_pool(args.common.threads)?;
    let mut design = pool.install(|| Design::search(args, search, text))?;
    design.is_exact = uncertainty.quantities.is_empty();
    if design.winner().is_none() {
        // The best set-up of another search would be taken for the winner of this search.
        output::remove(&folder, &["best"], &["toml"])?;
    }
    let shown = design.shown().ok_or_else(|| words::nothing(&design))?;
    let shown = Design::setup_of(shown)?.description().clone();
    let near = pool.install(|| neighbours(&shown, PART));
    let (report, written) = files::write(&design, &near, &folder)?;
    report.print(args.common.json, &written, out)?;
    design
        .winner()
        .map(|_| ())
        .ok_or_else(|| words::nothing(&design))
}

const HELP: &str =
    "a set-up file for a search has a section [design]; examples/setups/design.toml is one";
