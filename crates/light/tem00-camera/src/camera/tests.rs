use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::{CameraDescription, RadialDistortion, SensorTilt};

mod focus;
mod light;
mod optics;

/// 25 mm at f/8, focused on 30 cm.
fn description() -> CameraDescription {
    CameraDescription {
        position: DVec3::new(0.1, -0.05, 0.3),
        look_at: DVec3::new(0.01, 0.02, 0.0),
        ..CameraDescription::default()
    }
}

/// A camera with all features: 0.2 rad of tilt, a barrel of 3 % at the corners and the axis off the
/// middle. The image spans ±0.04 in tangents.
fn crooked() -> CameraDescription {
    CameraDescription {
        principal_point: Some(DVec2::new(300.0, 260.0)),
        tilt: SensorTilt {
            angle: 0.2,
            azimuth: 0.7,
        },
        distortion: RadialDistortion {
            k1: -10.0,
            k2: -50.0,
            k3: 1e3,
        },
        f_number: 2.0,
        ..description()
    }
}

#[test]
fn up_in_the_scene_is_up_in_the_image() {
    let camera = Camera::new(description()).unwrap();
    let above = camera
        .project(description().look_at + 1e-3 * DVec3::Y)
        .unwrap();
    assert!(above.y < 240.0, "y grows downwards, got {above}");
    let axes = camera.axes();
    assert_absolute(axes.determinant(), 1.0, 1e-12);
}

#[test]
fn pixels_see_the_solid_angle_of_the_sensor() {
    let camera = Camera::new(description()).unwrap();
    // A rectangle of half sides a, b at distance d subtends 4 asin(ab/√((a²+d²)(b²+d²))).
    let (a, b, d) = (320.0 * 3.45e-6, 240.0 * 3.45e-6, camera.image_distance());
    let exact = 4.0 * (a * b / ((a * a + d * d) * (b * b + d * d)).sqrt()).asin();
    let mut sum = 0.0;
    for y in 0..480_u32 {
        for x in 0..640_u32 {
            let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            sum += camera.solid_angle_per_pixel(centre);
        }
    }
    // The midpoint rule has an error of (pitch/d)²/24 · ∂²/∂x² cos³ ≈ 1e−9.
    assert_relative(sum, exact, 1e-7);
}
