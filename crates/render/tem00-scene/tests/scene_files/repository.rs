use std::fs;
use std::path::{Path, PathBuf};

use super::schema::{assert_allowed, tables};
use super::{CAMERA, LASER, SURFACE, TETRAHEDRON};
use tem00_scene::{parse_scene, read_scene};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// Returns a page of the documentation.
pub(super) fn page(name: &str) -> String {
    fs::read_to_string(repository().join("docs").join(name)).unwrap()
}

#[test]
fn the_scenes_of_the_repository_are_read() {
    let folders = ["examples/scenes", "examples/scenes/triangulation"];
    let entries = folders.map(|folder| fs::read_dir(repository().join(folder)).unwrap());
    let paths = entries.into_iter().flatten();
    let paths = paths.map(|entry| entry.unwrap().path());
    let paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    assert!(paths.len() >= 10, "{paths:?}");
    for path in paths {
        let scene = read_scene(&path).map_err(|error| error.to_string());
        assert!(scene.is_ok(), "{scene:?}");
        assert_allowed(&fs::read_to_string(path).unwrap());
    }
}

#[test]
fn the_snippets_of_the_documentation_are_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("parts")).unwrap();
    for (name, content) in [
        ("lasers.toml", ""),
        ("parts/bracket.toml", ""),
        ("bracket.obj", TETRAHEDRON),
        ("nut.obj", TETRAHEDRON),
    ] {
        fs::write(folder.path().join(name), content).unwrap();
    }
    let text = page("scene_file.md");
    let snippets = text.split("```toml\n").skip(1);
    let snippets: Vec<_> = snippets.filter_map(|rest| rest.split_once("```")).collect();
    assert!(snippets.len() >= 5, "{} snippets", snippets.len());
    for (snippet, _) in snippets {
        // What a snippet leaves out is taken from the minimal scene.
        let sections = [
            ("[camera]", CAMERA),
            ("[[laser]]", LASER),
            ("[[surface]]", SURFACE),
        ];
        let missing = sections
            .into_iter()
            .filter(|(header, _)| !snippet.contains(header));
        let missing: String = missing.map(|(_, section)| section).collect();
        let scene = format!("{snippet}{missing}");
        let read = parse_scene(&scene, folder.path()).map_err(|error| error.to_string());
        assert!(read.is_ok(), "{read:?}\n{scene}");
        assert_allowed(&scene);
    }
}

#[test]
fn every_key_is_documented() {
    let text = page("scene_file.md");
    // Cells of tables that name keys; a key that only a sentence mentions is explained nowhere.
    let rows = text.lines().filter_map(|line| line.strip_prefix("| "));
    let cells: Vec<&str> = rows.flat_map(|row| row.split(" | ")).collect();
    for (table, keys) in tables() {
        for key in keys {
            let quoted = format!("`{key}`");
            let mut naming = cells.iter().filter(|cell| cell.starts_with('`'));
            let documented = naming.any(|cell| cell.contains(&quoted))
                || text.contains(&format!("{key}]"))
                || text.contains(&format!("{key} = "));
            assert!(
                documented,
                "{key} of {table:?} is not in docs/scene_file.md"
            );
        }
    }
}
