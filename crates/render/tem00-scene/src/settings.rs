use tem00_camera::Camera;
use tem00_config::{Document, MEMORY, NUMBER, Problem, RADIANCE, Section, Value};
use tem00_numerics::cast::to_i64;
use tem00_tracer::{Crop, LaserEvents, Method, RenderOptions, Sampling, Scene, SpeckleSettings};

use crate::filter;

const RENDER_KEYS: &[&str] = &[
    "samples_per_pixel",
    "seed",
    "frames",
    "reference_frame",
    "max_depth",
    "method",
    "laser_events",
    "crop",
    "adaptive",
    "target_error",
    "filter",
    "white_level",
];
const SPECKLE_KEYS: &[&str] = &["size", "diameter", "half_period", "memory"];

const LASER_EVENTS: &[(&str, LaserEvents)] = &[
    ("beam", LaserEvents::Beam),
    ("sampled", LaserEvents::Sampled),
];

/// The largest pattern size and number of slices: what a memory of a tebibyte could hold.
const MAX: u64 = 1 << 15;

/// Reads into a scene how the image of its camera is rendered, and its frames.
pub(crate) fn render(root: &Document<'_>, scene: &mut Scene) -> Result<(), Problem> {
    let Some(section) = root.table("render", RENDER_KEYS)? else {
        return Ok(());
    };
    let default = scene.render;
    let methods = Method::ALL.map(|method| (method.name(), method));
    let frames = section.or("frames", scene.frames, count)?;
    scene.frames = frames;
    scene.reference_frame = section.or("reference_frame", scene.reference_frame, |value| {
        let frame = value.integer(0..=u64::from(frames - 1))?;
        Ok(u32::try_from(frame).unwrap_or(frames - 1))
    })?;
    scene.render = RenderOptions {
        samples_per_pixel: section.or("samples_per_pixel", default.samples_per_pixel, count)?,
        seed: section.or("seed", default.seed, |value| value.integer(0..=u64::MAX))?,
        max_depth: section.or("max_depth", default.max_depth, |value| {
            count(value).map(Some)
        })?,
        method: section.or("method", default.method, |value| value.one_of(&methods))?,
        laser_events: section.or("laser_events", default.laser_events, |value| {
            value.one_of(LASER_EVENTS)
        })?,
        crop: section.or("crop", default.crop, |value| {
            crop(value, &scene.camera).map(Some)
        })?,
        sampling: sampling(&section)?,
        filter: filter::read(&section)?,
        white_level: section.or("white_level", None, |value| {
            value.positive(&RADIANCE).map(Some)
        })?,
        ..default
    };
    Ok(())
}

/// Reads how the samples are distributed among the pixels.
fn sampling(section: &Section<'_>) -> Result<Sampling, Problem> {
    let target = section.or("target_error", None, |value| {
        let error = value.within(&NUMBER, 1e-6..=1.0, "from 1e-6 to 1")?;
        Ok(Some(error))
    })?;
    let is_adaptive = section.or("adaptive", false, Value::boolean)?;
    match target {
        Some(_) if is_adaptive => Err(section.problem_with(
            "adaptive",
            "`adaptive` must be false where `target_error` says how many samples a pixel gets",
        )),
        Some(error) => Ok(Sampling::TargetError(error)),
        None if is_adaptive => Ok(Sampling::Adaptive),
        None => Ok(Sampling::Even),
    }
}

/// Reads a part of the image, `[x, y, width, height]`.
fn crop(value: &Value<'_>, camera: &Camera) -> Result<Crop, Problem> {
    let allowed = "four numbers of pixels [x, y, width, height]";
    let [x, y, width, height] = value.elements(allowed)?;
    let pixels = |value: &Value<'_>, min| {
        let pixels = value.integer(min..=u64::from(u32::MAX))?;
        Ok(usize::try_from(pixels).unwrap_or(usize::MAX))
    };
    let crop = Crop {
        x: pixels(&x, 0)?,
        y: pixels(&y, 0)?,
        width: pixels(&width, 1)?,
        height: pixels(&height, 1)?,
    };
    let [columns, rows] = [camera.width(), camera.height()];
    if crop.lies_in([columns, rows]) {
        Ok(crop)
    } else {
        Err(value.must_be(format_args!(
            "a part [x, y, width, height] of the image of {columns} × {rows} pixels"
        )))
    }
}

/// A number from 1 to a million.
fn count(value: &Value<'_>) -> Result<u32, Problem> {
    const MAX: u32 = 1_000_000;
    let count = value.integer(1..=u64::from(MAX))?;
    Ok(u32::try_from(count).unwrap_or(MAX))
}

pub(crate) fn speckle(root: &Document<'_>) -> Result<SpeckleSettings, Problem> {
    let default = SpeckleSettings::default();
    let Some(section) = root.table("speckle", SPECKLE_KEYS)? else {
        return Ok(default);
    };
    let samples = |key, min| {
        section.or(key, None, |value| {
            let samples = value.integer(min..=MAX)?;
            Ok(usize::try_from(samples).ok())
        })
    };
    let size = samples("size", 16)?;
    let diameter = samples("diameter", 8)?;
    if let (Some(size), Some(diameter)) = (size, diameter)
        && diameter > size / 2
    {
        return Err(section.problem_with(
            "diameter",
            format_args!(
                "`diameter` must be at most half of `size`, {}, got {diameter}",
                size / 2
            ),
        ));
    }
    Ok(SpeckleSettings {
        size,
        diameter,
        half_period: samples("half_period", 1)?,
        memory: section.or("memory", default.memory, memory)?,
    })
}

fn memory(value: &Value<'_>) -> Result<u64, Problem> {
    let bytes = value.within(&MEMORY, 1.0..=1e18, "from 1 B to 10¹⁸ B")?;
    Ok(to_i64(bytes).unsigned_abs())
}
