//! `tem00-inspect calibrate`.

use std::{fs, path::Path};

use glam::DVec2;
use serde_json::Value;
use tem00_camera::{Camera, CameraDescription, RadialDistortion, SensorTilt};
use tem00_tracer::RigidMotion;
use tem00_triangulation::{DVec3, LaserPlane};

use super::{folder, message, run};

const SQUARE: f64 = 12e-3;
const OPTIONS: &str = "--corners 6x4 --square 12mm --pixel-pitch 16um --radial 0";

fn camera() -> Camera {
    Camera::new(CameraDescription {
        position: 0.25 * DVec3::new(0.0, -0.5, 0.75_f64.sqrt()),
        look_at: DVec3::ZERO,
        up: DVec3::Z,
        focal_length: 12e-3,
        f_number: 8.0,
        focus_distance: 0.25,
        pixel_pitch: 16e-6,
        resolution: [320, 240],
        principal_point: None,
        tilt: SensorTilt::default(),
        distortion: RadialDistortion::default(),
        depth_of_field: true,
    })
    .expect("the camera is possible")
}

/// From the frame of a board, whose origin is its lower left inner corner, to the world.
fn pose(number: u32) -> RigidMotion {
    let turn = |axis, angle| RigidMotion::about(DVec3::ZERO, axis, angle).expect("a rotation");
    let angle = 2.4 * f64::from(number);
    let tilt = if number == 0 { 0.0 } else { 0.4 };
    let middle = SQUARE * DVec3::new(2.5, 1.5, 0.0);
    let height = 4e-3 * f64::from(number % 3) * DVec3::Z;
    RigidMotion::along(height - middle)
        .expect("a translation")
        .then(&turn(DVec3::new(angle.cos(), angle.sin(), 0.0), tilt))
        .then(&turn(DVec3::X, 0.25))
}

/// Writes an image of what each point of the board shows, the mean of 4 × 4 points per pixel.
fn photograph(path: &Path, pose: &RigidMotion, grey: impl Fn(DVec3) -> f64) {
    let camera = camera();
    let (origin, normal) = (pose.point(DVec3::ZERO), pose.direction(DVec3::Z));
    let at = |place: DVec2| {
        let ray = camera.ray(place);
        let distance = (origin - ray.origin).dot(normal) / ray.direction.dot(normal);
        grey(ray.origin + distance * ray.direction)
    };
    let mean = |pixel: u32| {
        let corner = DVec2::new(f64::from(pixel % 320), f64::from(pixel / 320));
        let inside = |i: u32| DVec2::new(f64::from(i % 4), f64::from(i / 4)) / 4.0 + 0.125;
        (0..16).map(|i| at(corner + inside(i))).sum::<f64>() / 16.0
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "grey values lie between 0 and 255"
    )]
    let pixels: Vec<u8> = (0..320 * 240)
        .map(|pixel| mean(pixel).round() as u8)
        .collect();
    let file = fs::File::create(path).expect("the file is made");
    let mut encoder = png::Encoder::new(file, 320, 240);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("the header is written");
    writer
        .write_image_data(&pixels)
        .expect("the image is written");
}

/// Photographs of five boards, drawn from the geometry alone.
fn photographs(folder: &Path) {
    for number in 0..5 {
        let pose = pose(number);
        let back = pose.inverse();
        let squares = |point: DVec3| {
            let place = back.point(point) / SQUARE;
            let board = place.x > -1.0 && place.x < 6.0 && place.y > -1.0 && place.y < 4.0;
            let dark = (place.x.floor() + place.y.floor()).rem_euclid(2.0) < 0.5;
            if board && dark { 40.0 } else { 200.0 }
        };
        photograph(&folder.join(format!("board_{number}.png")), &pose, squares);
        // A line of 2.4 mm full width in the plane y = 0.
        let line = |point: DVec3| 200.0 * (-2.0 * (point.y / 1.2e-3).powi(2)).exp();
        photograph(&folder.join(format!("line_{number}.png")), &pose, line);
    }
}

