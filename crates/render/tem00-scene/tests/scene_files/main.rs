//! What the reader of scene files accepts and refuses, and that their page and their JSON schema
//! say the same.

#![expect(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

mod accepted;
mod any_text;
mod includes;
mod refused;
mod repository;
mod schema;
mod transcript;

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use tem00_config::ConfigError;
use tem00_scene::{parse_scene, read_scene};
use tem00_tracer::Scene;

const CAMERA: &str = "[camera]\nposition = [0, 0, \"300 mm\"]\n";
const LASER: &str = "[[laser]]\nwavelength = \"650 nm\"\npower = \"5 mW\"\n\
                     position = [0.1, 0, 0.2]\nspot.waist_radius = \"0.5 mm\"\n";
const SURFACE: &str = "[[surface]]\nrectangle.size = [\"40 mm\", \"30 mm\"]\n";

fn minimal() -> String {
    [CAMERA, LASER, SURFACE].concat()
}

/// Reads a scene; what the reader takes, the schema must allow.
#[track_caller]
fn parse(text: &str) -> Result<Scene, ConfigError> {
    let scene = parse_scene(text, Path::new("."));
    if scene.is_ok() {
        schema::assert_allowed(text);
    }
    scene
}

/// Returns the minimal scene with one line of it replaced.
#[track_caller]
fn with(line: &str, replacement: &str) -> String {
    let text = minimal();
    assert!(text.contains(line), "{line:?} is not in the scene");
    text.replace(line, replacement)
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n\
                           f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// Writes a mesh file and reads a scene that uses it with further keys.
fn parse_with_mesh(name: &str, content: &str, keys: &str) -> Result<Scene, ConfigError> {
    let directory = TempDir::new().unwrap();
    fs::write(directory.path().join(name), content).unwrap();
    let surface = format!("[[surface]]\n[surface.mesh]\nfile = \"{name}\"\n{keys}\n");
    let text = [CAMERA, LASER, &surface].concat();
    if parse_scene(&text, directory.path()).is_ok() {
        schema::assert_allowed(&text);
    }
    fs::write(directory.path().join("scene.toml"), text).unwrap();
    read_scene(&directory.path().join("scene.toml"))
}
