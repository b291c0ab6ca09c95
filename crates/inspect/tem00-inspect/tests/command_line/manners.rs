//! What all commands have in common: wrong kinds of files, and what shells are told.

use super::*;

#[test]
fn devices_are_no_files() {
    let folder = folder();
    images::write_line(&folder.path().join("frame.png"));
    for line in [
        "triangulate /dev/zero",
        "budget /dev/zero",
        "design /dev/zero",
        "lines /dev/zero.tif",
        "lines frame.png --calibration /dev/zero",
    ] {
        assert!(!said(folder.path(), line, 2).told.is_empty(), "{line}");
    }
}

#[test]
fn shells_and_man_know_every_command() {
    let folder = folder();
    let script = said(folder.path(), "completions bash", 0).out;
    assert_has(
        &script,
        &["triangulate", "calibrate", "repetitions", "tem00-inspect"],
    );
    said(folder.path(), "man pages", 0);
    let pages = files(&folder.path().join("pages")).join(" ");
    assert_has(&pages, &["tem00-inspect.1", "tem00-inspect-budget.1"]);
}
