//! From settings to lights, camera, part and stack, by the physics crates.

use core::f64::consts::PI;

use glam::{DQuat, DVec3, Vec3};
use tem00_beam::{FanGeometry, FocusCurve, LineProfile};
use tem00_camera::{Camera, CameraDescription};
use tem00_coherence::Spectrum;
use tem00_decorrelation::{ImagingGeometry, Refusal};
use tem00_numerics::cast::{to_f32, to_usize};
use tem00_shading::{BeamShape, Laser, LaserDescription, Pose, ShadingError};

use crate::settings::Values;

/// Width and height of the sensor, in pixels.
pub const SENSOR: [u32; 2] = [960, 640];
/// Pixel pitch, in metres.
const PITCH: f64 = 3.45e-6;
/// Focal length, in metres.
const FOCAL_LENGTH: f64 = 12e-3;
/// Distance of the laser from the part, in metres.
pub const LASER_DISTANCE: f64 = 0.3;
/// The fan of the line.
pub const FAN: FanGeometry = FanGeometry {
    fan_angle: 12.0 * PI / 180.0,
    apex_offset: 0.05,
    focus_distance: LASER_DISTANCE,
    focus_curve: FocusCurve::EqualDistance,
};
/// The boxes that a part has at most.
pub const BOXES: usize = 4;
/// Returns the camera, which looks at the middle of the part.
///
/// # Errors
///
/// Returns an error if the settings make no camera.
pub fn camera(values: &Values) -> Result<Camera, Refusal> {
    let distance = 1e-3 * values.distance;
    let (sin, cos) = values.elevation.to_radians().sin_cos();
    let (y, x) = values.azimuth.to_radians().sin_cos();
    Camera::new(CameraDescription {
        position: distance * DVec3::new(cos * x, cos * y, sin),
        look_at: DVec3::ZERO,
        up: DVec3::Z,
        focal_length: FOCAL_LENGTH,
        f_number: values.f_number,
        focus_distance: distance,
        pixel_pitch: PITCH,
        resolution: SENSOR.map(|n| n as usize),
        depth_of_field: false,
        ..CameraDescription::default()
    })
}

/// Returns the imaging geometry of the camera in the light of the laser.
///
/// # Errors
///
/// Returns an error if the settings make no camera.
pub fn geometry(values: &Values) -> Result<ImagingGeometry, Refusal> {
    camera(values)?.imaging_geometry(1e-9 * values.wavelength)
}

/// Returns the laser above the part: a line or a spot.
///
/// # Errors
///
/// Returns an error if the settings make no beam or no line.
pub fn laser(values: &Values) -> Result<Laser, ShadingError> {
    let waist_radius = 0.5e-3 * values.line_width;
    // A corner is lit across, from the side of its floor.
    let [direction, line_direction] = match to_usize(values.part) {
        3 => [
            DVec3::new(0.0, 0.5, -0.75_f64.sqrt()),
            DVec3::new(0.0, 0.75_f64.sqrt(), 0.5),
        ],
        _ => [DVec3::NEG_Z, DVec3::X],
    };
    let spot = BeamShape::Spot {
        waist_radius: [waist_radius; 2],
        waist_distance: [LASER_DISTANCE; 2],
        m_squared: [1.0; 2],
    };
    let line = BeamShape::Line {
        waist_radius,
        m_squared: 1.0,
        fan: FAN,
        profile: LineProfile::Powell { edge: 0.05 },
    };
    Laser::new(LaserDescription {
        spectrum: Spectrum::monochromatic(1e-9 * values.wavelength)?,
        power: 1e-3 * values.power,
        position: -LASER_DISTANCE * direction,
        look_at: DVec3::ZERO,
        line_direction,
        shape: if values.light > 0.5 { spot } else { line },
    })
}

/// Boxes and a sphere that make a part, in its own frame, in metres.
pub fn part(values: &Values) -> (Vec<[Vec3; 2]>, [f32; 4]) {
    let millimetres =
        |min: [f32; 3], max: [f32; 3]| [1e-3 * Vec3::from(min), 1e-3 * Vec3::from(max)];
    let plate = millimetres([-35.0, -25.0, -5.0], [35.0, 25.0, 0.0]);
    let mut boxes = vec![plate];
    let mut sphere = [0.0; 4];
    match to_usize(values.part) {
        1 => boxes.extend([1.0, 2.0, 3.0].map(|step| {
            millimetres(
                [15.0 * step - 30.0, -20.0, 0.0],
                [15.0 * step - 15.0, 20.0, 2.0 * step],
            )
        })),
        2 => sphere = [0.0, 0.0, 6e-3, 14e-3],
        3 => boxes.push(millimetres([-35.0, 8.0, 0.0], [35.0, 12.0, 25.0])),
        _ => {}
    }
    (boxes, sphere)
}

/// Returns the motion of the part since its reference state.
///
/// # Errors
///
/// Returns an error if a setting is not finite.
pub fn pose(values: &Values) -> Result<Pose, Refusal> {
    let along = 1e-6 * DVec3::new(values.slide, 0.0, values.lift);
    let tilt = Pose::about(DVec3::ZERO, DVec3::Y, 1e-3 * values.tilt)?;
    Ok(tilt.then(&Pose::along(along)?))
}

/// The rotation of a motion, as a quaternion, and its translation in metres.
pub fn rows_of(pose: &Pose) -> [[f32; 4]; 2] {
    let rotation = DQuat::from_mat3(&pose.rotation()).to_array();
    let translation = pose.translation().extend(0.0).to_array();
    [rotation, translation].map(|row| row.map(to_f32))
}

/// The part of the sensor's range, at 10,000 electrons and half of all photons found, that a
/// radiance of 1 W/(m² sr) fills.
pub fn exposure(values: &Values) -> f64 {
    const PHOTON: f64 = 6.626_070_15e-34 * 299_792_458.0;
    let full = 10_000.0 / 0.5 * PHOTON / (1e-9 * values.wavelength) / (PITCH * PITCH);
    PI / (4.0 * values.f_number * values.f_number) * 1e-3 * values.exposure / full
}
