//! `tem00-inspect characterise`: how a set-up measures artefacts whose shape is known.

mod drawings;
mod report;
mod rows;

use std::io::Write;

use tem00_report::{failure::Failure, interrupt, output, progress::Progress};
use tem00_scan::{ScanError, SetupSensor};
use tem00_topography::{Characteristics, Options, characterise};
use tem00_triangulation::{Budget, Setup, TriangulationError};

use crate::args::{CharacteriseArgs, SETUP_HELP};

/// Prints the characteristics of a set-up and writes their files.
///
/// # Errors
///
/// Returns a failure if the input is not valid, if a file cannot be written, if the user interrupts
/// it, or if the set-up measures nothing.
pub(crate) fn run(args: &CharacteriseArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (setup, text) = args
        .common
        .read(SETUP_HELP, |document, _| Ok(document.text().to_owned()))?;
    check(args, &setup)?;
    let (folder, _lock) = args.common.folder("set-up")?;
    let pool = output::thread_pool(args.common.threads)?;
    let found = pool.install(|| measure(args, &setup))?;
    let drawings = drawings::save(&found, &folder)?;
    let report = report::report(args, (&setup, &text), &found, drawings);
    let files = ["characteristics.json", "characteristics.html"].map(|name| folder.join(name));
    report.save_json(&files[0])?;
    report.save_page(&files[1])?;
    report.print(args.common.json, &files, out)
}

/// Checks that the set-up measures heights.
fn check(args: &CharacteriseArgs, setup: &Setup) -> Result<(), Failure> {
    let path = args.common.setup.display();
    match Budget::new(setup) {
        Ok(_) => Ok(()),
        Err(TriangulationError::NothingMeasured { why, advice }) => Err(Failure::no_result(
            format!("{path}: no characteristics: {why}"),
            advice,
        )),
        Err(error) => Err(Failure::input(format!("{path}: {error}"), SETUP_HELP)),
    }
}

fn measure(args: &CharacteriseArgs, setup: &Setup) -> Result<Characteristics, Failure> {
    let options = Options {
        repetitions: args.repetitions.into(),
    };
    let bar = Progress::of(options.profiles() as u64, "profiles");
    let progress = |artefact: &'static str| {
        bar.name(artefact.into());
        bar.advance(1);
    };
    let mut sensor = SetupSensor::new(setup, args.spp, args.seed, &progress, interrupt::flag());
    characterise(&mut sensor, options).map_err(|error| match error {
        ScanError::Cancelled => Failure::Interrupted,
        error => Failure::input(
            format!("{}: {error}", args.common.setup.display()),
            SETUP_HELP,
        ),
    })
}
