//! What all commands have in common: wrong kinds of files, units, notes, progress, and what shells
//! are told.

use std::{
    fs,
    io::{BufRead, BufReader},
};

use super::*;

#[test]
fn darkness_is_called_so() {
    let folder = folder();
    let away = SCENE.replace("centre = [0, 0, 0]", "centre = [\"70 mm\", 0, 0]");
    write(folder.path(), "a.toml", away);
    let output = done(folder.path(), "render a.toml --spp 1");
    let said = text(&output.stderr);
    assert!(said.contains("laser 0: no light on target"), "{said}");
    assert!(!said.contains("0.0000e0"), "{said}");
    let warned = said.find("misses every surface").expect("the reason");
    let rendered = said.find("a.png: laser 0").expect("the result");
    assert!(warned < rendered, "{said}");
    let written = files(&folder.path().join("out/a"));
    let is_drawn = written.contains(&"a_overview.svg".to_owned());
    assert!(is_drawn, "{written:?}");
}

#[test]
fn quiet_leaves_notes_out_and_keeps_results_and_errors() {
    let folder = scene_folder();
    let loud = run(folder.path(), "render a.toml --spp 1");
    assert!(!loud.stderr.is_empty(), "there are notes");
    for line in ["render a.toml --spp 1 -q", "--quiet render a.toml --spp 1"] {
        let quiet = done(folder.path(), line);
        assert_eq!(text(&quiet.stderr), "", "{line}");
        assert_eq!(quiet.stdout, loud.stdout, "{line}");
    }
    refused(folder.path(), "render missing.toml -q", &["missing.toml"]);
}

#[cfg(unix)]
#[test]
fn progress_is_told_in_lines_where_there_is_no_terminal() {
    let folder = scene_folder();
    let mut child = start(folder.path(), "render a.toml --spp 1000000 --threads 1");
    let stderr = BufReader::new(child.stderr.take().expect("it is piped"));
    let lines = stderr.lines().map_while(Result::ok);
    let mut lines = lines.filter(|line| line.starts_with("a: ") && line.contains(" %, "));
    let line = lines.next().expect("a line of progress");
    interrupt(&child);
    child.wait().expect("the program ends");
    assert!(
        line.contains("samples/s") && line.ends_with("left"),
        "{line}"
    );
}

#[test]
fn shells_and_man_know_every_command_and_option() {
    let folder = folder();
    for shell in ["bash", "zsh", "fish"] {
        let output = done(folder.path(), &format!("completions {shell}"));
        let script = text(&output.stdout);
        for word in ["pattern", "speckle", "white-level", "pupil-magnification"] {
            assert!(script.contains(word), "{word} is not told to {shell}");
        }
    }
    done(folder.path(), "man pages");
    let pages = files(&folder.path().join("pages"));
    for page in [
        "tem00.1",
        "tem00-render.1",
        "tem00-speckle.1",
        "tem00-man.1",
    ] {
        assert!(pages.contains(&page.to_owned()), "{page}: {pages:?}");
    }
    let render = fs::read_to_string(folder.path().join("pages/tem00-render.1")).expect("a page");
    // Hyphens are escaped in troff.
    assert!(render.contains("white\\-level"), "{render}");
    assert!(render.contains("tem00\\-render"), "{render}");
}
