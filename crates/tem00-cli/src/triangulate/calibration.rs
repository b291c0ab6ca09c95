//! The calibration that a measurement is made with.

use std::{
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
};

use tem00_triangulation::{BoardPlan, CalibrationMethod, CalibrationSettings, Measurement};

use super::measurement_failure;
use crate::{failure::Failure, interrupt, progress::Progress};

/// Returns the measurement with the calibration that the scene asks for: exact, or estimated from boards
/// that are rendered and photographed with the same sensor.
///
/// # Errors
///
/// Returns a failure if the boards do not give a calibration or the user ends it.
pub(super) fn calibrated(
    measurement: Measurement,
    settings: &CalibrationSettings,
    scene: &Path,
) -> Result<Measurement, Failure> {
    let CalibrationMethod::Estimated(boards) = &settings.method else {
        return Ok(measurement);
    };
    if boards.folder.is_some() {
        return Err(Failure::input(
            format!(
                "{}: images of real boards do not tell where the scene is: leave out `folder` in [calibration]",
                scene.display()
            ),
            "`tem00 calibrate` estimates a calibration from a folder, and `tem00 lines --calibration` uses it",
        ));
    }
    let refused = |error| measurement_failure(scene, &error);
    let plan = BoardPlan::new(measurement.scene(), boards).map_err(refused)?;
    let bar = Progress::of(plan.samples(), "samples");
    bar.name(format!("calibration, {} boards", boards.boards));
    let done = AtomicU64::new(0);
    let advance = |samples| bar.set(done.fetch_add(samples, Ordering::Relaxed) + samples);
    let calibration = plan
        .calibrate(
            measurement.sensor(),
            measurement.detector(),
            advance,
            interrupt::flag(),
        )
        .map_err(refused)?;
    Ok(measurement.with_calibration(calibration))
}
