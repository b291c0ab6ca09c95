use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, Normal};
use tem00_camera::{CameraDescription, RadialDistortion, SensorTilt};
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use tem00_triangulation::Triangulator;

const PITCH: f64 = 8e-6;

/// A short lens that sees ±0.2 in tangents.
fn camera(tilt: f64, distortion: RadialDistortion) -> Camera {
    Camera::new(CameraDescription {
        position: 0.25 * DVec3::new(0.0, -0.5, 0.75_f64.sqrt()),
        up: DVec3::Z,
        focal_length: 12e-3,
        focus_distance: 0.25,
        pixel_pitch: PITCH,
        principal_point: (tilt == 0.0).then_some(DVec2::new(331.0, 226.0)),
        tilt: SensorTilt {
            angle: tilt,
            azimuth: 0.1,
        },
        distortion,
        ..CameraDescription::default()
    })
    .unwrap()
}

fn laser_plane() -> LaserPlane {
    LaserPlane::new(DVec3::ZERO, DVec3::new(0.02, 1.0, 0.01)).unwrap()
}

fn board() -> Checkerboard {
    Checkerboard::new([7, 5], 8e-3).unwrap()
}

/// Boards from the frame of the board to the world: the middle near the origin, tilted about the
/// directions of a star.
fn poses(number: u32) -> Vec<RigidMotion> {
    let pose = |i: u32| {
        let angle = 2.4 * f64::from(i);
        let height = 4e-3 * f64::from(i % 3) - 4e-3;
        let axis = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let tilt = if i == 0 { 0.0 } else { 0.4 };
        let centred = RigidMotion::along(height * DVec3::Z - board().middle()).unwrap();
        // Leant towards the camera.
        let leant = RigidMotion::about(DVec3::ZERO, DVec3::X, 0.25).unwrap();
        centred
            .then(&RigidMotion::about(DVec3::ZERO, axis, tilt).unwrap())
            .then(&leant)
    };
    (0..number).map(pose).collect()
}

fn view(camera: &Camera, pose: &RigidMotion) -> BoardView {
    let points = board().points();
    let corners = points
        .iter()
        .map(|&corner| camera.project(pose.point(corner)).unwrap());
    // Where the laser plane cuts the board, from the left of the image to its right.
    let (normal, up) = (laser_plane().normal(), pose.direction(DVec3::Z));
    let along = normal.cross(up).normalize();
    let along = along * along.x.signum();
    let middle = pose.point(board().middle());
    let down = along.cross(up);
    let start = middle - down * (laser_plane().distance(middle) / normal.dot(down));
    let line = (-20..=20).map(|i| camera.project(start + 1e-3 * f64::from(i) * along).unwrap());
    BoardView {
        corners: corners.collect(),
        line: line.collect(),
    }
}

fn views(camera: &Camera, number: u32) -> Vec<BoardView> {
    poses(number)
        .iter()
        .map(|pose| view(camera, pose))
        .collect()
}

fn model(tilted: bool, radial: usize) -> CameraModel {
    CameraModel {
        pixel_pitch: PITCH,
        resolution: [640, 480],
        focal_length: Some(12e-3),
        f_number: 8.0,
        tilted,
        radial,
    }
}

const BARREL: RadialDistortion = RadialDistortion {
    k1: -0.3,
    k2: 0.2,
    k3: 0.0,
};

#[test]
fn exact_corners_give_the_camera_back() {
    for (tilt, radial, distortion) in [
        (0.0, 0, RadialDistortion::default()),
        (0.0, 2, BARREL),
        (0.08, 1, RadialDistortion { k2: 0.0, ..BARREL }),
        (-0.08, 0, RadialDistortion::default()),
    ] {
        let truth = camera(tilt, distortion);
        let calibration =
            calibrate(&board(), &views(&truth, 6), &model(tilt != 0.0, radial)).unwrap();
        let (found, expected) = (calibration.camera().description(), truth.description());
        // The search ends when at most 1e-12 of the sum of squares can be gained; the sum itself is
        // the rounding of pixels, 1e-12 pixel. Pixels on the far side of derivatives leave 1e-6 of
        // all.
        let distance = calibration.camera().image_distance();
        assert_relative(distance, truth.image_distance(), 1e-6);
        assert_relative(found.focus_distance, expected.focus_distance, 1e-4);
        let difference = found.axis_point().distance(expected.axis_point());
        assert!(difference < 1e-3, "{tilt}: {difference} pixel");
        let vector = |tilt: SensorTilt| tilt.angle * DVec2::from_angle(tilt.azimuth);
        let difference = vector(found.tilt).distance(vector(expected.tilt));
        assert!(difference < 1e-5, "{tilt}: {difference} rad");
        assert_absolute(found.distortion.k1, distortion.k1, 1e-4);
        assert_absolute(found.distortion.k2, distortion.k2, 1e-2);
        let quality = calibration.quality().unwrap();
        assert!(quality.rms_reprojection < 1e-7, "{quality:?}");
        assert!(quality.rms_plane < 1e-10, "{quality:?}");
        assert_eq!((quality.boards, quality.corners), (6, 210));
    }
}

#[test]
fn the_world_is_the_first_board() {
    let truth = camera(0.0, BARREL);
    let calibration = calibrate(&board(), &views(&truth, 6), &model(false, 2)).unwrap();
    let to_board = poses(1)[0].inverse();
    let position = to_board.point(truth.position());
    // 1e-6 of the distance, as the image distance.
    let apart = calibration.camera().position().distance(position);
    assert!(apart < 1e-6, "{apart}");
    let plane = calibration.plane();
    let origin = to_board.point(laser_plane().point());
    assert!(plane.distance(origin).abs() < 1e-7, "{plane:?}");
    let normal = to_board.direction(laser_plane().normal());
    assert!(plane.normal().cross(normal).length() < 1e-5, "{plane:?}");
}

