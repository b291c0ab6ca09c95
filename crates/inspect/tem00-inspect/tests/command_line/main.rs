//! The program as its users meet it: exit codes, what goes where, and which files appear.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

mod budget;
mod calibrate;
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

use std::{fs, path::Path};

use serde_json::Value;

use self::helpers::{assert_code, files, folder, message, tem00, text, words};

/// A set-up of the usual parts, with few rows.
const SETUP: &str = include_str!("../cmd/files/setup.toml");
/// The same to search from, over f-numbers and angles.
const DESIGN: &str = include_str!("../cmd/files/design.toml");
/// Two plates, a millimetre apart, that move under a line in four frames.
const SCAN: &str = include_str!("../cmd/files/scan.toml");

const PROGRAM: &str = env!("CARGO_BIN_EXE_tem00-inspect");

#[test]
fn what_cannot_be_is_refused_in_words_and_leaves_no_file() {
    let folder = helpers::play("refusals", |folder| {
        images::write_line(&folder.join("frame.png"));
        fs::create_dir(folder.join("folder")).expect("made");
    });
    // The folder of lines is made before a frame is read, and a map is refused once its points are
    // known.
    assert_eq!(files(&folder.path().join("out")), ["lines", "scan"]);
    assert!(files(&folder.path().join("out/lines")).is_empty());
}

#[test]
fn answers_are_as_they_read() {
    helpers::play("answers", |folder| {
        images::write_line(&folder.join("frame.png"));
    });
}

/// Makes a folder with a file `a.toml`.
fn written(text: &str) -> tempfile::TempDir {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), text).expect("the file is written");
    folder
}

/// Returns text with a part replaced, which it has.
#[track_caller]
fn replaced(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is in the file");
    text.replace(from, to)
}

/// Standard output of a command, and standard error in one line.
struct Said {
    out: String,
    told: String,
}

/// Runs a command, which ends with a code.
#[track_caller]
fn said(folder: &Path, line: &str, code: i32) -> Said {
    let output = tem00(folder, "").args(words(line)).output();
    let output = output.expect("the program starts");
    assert_code(&output, code);
    let (out, told) = (text(&output.stdout), message(&output));
    Said { out, told }
}

#[track_caller]
fn assert_has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("the file is there")
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("it is JSON")
}

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}
