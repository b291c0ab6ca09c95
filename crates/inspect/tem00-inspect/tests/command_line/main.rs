//! The program as its users meet it: exit codes, what goes where, and which files appear.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

mod budget;
mod calibrate;
mod changes;
mod characterise;
mod design;
mod folders;
#[path = "../../../../render/tem00-cli/tests/command_line/helpers.rs"]
mod helpers;
mod images;
mod lines;
mod manners;
mod reports;
mod sweep;
mod triangulate;
mod tutorial;

use self::helpers::{assert_code, files, folder, message, run, tem00, text};

const PROGRAM: &str = env!("CARGO_BIN_EXE_tem00-inspect");

#[test]
fn what_cannot_be_is_refused_in_words_and_leaves_no_file() {
    let folder = helpers::play("refusals", |folder| {
        images::write_line(&folder.join("frame.png"));
        std::fs::create_dir(folder.join("folder")).expect("made");
    });
    // The folder of lines is made before a frame is read, and a map is refused once its points are known.
    assert_eq!(files(&folder.path().join("out")), ["lines", "scan"]);
    assert!(files(&folder.path().join("out/lines")).is_empty());
}

#[test]
fn answers_are_as_they_read() {
    helpers::play("answers", |folder| {
        images::write_line(&folder.join("frame.png"));
    });
}
