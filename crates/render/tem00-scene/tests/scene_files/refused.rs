use std::fs;

use tempfile::TempDir;

use super::{TETRAHEDRON, parse, parse_with_mesh, with};
use tem00_scene::read_scene;

#[test]
fn bad_meshes_are_placed_at_their_file() {
    let cases = [
        ("a.obj", "v 0 0 0\n", "no triangles"),
        ("a.step", TETRAHEDRON, ".ply"),
        (
            "a.obj",
            "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            "vertex 0",
        ),
    ];
    for (name, content, word) in cases {
        let error = parse_with_mesh(name, content, "").unwrap_err();
        assert_eq!(error.line_column(), Some((10, 8)), "{error}");
        assert!(error.message().contains(word), "{word:?}: {error}");
    }
    let unit = parse_with_mesh("a.obj", TETRAHEDRON, "unit = \"deg\"").unwrap_err();
    assert!(unit.message().contains("a length in"), "{unit}");
}

#[test]
fn unreadable_files_are_refused_by_name() {
    for (old, new) in [
        ("rectangle.size", "mesh.file = \"no/such.ply\"\n#"),
        (
            "[camera]",
            "[[light]]\nenvironment.file = \"no/such.exr\"\n[camera]",
        ),
    ] {
        let error = parse(&with(old, new)).unwrap_err();
        assert!(
            error.is_unreadable() && error.message().contains("no/such"),
            "{error}"
        );
    }
    let folder = TempDir::new().unwrap();
    let missing = folder.path().join("missing.toml");
    let error = read_scene(&missing).unwrap_err();
    assert_eq!(error.path(), Some(missing.as_path()), "{error}");
    let told = "missing.toml: the scene file cannot be read";
    assert!(error.to_string().contains(told), "{error}");

    let error = read_scene(folder.path()).unwrap_err();
    assert!(error.message().ends_with(": it is a directory"), "{error}");

    let binary = folder.path().join("binary.toml");
    fs::write(&binary, b"[camera]\nup = \xff\n").unwrap();
    let error = read_scene(&binary).unwrap_err();
    assert!(error.message().contains("UTF-8"), "{error}");
    assert_eq!(error.line_column(), Some((2, 6)), "{error}");
}

#[test]
fn errors_point_at_the_bytes_that_are_wrong() {
    let error = parse(&with("\"5 mW\"", "\"−5 mW\"")).unwrap_err();
    let span = error.span().unwrap();
    assert_eq!(&error.source_text()[span], "\"−5 mW\"", "{error}");
}
