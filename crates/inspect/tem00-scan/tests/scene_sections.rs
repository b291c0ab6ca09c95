//! `docs/scene_file.md` and its JSON schema have the keys of the sections that measure, and no
//! others.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::{collections::BTreeSet, fs};

use serde_json::Value;
use tem00_config::FileAccess;
use tem00_scan::MeasurementScene;

const SCENE: &str = r#"
camera.position = [0, 0, "300 mm"]
sensor = { quantum_efficiency = 0.6, exposure = "1 ms" }
[[laser]]
wavelength = "650 nm"
power = "5 mW"
position = [0.1, 0, 0.2]
spot.waist_radius = "0.5 mm"
[[surface]]
rectangle.size = ["40 mm", "30 mm"]
"#;

fn page(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../docs/");
    fs::read_to_string(format!("{folder}{name}")).expect("the page is there")
}

/// Returns the keys that the reader says are allowed in a table.
fn keys(table: &str) -> BTreeSet<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    let unknown = format!("{table} = {{ unheard_of = 0 }}\n");
    let without = SCENE.lines().filter(|line| !line.starts_with(table));
    let without = without.collect::<Vec<_>>().join("\n");
    fs::write(&path, unknown + &without).expect("the scene is written");
    let error = MeasurementScene::read(&path, FileAccess::WithinFolder);
    let error = error.expect_err("a key is unknown");
    assert!(error.message().contains("`unheard_of`"), "{error}");
    let help = error
        .help()
        .and_then(|help| help.strip_prefix("allowed here: "));
    let keys = help.expect("the keys are told").split(", ");
    keys.map(str::to_owned).collect()
}

#[test]
fn the_schema_has_exactly_the_keys_of_the_readers() {
    let schema: Value = serde_json::from_str(&page("scene.schema.json")).expect("JSON");
    for table in ["sensor", "detector", "calibration", "scan", "scan.average"] {
        let path = table.replace('.', "/properties/");
        let section = &schema.pointer(&format!("/properties/{path}"));
        let section = section.expect("the schema has the section");
        let listed = section["properties"].as_object().expect("an object");
        assert_eq!(
            listed.keys().cloned().collect::<BTreeSet<_>>(),
            keys(table),
            "{table}"
        );
        assert_eq!(section["additionalProperties"], false, "{table}");
    }
}

#[test]
fn the_page_has_exactly_the_keys_of_the_readers() {
    let page = page("scene_file.md");
    for section in ["calibration", "scan"] {
        let (_, text) = page
            .split_once(&format!("# `[{section}]`\n"))
            .expect("a heading");
        let rows = text.split("\n#").next().unwrap_or(text).lines();
        let named = rows.filter_map(|row| row.strip_prefix("| `")?.split_once('`'));
        let named: BTreeSet<_> = named.map(|(key, _)| key.to_owned()).collect();
        assert_eq!(named, keys(section), "[{section}]");
    }
}
