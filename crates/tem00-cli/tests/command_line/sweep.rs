//! `tem00 sweep`.

use std::{fs, path::Path};

use super::{assert_code, folder, message, run, text};

const SETUP: &str = include_str!("../../../../setups/data_sheet.toml");

const GRID: &str = r#"
[sweep]
command = "budget"
file = "setup.toml"
options = ["--trials", "0"]
results = ["expanded", "terms.0.source"]

[[sweep.vary]]
key = "camera.f_number"
from = 5
to = 20
steps = 3
scale = "log"

[[sweep.vary]]
key = "laser.line_thickness"
values = ["0.2 mm", "0.3 mm"]
"#;

fn written(grid: &str) -> tempfile::TempDir {
    let folder = folder();
    fs::write(folder.path().join("setup.toml"), SETUP).expect("the set-up is written");
    fs::write(folder.path().join("grid.toml"), grid).expect("the grid is written");
    folder
}

fn table(folder: &Path, out: &str) -> String {
    fs::read_to_string(folder.join(out).join("sweep.csv")).expect("the table is there")
}

#[test]
fn a_table_is_the_same_however_its_tasks_are_shared() {
    let folder = written(GRID);
    assert_code(&run(folder.path(), "sweep grid.toml"), 0);
    let at_once = table(folder.path(), "out/grid");
    for part in [
        "--task 4..5",
        "--task 0",
        "--threads 1 --task 1..3",
        "--task 0..5",
        "--gather",
    ] {
        assert_code(
            &run(folder.path(), &format!("sweep grid.toml -o parts {part}")),
            0,
        );
    }
    assert_eq!(at_once, table(folder.path(), "parts"));

    let rows: Vec<&str> = at_once.lines().collect();
    let headings =
        "task,camera.f_number,laser.line_thickness,expanded,terms.0.source,outcome,reason";
    assert_eq!(rows[0], headings);
    assert!(rows[3].starts_with("2,10,0.2 mm,0.0000"), "{at_once}");
    assert!(rows[3].ends_with(",speckle,done,"), "{at_once}");
    assert_eq!(rows.len(), 7, "{at_once}");

    let listed = run(folder.path(), "sweep grid.toml --list");
    let listed = text(&listed.stdout);
    let expected = "task,camera.f_number,laser.line_thickness\n0,5,0.2 mm\n1,5,0.3 mm\n";
    assert!(listed.starts_with(expected), "{listed}");
}

#[test]
fn a_changed_file_is_not_answered_by_rows_of_before() {
    let folder = written(GRID);
    assert_code(&run(folder.path(), "sweep grid.toml --task 0..5"), 0);
    let changed = SETUP.replace("power = \"10 mW\"", "power = \"9 mW\"");
    assert_ne!(changed, SETUP);
    fs::write(folder.path().join("setup.toml"), changed).expect("the set-up is written");
    let output = run(folder.path(), "sweep grid.toml --gather");
    assert_code(&output, 1);
    let told = message(&output);
    assert!(told.contains("6 of 6 tasks have no row"), "{told}");
    assert!(
        !folder.path().join("out/grid/sweep.csv").exists(),
        "no table"
    );
}

#[test]
fn combinations_without_a_result_say_why() {
    let changes = GRID.replace(
        "from = 5\nto = 20\nsteps = 3\nscale = \"log\"",
        "values = [1, -8, 8]",
    );
    let folder = written(&changes);
    assert_code(&run(folder.path(), "sweep grid.toml"), 0);
    let table = table(folder.path(), "out/grid");
    let row = |task: usize| table.lines().nth(task + 1).unwrap_or_default();
    assert!(
        row(0).contains(",,,nothing measured,no uncertainty: the line saturates"),
        "{table}"
    );
    assert!(row(2).contains(",,,refused,"), "{table}");
    assert!(row(4).ends_with(",done,"), "{table}");
}

#[test]
fn grids_that_cannot_be_are_refused_where_they_are_wrong() {
    for (from, to, part) in [
        (
            "camera.f_number",
            "camera.f_numbr",
            "did you mean `f_number`",
        ),
        (
            "command = \"budget\"",
            "command = \"budgt\"",
            "did you mean \"budget\"",
        ),
        ("\"expanded\"", "\"expnded\"", "has no \"expnded\""),
        ("setup.toml", "set_up.toml", "cannot read"),
        ("to = 20", "to = \"20 mm\"", "grid.toml:11:6"),
        ("steps = 3", "steps = 1", "from 2 to"),
        ("from = 5", "from = -5", "positive ends"),
        ("\"--trials\"", "\"--trails\"", "--trails"),
        ("[sweep]", "[swep]", "did you mean `sweep`"),
        ("[\"0.2 mm\", \"0.3 mm\"]", "[]", "a list of values"),
    ] {
        let folder = written(&GRID.replace(from, to));
        let output = run(folder.path(), "sweep grid.toml");
        assert_code(&output, 2);
        let told = message(&output);
        assert!(told.contains(part), "{to}: {told}");
    }
    let folder = written(GRID);
    let output = run(folder.path(), "sweep grid.toml --task 3..6");
    assert_code(&output, 2);
    assert!(
        message(&output).contains("is 5, got 6"),
        "{}",
        message(&output)
    );
}
