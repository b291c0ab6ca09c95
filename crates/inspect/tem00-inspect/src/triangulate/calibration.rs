//! The calibration that a measurement is made with.

use std::sync::atomic::{AtomicU64, Ordering};

use tem00_calibration::{BoardSettings, Calibration};
use tem00_report::{failure::Failure, interrupt, progress::Progress};
use tem00_scan::{BoardPlan, ScanError};

use super::job::{Job, measurement_failure};

/// Estimates the calibration of a measurement from boards that are rendered and photographed with
/// the same sensor. The photographs are written, for `tem00-inspect calibrate`.
///
/// # Errors
///
/// Returns a failure if the boards do not give a calibration, a file cannot be written or the user
/// interrupts it.
pub(super) fn estimated(job: &Job<'_>, boards: &BoardSettings) -> Result<Calibration, Failure> {
    let refused = |error: ScanError| measurement_failure(&job.args.common.scene, &error);
    let measurement = &job.measurement;
    let plan = BoardPlan::new(measurement.scene(), boards).map_err(refused)?;
    let bar = Progress::of(plan.samples(), "samples");
    bar.name(format!("calibration, {} boards", boards.boards));
    let done = AtomicU64::new(0);
    let advance = |samples| bar.set(done.fetch_add(samples, Ordering::Relaxed) + samples);
    let mut frames = Vec::new();
    for pose in 0..plan.poses().len() {
        let pair = plan.frames(pose, measurement.sensor(), &advance, interrupt::flag());
        let pair = pair.map_err(refused)?;
        job.files.write_board(pose, &pair)?;
        frames.push(pair);
    }
    plan.calibration(&frames, measurement.detector())
        .map_err(refused)
}
