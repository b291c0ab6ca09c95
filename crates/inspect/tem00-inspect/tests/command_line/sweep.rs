//! `tem00-inspect sweep`.

use std::{fs, process::Stdio, thread::sleep, time::Duration};

use super::*;

const SHEET: &str = include_str!("../../../../../examples/setups/data_sheet.toml");

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

/// A folder with a grid `a.toml` and its set-up.
fn with_grid(grid: &str) -> tempfile::TempDir {
    let folder = written(grid);
    fs::write(folder.path().join("setup.toml"), SHEET).expect("the set-up is written");
    folder
}

fn table(folder: &Path, out: &str) -> String {
    read(&folder.join(out).join("sweep.csv"))
}

#[test]
fn a_table_is_the_same_however_its_tasks_are_shared() {
    let folder = with_grid(GRID);
    let path = folder.path();
    said(path, "sweep a.toml", 0);
    let at_once = table(path, "out/a");
    let parts = [
        "--task 4..5",
        "--task 0",
        "--threads 1 --task 1..3",
        "--task 0..5",
        "--gather",
    ];
    for part in parts {
        said(path, &format!("sweep a.toml -o parts {part}"), 0);
    }
    assert_eq!(at_once, table(path, "parts"));

    let rows: Vec<&str> = at_once.lines().collect();
    let keys = "task,camera.f_number,laser.line_thickness";
    assert_eq!(
        rows[0],
        format!("{keys},expanded,terms.0.source,outcome,reason")
    );
    assert!(rows[3].starts_with("2,10,0.2 mm,0.0000"), "{at_once}");
    assert!(rows[3].ends_with(",speckle,done,"), "{at_once}");
    assert_eq!(rows.len(), 7, "{at_once}");
    let result = |row: &str| row.split(',').nth(3).map(str::to_owned);
    assert_ne!(
        result(rows[1]),
        result(rows[2]),
        "every key is changed: {at_once}"
    );
    let listed = said(path, "sweep a.toml --list", 0).out;
    let expected = format!("{keys}\n0,5,0.2 mm\n1,5,0.3 mm\n");
    assert!(listed.starts_with(&expected), "{listed}");
}

#[test]
fn a_changed_file_is_not_answered_by_rows_of_before() {
    let folder = with_grid(GRID);
    said(folder.path(), "sweep a.toml --task 0..5", 0);
    let changed = replaced(SHEET, "power = \"10 mW\"", "power = \"9 mW\"");
    fs::write(folder.path().join("setup.toml"), changed).expect("the set-up is written");
    let told = said(folder.path(), "sweep a.toml --gather", 1).told;
    assert_has(&told, &["6 of 6 tasks have no row"]);
    assert!(!folder.path().join("out/a/sweep.csv").exists(), "no table");
}

#[test]
fn combinations_without_a_result_say_why() {
    let range = "from = 5\nto = 20\nsteps = 3\nscale = \"log\"";
    let folder = with_grid(&replaced(GRID, range, "values = [1, -8, 8]"));
    said(folder.path(), "sweep a.toml", 0);
    let table = table(folder.path(), "out/a");
    let row = |task: usize| table.lines().nth(task + 1).unwrap_or_default();
    let why = ",,,nothing measured,no uncertainty: the line saturates";
    assert_has(row(0), &[why]);
    assert_has(row(2), &[",,,refused,"]);
    assert!(row(4).ends_with(",done,"), "{table}");
}

#[test]
fn grids_that_cannot_be_are_refused_where_they_are_wrong() {
    for [from, to, part] in tem00_testkit::rows(
        r#"camera.f_number => camera.f_numbr => did you mean `f_number`
        command = "budget" => command = "budgt" => did you mean "budget"
        "expanded" => "expnded" => has no "expnded"
        setup.toml => set_up.toml => cannot read
        to = 20 => to = "20 mm" => a.toml:11:6
        steps = 3 => steps = 1 => from 2 to
        from = 5 => from = -5 => positive ends
        "--trials" => "--trails" => `options`: unexpected argument '--trails'
        [sweep] => [swep] => did you mean `sweep`
        ["0.2 mm", "0.3 mm"] => [] => a list of values
        laser.line_thickness => camera.f_number => varies already, by "camera.f_number"
        laser.line_thickness => camera => varies already, by "camera.f_number"
        "laser.line_thickness" => " camera.f_number " => a.toml:16:7
        laser.line_thickness => camera.f_number=1 => a key alone
        laser.line_thickness => DEEP => at most 32 steps, got 30001"#,
    ) {
        let to = to.replace("DEEP", &format!("camera{}", ".a".repeat(30_000)));
        let folder = with_grid(&replaced(GRID, &from, &to));
        assert_has(&said(folder.path(), "sweep a.toml", 2).told, &[&part]);
    }
    let folder = with_grid(GRID);
    let told = said(folder.path(), "sweep a.toml --task 3..6", 2).told;
    assert_has(&told, &["is 5, got 6"]);
}

