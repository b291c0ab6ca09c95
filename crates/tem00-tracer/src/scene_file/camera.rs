use super::document::Document;
use super::error::Problem;
use super::motion::{pivot, trajectory};
use super::placement::{Placement, across, rejected};
use super::quantity::{LENGTH, NUMBER};
use super::section::Section;
use super::value::Value;
use crate::{Camera, CameraDescription, Trajectory};

pub(super) const KEYS: &[&str] = &[
    "position",
    "look_at",
    "up",
    "focal_length",
    "f_number",
    "pixel_pitch",
    "resolution",
    "focus_distance",
    "displacement_per_frame",
    "rotation_per_frame",
    "pivot",
    "keyframe",
];

/// The camera of a scene and how it moves.
#[derive(Clone, Debug)]
pub(super) struct MovingCamera {
    pub(super) camera: Camera,
    pub(super) trajectory: Trajectory,
}

pub(super) fn read(root: &Document<'_>) -> Result<MovingCamera, Problem> {
    let section = root
        .table("camera", KEYS)?
        .ok_or_else(|| Problem::new("the scene needs a camera: a section [camera]"))?;
    let description = description(&section)?;
    let camera = Camera::new(description).map_err(|error| rejected(&error, &[&section]))?;
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
