use std::fs;
use std::path::{Path, PathBuf};

use super::super::{camera, laser, light, material, settings, surface};
use super::{parse, with};
use crate::read_scene;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn documentation() -> String {
    fs::read_to_string(repository().join("docs/scene_file.md")).unwrap()
}

#[test]
fn the_scenes_of_the_repository_are_read() {
    let scenes = [
        "gauge_blocks",
        "grazing_waist",
        "line_on_metal",
        "line_with_speckle",
        "moved_surface",
        "spot",
    ];
    for name in scenes {
        let path = repository().join(format!("scenes/{name}.toml"));
        let scene = read_scene(&path).map_err(|error| error.to_string());
        assert!(scene.is_ok(), "{scene:?}");
    }
}

#[test]
fn the_minimal_scene_of_the_documentation_is_read() {
    let text = documentation();
    let (_, rest) = text.split_once("```toml\n").unwrap();
    let (example, _) = rest.split_once("```").unwrap();
    let scene = parse(example).map_err(|error| error.to_string());
    assert!(scene.is_ok(), "{scene:?}");
}

#[test]
fn the_elliptic_spot_of_the_documentation_is_read() {
    let text = documentation();
    let spot = text.lines().find(|line| line.starts_with("spot = "));
    let scene = parse(&with("spot.waist_radius = \"0.5 mm\"", spot.unwrap()));
    let scene = scene.map_err(|error| error.to_string());
    assert!(scene.is_ok(), "{scene:?}");
}

#[test]
fn every_key_is_documented() {
    let text = documentation();
    let choices = [
        laser::SHAPES,
        surface::SHAPES,
        material::MATERIALS,
        light::SHAPES,
    ];
    let nested = choices.into_iter().flatten().map(|(_, keys)| *keys);
    let own = [
        camera::KEYS,
        laser::KEYS,
        surface::KEYS,
        light::KEYS,
        settings::RENDER_KEYS,
        settings::SPECKLE_KEYS,
    ];
    for key in own.into_iter().chain(nested).flatten() {
        let documented =
            text.contains(&format!("| `{key}` |")) || text.contains(&format!(".{key}]"));
        assert!(documented, "{key} is not in docs/scene_file.md");
    }
}
