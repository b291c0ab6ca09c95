use tem00_camera::CameraDescription;
use tem00_testkit::assert_absolute;

use super::*;
use crate::PARAMETERS;

/// A lens of 25 mm at 30° from the laser plane, at a distance of 0.3 m, with pixels of 3.45 µm.
fn camera() -> Camera {
    Camera::new(CameraDescription {
        position: 0.3 * DVec3::new(0.0, -0.5, 0.75_f64.sqrt()),
        up: DVec3::Z,
        ..CameraDescription::default()
    })
    .unwrap()
}

fn exact() -> Calibration {
    Calibration::exact(camera(), LaserPlane::new(DVec3::ZERO, DVec3::Y).unwrap())
}

fn parameter(name: &str) -> usize {
    PARAMETERS.iter().position(|p| p.name == name).unwrap()
}

/// The calibration in which a single parameter is uncertain.
fn with_uncertain(parameter: usize, uncertainty: f64) -> Calibration {
    let mut rows = [[0.0; PARAMETERS.len()]; PARAMETERS.len()];
    rows[parameter][parameter] = uncertainty * uncertainty;
    let covariance = CalibrationCovariance::new(DVec3::ZERO, &rows).unwrap();
    exact().with_covariance(covariance).unwrap()
}

#[test]
fn exact_calibrations_leave_no_uncertainty() {
    let calibration = exact();
    let heights = [DVec3::ZERO, 1e-3 * DVec3::Z];
    assert_eq!(
        calibration.height_uncertainty(heights[1], DVec3::Z),
        Some(0.0)
    );
    assert_eq!(calibration.step_uncertainty(heights, DVec3::Z), Some(0.0));
    let behind = DVec3::new(0.0, -1.0, 1.0);
    assert_eq!(calibration.height_uncertainty(behind, DVec3::Z), None);
}

#[test]
fn parameters_move_heights_as_the_geometry_says() {
    let high = 5e-3 * DVec3::Z;
    for (name, uncertainty, point, expected) in [
        // The plane moves by δ along y: the sight at 30° to the plane slides by δ / tan 30° in
        // height.
        ("plane offset", 1e-6, DVec3::ZERO, 3.0_f64.sqrt() * 1e-6),
        // A pixel of the principal point is pitch / (m sin 30°).
        ("principal point y", 0.1, DVec3::ZERO, 0.1 * 3.45e-6 * 22.0),
        // A board that stands higher by δ along the view: cos 30° of δ.
        ("shift view", 1e-6, DVec3::ZERO, 0.75_f64.sqrt() * 1e-6),
        // Turned about the right of the image by ω, a point at the height z moves along y alone.
        ("rotation right", 1e-4, high, 0.0),
        // On the axis the image distance has no effect.
        ("image distance", 1e-6, DVec3::ZERO, 0.0),
    ] {
        let calibration = with_uncertain(parameter(name), uncertainty);
        let found = calibration.height_uncertainty(point, DVec3::Z).unwrap();
        // Central differences of a step of 1e-3 uncertainties: rounding 1e-16 m by 1e-3 of 1e-6 m.
        assert_absolute(found, expected, 1e-6 * expected + 1e-12);
    }
}

#[test]
fn what_moves_both_points_alike_leaves_their_step_certain() {
    let calibration = with_uncertain(parameter("shift view"), 1e-5);
    let points = [DVec3::ZERO, DVec3::new(1e-3, 0.0, 2e-3)];
    let step = calibration.step_uncertainty(points, DVec3::Z).unwrap();
    assert!(step < 1e-18, "{step:e}");
    // A scale does not: the step is wrong by the same fraction as the plane.
    let plane = with_uncertain(PARAMETERS.len() - 1, 1e-4);
    let step = plane.step_uncertainty(points, DVec3::Z).unwrap();
    let alone = plane.height_uncertainty(points[1], DVec3::Z).unwrap();
    assert!(step > 0.0 && step < 0.02 * alone, "{step:e}, {alone:e}");
}

#[test]
fn carried_along_nothing_changes() {
    let motion = RigidMotion::about(DVec3::X, DVec3::new(1.0, 2.0, 0.5), 0.7).unwrap();
    let point = DVec3::new(1e-3, 0.0, 2e-3);
    for parameter in 0..PARAMETERS.len() {
        let calibration = with_uncertain(parameter, 1e-5);
        let moved = calibration.moved(&motion).unwrap();
        let before = calibration.height_uncertainty(point, DVec3::Z).unwrap();
        let up = motion.direction(DVec3::Z);
        let after = moved.height_uncertainty(motion.point(point), up).unwrap();
        // Positions round at 1e-16 m, by a step of 1e-8 m.
        assert_absolute(after, before, 1e-6 * before + 1e-12);
    }
}

#[test]
fn impossible_covariances_are_refused() {
    type Change = fn(&mut [[f64; 18]; 18]);
    let made = |change: Change| {
        let mut rows = [[0.0; 18]; 18];
        (0..18).for_each(|i| rows[i][i] = 1e-8);
        change(&mut rows);
        CalibrationCovariance::new(DVec3::ZERO, &rows)
    };
    made(|_| ()).expect("independent parameters");
    let bad: [(Change, &str); 5] = [
        (|rows| rows[3][3] = f64::NAN, "NaN"),
        (|rows| rows[3][3] = -1e-8, "a negative variance"),
        (|rows| rows[3][4] = 1e-9, "not symmetric"),
        (
            |rows| (rows[3][4], rows[4][3]) = (2e-8, 2e-8),
            "correlates by 2",
        ),
        (
            |rows| (rows[5][5], rows[5][4], rows[4][5]) = (0.0, 1e-9, 1e-9),
            "a known parameter that is correlated",
        ),
    ];
    for (change, why) in bad {
        assert!(made(change).is_err(), "{why}");
    }
}
