//! `tem00-inspect budget`: the height uncertainty of a set-up, and its dominant source.

mod answers;
mod certificate;
mod drawings;
mod findings;
mod measured;
mod report;
mod words;

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use tem00_report::{failure::Failure, output};
use tem00_triangulation::read_uncertainty;

use self::{
    certificate::{CertificateData, certificate},
    findings::{Findings, SetupFile},
};
use crate::{
    args::{BudgetArgs, SETUP_HELP},
    date,
};

/// Prints the budget of a set-up and writes its files.
///
/// # Errors
///
/// Returns a failure if the input is not valid, if a file cannot be written, if the user interrupts
/// it, or, with all files written, if the set-up measures nothing.
pub(crate) fn run(args: &BudgetArgs, out: &mut impl Write) -> Result<(), Failure> {
    let day = date::today()?;
    let (setup, (read, uncertainty, data)) = args.common.read(SETUP_HELP, |document, setup| {
        let uncertainty = read_uncertainty(document, setup)?;
        let data = CertificateData::read(document, uncertainty.states_height())?;
        let title = document.value("title");
        let title = title.map(|title| title.string().map(str::to_owned));
        let read = SetupFile {
            path: &args.common.setup,
            text: document.text().to_owned(),
            title: title.transpose()?,
        };
        Ok((read, uncertainty, data))
    })?;
    let (folder, _lock) = args.common.folder("set-up")?;
    let pool = output::thread_pool(args.common.threads)?;
    let findings = pool.install(|| Findings::new(args, (setup, &uncertainty), read))?;
    let report = report::report(&findings, draw(&findings, &folder)?, &day);
    let mut files = ["budget.json", "budget.html"]
        .map(|name| folder.join(name))
        .to_vec();
    report.save_json(&files[0])?;
    report.save_page(&files[1])?;
    files.extend(certify(data.as_ref(), &findings, &folder)?);
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
        // Drawings of another run would be taken for drawings of this run.
        Err(_) => {
            output::remove(folder, &[CONTRIBUTIONS, OVER_RANGE], &["svg", "png"])?;
            Ok(Vec::new())
        }
    }
}

/// Writes the certificate into the folder, if the set-up asks for one and there is an uncertainty,
/// and returns its path.
fn certify(
    data: Option<&CertificateData>,
    findings: &Findings<'_>,
    folder: &Path,
) -> Result<Option<PathBuf>, Failure> {
    let answer = findings.answer.as_ref().ok();
    let measured = answer.and_then(|answer| answer.measured.as_ref());
    let Some((data, measured)) = data.zip(measured) else {
        output::remove(folder, &[CERTIFICATE], &["xml"])?;
        return Ok(None);
    };
    let path = folder.join(CERTIFICATE).with_extension("xml");
    let certificate = certificate(data, measured, &findings.setup);
    output::save(&path, |file| file.write_all(certificate.as_bytes()))?;
    Ok(Some(path))
}

/// The name of the certificate, without its ending.
const CERTIFICATE: &str = "certificate";
/// The names of the drawings.
const CONTRIBUTIONS: &str = "contributions";
const OVER_RANGE: &str = "over_range";
