//! `docs/setup_file.md` has the keys that the readers know, and no others.

use std::collections::BTreeSet;

use super::{design, detector, sensor, setup};

fn page() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/setup_file.md");
    std::fs::read_to_string(path).unwrap()
}

/// Returns the text under a heading, up to the next one.
fn section<'a>(page: &'a str, heading: &str) -> &'a str {
    let (_, after) = page.split_once(&format!("# `[{heading}]`\n")).unwrap();
    after.split("\n#").next().unwrap_or(after)
}

/// Returns what stands between backticks.
fn in_backticks(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Returns the keys that the first cells of a section's tables name; quoted ones are values.
pub(super) fn documented<'a>(page: &'a str, heading: &str) -> BTreeSet<&'a str> {
    let rows = section(page, heading).lines();
    let cells = rows.filter_map(|line| line.strip_prefix("| ")?.split(" |").next());
    let keys = cells.flat_map(in_backticks);
    keys.filter(|key| {
        key.bytes()
            .all(|byte| byte == b'_' || byte.is_ascii_lowercase())
    })
    .collect()
}

#[test]
fn the_page_has_exactly_the_keys_of_the_reader() {
    let page = page();
    for (heading, keys) in [
        ("laser", setup::LASER),
        ("camera", setup::CAMERA),
        ("sensor", sensor::KEYS),
        ("surface", setup::SURFACE),
        ("calibration", setup::CALIBRATION),
        ("average", setup::AVERAGE),
        ("design", design::KEYS),
        ("design.vary", design::RANGE),
        ("design.require", design::REQUIRE),
    ] {
        let keys: BTreeSet<_> = keys.iter().copied().collect();
        assert_eq!(documented(&page, heading), keys, "[{heading}]");
    }
}

#[test]
fn the_page_has_the_keys_of_the_detector_and_its_methods() {
    let page = page();
    let mut documented = documented(&page, "detector");
    assert!(documented.contains("method"), "{documented:?}");
    let keys: BTreeSet<_> = detector::KEYS.iter().copied().collect();
    documented.retain(|key| !keys.contains(key));
    assert!(documented.is_empty(), "{documented:?} are no keys");
    for key in keys {
        let row = format!("| `{key}` |");
        assert!(section(&page, "detector").contains(&row), "{key}");
    }
    for method in crate::LineMethod::ALL {
        let name = format!("`\"{method}\"`");
        assert!(section(&page, "detector").contains(&name), "{method}");
    }
}

#[test]
fn the_page_has_what_a_search_can_vary() {
    let page = page();
    let text = section(&page, "design.vary");
    for key in design::VARY {
        let named = in_backticks(text).any(|name| name == *key);
        assert!(named, "{key}");
    }
}
