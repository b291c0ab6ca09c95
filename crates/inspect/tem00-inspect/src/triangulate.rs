//! `tem00-inspect triangulate`: from a scene file to a measured part.

mod calibration;
mod drawings;
mod files;
mod frame;
mod job;
mod refusal;
mod report;
mod terms;
mod x3p;

use std::io::Write;

use tem00_report::{
    failure::Failure,
    kind::{Kind, wrong_or},
    output,
    report::Report,
};
use tem00_scan::MeasurementScene;

use self::job::{Job, ScanResult};
use crate::args::TriangulateArgs;

/// The help for a file that is not a scene.
const HELP: &str = "a scene needs a camera, a laser with [laser.line], a surface and a [sensor]";

/// Measures a scene and prints the sources of uncertainty of its heights.
///
/// # Errors
///
/// Returns a failure if the input is not valid, a file cannot be written, the user interrupts it,
/// or, with all files written, if no point is valid.
pub(crate) fn run(args: &TriangulateArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (scene, notes) = MeasurementScene::read(&args.common.scene, args.common.files.reading())
        .map_err(|error| {
            wrong_or(&args.common.scene, Kind::Scene, || {
                Failure::file(&args.common.scene, &error, HELP)
            })
        })?;
    let boards = scene.calibration.boards.clone();
    let mut job = Job::new(args, scene, notes)?;
    job.warn_of_darkness()?;
    let pool = output::thread_pool(args.common.threads)?;
    if let Some(boards) = boards {
        let calibration = pool.install(|| calibration::estimated(&job, &boards))?;
        job.measurement = job.measurement.with_calibration(calibration);
    }
    let measured = pool.install(|| job.measure())?;
    let report = write(&job, &measured)?;
    report.print(false, &[job.files.path("report.html")], out)?;
    measured.terms.map(drop).map_err(|refusal| {
        let message = format!(
            "{}: nothing was measured: {}",
            args.common.scene.display(),
            refusal.why
        );
        Failure::no_result(message, refusal.advice)
    })
}

/// Writes all files, and returns the report.
fn write(job: &Job<'_>, measured: &ScanResult) -> Result<Report, Failure> {
    let height = job.measurement.settings().height;
    job.files.write_profiles(&measured.profiles, height)?;
    job.files.write_point_clouds(&measured.profiles)?;
    job.files.write_height_map(measured.map.as_ref())?;
    let report = report::report(job, measured)?;
    report.save_json(&job.files.path("measurement.json"))?;
    report.save_page(&job.files.path("report.html"))?;
    Ok(report)
}
