//! The JSON schema of scene files, for editors, says what the reader does.

mod json;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;
use toml::de::DeTable;

use super::{minimal, parse, with};
use json::{Schema, from_toml};

/// Reads the schema of the repository.
fn schema() -> Schema {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/scene.schema.json");
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

/// Every table of a scene file: the name of its definition in the schema, the section that it stands in, and a line there
/// that gives it a key that no table has. The scene itself has no name.
const TABLES: &[(&str, &str, &str)] = &[
    ("", "", "?"),
    ("camera", "[camera]", "?"),
    ("tilt", "[camera]", "tilt = { ? }"),
    ("laser", "[[laser]]", "?"),
    ("spot", "[[laser]]", "spot = { ? }"),
    ("line", "[[laser]]", "line = { ? }"),
    (
        "profile_table",
        "[[laser]]",
        "line = { fan_angle = 1, thickness = 1e-3, profile = { ? } }",
    ),
    ("surface", "[[surface]]", "?"),
    ("rectangle", "[[surface]]", "rectangle = { ? }"),
    ("sphere", "[[surface]]", "sphere = { ? }"),
    ("cylinder", "[[surface]]", "cylinder = { ? }"),
    ("mesh", "[[surface]]", "mesh = { ? }"),
    ("lambertian", "[[surface]]", "lambertian = { ? }"),
    ("oren_nayar", "[[surface]]", "oren_nayar = { ? }"),
    ("conductor", "[[surface]]", "conductor = { ? }"),
    ("plastic", "[[surface]]", "plastic = { ? }"),
    ("mirror", "[[surface]]", "mirror = { ? }"),
    ("dielectric", "[[surface]]", "dielectric = { ? }"),
    (
        "instance",
        "[[surface]]",
        "rectangle.size = [1, 1]\ninstance = [{ ? }]",
    ),
    (
        "surface_speckle",
        "[[surface]]",
        "rectangle.size = [1, 1]\nspeckle = { ? }",
    ),
    ("keyframe", "[camera]", "keyframe = [{ ? }]"),
    ("rotation", "[camera]", "rotation_per_frame = { ? }"),
    ("light", "[[light]]", "?"),
    ("light_point", "[[light]]", "point = { ? }"),
    ("light_rectangle", "[[light]]", "rectangle = { ? }"),
    ("environment", "[[light]]", "environment = { ? }"),
    ("render", "[render]", "?"),
    ("filter", "[render]", "filter = { ? }"),
    ("filter_radius", "[render]", "filter = { box = { ? } }"),
    (
        "filter_gaussian",
        "[render]",
        "filter = { gaussian = { ? } }",
    ),
    ("speckle", "[speckle]", "?"),
];

/// Asks the reader for the keys of every table, by the name of its definition.
pub(super) fn tables() -> impl Iterator<Item = (&'static str, BTreeSet<String>)> {
    TABLES
        .iter()
        .map(|(name, section, line)| (*name, keys(section, line)))
}

/// Returns the keys that the reader says are allowed where the `line` of a `section` has another.
fn keys(section: &str, line: &str) -> BTreeSet<String> {
    let line = line.replace('?', "unheard_of = 0");
    let shape = match section {
        "[[laser]]" => "spot.waist_radius = \"0.5 mm\"\n",
        "[[surface]]" => "rectangle.size = [\"40 mm\", \"30 mm\"]\n",
        _ => "",
    };
    let scene = with(shape, "");
    let text = match scene.contains(section) {
        true => scene.replacen(section, &format!("{section}\n{line}\n"), 1),
        false => format!("{scene}{section}\n{line}\n"),
    };
    let error = parse(&text).unwrap_err();
    assert!(error.message().contains("`unheard_of`"), "{error}\n{text}");
    let help = error.help().unwrap();
    let keys = help.strip_prefix("allowed here: ").unwrap();
    keys.split(", ").map(str::to_owned).collect()
}

#[test]
fn the_schema_has_exactly_the_keys_of_the_reader() {
    let schema = schema();
    let defined = schema.tables();
    for (name, keys) in tables() {
        assert_eq!(defined.get(name), Some(&keys), "keys of {name:?}");
    }
    let known: BTreeSet<&str> = TABLES.iter().map(|(name, ..)| *name).collect();
    let defined: BTreeSet<&str> = defined.into_keys().collect();
    assert_eq!(known, defined, "tables of the reader and of the schema");
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
