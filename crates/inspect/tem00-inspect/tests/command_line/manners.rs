//! What all commands have in common: wrong kinds of files, and what shells are told.

use super::{assert_code, files, folder, message, run, text};

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
