use super::error::Problem;
use super::quantity::MEMORY;
use super::section::Section;
use super::value::Value;
use crate::{RenderSettings, SpeckleSettings};

pub(super) const RENDER_KEYS: &[&str] = &["samples_per_pixel", "seed", "frames"];
pub(super) const SPECKLE_KEYS: &[&str] = &["size", "diameter", "half_period", "memory"];

/// The largest pattern size and number of slices: what a memory of a tebibyte could hold.
const MOST: u64 = 1 << 15;

pub(super) fn render(root: &Section<'_>) -> Result<RenderSettings, Problem> {
    let default = RenderSettings::default();
    let Some(section) = root.table("render", RENDER_KEYS)? else {
        return Ok(default);
    };
    Ok(RenderSettings {
        samples_per_pixel: section.or("samples_per_pixel", default.samples_per_pixel, count)?,
        seed: section.or("seed", default.seed, |value| value.integer(0..=u64::MAX))?,
        frames: section.or("frames", default.frames, count)?,
        ..default
    })
}

/// A number from 1 to a million.
fn count(value: &Value<'_>) -> Result<u32, Problem> {
    const MOST: u32 = 1_000_000;
    let count = value.integer(1..=u64::from(MOST))?;
    Ok(u32::try_from(count).unwrap_or(MOST))
}

pub(super) fn speckle(root: &Section<'_>) -> Result<SpeckleSettings, Problem> {
    let default = SpeckleSettings::default();
    let Some(section) = root.table("speckle", SPECKLE_KEYS)? else {
        return Ok(default);
    };
    let samples = |key, least| {
        section.or(key, None, |value| {
            let samples = value.integer(least..=MOST)?;
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

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an amount of memory is at least 1 byte and below 2⁶³ bytes"
)]
fn memory(value: &Value<'_>) -> Result<u64, Problem> {
    let bytes = value.within(&MEMORY, 1.0..=1e18, "from 1 B to 10¹⁸ B")?;
    Ok(bytes as u64)
}
