//! A step of known height, measured from end to end: rendered, exposed, found, triangulated. The height
//! comes back within the uncertainty that the measurement states of itself.

mod step_artefact;

use step_artefact::{PLATES, STEP, measure, measured_frame, prepare, scene, step};
use tem00::scan::{
    Averaging, MeasuredFrame, MeasuredPoint, MeasurementScene, Scan, SpeckleCorrelation,
};
use tem00::tracer::Trajectory;
use tem00::triangulation::DVec3;

/// The scene, with both plates moving by so many metres per frame.
fn moving(by: DVec3, frames: u32) -> MeasurementScene {
    let mut scene = scene();
    scene.scene.frames = frames;
    for surface in &mut scene.scene.surfaces {
        surface.trajectory = Trajectory::steady(by).expect("a motion");
    }
    scene
}

/// How far a point lies above its plate, in metres.
fn height_error(point: &MeasuredPoint) -> f64 {
    let plate = if point.seen.pixel.x < 48.0 { 0.0 } else { STEP };
    point.position.z - plate
}

/// Whether a column lies on a plate, clear of the edge.
fn is_clear(point: &MeasuredPoint) -> bool {
    let on_plate = |plate: &core::ops::Range<usize>| plate.contains(&point.seen.column);
    point.is_valid() && PLATES.iter().any(on_plate)
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

/// With 160 degrees of freedom χ²/160 leaves this range with a probability of 1e-4.
const MEAN_SQUARES_OF_A_SCAN: core::ops::Range<f64> = 0.62..1.50;

#[test]
fn a_part_that_moves_and_rises_keeps_its_heights() {
    // The plates rise by a fifth of the step in all; their own heights must not.
    let mut scene = moving(DVec3::new(0.0, 1e-4, 1e-5), 21);
    scene.scan.average = Averaging {
        frames: 3,
        columns: 3,
    };
    let prepared = prepare(&scene);
    let mut scan = Scan::new(&prepared.0);
    for frame in 0..21 {
        scan.add(measured_frame(&prepared, frame));
    }
    let part = scan.finish();
    assert_eq!(part.profiles().len(), 7, "three frames to a profile");
    let independent = part.effective_frames().expect("points are valid");
    // Speckle that has moved by a good part of the width of the line moves it the other way.
    assert!((1.0..4.0).contains(&independent), "{independent}");

    let points = part.profiles().iter().flatten().filter(|p| is_clear(p));
    let squares: Vec<f64> = points
        .map(|point| (height_error(point) / point.uncertainty_along(DVec3::Z)).powi(2))
        .collect();
    let mean_square = squares.iter().sum::<f64>() / squares.len() as f64;
    // 7 · 22 blocks of columns, hardly correlated.
    assert!(squares.len() >= 150, "{}", squares.len());
    assert!(
        MEAN_SQUARES_OF_A_SCAN.contains(&mean_square),
        "{mean_square}"
    );
}

#[test]
fn errors_of_consecutive_frames_correlate_as_the_law_of_speckle_motion_says() {
    // 50 µm are 1.1 pixels across the line, of a width of 6.8, and a tenth of that to the side. Speckle
    // that has moved by half of that width moves the line the other way.
    let scene = moving(DVec3::new(5e-6, 5e-5, 0.0), 24);
    let prepared = prepare(&scene);
    let frames: Vec<MeasuredFrame> = (0..24).map(|f| measured_frame(&prepared, f)).collect();
    let errors = |frame: &MeasuredFrame| {
        let mut errors = [f64::NAN; 96];
        for point in frame.points.iter().filter(|p| is_clear(p)) {
            errors[point.seen.column] = height_error(point);
        }
        errors
    };
    let correlation = prepared.0.frame_correlation(&frames[0], 4);
    for later in [1_u32, 3] {
        let pairs: Vec<[f64; 2]> = frames
            .windows(later as usize + 1)
            .flat_map(|window| {
                errors(&window[0])
                    .into_iter()
                    .zip(errors(&window[later as usize]))
            })
            .map(|(a, b)| [a, b])
            .filter(|pair| pair.iter().all(|error| error.is_finite()))
            .collect();
        let mean = |of: &dyn Fn(&[f64; 2]) -> f64| pairs.iter().map(of).sum::<f64>();
        let found = mean(&|[a, b]| a * b) / mean(&|[a, b]| 0.5 * (a * a + b * b));
        let expected = correlation.between(0, later);
        // Some 1500 pairs, of which neighbours in either direction are correlated, are worth 400: a
        // standard error of 0.05 at most.
        let difference = found - expected;
        assert!(difference.abs() < 0.16, "{later}: {found}, {expected}");
    }
}
