use tem00_config::{Document, LENGTH, Problem, Section, Value};
use tem00_tracer::Scene;

use crate::settings::{Averaging, RawFormat, ScanSettings};

const KEYS: &[&str] = &["surface", "height", "pitch", "average", "raw"];
const AVERAGE_KEYS: &[&str] = &["frames", "columns"];

const RAW_FORMATS: &[(&str, RawFormat)] = &[("png", RawFormat::Png), ("tiff", RawFormat::Tiff)];

/// The maximum number of columns: no image has more.
const MAX_COLUMNS: u64 = 1 << 16;

/// Reads the section `[scan]` of a scene file.
///
/// # Errors
///
/// Returns a problem, placed in the file, if a key is unknown or a value is not allowed.
pub(crate) fn read_scan(document: &Document<'_>, scene: &Scene) -> Result<ScanSettings, Problem> {
    let default = ScanSettings::default();
    let Some(section) = document.table("scan", KEYS)? else {
        return Ok(default);
    };
    Ok(ScanSettings {
        surface: section.or("surface", None, |value| surface(value, scene).map(Some))?,
        height: section.or("height", default.height, Value::direction)?,
        pitch: section.or("pitch", None, |value| value.positive(&LENGTH).map(Some))?,
        average: averaging(&section, scene)?,
        raw: section.or("raw", default.raw, |value| value.one_of(RAW_FORMATS))?,
    })
}

/// Reads the name of a surface of the scene.
fn surface(value: &Value<'_>, scene: &Scene) -> Result<String, Problem> {
    let name = value.string()?;
    if scene.surfaces.iter().any(|surface| surface.name == name) {
        return Ok(name.to_owned());
    }
    let names: Vec<&str> = scene.surfaces.iter().map(|s| s.name.as_str()).collect();
    Err(value.must_be(format_args!(
        "the name of a surface: \"{}\"",
        names.join("\", \"")
    )))
}

fn averaging(section: &Section<'_>, scene: &Scene) -> Result<Averaging, Problem> {
    let default = Averaging::default();
    let Some(section) = section.table("average", AVERAGE_KEYS)? else {
        return Ok(default);
    };
    Ok(Averaging {
        frames: section.or("frames", default.frames, |value| {
            let frames = value.integer(1..=u64::from(scene.frames))?;
            Ok(u32::try_from(frames).unwrap_or(scene.frames))
        })?,
        columns: section.or("columns", default.columns, |value| {
            let columns = value.integer(1..=MAX_COLUMNS)?;
            Ok(usize::try_from(columns).unwrap_or(usize::MAX))
        })?,
    })
}
