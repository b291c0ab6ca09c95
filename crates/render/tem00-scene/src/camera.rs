use glam::DVec2;
use tem00_camera::{Camera, CameraDescription, RadialDistortion, SensorTilt};
use tem00_config::{ANGLE, Document, LENGTH, NUMBER, Problem, Section, Value, rejected};
use tem00_tracer::Trajectory;

use crate::motion::{pivot, trajectory};
use crate::placement::{Placement, across};

const KEYS: &[&str] = &[
    "position",
    "look_at",
    "up",
    "focal_length",
    "f_number",
    "pixel_pitch",
    "resolution",
    "focus_distance",
    "principal_point",
    "tilt",
    "distortion",
    "depth_of_field",
    "displacement_per_frame",
    "rotation_per_frame",
    "pivot",
    "keyframe",
];

const TILT_KEYS: &[&str] = &["angle", "azimuth"];

/// The camera of a scene and how it moves.
#[derive(Clone, Debug)]
pub(crate) struct MovingCamera {
    pub(crate) camera: Camera,
    pub(crate) trajectory: Trajectory,
}

pub(crate) fn read(root: &Document<'_>) -> Result<MovingCamera, Problem> {
    let section = root
        .table("camera", KEYS)?
        .ok_or_else(|| Problem::new("the scene needs a camera: a section [camera]"))?;
    let description = description(&section)?;
    let camera = Camera::new(description).map_err(|error| {
        let problem = rejected(&error, Some(error.parameter), &[&section]);
        if error.parameter != "focus_distance" || section.has("focus_distance") {
            return problem;
        }
        problem.with_help("without focus_distance the camera has look_at in focus: it is too near")
    })?;
    Ok(MovingCamera {
        trajectory: trajectory(&section, pivot(&section, camera.position())?)?,
        camera,
    })
}

fn description(section: &Section<'_>) -> Result<CameraDescription, Problem> {
    let placement = Placement::read(section)?;
    let axis = placement.axis();
    let length = |value: &Value<'_>| value.positive(&LENGTH);
    Ok(CameraDescription {
        position: placement.position,
        look_at: placement.look_at,
        up: section.or(
            "up",
            across(axis, glam::DVec3::Y, glam::DVec3::Z),
            Value::direction,
        )?,
        focal_length: section.or("focal_length", 25e-3, length)?,
        f_number: section.or("f_number", 8.0, |value| value.positive(&NUMBER))?,
        focus_distance: section.or("focus_distance", axis.length(), length)?,
        pixel_pitch: section.or("pixel_pitch", 3.45e-6, length)?,
        resolution: section.or("resolution", [320, 240], resolution)?,
        principal_point: section.or("principal_point", None, |value| {
            image_point(value).map(Some)
        })?,
        tilt: tilt(section)?,
        distortion: section.or("distortion", RadialDistortion::default(), distortion)?,
        depth_of_field: section.or("depth_of_field", true, Value::boolean)?,
    })
}

fn image_point(value: &Value<'_>) -> Result<DVec2, Problem> {
    let [x, y] = value.elements("two numbers of pixels, such as [160, 120]")?;
    Ok(DVec2::new(x.quantity(&NUMBER)?, y.quantity(&NUMBER)?))
}

fn tilt(section: &Section<'_>) -> Result<SensorTilt, Problem> {
    let Some(tilt) = section.table("tilt", TILT_KEYS)? else {
        return Ok(SensorTilt::default());
    };
    Ok(SensorTilt {
        angle: tilt.required("angle", "\"5 deg\"")?.quantity(&ANGLE)?,
        azimuth: tilt.or("azimuth", 0.0, |value| value.quantity(&ANGLE))?,
    })
}

fn distortion(value: &Value<'_>) -> Result<RadialDistortion, Problem> {
    let [k1, k2, k3] = value.elements("three numbers [k1, k2, k3], such as [-0.1, 0, 0]")?;
    Ok(RadialDistortion {
        k1: k1.quantity(&NUMBER)?,
        k2: k2.quantity(&NUMBER)?,
        k3: k3.quantity(&NUMBER)?,
    })
}

fn resolution(value: &Value<'_>) -> Result<[usize; 2], Problem> {
    let [width, height] = value.elements("two numbers of pixels, such as [320, 240]")?;
    Ok([pixels(&width)?, pixels(&height)?])
}

fn pixels(value: &Value<'_>) -> Result<usize, Problem> {
    let pixels = value.integer(1..=u64::from(u32::MAX))?;
    usize::try_from(pixels).map_err(|_| value.must_be("a number of pixels that can be counted"))
}
