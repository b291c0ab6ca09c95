//! A step between two plates, measured from end to end.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use tem00::config::FileAccess;
use tem00::engine::SpeckleModel;
use tem00::scan::{MeasuredFrame, MeasuredPoint, Measurement, MeasurementScene, mean_point};

use crate::renders;

/// The height of the step, in metres.
pub(crate) const STEP: f64 = 1e-3;

/// The columns of the lower and of the upper plate: as many, clear of the edge by a window's worth.
pub(crate) const PLATES: [core::ops::Range<usize>; 2] = [4..40, 56..92];

pub(crate) fn scene() -> MeasurementScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/step_height/step.toml");
    MeasurementScene::read(&path, FileAccess::WithinFolder)
        .expect("the scene is one")
        .0
}

/// Generates the speckle of a scene with its own seed, and prepares to measure it.
pub(crate) fn prepare(scene: &MeasurementScene) -> (Measurement, SpeckleModel) {
    let speckle = renders::speckle(&scene.scene, scene.scene.render.seed);
    let measurement = Measurement::new(scene.clone()).expect("the scene can be measured");
    (measurement, speckle)
}

pub(crate) fn measured_frame(
    (measurement, speckle): &(Measurement, SpeckleModel),
    frame: u32,
) -> MeasuredFrame {
    measurement
        .measure(Some(speckle), frame, &|_| (), &AtomicBool::new(false))
        .expect("the frame is rendered")
}

/// Measures the first frame of a scene with its own seed.
pub(crate) fn measure(scene: &MeasurementScene) -> (Measurement, MeasuredFrame) {
    let prepared = prepare(scene);
    let frame = measured_frame(&prepared, 0);
    (prepared.0, frame)
}

/// The mean over the columns of a plate.
fn plate(
    (measurement, frame): &(Measurement, MeasuredFrame),
    columns: &core::ops::Range<usize>,
) -> MeasuredPoint {
    let correlation = measurement.frame_correlation(frame, 1);
    let points: Vec<_> = frame
        .points
        .iter()
        .filter(|point| point.is_valid() && columns.contains(&point.seen.column))
        .map(|point| (frame.frame, point))
        .collect();
    let mean = mean_point(&points, |columns, later| {
        correlation.between(columns, later)
    });
    mean.expect("the line crosses the plate")
}

/// The height of the step and its standard uncertainty, in metres.
pub(crate) fn step(measured: &(Measurement, MeasuredFrame)) -> [f64; 2] {
    let [lower, upper] = PLATES.map(|columns| plate(measured, &columns));
    let up = measured.0.settings().height;
    // Plates far apart share no speckle.
    let uncertainty = lower
        .uncertainty_along(up)
        .hypot(upper.uncertainty_along(up));
    [(upper.position - lower.position).dot(up), uncertainty]
}
