use proptest::prelude::*;
use tem00_camera::{CameraDescription, RadialDistortion, SensorTilt};
use tem00_testkit::refuses;

use super::*;
use crate::{LinePoint, Validity};

const PITCH: f64 = 3.45e-6;
const DISTANCE: f64 = 0.3;
const FOCAL_LENGTH: f64 = 25e-3;

/// A camera at `angle` to the vertical laser plane, sharp over the plane if `scheimpflug`.
fn description(angle: f64, scheimpflug: bool) -> CameraDescription {
    let magnification = FOCAL_LENGTH / (DISTANCE - FOCAL_LENGTH);
    // The plane in focus turns by τ′ with tan τ′ = tan τ / m; it must turn to the laser plane.
    let tilt = -(magnification / angle.tan()).atan();
    let tilt = if scheimpflug { tilt } else { 0.0 };
    CameraDescription {
        position: DISTANCE * DVec3::new(0.0, -angle.sin(), angle.cos()),
        up: DVec3::Z,
        focal_length: FOCAL_LENGTH,
        focus_distance: DISTANCE,
        pixel_pitch: PITCH,
        resolution: [640, 480],
        tilt: SensorTilt {
            angle: tilt,
            azimuth: 0.0,
        },
        ..CameraDescription::default()
    }
}

fn triangulator(description: CameraDescription) -> Triangulator {
    let plane = LaserPlane::new(DVec3::ZERO, DVec3::Y).unwrap();
    Triangulator::new(Camera::new(description).unwrap(), plane)
}

fn distorted() -> CameraDescription {
    CameraDescription {
        distortion: RadialDistortion {
            k1: -8.0,
            k2: 60.0,
            k3: -300.0,
        },
        principal_point: Some(DVec2::new(310.0, 255.0)),
        ..description(0.5, true)
    }
}

proptest! {
    #[test]
    fn points_of_the_plane_come_back_from_their_images(
        x in -5e-3_f64..5e-3, z in -4e-3_f64..4e-3, angle in 0.2_f64..1.2, scheimpflug: bool,
    ) {
        let point = DVec3::new(x, 0.0, z);
        for camera in [description(angle, scheimpflug), distorted()] {
            let triangulator = triangulator(camera);
            let pixel = triangulator.camera().project(point).unwrap();
            let back = triangulator.point(pixel).unwrap();
            // 1e-13 pixel of rounding, times 2e-4 m per pixel at most, and roundings of 0.3 m.
            prop_assert!(back.distance(point) < 1e-12, "{back} for {point}");
        }
    }
}

#[test]
fn heights_per_pixel_follow_the_angle_of_triangulation() {
    for angle in [0.2, 0.5, 0.9, 1.3] {
        let axis = DVec2::new(320.0, 240.0);
        let magnification = FOCAL_LENGTH / (DISTANCE - FOCAL_LENGTH);
        let straight = triangulator(description(angle, false));
        let point = straight.point_with_uncertainty(axis, 0.1).unwrap();
        // σ_z = σ_y pitch / (m sin θ), exactly on the axis.
        let expected = 0.1 * PITCH / (magnification * angle.sin());
        assert!((point.uncertainty.z / expected - 1.0).abs() < 1e-12);
        assert!((point.along / expected - 1.0).abs() < 1e-12, "{point:?}");
        assert!(point.direction.distance(DVec3::Z) < 1e-12, "{point:?}");
        assert!(point.uncertainty.x < 1e-18, "only the height is uncertain");
        // A pixel to the right is pitch / m.
        let [right, _] = straight.derivatives(axis).unwrap();
        assert!(right.distance(DVec3::X * PITCH / magnification) < 1e-16);
    }
}

