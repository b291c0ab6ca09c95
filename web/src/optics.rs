//! From settings to lights, camera, part and stack, by the physics crates.

use core::f64::consts::PI;

use glam::{DVec3, Vec3};
use tem00_beam::{
    BeamError, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight, LineProfile, Placement,
    SpotLight,
};
use tem00_decorrelation::{CameraFrame, DecorrelationError, ImagingGeometry, LensData};
use tem00_numerics::cast::{to_f32, to_usize};
use tem00_speckle::{SpeckleError, StackNeeds, StackPlan};

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
/// The slices may take so many bytes: what every card lets a kernel see of one buffer.
const MEMORY: u64 = 128 << 20;
/// The largest motion of the pupil over the speckle that is looked up, in its diameters.
const MOTION: f64 = 1.0;

/// Lens, place and axes of the camera.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The lens and its pupil.
    pub geometry: ImagingGeometry,
    /// The axes.
    pub frame: CameraFrame,
    /// The centre of the pupil, in metres.
    pub eye: DVec3,
}

impl View {
    /// The camera looks at the middle of the part.
    ///
    /// # Errors
    ///
    /// Returns an error if the settings make no lens.
    pub fn new(values: &Values) -> Result<Self, DecorrelationError> {
        let distance = 1e-3 * values.distance;
        let (sin, cos) = values.elevation.to_radians().sin_cos();
        let (y, x) = values.azimuth.to_radians().sin_cos();
        let eye = distance * DVec3::new(cos * x, cos * y, sin);
        Ok(Self {
            geometry: ImagingGeometry::from_lens(LensData {
                wavelength: 1e-9 * values.wavelength,
                focal_length: FOCAL_LENGTH,
                f_number: values.f_number,
                surface_to_pupil: distance,
                pixel_pitch: PITCH,
            })?,
            frame: CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Z)?,
            eye,
        })
    }
}

/// Sizes of the speckle that repeats nothing on the sensor.
///
/// # Errors
///
/// Returns an error if the image holds more speckles than the largest pattern.
pub fn plan(view: &View) -> Result<StackPlan, SpeckleError> {
    let image = SENSOR.map(f64::from);
    StackPlan::new(&StackNeeds {
        image,
        region: image,
        speckle_size: view.geometry.speckle_size_in_pixels(),
        motion: Some(MOTION),
        frames: 2,
        memory_limit: MEMORY,
    })
}

/// Both lights above the part.
///
/// # Errors
///
/// Returns an error if the settings make no beam or no line.
pub fn lights(values: &Values) -> Result<(LineLight<f32>, SpotLight<f32>), BeamError> {
    let (wavelength, width) = (1e-9 * values.wavelength, 1e-3 * values.line_width);
    let power = 1e-3 * values.power;
    // A corner is lit across, from the side of its floor.
    let [direction, fan_axis] = match to_usize(values.part) {
        3 => [
            DVec3::new(0.0, 0.5, -0.75_f64.sqrt()),
            DVec3::new(0.0, 0.75_f64.sqrt(), 0.5),
        ],
        _ => [DVec3::NEG_Z, DVec3::X],
    };
    let placement = Placement {
        origin: -LASER_DISTANCE * direction,
        direction,
        fan_axis,
    };
    let beam = GaussianBeam::from_waist(wavelength, 0.5 * width)?;
    let line = LaserLine::new(beam, FAN, LineProfile::Powell { edge: 0.05 })?;
    let line = LineLight::place(&line, &placement, power)?.to_f32()?;
    let spot = SpotLight::place(&beam, LASER_DISTANCE, &placement, power)?.to_f32()?;
    Ok((line, spot))
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

/// The rotation of the part since its reference state, as a quaternion, and its translation in metres.
pub fn pose(values: &Values) -> [[f32; 4]; 2] {
    let (sin, cos) = (0.5e-3 * values.tilt).sin_cos();
    let [slide, lift] = [values.slide, values.lift].map(|micrometres| to_f32(1e-6 * micrometres));
    [
        [0.0, to_f32(sin), 0.0, to_f32(cos)],
        [slide, 0.0, lift, 0.0],
    ]
}

/// The part of the sensor's range, at 10,000 electrons and half of all photons found, that a radiance of 1 W/(m² sr) fills.
pub fn exposure(values: &Values) -> f64 {
    const PHOTON: f64 = 6.626_070_15e-34 * 299_792_458.0;
    let full = 10_000.0 / 0.5 * PHOTON / (1e-9 * values.wavelength) / (PITCH * PITCH);
    PI / (4.0 * values.f_number * values.f_number) * 1e-3 * values.exposure / full
}
