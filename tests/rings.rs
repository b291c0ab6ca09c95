//! The rings of the house: an arrow between crates only falls, and what a renderer links stays
//! light.

use std::{collections::BTreeMap, fs, path::Path};

use tem00::{beam, decorrelation, shading, speckle};
use toml::de::{DeTable, DeValue};

/// From the ground up. Bindings and tests stand on all of them.
const RINGS: [&str; 4] = ["light", "judge", "render", "inspect"];

/// Of the workspace.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn read(path: &str) -> String {
    let path = Path::new(ROOT).join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The names that a section of a manifest holds.
fn keys(manifest: &str, section: &str) -> Vec<String> {
    let document = DeTable::parse(manifest).expect("a manifest is valid TOML");
    match document.get_ref().get(section).map(|value| value.get_ref()) {
        Some(DeValue::Table(table)) => table.keys().map(|key| key.get_ref().to_string()).collect(),
        _ => Vec::new(),
    }
}

/// Ring and manifest of each crate by its name.
fn crates() -> BTreeMap<String, (usize, String)> {
    let mut found = BTreeMap::new();
    for (ring, folder) in RINGS.iter().enumerate() {
        let path = Path::new(ROOT).join("crates").join(folder);
        for entry in fs::read_dir(path).expect("a ring is a folder") {
            let name = entry.expect("an entry").file_name();
            let name = name.to_string_lossy().into_owned();
            let manifest = read(&format!("crates/{folder}/{name}/Cargo.toml"));
            found.insert(name, (ring, manifest));
        }
    }
    found
}

/// Tests may also borrow from the ring of judges, and from the kit of tests.
#[test]
fn no_ring_names_a_ring_above_it() {
    let crates = crates();
    assert!(crates.len() > 15, "{} crates", crates.len());
    for (name, (ring, manifest)) in &crates {
        for (section, highest) in [("dependencies", *ring), ("dev-dependencies", 1.max(*ring))] {
            let ours = keys(manifest, section).into_iter();
            let ours = ours.filter(|name| name.starts_with("tem00") && name != "tem00-testkit");
            for used in ours {
                let place = crates.get(&used).map(|(ring, _)| *ring);
                assert!(
                    place.is_some_and(|place| place <= highest),
                    "{section} of {name} in `{}` must not hold {used}",
                    RINGS[*ring]
                );
            }
        }
    }
}

#[test]
fn the_first_ring_brings_no_threads_unless_asked() {
    for (name, (ring, manifest)) in crates() {
        let defaults = keys(&manifest, "features").contains(&"default".to_owned());
        assert!(
            ring > 0 || !defaults,
            "{name} must have no default features"
        );
    }
}

#[test]
fn a_citation_names_the_version() {
    let version = format!("\nversion: {}\n", env!("CARGO_PKG_VERSION"));
    assert!(read("CITATION.cff").contains(&version), "{version}");
}

#[test]
fn the_guide_shows_the_programs_that_run() {
    let page = read("docs/integration.md");
    for (language, file) in [
        ("rust,ignore", "examples/moved_spot.rs"),
        ("cpp", "bindings/integrations/cpp/moved_spot.cpp"),
        ("python", "bindings/integrations/python/moved_spot.py"),
        ("wgsl", "bindings/gpu/examples/factors.wgsl"),
    ] {
        let shown = format!("```{language}\n{}```\n", read(file));
        assert!(page.contains(&shown), "another program than {file}");
    }
}

#[test]
fn what_a_renderer_holds_crosses_threads() {
    const fn crosses<T: Send + Sync>() {}
    const {
        crosses::<(beam::SpotLight, beam::LineLight, beam::Refusal)>();
        crosses::<(speckle::SpeckleStack, speckle::SpecklePattern)>();
        crosses::<(decorrelation::RigidChange, shading::Laser)>();
        crosses::<(shading::Speckle, shading::SpeckleFrame)>();
    }
}

#[test]
fn vectors_of_other_libraries_pass_through_mint() {
    let theirs = mint::Vector3 {
        x: 1.0,
        y: -2.0,
        z: 0.5,
    };
    let placement = beam::Placement {
        origin: theirs.into(),
        direction: theirs.into(),
        fan_axis: beam::DVec3::Z,
    };
    let motion = decorrelation::RigidMotion::along(theirs.into()).expect("a translation");
    let back: [mint::Vector3<f64>; 2] = [placement.origin.into(), motion.translation().into()];
    assert_eq!(back, [theirs; 2], "there and back");
}
