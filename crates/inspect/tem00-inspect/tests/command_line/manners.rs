//! What all commands have in common: wrong kinds of files, and what shells are told.

use std::fs;

use super::{assert_code, files, folder, message, run, text};

const SETUP: &str = "[laser]\nwavelength = \"650 nm\"\n[camera]\n[surface]\nreflectance = 0.5\n";

#[test]
fn a_file_of_another_kind_is_told_with_the_command_that_takes_it() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("a.toml"), super::triangulate::SCAN).expect("written");
    fs::write(path.join("b.toml"), SETUP).expect("written");
    let grid = "[sweep]\ncommand = \"budget\"\nfile = \"b.toml\"\n[[sweep.vary]]\nkey = \"camera.f_number\"\n";
    fs::write(path.join("g.toml"), grid).expect("written");
    let is_grid = [
        "this is the grid file of a sweep",
        "tem00-inspect sweep g.toml",
    ];
    super::images::write_line(&path.join("c.png"));
    for (line, parts) in [
        (
            "triangulate b.toml",
            ["this is a set-up file", "tem00-inspect budget b.toml"],
        ),
        (
            "budget a.toml",
            ["this is a scene file", "tem00 render a.toml"],
        ),
        (
            "design a.toml",
            ["this is a scene file", "tem00 render a.toml"],
        ),
        ("budget g.toml", is_grid),
        ("design g.toml", is_grid),
        ("triangulate g.toml", is_grid),
        (
            "sweep a.toml",
            ["this is a scene file", "tem00 render a.toml"],
        ),
        (
            "sweep b.toml",
            ["this is a set-up file", "tem00-inspect budget b.toml"],
        ),
        ("budget c.png", ["this is an image", "tem00 stats c.png"]),
        (
            "lines a.toml",
            ["this is a scene file", "tem00 render a.toml"],
        ),
    ] {
        let output = run(path, line);
        assert_code(&output, 2);
        let told = message(&output);
        for part in parts {
            assert!(told.contains(part), "{line}: {told}");
        }
    }
}

#[test]
fn devices_are_no_files() {
    let folder = folder();
    for line in [
        "triangulate /dev/zero",
        "budget /dev/zero",
        "design /dev/zero",
        "lines /dev/zero.tif",
        "lines frame.png --calibration /dev/zero",
    ] {
        super::images::write_line(&folder.path().join("frame.png"));
        let output = run(folder.path(), line);
        assert_code(&output, 2);
        assert!(!message(&output).is_empty(), "{line}");
    }
}

#[test]
fn shells_and_man_know_every_command() {
    let folder = folder();
    let output = run(folder.path(), "completions bash");
    assert_code(&output, 0);
    let script = text(&output.stdout);
    for word in ["triangulate", "calibrate", "repetitions", "tem00-inspect"] {
        assert!(script.contains(word), "{word} is not in the script");
    }
    assert_code(&run(folder.path(), "man pages"), 0);
    let pages = files(&folder.path().join("pages"));
    for page in ["tem00-inspect.1", "tem00-inspect-budget.1"] {
        assert!(
            pages.contains(&page.to_owned()),
            "{page} is not in {pages:?}"
        );
    }
}

#[test]
fn lists_name_what_set_ups_can_name_with_its_source() {
    let folder = folder();
    for (what, parts) in [
        ("detectors", &["blais_rioux", "Steger 1998"][..]),
        ("sensors", &["full_well (electrons)", "10500", "Typical"]),
    ] {
        let output = run(folder.path(), &format!("list {what}"));
        assert_code(&output, 0);
        let table = text(&output.stdout);
        for part in parts {
            assert!(table.contains(part), "{part} is not in\n{table}");
        }
    }
}
