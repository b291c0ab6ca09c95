//! `tem00-inspect sweep`.

use std::{fs, path::Path, process::Stdio, thread::sleep, time::Duration};

use super::{assert_code, files, folder, message, run, tem00, text};

const SETUP: &str = include_str!("../../../../../examples/setups/data_sheet.toml");

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
    let deep = format!("camera{}", ".a".repeat(30_000));
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
        (
            "laser.line_thickness",
            "camera.f_number",
            "varies already, by \"camera.f_number\"",
        ),
        (
            "laser.line_thickness",
            "camera",
            "varies already, by \"camera.f_number\"",
        ),
        (
            "laser.line_thickness",
            " camera.f_number ",
            "grid.toml:16:7",
        ),
        ("laser.line_thickness", "camera.f_number=1", "a key alone"),
        ("laser.line_thickness", &deep, "at most 32 steps, got 30001"),
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

/// Runs a sweep, waits until it is at work on its first task, and returns it.
fn begun(folder: &Path, line: &str) -> std::process::Child {
    let mut command = tem00(folder, line);
    let child = command
        .stdout(Stdio::null())
        .spawn()
        .expect("the program starts");
    let lock = folder.join("out/rows/.tem00.000000.lock");
    while !lock.exists() && !folder.join("out/rows/000000.json").exists() {
        sleep(Duration::from_millis(5));
    }
    child
}

#[test]
fn of_two_sweeps_each_task_is_done_by_one() {
    let folder = written(&GRID.replace("\"--trials\", \"0\"", "\"--trials\", \"100\""));
    let path = folder.path();
    assert_code(&run(path, "sweep grid.toml -o ref"), 0);
    let mut first = begun(path, "sweep grid.toml -o out --task 0..1");
    let second = run(path, "sweep grid.toml -o out");
    assert_code(&second, 0);
    assert!(first.wait().expect("it ends").success());
    assert_eq!(table(path, "ref"), table(path, "out"));
    let mut killed = begun(path, "sweep grid.toml -o out --task 0");
    killed.kill().and_then(|()| killed.wait()).expect("killed");
    assert_code(&run(path, "sweep grid.toml -o out"), 0);
    assert_eq!(table(path, "ref"), table(path, "out"));
}

#[test]
fn only_values_that_are_refused_leave_a_row() {
    let folder = written(GRID);
    let path = folder.path();
    let rows = || files(&path.join("out/rows"));
    // What another process leaves or has: a folder that is taken, one through which nothing is written, a file that is
    // not there.
    let tasks = path.join("out/tasks");
    fs::create_dir_all(&tasks).expect("made");
    let taken = tasks.join("000001");
    fs::write(&taken, "").expect("written");
    let output = run(path, "sweep grid.toml -o out");
    assert_code(&output, 2);
    let told = message(&output);
    assert!(
        told.contains("task 1: cannot write into the folder"),
        "{told}"
    );
    assert_eq!(rows().len(), 5, "{:?}", rows());
    fs::remove_file(&taken).expect("removed");
    fs::create_dir(&taken).expect("made");
    let lock = fs::File::create(taken.join(".tem00.lock")).expect("made");
    lock.lock().expect("locked");
    let output = run(path, "sweep grid.toml -o out");
    assert_code(&output, 2);
    assert!(
        message(&output).contains("task 1: another tem00"),
        "{}",
        message(&output)
    );
    assert_eq!(rows().len(), 5, "{:?}", rows());
    drop(lock);
    fs::write(path.join("out/rows/.tem00-abcdef.part"), "half").expect("written");
    assert_code(&run(path, "sweep grid.toml -o out"), 0);
    assert_eq!(rows().len(), 6, "{:?}", rows());

    let included = format!("include = [\"laser.toml\"]\n{SETUP}");
    fs::write(path.join("setup.toml"), included).expect("written");
    let output = run(path, "sweep grid.toml -o new");
    assert_code(&output, 2);
    assert!(
        message(&output).contains("cannot be read"),
        "{}",
        message(&output)
    );
    assert_eq!(files(&path.join("new/rows")), [""; 0]);
}

#[cfg(unix)]
#[test]
fn a_sweep_reads_files_alone_and_writes_through_no_link() {
    use std::os::unix::fs::symlink;
    let folder = written(GRID);
    let path = folder.path();
    for file in ["/dev/zero", "pipe", "."] {
        // Whoever opens a pipe waits.
        let _ = std::process::Command::new("mkfifo")
            .arg(path.join("pipe"))
            .status();
        fs::write(path.join("bad.toml"), GRID.replace("setup.toml", file)).expect("written");
        let output = run(path, "sweep bad.toml");
        assert_code(&output, 2);
        assert!(
            message(&output).contains("cannot read"),
            "{}",
            message(&output)
        );
    }
    fs::create_dir_all(path.join("out/grid/rows")).expect("made");
    fs::rename(path.join("pipe"), path.join("out/grid/rows/000000.json")).expect("moved");
    assert_code(&run(path, "sweep grid.toml --gather"), 1);
    assert_code(&run(path, "sweep grid.toml"), 0);

    fs::create_dir(path.join("elsewhere")).expect("made");
    for link in ["rows", "tasks", "tasks/000000"] {
        let out = path.join(format!("{}_out", link.replace('/', "_")));
        fs::create_dir_all(out.join(link).parent().expect("a parent")).expect("made");
        symlink(path.join("elsewhere"), out.join(link)).expect("linked");
        let output = run(
            path,
            &format!("sweep grid.toml --task 0 -o {}", out.display()),
        );
        assert_code(&output, 2);
        assert!(
            message(&output).contains("is a link"),
            "{}",
            message(&output)
        );
    }
    assert_eq!(files(&path.join("elsewhere")), [""; 0]);
}

#[test]
fn names_and_values_are_no_options_and_do_nothing() {
    let grid = GRID.replace("setup.toml", "--help").replace(
        "\"0.2 mm\", \"0.3 mm\"",
        "\"0.2 mm\", \"\\u001b]0;own\\u0007\", \"=1+1\"",
    );
    let folder = written(&grid);
    fs::rename(
        folder.path().join("setup.toml"),
        folder.path().join("--help"),
    )
    .expect("renamed");
    assert_code(&run(folder.path(), "sweep grid.toml"), 0);
    let table = table(folder.path(), "out/grid");
    assert!(table.contains("\n2,5,'=1+1,"), "{table}");
    assert!(table.contains("\n1,5,\\u001b]0;own\\u0007,"), "{table}");
    assert!(table.contains("\n0,5,0.2 mm,0.0000"), "{table}");
}
