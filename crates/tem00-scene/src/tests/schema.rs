//! The JSON schema of scene files, for editors, says what the reader does.

mod json;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde_json::Value;
use toml::de::DeTable;

use super::{minimal, parse, with};
use crate::{camera, filter, laser, light, material, motion, settings, shape, surface};
use json::{Schema, from_toml};

/// Reads the schema of the repository.
fn schema() -> Schema {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene.schema.json");
    let text = fs::read_to_string(path).unwrap();
    Schema::new(serde_json::from_str(&text).unwrap())
}

/// Asserts that the schema allows a document that the reader has accepted.
#[track_caller]
pub(super) fn assert_allowed(text: &str) {
    if let Err(why) = check(text) {
        panic!("the schema does not allow this scene: {why}\n{text}");
    }
}

fn check(text: &str) -> Result<(), String> {
    let document = DeTable::parse(text).map_err(|error| error.to_string())?;
    schema().check(&from_toml(document.get_ref()))
}

/// The keys of every table of a scene file, by the name of its definition in the schema; the scene
/// itself has none.
pub(super) fn tables() -> BTreeMap<&'static str, &'static [&'static str]> {
    let own = [
        ("", crate::scene_file::SCENE.keys),
        ("camera", camera::KEYS),
        ("tilt", camera::TILT_KEYS),
        ("laser", laser::KEYS),
        ("profile_table", laser::TABLE_KEYS),
        ("surface", surface::KEYS),
        ("instance", surface::INSTANCE_KEYS),
        ("surface_speckle", surface::SPECKLE_KEYS),
        ("keyframe", motion::KEYFRAME_KEYS),
        ("rotation", motion::ROTATION_KEYS),
        ("light", light::KEYS),
        ("render", settings::RENDER_KEYS),
        ("filter", filter::KEYS),
        ("speckle", settings::SPECKLE_KEYS),
    ];
    let lights = light::SHAPES.iter().map(|(name, keys)| match *name {
        "point" => ("light_point", *keys),
        "rectangle" => ("light_rectangle", *keys),
        "environment" => ("environment", *keys),
        other => panic!("no definition is named for the light {other}"),
    });
    let filters = filter::FILTERS.iter().map(|(name, keys)| match *name {
        "box" | "tent" | "lanczos" => ("filter_radius", *keys),
        "gaussian" => ("filter_gaussian", *keys),
        "mitchell_netravali" => ("filter_mitchell_netravali", *keys),
        other => panic!("no definition is named for the filter {other}"),
    });
    let choices = [laser::SHAPES, shape::SHAPES, material::MATERIALS];
    let choices = choices.into_iter().flatten().copied();
    own.into_iter()
        .chain(choices)
        .chain(lights)
        .chain(filters)
        .collect()
}

#[test]
fn the_schema_has_exactly_the_keys_of_the_reader() {
    let schema = schema();
    let mut defined = schema.tables();
    for (name, keys) in tables() {
        let keys: BTreeSet<String> = keys.iter().map(|key| (*key).to_owned()).collect();
        assert_eq!(defined.remove(name), Some(keys), "keys of {name:?}");
    }
    assert!(defined.is_empty(), "the reader does not know {defined:?}");
}

#[test]
fn the_schema_refuses_what_an_editor_should_mark() {
    let mistakes = [
        ("wavelength", "wave_length"),
        ("\"650 nm\"", "\"650 km\""),
        ("\"650 nm\"", "\"-650 nm\""),
        ("\"650 nm\"", "\"650\""),
        ("\"650 nm\"", "true"),
        ("\"5 mW\"", "\"5 nm\""),
        ("[0.1, 0, 0.2]", "[0.1, 0]"),
        ("[[laser]]", "[laser]"),
        ("spot.waist_radius = \"0.5 mm\"\n", ""),
        ("spot.", "line = { fan_angle = 1, thickness = 1 }\nspot."),
        ("rectangle.size = ", "sphere.radius = 1\nrectangle.size = "),
        (
            "rectangle.",
            "lambertian = {}\nconductor.metal = \"gold\"\nrectangle.",
        ),
        ("rectangle.", "conductor.metal = \"aluminum\"\nrectangle."),
        ("rectangle.", "lambertian.reflectance = 1.5\nrectangle."),
        ("[camera]", "[render]\nframes = 0\n[camera]"),
        ("[camera]", "[render]\nmethod = \"photon\"\n[camera]"),
    ];
    for (good, bad) in mistakes {
        let text = with(good, bad);
        assert!(parse(&text).is_err(), "the reader takes {bad}");
        assert!(check(&text).is_err(), "the schema takes {bad}");
    }
    assert_allowed(&minimal());
}

#[test]
fn values_that_the_reader_writes_down_are_in_the_schema() {
    let text = schema().text();
    for (name, _) in tem00_tracer::Metal::NAMED {
        assert!(text.contains(&format!("\"{name}\"")), "{name}");
    }
    for dimension in tem00_config::DIMENSIONS {
        for symbol in dimension.symbols() {
            // Parentheses are escaped in a pattern, and backslashes in JSON.
            let symbol = symbol.replace('(', "\\\\(").replace(')', "\\\\)");
            let listed = [
                format!("({symbol}|"),
                format!("|{symbol}|"),
                format!("|{symbol})"),
            ];
            assert!(listed.iter().any(|s| text.contains(s)), "{symbol}");
        }
    }
}

#[test]
fn the_check_knows_every_word_that_the_schema_uses() {
    let unknown = schema().unknown_words();
    assert!(unknown.is_empty(), "{unknown:?}");
    let defaults = schema().broken_defaults();
    assert_eq!(defaults, Vec::<Value>::new(), "defaults are allowed values");
}
