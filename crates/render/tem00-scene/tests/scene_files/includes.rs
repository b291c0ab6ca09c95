use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{CAMERA, LASER, SURFACE, TETRAHEDRON, parse};
use tem00_config::ConfigError;
use tem00_tracer::Scene;

use tem00_scene::{SceneFile, read_scene};

/// Writes files and reads the scene `scene.toml` among them.
fn read(files: &[(&str, &str)]) -> Result<Scene, ConfigError> {
    let folder = write(files);
    read_scene(&folder.path().join("scene.toml"))
}

fn write(files: &[(&str, &str)]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, content) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
    folder
}

/// Asserts that the scene is refused in `file` at `line`, with a message that contains all of
/// `words`.
#[track_caller]
fn assert_refused(files: &[(&str, &str)], (file, line): (&str, usize), words: &[&str]) {
    let error = read(files).expect_err("this scene should not be read");
    let path = error.path().unwrap_or(Path::new(""));
    assert!(path.ends_with(file), "{error} is not in {file}");
    let (got, _) = error.line_column().unwrap_or_default();
    assert_eq!(got, line, "line of: {error}");
    for word in words {
        let message = error.message();
        assert!(message.contains(word), "{word:?} is not in: {error}");
    }
}

#[test]
fn a_scene_may_be_spread_over_files() {
    let laser = LASER.replace("650 nm", "532 nm");
    let lasers = format!("include = [\"more.toml\"]\n{LASER}");
    let include = "include = [\"parts/lasers.toml\", \"surface.toml\"]";
    let scene = read(&[
        ("scene.toml", &format!("{include}\n{CAMERA}{LASER}")),
        ("parts/lasers.toml", &lasers),
        ("parts/more.toml", &laser),
        ("surface.toml", SURFACE),
    ])
    .unwrap();
    let colours = scene.lasers.iter().map(|laser| laser.wavelength());
    // What is included comes first.
    assert_eq!(colours.collect::<Vec<_>>(), [532e-9, 650e-9, 650e-9]);
    assert_eq!(scene.surfaces.len(), 1, "surfaces");
}

#[test]
fn files_are_looked_for_beside_the_file_that_names_them() {
    let surface = "[[surface]]\nmesh.file = \"a.obj\"\n";
    let main = format!("include = [\"parts/part.toml\"]\n{CAMERA}{LASER}");
    let folder = write(&[
        ("scene.toml", &main),
        ("parts/part.toml", surface),
        ("parts/a.obj", TETRAHEDRON),
    ]);
    let path = folder.path().join("scene.toml");
    let read = SceneFile::read(&path).unwrap();
    assert_eq!(read.scene.surfaces.len(), 1, "surfaces");
    let names = ["scene.toml", "parts/part.toml", "parts/a.obj"];
    let expected = names.map(|name| folder.path().join(name));
    assert_eq!(read.files, expected, "all files are told");
}

#[test]
fn mistakes_are_placed_in_the_file_that_has_them() {
    let main = format!("include = [\"part.toml\"]\n{CAMERA}{LASER}");
    for (text, line, word) in [
        (
            "\n[[surface]]\nsphere.radis = 1\n",
            3,
            "unknown key `radis`",
        ),
        ("[[surface]]\nsphere.radius = -1\n", 2, "positive"),
        ("[[surface]]\nsphere.radius = \n", 2, "not valid TOML"),
        ("\n\nbackground = 1\n", 3, "unknown key `background`"),
        ("[[surface]]\nmesh.file = \"no.ply\"\n", 2, "no.ply"),
    ] {
        let files = [("scene.toml", &*main), ("part.toml", text)];
        assert_refused(&files, ("part.toml", line), &[word]);
    }
}

#[test]
fn a_section_of_which_there_is_one_stands_in_one_file() {
    let main = format!("include = [\"part.toml\"]\n\n{CAMERA}{LASER}{SURFACE}");
    let part = format!("# The camera.\n{CAMERA}");
    let files = [("scene.toml", &*main), ("part.toml", &*part)];
    assert_refused(
        &files,
        ("scene.toml", 3),
        &["[camera] is given a second time", "part.toml:2:1"],
    );
}

#[test]
fn includes_that_lead_nowhere_are_refused_where_they_stand() {
    let main = |include: &str| format!("\ninclude = {include}\n{CAMERA}{LASER}{SURFACE}");
    let table = r#"
        ["missing.toml"] => missing.toml cannot be read
        ["."] => cannot be read
        ["scene.toml"] => would include itself
        ["other.toml"] => must be text in UTF-8
        ["empty.toml", "./empty.toml"] => part of the document already
        "empty.toml" => must be a list of files
        [1] => element 1 of `include` must be a string
    "#;
    for [include, word] in tem00_testkit::rows(table) {
        let folder = write(&[("scene.toml", &main(&include)), ("empty.toml", "")]);
        fs::write(folder.path().join("other.toml"), [0x66, 0xff]).unwrap();
        let error = read_scene(&folder.path().join("scene.toml")).unwrap_err();
        assert!(error.message().contains(&word), "{word:?}: {error}");
        let line = error.line_column().map(|(line, _)| line);
        assert_eq!(line, Some(2), "{error}");
    }
}

#[test]
fn circles_and_endless_chains_of_includes_end() {
    let main = format!("include = [\"a.toml\"]\n{CAMERA}{LASER}{SURFACE}");
    let circle = [
        ("scene.toml", &*main),
        ("a.toml", "include = [\"b.toml\"]"),
        ("b.toml", "include = [\"a.toml\"]"),
    ];
    assert_refused(&circle, ("b.toml", 1), &["a.toml would include itself"]);

    let names: Vec<String> = (0..40).map(|i| format!("{i}.toml")).collect();
    let contents: Vec<String> = (1..=40)
        .map(|i| format!("include = [\"{i}.toml\"]"))
        .collect();
    let mut chain: Vec<(&str, &str)> = vec![("scene.toml", "include = [\"0.toml\"]")];
    chain.extend(names.iter().zip(&contents).map(|(n, c)| (&**n, &**c)));
    assert_refused(&chain, ("15.toml", 1), &["more than 16 files away"]);
}

#[test]
fn text_without_a_file_may_include_files() {
    let missing = "include = [\"no/such/file.toml\"]\n";
    let error = parse(missing).unwrap_err();
    assert_eq!(error.path(), None, "the text has no file");
    assert_eq!(error.line_column(), Some((1, 12)), "{error}");
}

#[test]
fn a_byte_order_mark_is_no_part_of_a_file() {
    let marked = |text: &str| format!("\u{feff}{text}");
    let scene = format!("include = [\"surface.toml\"]\n{CAMERA}{LASER}");
    let read_scene = read(&[
        ("scene.toml", &marked(&scene)),
        ("surface.toml", &marked(SURFACE)),
    ]);
    assert_eq!(read_scene.unwrap().surfaces.len(), 1);
    assert!(parse(&marked(&[CAMERA, LASER, SURFACE].concat())).is_ok());
    let error = read(&[("scene.toml", "\u{feff}inclode = 1\n")]).unwrap_err();
    assert_eq!(error.line_column(), Some((1, 1)), "{error}");
}
