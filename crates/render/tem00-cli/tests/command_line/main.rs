//! The program as its users meet it: exit codes, what goes where, and which files appear.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

mod changes;
mod folders;
mod helpers;
mod hostile;
mod images;
mod inspection;
mod manners;
#[cfg(target_os = "linux")]
mod memory;
mod patterns;
mod render;
mod sequence;
mod speckle;

use std::fs;

use self::helpers::{assert_code, files, folder, interrupt, message, run, tem00, text};

const PROGRAM: &str = env!("CARGO_BIN_EXE_tem00");

/// A spot on a diffuse plane, small enough to be rendered in a moment.
const SCENE: &str = r#"
[camera]
position = ["0 mm", "0 mm", "300 mm"]
look_at = ["0 mm", "0 mm", "0 mm"]
focal_length = "25 mm"
f_number = 8
pixel_pitch = "3.45 um"
resolution = [48, 40]

[[laser]]
wavelength = "650 nm"
power = "5 mW"
position = ["100 mm", "0 mm", "300 mm"]
look_at = ["0 mm", "0 mm", "0 mm"]
spot = { waist_radius = "0.2 mm" }

[[surface]]
rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = ["20 mm", "20 mm"] }

[render]
samples_per_pixel = 4
"#;

pub(crate) fn scene_folder() -> tempfile::TempDir {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), SCENE).expect("the scene is written");
    folder
}

#[test]
fn help_teaches_by_examples() {
    let folder = folder();
    let output = run(folder.path(), "--help");
    assert_code(&output, 0);
    assert!(
        text(&output.stdout).contains("tem00 pattern -o speckle.png"),
        "examples are shown"
    );
    for command in ["render", "pattern", "stats", "speckle", "list"] {
        let output = run(folder.path(), &format!("{command} --help"));
        assert_code(&output, 0);
        assert!(
            text(&output.stdout).contains("Examples:"),
            "{command} shows examples"
        );
    }
}

#[test]
fn bad_input_is_one_message_exit_code_2_and_no_file() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("text.png"), "no picture").expect("written");
    fs::write(path.join("a.toml"), SCENE).expect("written");
    let before = files(path);
    for (line, part) in [
        ("pattern -o a.jpg", "a.jpg"),
        ("pattern -o a.png --diameter 300", "got 300"),
        ("pattern -o a.png --diameter 4", "got 4"),
        ("pattern -o a.png --size 1000000", "16384"),
        ("pattern -o a.png --size 0", "got 0"),
        ("pattern -o a.png --pupil annulus:1.5", "1.5"),
        ("pattern -o a.png --pupil square", "square"),
        ("pattern -o a.png --amplitude", "amplitude"),
        ("pattern -o no/a.png", "no/a.png"),
        ("pattern -o a.png --sede 3", "--seed"),
        ("stats missing.png", "missing.png"),
        ("stats text.png", "text.png"),
        ("stats a.toml", "a.toml"),
        ("render missing.toml", "missing.toml"),
        ("render a.toml --spp 0", "0"),
        ("render a.toml --white-level 0", "positive"),
        ("render a.toml -o text.png/out", "text.png/out"),
        ("rendr a.toml", "render"),
    ] {
        let output = run(path, line);
        assert_code(&output, 2);
        assert!(
            message(&output).contains(part),
            "{line}: {}",
            message(&output)
        );
        assert!(output.stdout.is_empty(), "{line}: nothing is data");
        assert_eq!(files(path), before, "{line}");
    }
}
