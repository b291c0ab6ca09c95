//! The program as its users meet it: exit codes, what goes where, and which files appear.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

mod changes;
mod folders;
mod helpers;
mod hostile;
mod images;
mod manners;
#[cfg(target_os = "linux")]
mod memory;
mod patterns;
mod render;
mod sequence;
mod speckle;

use std::fs;

use self::helpers::{
    assert_code, done, files, folder, interrupt, json, json_of, message, refused, run, start,
    tem00, text, wait_until, write,
};

const PROGRAM: &str = env!("CARGO_BIN_EXE_tem00");

/// A spot on a diffuse plane, small enough to be rendered in a moment.
const SCENE: &str = include_str!("../cmd/files/a.toml");

pub(crate) fn scene_folder() -> tempfile::TempDir {
    let folder = folder();
    write(folder.path(), "a.toml", SCENE);
    folder
}

#[test]
fn what_cannot_be_is_refused_in_words_and_leaves_no_file() {
    let folder = helpers::play("refusals", |_| ());
    let given = fs::read_dir("tests/cmd/files").expect("the files").count();
    assert_eq!(files(folder.path()).len(), given);
}

#[test]
fn what_the_camera_will_see_is_told_before_anything_is_rendered() {
    let folder = helpers::play("check", |_| ());
    let drawing = fs::read_to_string(folder.path().join("drawn/a_overview.svg"));
    let drawing = drawing.expect("the drawing");
    for name in [
        "camera",
        "laser 0",
        "surface 1",
        "from +z",
        "from −x",
        "from +y",
    ] {
        assert!(drawing.contains(name), "{name} is not drawn");
    }
    let of_mistakes = ["a_overview.png", "a_overview.svg"];
    assert_eq!(files(&folder.path().join("out/a")), of_mistakes);
}

#[test]
fn answers_are_as_they_read() {
    helpers::play("answers", |_| ());
}
