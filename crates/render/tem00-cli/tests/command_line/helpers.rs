//! What the tests of both programs share: a folder, a command, and what it says.

#![allow(dead_code, reason = "each program needs a part of it")]

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

pub(crate) fn tem00(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(super::PROGRAM);
    command
        .current_dir(folder)
        .args(line.split_whitespace())
        .stdin(Stdio::null());
    command
}

pub(crate) fn run(folder: &Path, line: &str) -> Output {
    tem00(folder, line).output().expect("the program starts")
}

pub(crate) fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

pub(crate) fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder can be read");
    let mut names: Vec<_> = entries
        .map(|entry| entry.expect("the entry can be read").file_name())
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Returns standard error as one line without the frame that long messages are wrapped in.
pub(crate) fn message(output: &Output) -> String {
    let words = text(&output.stderr);
    let words = words.split_whitespace().filter(|word| *word != "│");
    words.collect::<Vec<_>>().join(" ")
}

#[track_caller]
pub(crate) fn assert_code(output: &Output, code: i32) {
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
}

/// Sends an interrupt, as Ctrl-C does.
#[cfg(unix)]
pub(crate) fn interrupt(child: &std::process::Child) {
    let interrupt = format!("kill -INT {}", child.id());
    let sent = Command::new("sh").args(["-c", &interrupt]).status();
    assert!(sent.expect("a shell").success(), "the signal is sent");
}
