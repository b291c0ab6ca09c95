//! A step of known height, measured from end to end: rendered, exposed, found, triangulated. The
//! height comes back within the uncertainty that the measurement states of itself.

mod step_artefact;

use step_artefact::{PLATES, STEP, measure, measured_frame, prepare, scene, step};
use tem00::scan::{Averaging, MeasuredPoint, Scan};
use tem00::tracer::Trajectory;
use tem00::triangulation::DVec3;

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
    let mut scene = scene();
    scene.scene.frames = 21;
    let rising = Trajectory::steady(DVec3::new(0.0, 1e-4, 1e-5)).expect("a motion");
    for surface in &mut scene.scene.surfaces {
        surface.trajectory = rising.clone();
    }
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

    // Of the points on a plate, clear of the edge.
    let square = |point: &MeasuredPoint| {
        let plate = PLATES
            .iter()
            .position(|plate| plate.contains(&point.seen.column));
        let height = plate.filter(|_| point.is_valid())? as f64 * STEP;
        Some(((point.position.z - height) / point.uncertainty_along(DVec3::Z)).powi(2))
    };
    let squares: Vec<f64> = part
        .profiles()
        .iter()
        .flatten()
        .filter_map(square)
        .collect();
    let mean_square = squares.iter().sum::<f64>() / squares.len() as f64;
    // 7 · 22 blocks of columns, hardly correlated.
    assert!(squares.len() >= 150, "{}", squares.len());
    assert!(
        MEAN_SQUARES_OF_A_SCAN.contains(&mean_square),
        "{mean_square}"
    );
}
