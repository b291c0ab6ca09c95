//! A step of known height, measured from end to end: rendered, exposed, found, triangulated. The
//! height comes back within the uncertainty that the measurement states of itself.

mod step_artefact;

use step_artefact::{PLATES, STEP, measure, measured_frame, prepare, scene, step};
use tem00::scan::{Averaging, MeasuredFrame, MeasuredPoint, MeasurementScene, Scan};
use tem00::tracer::Trajectory;
use tem00::triangulation::DVec3;
use tem00_testkit::assert_absolute;

/// The scene, with both plates moving by so many metres per frame.
fn moving(by: DVec3, frames: u32) -> MeasurementScene {
    let mut scene = scene();
    scene.scene.frames = frames;
    for surface in &mut scene.scene.surfaces {
        surface.trajectory = Trajectory::steady(by).expect("a motion");
    }
    scene
}

/// Returns how far a point lies above its plate, in metres; nothing beside the plates and at their
/// edge.
fn height_error(point: &MeasuredPoint) -> Option<f64> {
    let plates = &mut PLATES.iter();
    let plate = plates.position(|plate| plate.contains(&point.seen.column));
    let height = plate.filter(|_| point.is_valid())? as f64 * STEP;
    Some(point.position.z - height)
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

    let points = part.profiles().iter().flatten();
    let score = |point: &MeasuredPoint| {
        Some((height_error(point)? / point.uncertainty_along(DVec3::Z)).powi(2))
    };
    let squares: Vec<f64> = points.filter_map(score).collect();
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
    // 50 µm are 1.1 pixels across the line, of a width of 6.8, and a tenth of that to the side.
    // Speckle that has moved by half of that width moves the line the other way.
    let prepared = prepare(&moving(DVec3::new(5e-6, 5e-5, 0.0), 24));
    let errors = |frame: &MeasuredFrame| {
        let mut errors = [None; 96];
        for point in &frame.points {
            errors[point.seen.column] = height_error(point);
        }
        errors
    };
    let frames: Vec<MeasuredFrame> = (0..24).map(|f| measured_frame(&prepared, f)).collect();
    let correlation = prepared.0.frame_correlation(&frames[0], 4);
    let errors: Vec<_> = frames.iter().map(errors).collect();
    for later in [1, 3] {
        let both = errors.iter().zip(&errors[later..]);
        let columns = both.flat_map(|(a, b)| a.iter().zip(b));
        let [mut products, mut squares] = [0.0; 2];
        for (a, b) in columns.filter_map(|(a, b)| a.zip(*b)) {
            products += a * b;
            squares += 0.5 * (a * a + b * b);
        }
        // Some 1500 pairs, of which neighbours in either direction are correlated, are worth 400: a
        // standard error of 0.05 at most.
        let expected = correlation.between(0, u32::try_from(later).expect("few frames"));
        assert_absolute(products / squares, expected, 0.16);
    }
}
