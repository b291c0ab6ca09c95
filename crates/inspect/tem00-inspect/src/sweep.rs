//! `tem00-inspect sweep`: a command over all combinations of some values, a row for each.

mod command;
mod grid;
mod row;
mod task;

use std::{io::Write, ops::RangeInclusive, thread::sleep, time::Duration};

use tem00_report::{
    failure::Failure,
    interrupt,
    kind::{Kind, wrong_or},
    output,
    progress::Progress,
};

use self::{
    grid::{Grid, HELP},
    row::{Outcome, TaskRow, cell, quoted},
    task::{Sweep, Worked},
};
use crate::args::SweepArgs;

/// The time after which the tasks of other processes are checked again.
const PAUSE: Duration = Duration::from_millis(200);

/// Lists the tasks, runs some of them, or makes the table of their rows.
///
/// # Errors
///
/// Returns a failure if the grid is not valid, if a task fails for another reason than its values,
/// if a file cannot be written, if the user interrupts it, if rows are missing for the table, or if
/// all tasks are refused.
pub(crate) fn run(args: &SweepArgs, out: &mut impl Write) -> Result<(), Failure> {
    let grid = Grid::read(&args.grid).map_err(|error| {
        wrong_or(&args.grid, Kind::Grid, || {
            Failure::file(&args.grid, &error, HELP)
        })
    })?;
    if args.list {
        return list(&grid, out).map_err(|error| Failure::stdout(&error));
    }
    let name = output::name(&args.grid, "sweep");
    let folder = output::folder(args.output.as_deref(), &name);
    let sweep = Sweep::new((&grid, &folder), output::bounded(args.threads))?;
    if !args.gather {
        do_tasks(&sweep, tasks(args, &grid)?)?;
    }
    if args.tasks.is_some() {
        return Ok(());
    }
    gather(&sweep, out)
}

/// Returns the requested tasks.
fn tasks(args: &SweepArgs, grid: &Grid) -> Result<RangeInclusive<usize>, Failure> {
    let last = grid.count() - 1;
    let Some(asked) = args.tasks else {
        return Ok(0..=last);
    };
    match (usize::try_from(asked.first), usize::try_from(asked.last)) {
        (Ok(first), Ok(end)) if end <= last => Ok(first..=end),
        _ => Err(Failure::input(
            format!(
                "--task: the last task of the grid is {last}, got {}",
                asked.last
            ),
            "tasks are counted from 0; --list shows them",
        )),
    }
}

/// Runs the tasks that have no row yet, and waits for the tasks that another process runs.
///
/// # Errors
///
/// Returns the first failure that is not an outcome of a task. If a task lacks something that it
/// needs, the other tasks are run first.
fn do_tasks(sweep: &Sweep<'_>, tasks: RangeInclusive<usize>) -> Result<(), Failure> {
    let progress = Progress::of(tasks.clone().count() as u64, "tasks");
    // The output of the commands is in their files.
    output::set_quiet();
    let (mut left, mut without_row): (Vec<usize>, _) = (tasks.collect(), None);
    while !left.is_empty() {
        let mut busy = Vec::new();
        for &task in &left {
            interrupt::check()?;
            progress.name(format!("task {task}"));
            match sweep.run(task) {
                Ok(Worked::Done) => progress.advance(1),
                Ok(Worked::ByAnother) => busy.push(task),
                Err(failure @ Failure::Unavailable(_)) => {
                    progress.advance(1);
                    without_row.get_or_insert(failure.about(format_args!("task {task}")));
                }
                Err(failure) => return Err(failure),
            }
        }
        if busy.len() == left.len() {
            progress.name(format!("task {}, which another tem00 does", busy[0]));
            sleep(PAUSE);
        }
        left = busy;
    }
    without_row.map_or(Ok(()), Err)
}

/// Prints the tasks and their values.
fn list(grid: &Grid, out: &mut impl Write) -> std::io::Result<()> {
    writeln!(out, "{}", line("task", keys(grid)))?;
    (0..grid.count()).try_for_each(|task| {
        let values = grid.values(task).into_iter().map(quoted);
        writeln!(out, "{}", line(&task.to_string(), values))
    })
}

fn keys(grid: &Grid) -> impl Iterator<Item = String> {
    grid.axes.iter().map(|axis| quoted(&axis.key))
}

fn line(first: &str, cells: impl Iterator<Item = String>) -> String {
    cells.fold(first.to_owned(), |line, cell| format!("{line},{cell}"))
}

/// Writes the table of all rows.
fn gather(sweep: &Sweep<'_>, out: &mut impl Write) -> Result<(), Failure> {
    let grid = sweep.grid;
    let rows: Vec<Option<TaskRow>> = (0..grid.count()).map(|task| sweep.find(task)).collect();
    let missing: Vec<usize> = (0..rows.len())
        .filter(|&task| rows[task].is_none())
        .collect();
    if let [first, ..] = missing[..] {
        let message = format!(
            "{} of {} tasks have no row; the first is {first}",
            missing.len(),
            rows.len()
        );
        return Err(Failure::running(message));
    }
    let rows: Vec<TaskRow> = rows.into_iter().flatten().collect();
    let path = sweep.folder.join("sweep.csv");
    output::save(&path, |file| write_table(grid, &rows, file))?;
    let count = |outcome| rows.iter().filter(|row| row.outcome == outcome).count();
    let (done, refused) = (count(Outcome::Done), count(Outcome::Refused));
    writeln!(
        out,
        "{} tasks: {done} done, {} measured nothing, {refused} refused.\n{}",
        rows.len(),
        count(Outcome::NothingMeasured),
        path.display()
    )
    .map_err(|error| Failure::stdout(&error))?;
    match rows.first().and_then(|row| row.reason.as_deref()) {
        Some(reason) if refused == rows.len() => Err(Failure::input(
            format!("every task was refused; the first: {reason}"),
            "the values of the grid are those of the file's keys",
        )),
        _ => Ok(()),
    }
}

fn write_table(grid: &Grid, rows: &[TaskRow], file: &mut impl Write) -> std::io::Result<()> {
    let headings = keys(grid).chain(grid.results.iter().map(|result| quoted(result)));
    let ends = ["outcome", "reason"].map(str::to_owned);
    writeln!(file, "{}", line("task", headings.chain(ends)))?;
    rows.iter().try_for_each(|row| {
        let values = grid.values(row.task).into_iter().map(quoted);
        let results = row.results.iter().map(cell);
        let reason = row.reason.as_deref().unwrap_or_default();
        let ends = [row.outcome.name().to_owned(), quoted(reason)];
        let cells = values.chain(results).chain(ends);
        writeln!(file, "{}", line(&row.task.to_string(), cells))
    })
}