/// Runs a sweep, waits until it is at work on its first task, and returns it.
fn begun(folder: &Path, line: &str) -> std::process::Child {
    let mut command = tem00(folder, line);
    let child = command.stdout(Stdio::null()).spawn();
    let rows = folder.join("out/rows");
    while !rows.join(".tem00.000000.lock").exists() && !rows.join("000000.json").exists() {
        sleep(Duration::from_millis(5));
    }
    child.expect("the program starts")
}

#[test]
fn of_two_sweeps_each_task_is_done_by_one() {
    let trials = replaced(GRID, "\"--trials\", \"0\"", "\"--trials\", \"20\"");
    let folder = with_grid(&replaced(&trials, "steps = 3", "steps = 2"));
    let path = folder.path();
    said(path, "sweep a.toml -o ref", 0);
    let mut first = begun(path, "sweep a.toml -o out --task 0..1");
    said(path, "sweep a.toml -o out", 0);
    assert!(first.wait().expect("it ends").success());
    assert_eq!(table(path, "ref"), table(path, "out"));
    let mut killed = begun(path, "sweep a.toml -o out --task 0");
    killed.kill().and_then(|()| killed.wait()).expect("killed");
    said(path, "sweep a.toml -o out", 0);
    assert_eq!(table(path, "ref"), table(path, "out"));
}

#[test]
fn only_values_that_are_refused_leave_a_row() {
    let folder = with_grid(GRID);
    let path = folder.path();
    let rows = || files(&path.join("out/rows")).len();
    // What another process leaves or has: a folder that is taken, one through which nothing is
    // written, a file that is not there.
    let taken = path.join("out/tasks/000001");
    fs::create_dir_all(path.join("out/tasks")).expect("made");
    fs::write(&taken, "").expect("written");
    let told = said(path, "sweep a.toml -o out", 2).told;
    assert_has(&told, &["task 1: cannot write into the folder"]);
    assert_eq!(rows(), 5);
    fs::remove_file(&taken).expect("removed");
    fs::create_dir(&taken).expect("made");
    let lock = fs::File::create(taken.join(".tem00.lock")).expect("made");
    lock.lock().expect("locked");
    let told = said(path, "sweep a.toml -o out", 2).told;
    assert_has(&told, &["task 1: another tem00"]);
    assert_eq!(rows(), 5);
    drop(lock);
    fs::write(path.join("out/rows/.tem00-abcdef.part"), "half").expect("written");
    said(path, "sweep a.toml -o out", 0);
    assert_eq!(rows(), 6);

    let included = format!("include = [\"laser.toml\"]\n{SHEET}");
    fs::write(path.join("setup.toml"), included).expect("written");
    let told = said(path, "sweep a.toml -o new", 2).told;
    assert_has(&told, &["cannot be read"]);
    assert_eq!(files(&path.join("new/rows")), [""; 0]);
}

#[cfg(unix)]
#[test]
fn a_sweep_reads_files_alone_and_writes_through_no_link() {
    use std::os::unix::fs::symlink;
    let folder = with_grid(GRID);
    let path = folder.path();
    let pipe = path.join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("a shell").success(), "whoever opens it waits");
    for file in ["/dev/zero", "pipe", "."] {
        fs::write(path.join("bad.toml"), replaced(GRID, "setup.toml", file)).expect("written");
        assert_has(&said(path, "sweep bad.toml", 2).told, &["cannot read"]);
    }
    fs::create_dir_all(path.join("out/a/rows")).expect("made");
    fs::rename(pipe, path.join("out/a/rows/000000.json")).expect("moved");
    said(path, "sweep a.toml --gather", 1);
    said(path, "sweep a.toml", 0);

    fs::create_dir(path.join("elsewhere")).expect("made");
    for link in ["rows", "tasks", "tasks/000000"] {
        let out = path.join(format!("{}_out", link.replace('/', "_")));
        fs::create_dir_all(out.join(link).parent().expect("a parent")).expect("made");
        symlink(path.join("elsewhere"), out.join(link)).expect("linked");
        let line = format!("sweep a.toml --task 0 -o {}", out.display());
        assert_has(&said(path, &line, 2).told, &["is a link"]);
    }
    assert_eq!(files(&path.join("elsewhere")), [""; 0]);
}

#[test]
fn names_and_values_are_no_options_and_do_nothing() {
    let values = "\"0.2 mm\", \"\\u001b]0;own\\u0007\", \"=1+1\"";
    let grid = replaced(GRID, "\"0.2 mm\", \"0.3 mm\"", values);
    let folder = with_grid(&replaced(&grid, "setup.toml", "--help"));
    let file = |name: &str| folder.path().join(name);
    fs::rename(file("setup.toml"), file("--help")).expect("renamed");
    said(folder.path(), "sweep a.toml", 0);
    let table = table(folder.path(), "out/a");
    let parts = [
        "\n2,5,'=1+1,",
        "\n1,5,\\u001b]0;own\\u0007,",
        "\n0,5,0.2 mm,0.0000",
    ];
    assert_has(&table, &parts);
}
