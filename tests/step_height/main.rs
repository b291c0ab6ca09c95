//! A step of known height, measured from end to end: rendered, exposed, found, triangulated. The height
//! comes back within the uncertainty that the measurement states of itself.

#![expect(clippy::expect_used, reason = "a test ends where something fails")]

use std::path::Path;
use std::sync::atomic::AtomicBool;

use tem00::tracer::{Formulas, SpeckleModel, SpecklePlan};
use tem00::triangulation::{
    FrameCorrelation, MeasuredFrame, MeasuredPoint, Measurement, MeasurementScene, mean_point,
};

/// The height of the step, in metres.
const STEP: f64 = 1e-3;

/// The columns of the lower and of the upper plate: as many, clear of the edge by a window's worth.
const PLATES: [core::ops::Range<usize>; 2] = [4..40, 56..92];

fn scene() -> MeasurementScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/step_height/step.toml");
    MeasurementScene::read(&path).expect("the scene is one").0
}

/// Measures the first frame of a scene with its own seed.
fn measure(scene: &MeasurementScene) -> (Measurement, MeasuredFrame) {
    let plan = SpecklePlan::new(&scene.scene, Formulas::Derived, scene.scene.render.seed);
    let plan = plan.expect("the patterns fit");
    let speckle = SpeckleModel::generate(&scene.scene, &plan).expect("the patterns fit");
    let measurement = Measurement::new(scene.clone()).expect("the scene can be measured");
    let frame = measurement.measure(Some(&speckle), 0, |_| (), &AtomicBool::new(false));
    let frame = frame.expect("the frame is rendered");
    (measurement, frame)
}

/// The mean over the columns of a plate.
fn plate(
    (measurement, frame): &(Measurement, MeasuredFrame),
    columns: &core::ops::Range<usize>,
) -> MeasuredPoint {
    let correlation: FrameCorrelation = measurement.frame_correlation(frame, 1);
    let points: Vec<_> = frame
        .points
        .iter()
        .filter(|point| point.is_valid() && columns.contains(&point.seen.column))
        .map(|point| (frame.frame, point))
        .collect();
    mean_point(&points, &correlation).expect("the line crosses the plate")
}

/// The height of the step and its standard uncertainty, in metres.
fn step(measured: &(Measurement, MeasuredFrame)) -> [f64; 2] {
    let [lower, upper] = PLATES.map(|columns| plate(measured, &columns));
    let up = measured.0.settings().height;
    // Plates far apart share no speckle.
    let uncertainty = lower
        .uncertainty_along(up)
        .hypot(upper.uncertainty_along(up));
    [(upper.position - lower.position).dot(up), uncertainty]
}

/// Of 60 correct 95 % intervals fewer than 51 hold the height with a probability of 7e-4.
const FEWEST_COVERED: usize = 51;

/// With 60 degrees of freedom χ²/60 leaves this range with a probability of 1e-3.
const MEAN_SQUARES: core::ops::Range<f64> = 0.506..1.712;

#[test]
fn a_step_comes_back_within_its_uncertainty() {
    let mut scene = scene();
    let scores: Vec<f64> = (0..60)
        .map(|seed| {
            scene.scene.render.seed = seed;
            let [height, uncertainty] = step(&measure(&scene));
            (height - STEP) / uncertainty
        })
        .collect();
    let covered = scores.iter().filter(|z| z.abs() < 1.96).count();
    assert!(covered >= FEWEST_COVERED, "{covered} of 60: {scores:.2?}");
    let mean_square = scores.iter().map(|z| z * z).sum::<f64>() / 60.0;
    assert!(
        MEAN_SQUARES.contains(&mean_square),
        "{mean_square}: {scores:.2?}"
    );
}
