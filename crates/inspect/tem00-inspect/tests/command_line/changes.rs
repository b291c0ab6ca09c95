//! `--set`: values that take the place of those in the file.

use std::fs;

use serde_json::Value;

use super::{budget::SETUP, *};

/// Returns what a command prints on standard output, in a folder with the set-up.
#[track_caller]
fn told(setup: &str, arguments: &[&str]) -> String {
    let folder = folder();
    fs::write(folder.path().join("b.toml"), setup).expect("written");
    let output = tem00(folder.path(), "").args(arguments).output();
    let output = output.expect("the program starts");
    assert_code(&output, 0);
    text(&output.stdout)
}

fn replaced(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is in the file");
    text.replacen(from, to, 1)
}

#[test]
fn a_changed_set_up_has_the_budget_of_an_edited_one() {
    let budget = |setup: &str, changes: &[&str]| {
        let line = ["budget", "b.toml", "--json", "--trials", "0"];
        let mut found: Value =
            serde_json::from_str(&told(setup, &[&line, changes].concat())).expect("JSON");
        // The file of the one has another text than that of the other.
        found["setup"].take();
        found
    };
    let changed = budget(SETUP, &["--set", "camera.f_number=11"]);
    let edited = budget(&replaced(SETUP, "f_number = 8", "f_number = 11"), &[]);
    assert_eq!(changed, edited);
    assert_ne!(changed, budget(SETUP, &[]), "the change counts");
}
