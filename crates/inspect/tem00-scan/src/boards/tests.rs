use std::{path::Path, sync::atomic::AtomicBool};

use tem00_calibration::find_corners;
use tem00_camera::{CameraDescription, RadialDistortion};
use tem00_scene::parse_scene;
use tem00_testkit::assert_absolute;
use tem00_triangulation::{DetectorSettings, LineDetector, Sensor, SensorDescription};

use super::*;
use crate::laser_plane::plane_of;

/// A short lens before a vertical laser plane, at 30° from it.
fn scene() -> Scene {
    let text = r#"
        [camera]
        position = ["0 mm", "-125 mm", "216.5 mm"]
        look_at = ["0 mm", "0 mm", "0 mm"]
        up = [0, 0, 1]
        focal_length = "8 mm"
        f_number = 16
        focus_distance = "250 mm"
        pixel_pitch = "16 um"
        resolution = [240, 180]
        distortion = [-0.2, 0, 0]

        [render]
        samples_per_pixel = 16

        [[laser]]
        wavelength = "650 nm"
        power = "5 mW"
        position = ["0 mm", "0 mm", "300 mm"]
        look_at = ["0 mm", "0 mm", "0 mm"]
        line_direction = [1, 0, 0]
        line = { fan_angle = "40 deg", thickness = "2 mm", focus_distance = "300 mm" }

        [[surface]]
        rectangle = { size = ["200 mm", "200 mm"] }
    "#;
    parse_scene(text, Path::new(".")).unwrap()
}

fn plan(boards: usize) -> BoardPlan {
    plan_of(&scene(), boards)
}

fn plan_of(scene: &Scene, boards: usize) -> BoardPlan {
    let settings = BoardSettings {
        corners: [7, 5],
        boards,
        ..BoardSettings::default()
    };
    BoardPlan::new(scene, &settings).unwrap()
}

fn sensor() -> Sensor {
    Sensor::new(SensorDescription {
        quantum_efficiency: 0.6,
        exposure_time: 2e-3,
        pixel_pitch: 16e-6,
        ..SensorDescription::typical(12)
    })
    .unwrap()
}

#[test]
fn rendered_corners_are_found_where_they_are_projected() {
    let plan = plan(2);
    let camera = scene().camera;
    let cancel = AtomicBool::new(false);
    let mut sum = 0.0;
    for (i, pose) in plan.poses().iter().enumerate() {
        let [lit, _] = plan.frames(i, &sensor(), &|_| (), &cancel).unwrap();
        let found = find_corners(&lit.grey_values(), plan.board()).unwrap();
        for (found, corner) in found.iter().zip(plan.board().points()) {
            let expected = camera.project(pose.point(corner)).unwrap();
            let distance = found.distance(expected);
            sum += distance * distance;
            // Four deviations, along both axes.
            assert!(distance < 0.19, "board {i}: {found} instead of {expected}");
        }
    }
    // Sampling noise: the pixels on the edges scatter by √(1/6 / 16) of the contrast. By a saddle
    // of the curvature 1 / (π σ²) a position scatters by its square times √π / (8 σ): 0.033 pixel
    // per axis for a smoothing of 2 pixels. With 140 coordinates the root mean square is 25 % more
    // with 1e-5.
    let rms = (sum / (2.0 * 35.0)).sqrt();
    assert!(rms < 0.06, "{rms}");
}

#[test]
fn rendered_boards_give_the_scene_back() {
    let mut scene = scene();
    // The noise of few samples counts in the stated uncertainty.
    scene.render.samples_per_pixel = 4;
    let plan = plan_of(&scene, 6);
    let detector = LineDetector::new(DetectorSettings {
        window: 15,
        ..DetectorSettings::default()
    })
    .unwrap();
    let cancel = AtomicBool::new(false);
    let frames = (0..plan.poses().len()).map(|pose| {
        let frames = plan.frames(pose, &sensor(), &|_| (), &cancel);
        frames.unwrap()
    });
    let calibration = plan
        .calibration(&frames.collect::<Vec<_>>(), &detector)
        .unwrap();
    let exact = Triangulator::new(scene.camera, plane_of(&scene.lasers[0]).unwrap());
    for pixel in [[120.0, 90.0], [60.0, 60.0], [180.0, 120.0]].map(DVec2::from) {
        let (found, expected) = (calibration.triangulator().point(pixel), exact.point(pixel));
        let (found, expected) = (found.unwrap(), expected.unwrap());
        let uncertainty = calibration.height_uncertainty(found, DVec3::Z).unwrap();
        // Four standard uncertainties: 6e-5 for each of three points, which are hardly independent.
        let error = (found.z - expected.z).abs();
        assert!(
            error < 4.0 * uncertainty,
            "{pixel}: {error:e}, {uncertainty:e} m"
        );
        // A pixel is 1 mm in height; six boards determine it to a fifth.
        assert!(uncertainty < 2e-4, "{uncertainty:e} m");
    }
}

