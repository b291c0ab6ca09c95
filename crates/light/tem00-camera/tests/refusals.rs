//! Arguments that constructors refuse, by name.

use tem00_camera::{Camera, CameraDescription, RadialDistortion, SensorTilt};
use tem00_decorrelation::{DVec2, DVec3};
use tem00_testkit::refuses;

const NAN: f64 = f64::NAN;
const INFINITE: f64 = f64::INFINITY;

fn distortion(k1: f64, k2: f64, k3: f64) -> RadialDistortion {
    RadialDistortion { k1, k2, k3 }
}

fn tilt(angle: f64) -> SensorTilt {
    SensorTilt {
        angle,
        azimuth: 0.0,
    }
}

#[test]
fn cameras() {
    // The rim of the pupil, f/16 off the axis, is behind the sensor, which is 25 mm · 0.3 / 0.275
    // away.
    let steepest = (16.0_f64 * 0.3 / 0.275).atan();
    let oblique = CameraDescription {
        position: DVec3::new(0.1, 0.2, 0.3),
        look_at: DVec3::new(0.03, 0.0, 0.0),
        ..CameraDescription::default()
    };
    refuses!(camera = oblique => Camera::new(camera);
        camera.focal_length: [0.0, -1.0, NAN, INFINITE],
        camera.f_number: [0.0, 0.499, NAN, INFINITE],
        camera.pixel_pitch: [0.0, -1.0, NAN, INFINITE],
        camera.focus_distance: [25e-3, 0.0, NAN, INFINITE],
        camera.resolution: [[0, 480], [640, 0], [1 << 40, 1 << 40], [1 << 14, 16_385]],
        camera.position as "look_at": [DVec3::NAN, DVec3::new(0.03, 0.0, 0.0)],
        camera.look_at: [DVec3::NAN, DVec3::new(0.1, 0.2, 0.3)],
        // Along the view, in spite of rounding.
        camera.up: [DVec3::new(0.7, 2.0, 3.0), DVec3::ZERO, DVec3::NAN],
        camera.principal_point: [Some(DVec2::NAN), Some(DVec2::new(0.0, INFINITE))],
        // Each folds inside the image; the last one shrinks between the radii 0.022 and 0.032 only.
        camera.distortion: [
            distortion(-200.0, 0.0, 0.0),
            distortion(0.0, -1e5, 0.0),
            distortion(0.0, 0.0, -1e8),
            distortion(NAN, 0.0, 0.0),
            distortion(0.0, 0.0, INFINITE),
            distortion(-1000.0, 4e5, 0.0),
        ],
        camera.tilt: [
            tilt(1.6),
            tilt(NAN),
            tilt(1.001 * steepest),
            SensorTilt { angle: 0.1, azimuth: NAN },
        ],
    );
    // An image higher than the lens is far: its top reaches through the lens.
    let high = CameraDescription {
        focal_length: 2e-3,
        resolution: [2000, 2000],
        ..CameraDescription::default()
    };
    refuses!(camera = high => Camera::new(camera); camera.tilt as "whole image": [tilt(0.8)]);
    let camera = Camera::new(oblique).unwrap();
    refuses!(wavelength = 650e-9 => camera.imaging_geometry(wavelength);
        wavelength: [0.0, NAN], wavelength as "pupil_diameter": [1.0]);
}

/// Limits of what is accepted.
#[test]
fn possible_cameras() {
    let steepest = (16.0_f64 * 0.3 / 0.275).atan();
    let default = CameraDescription::default();
    for camera in [
        CameraDescription {
            f_number: 0.5,
            ..default
        },
        CameraDescription {
            resolution: [1 << 14, 1 << 14],
            ..default
        },
        CameraDescription {
            distortion: distortion(200.0, 0.0, 0.0),
            ..default
        },
        CameraDescription {
            distortion: distortion(-10.0, 1e4, 0.0),
            ..default
        },
        CameraDescription {
            distortion: distortion(1.0, -1.0, 1e6),
            ..default
        },
        CameraDescription {
            tilt: tilt(0.999 * steepest),
            ..default
        },
    ] {
        assert!(Camera::new(camera).is_ok(), "{camera:?}");
    }
}
