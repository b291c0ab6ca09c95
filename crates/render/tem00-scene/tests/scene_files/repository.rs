use std::fs;
use std::path::{Path, PathBuf};

use super::schema::{assert_allowed, tables};
use super::{CAMERA, LASER, SURFACE, TETRAHEDRON};
use tem00_scene::{parse_scene, read_scene};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

fn documentation() -> String {
    fs::read_to_string(repository().join("docs/scene_file.md")).unwrap()
}

#[test]
fn the_scenes_of_the_repository_are_read() {
    let folders = ["examples/scenes", "examples/scenes/triangulation"];
    let entries = folders.map(|folder| fs::read_dir(repository().join(folder)).unwrap());
    let paths = entries
        .into_iter()
        .flatten()
        .map(|entry| entry.unwrap().path());
    let paths: Vec<PathBuf> = paths
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    assert!(paths.len() >= 10, "{paths:?}");
    for path in paths {
        let scene = read_scene(&path).map_err(|error| error.to_string());
        assert!(scene.is_ok(), "{scene:?}");
        assert_allowed(&fs::read_to_string(path).unwrap());
    }
}

/// Returns the snippets of the documentation that are TOML.
fn snippets(text: &str) -> Vec<&str> {
    let after = text.split("```toml\n").skip(1);
    after
        .filter_map(|rest| Some(rest.split_once("```")?.0))
        .collect()
}

#[test]
fn the_snippets_of_the_documentation_are_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("parts")).unwrap();
    for name in ["lasers.toml", "parts/bracket.toml"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    for name in ["bracket.obj", "nut.obj"] {
        fs::write(folder.path().join(name), TETRAHEDRON).unwrap();
    }
    let text = documentation();
    let snippets = snippets(&text);
    assert!(snippets.len() >= 5, "{} snippets", snippets.len());
    for snippet in snippets {
        // What a snippet leaves out is taken from the minimal scene.
        let mut scene = snippet.to_owned();
        for (header, section) in [
            ("[camera]", CAMERA),
            ("[[laser]]", LASER),
            ("[[surface]]", SURFACE),
        ] {
            if !snippet.contains(header) {
                scene.push_str(section);
            }
        }
        let read = parse_scene(&scene, folder.path()).map_err(|error| error.to_string());
        assert!(read.is_ok(), "{read:?}\n{scene}");
        assert_allowed(&scene);
    }
}

#[test]
fn every_key_is_documented() {
    let text = documentation();
    // Cells of tables that name keys; a key that only a sentence mentions is explained nowhere.
    let rows = text.lines().filter_map(|line| line.strip_prefix("| "));
    let cells = rows.flat_map(|row| row.split(" | "));
    let cells: Vec<&str> = cells.filter(|cell| cell.starts_with('`')).collect();
    for (table, keys) in tables() {
        for key in keys {
            let quoted = format!("`{key}`");
            let documented = cells.iter().any(|cell| cell.contains(&quoted))
                || text.contains(&format!("{key}]"))
                || text.contains(&format!("{key} = "));
            assert!(
                documented,
                "{key} of {table:?} is not in docs/scene_file.md"
            );
        }
    }
}