/// The stage before a lens without distortion.
fn stage() -> Stage {
    let scene = scene();
    let camera = Camera::new(CameraDescription {
        distortion: RadialDistortion::default(),
        ..*scene.camera.description()
    });
    Stage::new(&camera.unwrap(), &scene.lasers[0]).unwrap()
}

#[test]
fn boards_shift_until_the_line_is_off_their_middle_or_by_a_tenth_of_the_distance() {
    // A board leans by half of the angle between view and laser plane. A shift s moves its middle
    // from the plane by s sin of that angle, and the line on it by this shift over the cosine of
    // the half.
    let angle = 125_f64.atan2(216.5);
    let by_line = 0.3 * 20e-3 * (0.5 * angle).cos() / angle.sin();
    for (square, expected) in [(5e-3, by_line), (20e-3, 0.1 * 0.125_f64.hypot(0.2165))] {
        let board = Checkerboard::new([7, 5], square).unwrap();
        assert_absolute(stage().largest_shift(&board), expected, 1e-12);
    }
}

#[test]
fn a_board_is_seen_if_four_pixels_are_left_beside_its_squares() {
    let stage = stage();
    let board = Checkerboard::new([7, 5], 5e-3).unwrap();
    let axes = stage.camera.axes();
    // Across the axis, in the plane in focus, where a pixel is 16 µm (L − f) / f wide.
    let focus = stage.camera.position() - 0.25 * axes.z_axis;
    let pixel = 16e-6 * 242.0 / 8.0;
    // Half of the image minus half of the 8 × 6 squares, which are turned so that one corner leads
    // on each side.
    let turn = 0.2_f64;
    let (right, up) = (
        120.0 * pixel - 20e-3 * turn.cos() - 15e-3 * turn.sin(),
        90.0 * pixel - 20e-3 * turn.sin() - 15e-3 * turn.cos(),
    );
    let turned = axes * DMat3::from_rotation_z(turn);
    for (side, gap) in [
        (axes.x_axis, right),
        (-axes.x_axis, right),
        (axes.y_axis, up),
        (-axes.y_axis, up),
    ] {
        for (left, is_seen) in [(3.99, false), (4.01, true)] {
            let middle = focus + (gap - left * pixel) * side;
            let pose = RigidMotion::new(turned, middle - turned * board.middle()).unwrap();
            assert_eq!(stage.sees(&board, &pose), is_seen, "{side}: {left}");
        }
    }
}

#[test]
fn boards_that_do_not_fit_are_refused() {
    let settings = BoardSettings {
        square: Some(0.1),
        ..BoardSettings::default()
    };
    let refused = BoardPlan::new(&scene(), &settings).unwrap_err();
    assert!(refused.to_string().contains("square_size"), "{refused}");
    let mut dark = scene();
    dark.lasers.clear();
    let refused = BoardPlan::new(&dark, &settings).unwrap_err();
    assert!(refused.to_string().contains("lasers"), "{refused}");
    let fits = plan(6).board().square();
    assert!((1e-3..20e-3).contains(&fits), "{fits}");
}

#[test]
fn lines_span_the_laser_plane() {
    let plan = plan(12);
    let plane = plane_of(&scene().lasers[0]).unwrap();
    let offset = |pose: &RigidMotion| plane.distance(pose.point(plan.board().middle()));
    let offsets: Vec<f64> = plan.poses().iter().map(offset).collect();
    let height = plan.board().square() * 4.0;
    let [low, high] = [f64::min as fn(f64, f64) -> f64, f64::max]
        .map(|end| offsets.iter().copied().fold(0.0, end));
    assert!(high - low > 0.2 * height, "{offsets:?}");
    assert!(high.max(-low) < 0.5 * height, "{offsets:?}");
}