#[test]
fn photographs_give_camera_and_plane() {
    let folder = folder();
    photographs(folder.path());
    let done = run(
        folder.path(),
        &format!("calibrate . {OPTIONS} -o found.json"),
    );
    let told = String::from_utf8_lossy(&done.stdout);
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    for part in [
        "image distance",
        "principal point x",
        "120 corners on 5 boards",
        "in 5 of 5 pictures, are used; left out: 0 too far off, ",
        "found.json",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    let text = fs::read_to_string(folder.path().join("found.json")).expect("the file is there");
    let found: Value = serde_json::from_str(&text).expect("it is JSON");
    let number = |value: &Value| value.as_f64().expect("a number");
    let vector =
        |value: &Value| DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]));
    let [f, focus] = ["focal_length", "focus_distance"].map(|key| number(&found["camera"][key]));
    let distance = f * focus / (focus - f);
    let sigma = number(&found["covariance"]["rows"][0][0]).sqrt();
    // Corners of 16 points per pixel scatter and have errors of their own: five uncertainties.
    let error = (distance - camera().image_distance()).abs();
    assert!(
        error < 5.0 * sigma && sigma < 1e-4,
        "{error:e}, {sigma:e} m"
    );
    let plane = LaserPlane::new(
        vector(&found["plane"]["point"]),
        vector(&found["plane"]["normal"]),
    );
    let plane = plane.expect("the plane has a normal");
    let origin = pose(0).inverse().point(DVec3::ZERO);
    // A tenth of a pixel of 0.33 mm.
    assert!(
        plane.distance(origin).abs() < 3e-5,
        "{:e} m",
        plane.distance(origin)
    );
}

#[test]
fn what_photographs_of_lines_did_not_give_is_told() {
    let folder = folder();
    photographs(folder.path());
    // Two of five clipped, one without a line, and one without a photograph of it.
    for number in [1, 2] {
        let line = |point: DVec3| (600.0 * (-2.0 * (point.y / 1.2e-3).powi(2)).exp()).min(255.0);
        let path = folder.path().join(format!("line_{number}.png"));
        photograph(&path, &pose(number), line);
    }
    photograph(&folder.path().join("line_3.png"), &pose(3), |_| 0.0);
    fs::remove_file(folder.path().join("line_4.png")).expect("it was there");
    let done = run(folder.path(), &format!("calibrate . {OPTIONS}"));
    let told = message(&done);
    assert_eq!(
        done.status.code(),
        Some(2),
        "one line leaves the plane open: {told}"
    );
    for part in [
        "because pixels are saturated",
        "3 of 4 pictures of the line gave no point",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }

    let line = |point: DVec3| 200.0 * (-2.0 * (point.y / 1.2e-3).powi(2)).exp();
    photograph(&folder.path().join("line_4.png"), &pose(4), line);
    let done = run(folder.path(), &format!("calibrate . {OPTIONS}"));
    let (table, told) = (String::from_utf8_lossy(&done.stdout), message(&done));
    assert_eq!(done.status.code(), Some(0), "{told}");
    for part in [
        "3 of 5 pictures of the line gave no point: line_1 (pixels are saturated: expose shorter), line_2",
        "line_3 (no line was found",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    // 640 columns of the two clipped photographs, if the line crosses the whole image.
    assert!(table.contains("in 2 of 5 pictures, are used"), "{table}");
    assert!(table.contains(" saturated."), "{table}");
}

#[test]
fn what_cannot_be_calibrated_with_is_told_in_words() {
    let folder = folder();
    let refused = |line: &str, part: &str| {
        let done = run(folder.path(), line);
        let told = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(2), "{line}: {told}");
        assert!(told.contains(part), "{line}: {told}");
    };
    photograph(&folder.path().join("board_1.png"), &pose(0), |_| 100.0);
    photograph(&folder.path().join("line_1.png"), &pose(0), |_| 100.0);
    refused(&format!("calibrate . {OPTIONS}"), "board_1.png");
    fs::write(folder.path().join("board_1.png"), "no image").expect("the file is written");
    refused(&format!("calibrate . {OPTIONS}"), "cannot read");
}
