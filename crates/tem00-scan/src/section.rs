use tem00_config::{Document, LENGTH, Problem, Section, Value};
use tem00_tracer::Scene;

use crate::settings::{Averaging, RawFormat, ScanSettings};

const KEYS: &[&str] = &["surface", "height", "pitch", "average", "raw"];
const AVERAGE_KEYS: &[&str] = &["frames", "columns"];

const RAW_FORMATS: &[(&str, RawFormat)] = &[("png", RawFormat::Png), ("tiff", RawFormat::Tiff)];

/// More columns than these have no image.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn file(name: &str) -> String {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/");
        std::fs::read_to_string(format!("{folder}{name}")).unwrap()
    }

    #[test]
    fn page_and_schema_have_exactly_the_keys_of_the_reader() {
        let schema: serde_json::Value = serde_json::from_str(&file("scene.schema.json")).unwrap();
        let scan = &schema["properties"]["scan"];
        for (section, keys) in [(scan, KEYS), (&scan["properties"]["average"], AVERAGE_KEYS)] {
            let mut listed: Vec<_> = section["properties"].as_object().unwrap().keys().collect();
            let mut keys = keys.to_vec();
            listed.sort();
            keys.sort_unstable();
            assert_eq!(listed, keys, "{section}");
            assert_eq!(section["additionalProperties"], false, "{section}");
        }
        let page = file("scene_file.md");
        let (_, scan) = page.split_once("# `[scan]`\n").unwrap();
        let rows = scan.split("\n#").next().unwrap().lines();
        let named = rows.filter_map(|row| row.strip_prefix("| `")?.split_once('`'));
        let mut named: Vec<_> = named.map(|(key, _)| key).collect();
        let mut keys = KEYS.to_vec();
        named.sort_unstable();
        keys.sort_unstable();
        assert_eq!(named, keys);
    }
}
