//! `docs/scene_file.md` and `docs/scene.schema.json` have the keys that the readers know, and no others.

use std::collections::BTreeSet;

use serde_json::Value;

use super::{calibration, detector, documentation::documented, sensor};

fn file(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/");
    std::fs::read_to_string(format!("{folder}{name}")).unwrap()
}

#[test]
fn the_page_of_scenes_has_exactly_the_keys_of_the_readers() {
    let page = file("scene_file.md");
    let keys: BTreeSet<_> = calibration::KEYS.iter().copied().collect();
    assert_eq!(documented(&page, "calibration"), keys);
}

#[test]
fn the_schema_of_scenes_has_exactly_the_keys_of_the_readers() {
    let schema: Value = serde_json::from_str(&file("scene.schema.json")).unwrap();
    for (section, keys) in [
        (&schema["properties"]["sensor"], sensor::KEYS),
        (&schema["properties"]["detector"], detector::KEYS),
        (&schema["properties"]["calibration"], calibration::KEYS),
    ] {
        let listed = section["properties"].as_object().unwrap();
        let listed: BTreeSet<&str> = listed.keys().map(String::as_str).collect();
        assert_eq!(listed, keys.iter().copied().collect(), "{section}");
        assert_eq!(section["additionalProperties"], false, "{section}");
    }
}
