//! `tem00-inspect calibrate`.

use std::fs;

use glam::DVec2;
use png::BitDepth;
use tem00_camera::{Camera, CameraDescription};
use tem00_tracer::RigidMotion;
use tem00_triangulation::{DVec3, LaserPlane};

use super::{
    helpers::{rounded, write_png},
    *,
};

const SQUARE: f64 = 12e-3;
const OPTIONS: &str = "--corners 6x4 --square 12mm --pixel-pitch 16um --radial 0";

fn camera() -> Camera {
    Camera::new(CameraDescription {
        position: 0.25 * DVec3::new(0.0, -0.5, 0.75_f64.sqrt()),
        up: DVec3::Z,
        focal_length: 12e-3,
        focus_distance: 0.25,
        pixel_pitch: 16e-6,
        resolution: [320, 240],
        ..CameraDescription::default()
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
    write_png(path, [320, 240], BitDepth::Eight, |x, y| {
        let inside = |i: usize| DVec2::new((i % 4) as f64, (i / 4) as f64) / 4.0 + 0.125;
        let corner = DVec2::new(x as f64, y as f64);
        [rounded(
            (0..16).map(|i| at(corner + inside(i))).sum::<f64>() / 16.0,
        )]
    });
}

/// The light of a line of 2.4 mm full width in the plane y = 0.
fn line(point: DVec3) -> f64 {
    (-2.0 * (point.y / 1.2e-3).powi(2)).exp()
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
        let path = folder.join(format!("line_{number}.png"));
        photograph(&path, &pose, |point| 200.0 * line(point));
    }
}

#[test]
fn photographs_give_camera_and_plane() {
    let folder = folder();
    photographs(folder.path());
    let line = format!("calibrate . {OPTIONS} -o found.json");
    let parts = [
        "image distance",
        "principal point x",
        "120 corners on 5 boards",
        "in 5 of 5 pictures, are used; left out: 0 too far off, ",
        "found.json",
    ];
    assert_has(&said(folder.path(), &line, 0).out, &parts);
    let found = json(&read(&folder.path().join("found.json")));
    let vector = |key: &str| DVec3::from([0, 1, 2].map(|axis| number(&found["plane"][key][axis])));
    let [f, focus] = ["focal_length", "focus_distance"].map(|key| number(&found["camera"][key]));
    let distance = f * focus / (focus - f);
    let sigma = number(&found["covariance"]["rows"][0][0]).sqrt();
    // Corners of 16 points per pixel scatter and have errors of their own: five uncertainties.
    let error = (distance - camera().image_distance()).abs();
    assert!(
        error < 5.0 * sigma && sigma < 1e-4,
        "{error:e}, {sigma:e} m"
    );
    let plane = LaserPlane::new(vector("point"), vector("normal"));
    let origin = pose(0).inverse().point(DVec3::ZERO);
    // A tenth of a pixel of 0.33 mm.
    let distance = plane.expect("the plane has a normal").distance(origin);
    assert!(distance.abs() < 3e-5, "{distance:e} m");
}

#[test]
fn what_photographs_of_lines_did_not_give_is_told() {
    let folder = folder();
    photographs(folder.path());
    let path = |number: u32| folder.path().join(format!("line_{number}.png"));
    // Two of five clipped, one without a line, and one without a photograph of it.
    for number in [1, 2] {
        let clipped = |point| (600.0 * line(point)).min(255.0);
        photograph(&path(number), &pose(number), clipped);
    }
    photograph(&path(3), &pose(3), |_| 0.0);
    fs::remove_file(path(4)).expect("it was there");
    let command = format!("calibrate . {OPTIONS}");
    // One line leaves the plane open.
    let told = said(folder.path(), &command, 2).told;
    let parts = [
        "because pixels are saturated",
        "3 of 4 pictures of the line gave no point",
    ];
    assert_has(&told, &parts);

    photograph(&path(4), &pose(4), |point| 200.0 * line(point));
    let line = format!("{command} --focal-length 14mm");
    let Said { out, told } = said(folder.path(), &line, 0);
    let parts = [
        "--focal-length 14 mm is not below the image distance of ",
        "3 of 5 pictures of the line gave no point: line_1 (pixels are saturated: expose shorter), \
         line_2",
        "line_3 (no line was found",
    ];
    assert_has(&told, &parts);
    // 640 columns of the two clipped photographs, if the line crosses the whole image.
    assert_has(&out, &["in 2 of 5 pictures, are used", " saturated."]);
}

#[test]
fn what_cannot_be_calibrated_with_is_told_in_words() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let command = format!("calibrate . {OPTIONS}");
    photograph(&path("board_1.png"), &pose(0), |_| 100.0);
    photograph(&path("line_1.png"), &pose(0), |_| 100.0);
    assert_has(&said(folder.path(), &command, 2).told, &["board_1.png"]);
    fs::write(path("board_1.png"), "no image").expect("the file is written");
    assert_has(&said(folder.path(), &command, 2).told, &["cannot read"]);
}