/// Moves every position by normal noise.
fn noisy(views: &[BoardView], sigma: f64, seed: u64) -> Vec<BoardView> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let normal = Normal::new(0.0, sigma).unwrap();
    let mut moved =
        |position: &DVec2| position + DVec2::new(normal.sample(&mut rng), normal.sample(&mut rng));
    let mut view = |view: &BoardView| BoardView {
        corners: view.corners.iter().map(&mut moved).collect(),
        line: view.line.iter().map(&mut moved).collect(),
    };
    views.iter().map(&mut view).collect()
}

#[test]
fn errors_are_as_large_as_their_covariance_says() {
    const SEEDS: u64 = 24;
    let truth = camera(0.0, RadialDistortion { k2: 0.0, ..BARREL });
    let exact = views(&truth, 6);
    let to_board = poses(1)[0].inverse();
    let triangulator = Triangulator::new(truth, laser_plane());
    let pixels = [DVec2::new(320.0, 240.0), DVec2::new(150.0, 130.0)];
    let heights = pixels.map(|pixel| to_board.point(triangulator.point(pixel).unwrap()).z);
    let free = [0, 1, 2, 5];
    let expected = [truth.image_distance(), 331.0, 226.0, BARREL.k1];
    let (mut parameters, mut height, mut step) = (0.0, [0.0; 2], 0.0);
    for seed in 0..SEEDS {
        let calibration = calibrate(&board(), &noisy(&exact, 0.1, seed), &model(false, 1)).unwrap();
        let covariance = calibration.covariance().unwrap();
        let found = calibration.camera().description();
        let principal = found.principal_point.unwrap();
        let found = [
            calibration.camera().image_distance(),
            principal.x,
            principal.y,
            found.distortion.k1,
        ];
        let error = nalgebra::Vector4::from_fn(|i, _| found[i] - expected[i]);
        let matrix = nalgebra::Matrix4::from_fn(|i, j| covariance.between(free[i], free[j]));
        parameters += (error.transpose() * matrix.try_inverse().unwrap() * error)[0];
        let points = pixels.map(|pixel| calibration.triangulator().point(pixel).unwrap());
        for i in 0..2 {
            let uncertainty = calibration.height_uncertainty(points[i], DVec3::Z).unwrap();
            height[i] += ((points[i].z - heights[i]) / uncertainty).powi(2);
        }
        let uncertainty = calibration.step_uncertainty(points, DVec3::Z).unwrap();
        step += ((points[1].z - points[0].z - heights[1] + heights[0]) / uncertainty).powi(2);
    }
    // χ² of 4 · 24 and of 24 degrees of freedom, each at 5e-4 on either side. The variance is
    // itself estimated from 380 degrees of freedom, which widens χ² by half a per cent.
    assert!((56.0..150.0).contains(&parameters), "{parameters}");
    for sum in [height[0], height[1], step] {
        assert!((7.3..54.0).contains(&sum), "{height:?}, {step}");
    }
}

#[test]
fn corners_that_are_given_twice_count_twice() {
    let views = noisy(&views(&camera(0.0, RadialDistortion::default()), 3), 0.1, 1);
    let model = model(false, 0);
    let variance = |times: usize| {
        let points = board().points().repeat(times);
        let corners = views.iter().map(|view| view.corners.repeat(times));
        let corners: Vec<_> = corners.collect();
        let bundle = Bundle {
            model: &model,
            free: vec![0, 1, 2],
            board: &points,
            images: corners.iter().map(Vec::as_slice).collect(),
        };
        let solution = minimise(&bundle, best_pinhole(&bundle).unwrap());
        solution.unwrap().covariance[(0, 0)]
    };
    // The sum of squares and the normal matrix are doubled; of 210 and 420 coordinates the camera
    // and three poses take 21.
    let expected = (420.0 - 21.0) / (210.0 - 21.0);
    assert_relative(variance(1) / variance(2), expected, 1e-6);
}

#[test]
fn lines_beyond_the_board_and_stray_points_do_not_count() {
    let truth = camera(0.0, RadialDistortion::default());
    let mut views = views(&truth, 6);
    let good = calibrate(&board(), &views, &model(false, 0)).unwrap();
    for view in &mut views {
        view.line.push(DVec2::new(5.0, 5.0));
        let stray = view.line[3] + DVec2::new(0.0, 3.0);
        view.line.push(stray);
    }
    let found = calibrate(&board(), &views, &model(false, 0)).unwrap();
    assert_eq!(found.quality().unwrap().outliers, 6);
    let turned = found.plane().normal().cross(good.plane().normal()).length();
    assert!(turned < 1e-9, "{turned:e}");
}

#[test]
fn what_leaves_something_open_is_refused() {
    let views = views(&camera(0.0, RadialDistortion::default()), 6);
    let refused = |change: fn(&mut Vec<BoardView>, &mut CameraModel), why: &str| {
        let (mut views, mut model) = (views.clone(), model(false, 0));
        change(&mut views, &mut model);
        let error = calibrate(&board(), &views, &model).unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    };
    refused(|views, _| views.truncate(2), "at least 3 boards");
    refused(
        |views, _| views[1].corners.truncate(34),
        "7 × 5 inner corners",
    );
    refused(
        |views, _| views.iter_mut().for_each(|view| view.line.clear()),
        "laser line on the boards",
    );
    refused(
        |views, _| *views = vec![views[1].clone(); 4],
        "not determined",
    );
    refused(|_, model| model.radial = 4, "radial");
    refused(|_, model| model.pixel_pitch = -1.0, "pixel_pitch");
}
