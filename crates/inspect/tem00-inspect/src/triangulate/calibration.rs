//! The calibration that a measurement is made with.

use std::{
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
};

use tem00_calibration::CalibrationSettings;
use tem00_report::{failure::Failure, interrupt, progress::Progress};
use tem00_scan::{BoardPlan, Measurement, ScanError};

use super::{files::Files, job::measurement_failure};

/// Returns the measurement with the calibration that the scene asks for: exact, or estimated from
/// boards that are rendered and photographed with the same sensor. The photographs are written, for
/// `tem00-inspect calibrate`.
///
/// # Errors
///
/// Returns a failure if the boards do not give a calibration, a file cannot be written or the user
/// interrupts it.
pub(super) fn calibrated(
    measurement: Measurement,
    settings: &CalibrationSettings,
    (scene, files): (&Path, &Files),
) -> Result<Measurement, Failure> {
    let Some(boards) = &settings.boards else {
        return Ok(measurement);
    };
    let refused = |error: ScanError| measurement_failure(scene, &error);
    let plan = BoardPlan::new(measurement.scene(), boards).map_err(refused)?;
    let bar = Progress::of(plan.samples(), "samples");
    bar.name(format!("calibration, {} boards", boards.boards));
    let done = AtomicU64::new(0);
    let advance = |samples| bar.set(done.fetch_add(samples, Ordering::Relaxed) + samples);
    let mut frames = Vec::new();
    for pose in 0..plan.poses().len() {
        let pair = plan.frames(pose, measurement.sensor(), &advance, interrupt::flag());
        let pair = pair.map_err(refused)?;
        files.write_board(pose, &pair)?;
        frames.push(pair);
    }
    let calibration = plan.calibration(&frames, measurement.detector());
    let calibration = calibration.map_err(refused)?;
    Ok(measurement.with_calibration(calibration))
}
