//! `tem00 budget`: what height uncertainty a set-up gives, and what dominates it.

mod answers;
mod drawings;
mod findings;
mod measured;
mod report;
mod words;

use std::{io::Write, path::Path};

use tem00_triangulation::{read_setup_with, read_uncertainty};

use self::findings::{Findings, HELP};
use crate::{
    args::BudgetArgs,
    failure::Failure,
    kind::{Kind, wrong_or},
    output,
};

/// Prints the budget of a set-up and writes its files.
///
/// # Errors
///
/// Returns a failure if the input is not valid, if a file cannot be written, if the user ends it, or, with
/// all files written, if the set-up measures nothing.
pub(crate) fn run(args: &BudgetArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (setup, (text, uncertainty)) = read_setup_with(
        &args.common.setup,
        args.common.files.reading(),
        |document, setup| {
            Ok((
                document.text().to_owned(),
                read_uncertainty(document, setup)?,
            ))
        },
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
    let findings = pool.install(|| Findings::new(args, (setup, &uncertainty), text))?;
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
