//! What all commands have in common: wrong kinds of files, units, notes, progress, and what shells are told.

use std::{
    fs,
    io::{BufRead, BufReader},
};

use super::*;

#[test]
fn darkness_is_called_so() {
    let folder = folder();
    let away = SCENE.replace("centre = [0, 0, 0]", "centre = [\"70 mm\", 0, 0]");
    fs::write(folder.path().join("a.toml"), away).expect("written");
    let output = run(folder.path(), "render a.toml --spp 1");
    assert_code(&output, 0);
    let said = text(&output.stderr);
    assert!(said.contains("laser 0: no light on target"), "{said}");
    assert!(!said.contains("0.0000e0"), "{said}");
}

#[test]
fn quiet_leaves_notes_out_and_keeps_results_and_errors() {
    let folder = scene_folder();
    let loud = run(folder.path(), "render a.toml --spp 1");
    assert!(!loud.stderr.is_empty(), "there are notes");
    for line in ["render a.toml --spp 1 -q", "--quiet render a.toml --spp 1"] {
        let quiet = run(folder.path(), line);
        assert_code(&quiet, 0);
        assert_eq!(text(&quiet.stderr), "", "{line}");
        assert_eq!(quiet.stdout, loud.stdout, "{line}");
    }
    let failed = run(folder.path(), "render missing.toml -q");
    assert_code(&failed, 2);
    assert!(message(&failed).contains("missing.toml"), "errors are told");
}

#[cfg(unix)]
#[test]
fn progress_is_told_in_lines_where_there_is_no_terminal() {
    let folder = scene_folder();
    let mut child = tem00(folder.path(), "render a.toml --spp 1000000")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let stderr = BufReader::new(child.stderr.take().expect("it is piped"));
    let lines = stderr.lines().map_while(Result::ok);
    let line = lines
        .filter(|line| line.starts_with("a: "))
        .find(|line| line.contains(" %, "));
    let line = line.expect("a line of progress");
    interrupt(&child);
    child.wait().expect("the program ends");
    assert!(
        line.contains("samples/s") && line.ends_with("left"),
        "{line}"
    );
}