#[test]
fn a_sensor_after_scheimpflug_sees_the_whole_plane_in_focus() {
    let angle = 0.5;
    let triangulator = triangulator(description(angle, true));
    let (point, normal) = triangulator.camera().plane_in_focus();
    assert!(
        triangulator.plane().distance(point).abs() < 1e-15,
        "{point}"
    );
    assert!(normal.dot(DVec3::Y).abs() > 1.0 - 1e-14, "{normal}");
    // Across the axis, a pixel of a sensor tilted by τ measures pitch cos τ.
    let tilt = triangulator.camera().description().tilt.angle;
    let magnification = FOCAL_LENGTH / (DISTANCE - FOCAL_LENGTH);
    let [_, down] = triangulator.derivatives(DVec2::new(320.0, 240.0)).unwrap();
    let expected = PITCH * tilt.cos() / (magnification * angle.sin());
    assert!((-down.z / expected - 1.0).abs() < 1e-12, "{down}");
}

#[test]
fn derivatives_are_those_of_the_point() {
    let triangulator = triangulator(distorted());
    let step = 0.05;
    for pixel in [DVec2::new(30.0, 50.0), DVec2::new(500.0, 400.0)] {
        let derivatives = triangulator.derivatives(pixel).unwrap();
        for (axis, derivative) in [DVec2::X, DVec2::Y].into_iter().zip(derivatives) {
            let point = |offset: f64| triangulator.point(pixel + offset * axis).unwrap();
            let difference = (point(step) - point(-step)) / (2.0 * step);
            // Roundings of 0.3 m by the step, against 4e-5 m: 1e-11; the third derivative adds
            // less.
            let error = difference.distance(derivative) / derivative.length();
            assert!(error < 1e-8, "{pixel}: {error:e}");
        }
    }
}

#[test]
fn a_plane_behind_the_camera_or_through_it_has_no_points() {
    let camera = Camera::new(description(0.5, false)).unwrap();
    let pixel = DVec2::new(320.0, 240.0);
    for (point, normal) in [
        (2.0 * camera.position(), DVec3::Z),
        (camera.position(), DVec3::Y),
    ] {
        let plane = LaserPlane::new(point, normal).unwrap();
        let triangulator = Triangulator::new(camera, plane);
        assert_eq!(triangulator.point(pixel), None, "{plane:?}");
        assert_eq!(triangulator.derivatives(pixel), None, "{plane:?}");
    }
}

#[test]
fn planes_need_a_normal() {
    refuses!(point = DVec3::ZERO, normal = DVec3::X => LaserPlane::new(point, normal);
        normal: [DVec3::ZERO, DVec3::NAN],
        point: [DVec3::INFINITY],
    );
}

#[test]
fn the_plane_of_a_laser_holds_its_axis_and_its_line() {
    let (position, look_at) = (DVec3::new(0.1, 0.2, 0.4), DVec3::new(0.1, 0.25, 0.0));
    let line_direction = DVec3::new(1.0, 0.3, 0.1);
    let plane = LaserPlane::of_line(position, look_at - position, line_direction).unwrap();
    for point in [position, look_at, look_at + 0.1 * line_direction] {
        assert!(plane.distance(point).abs() < 1e-15, "{point}");
    }
    assert!((plane.distance(position + plane.normal()) - 1.0).abs() < 1e-15);
}

#[test]
fn profiles_keep_what_the_detector_found() {
    let triangulator = triangulator(description(0.5, false));
    let found = |position, line| LinePoint {
        position,
        width: 6.0,
        peak: 200.0,
        integral: 900.0,
        background: 3.0,
        validity: Validity::Valid,
        line,
    };
    let columns = vec![
        vec![found(240.0, 0)],
        vec![],
        vec![found(100.0, 0), found(300.5, 1)],
    ];
    let uncertainty = |column, point: &LinePoint| if column == 0 { 0.1 } else { point.position };
    let profile = triangulator.profile(&columns, uncertainty);
    let positions: Vec<_> = profile.iter().map(|p| (p.column, p.line)).collect();
    assert_eq!(positions, [(0, 0), (2, 0), (2, 1)]);
    for point in &profile {
        let pixel = triangulator.camera().project(point.point.position).unwrap();
        assert!(pixel.distance(point.pixel) < 1e-9, "{point:?}");
        assert!(
            (point.reflectance, point.width) == (900.0, 6.0),
            "{point:?}"
        );
    }
    // The uncertainty is the requested one, per point.
    let ratio = profile[2].point.along / profile[0].point.along;
    assert!((ratio / 3005.0 - 1.0).abs() < 0.1, "{ratio}");
}
