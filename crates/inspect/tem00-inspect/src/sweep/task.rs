//! Tasks of a sweep.

use std::path::{Path, PathBuf};

use serde_json::Value;
use tem00_config::{Change, MAX_TEXT_BYTES, read_input};
use tem00_report::{
    failure::Failure,
    folder_lock::{FolderLock, Refused},
    output,
};

use super::{
    command::{HELP, SweptCommand},
    grid::{Grid, Swept},
    row::{Outcome, TaskRow, result_at},
};

/// A sweep with the folder of its results.
pub(super) struct Sweep<'a> {
    pub(super) grid: &'a Grid,
    pub(super) folder: &'a Path,
    command: SweptCommand,
    rows: PathBuf,
    tasks: PathBuf,
    /// A number that changes with all inputs that the tasks have in common.
    fingerprint: String,
    threads: Option<u16>,
}

/// Outcome of a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Worked {
    /// The task has a row.
    Done,
    /// Another process is running it.
    ByAnother,
}

impl<'a> Sweep<'a> {
    /// Reads the file that the grid names, and makes the folder of the rows.
    pub(super) fn new(
        (grid, folder): (&'a Grid, &'a Path),
        threads: Option<u16>,
    ) -> Result<Self, Failure> {
        let text = read_input(&grid.file, MAX_TEXT_BYTES).map_err(|error| {
            let message = format!("cannot read {}: {error}", grid.file.display());
            Failure::unavailable(message, "the key `file` of the grid is relative to it")
        })?;
        let version = env!("CARGO_PKG_VERSION");
        let common = (
            version,
            grid.command.name(),
            text,
            &grid.options,
            &grid.results,
        );
        Ok(Self {
            grid,
            folder,
            command: SweptCommand::of(grid)?,
            rows: output::subfolder(folder, "rows")?,
            tasks: output::subfolder(folder, "tasks")?,
            fingerprint: format!("{:x}", md5::compute(format!("{common:?}"))),
            threads,
        })
    }

    /// Returns the row of a task, if it is there.
    pub(super) fn find(&self, task: usize) -> Option<TaskRow> {
        TaskRow::find(&self.row_path(task), &self.fingerprint(task))
    }

    /// Runs a task that has no row, and writes the row.
    ///
    /// # Errors
    ///
    /// Returns the failures of the command except those that are an outcome; a task that fails with
    /// one leaves no row.
    pub(super) fn run(&self, task: usize) -> Result<Worked, Failure> {
        if self.find(task).is_some() {
            return Ok(Worked::Done);
        }
        let lock = FolderLock::by_file(self.rows.join(format!(".tem00.{task:06}.lock")));
        let _lock = match lock {
            Ok(lock) => lock,
            Err(Refused::InUse(_)) => return Ok(Worked::ByAnother),
            Err(Refused::Io(error)) => return Err(output::not_writable(&self.rows, &error)),
        };
        // Another process may have written its row while nobody had the lock.
        if self.find(task).is_none() {
            self.work(task)?;
        }
        Ok(Worked::Done)
    }

    fn work(&self, task: usize) -> Result<(), Failure> {
        let (outcome, reason) = match self.execute(task) {
            Ok(()) => (Outcome::Done, None),
            Err(failure @ Failure::NoResult(_)) => (Outcome::NothingMeasured, Some(failure)),
            Err(failure @ Failure::Input(_)) => (Outcome::Refused, Some(failure)),
            Err(failure) => return Err(failure),
        };
        let row = TaskRow {
            task,
            fingerprint: self.fingerprint(task),
            outcome,
            reason: reason.map(|failure| self.reason(&failure)),
            results: self.results(task, outcome)?,
        };
        row.write(&self.row_path(task))
    }

    /// Executes the command of a task.
    fn execute(&self, task: usize) -> Result<(), Failure> {
        let folder = output::subfolder(&self.tasks, &format!("{task:06}"))?;
        let change = |text: &String| {
            let refused = |why| Failure::input(format!("{text}: {why}"), HELP);
            text.parse().map_err(refused)
        };
        let changes: Vec<Change> = self
            .changes(task)
            .iter()
            .map(change)
            .collect::<Result<_, _>>()?;
        self.command.run(&changes, folder, self.threads)
    }

    /// Returns the message of a failure without the path of the file, which may differ between
    /// machines.
    fn reason(&self, failure: &Failure) -> String {
        let path = format!("{}: ", self.grid.file.display());
        let message = failure.message();
        message.strip_prefix(&path).unwrap_or(message).to_owned()
    }

    /// The values of a task as changes of the file.
    fn changes(&self, task: usize) -> Vec<String> {
        let values = self.grid.values(task).into_iter();
        let keys = self.grid.axes.iter().map(|axis| &axis.key);
        keys.zip(values)
            .map(|(key, value)| format!("{key}={value}"))
            .collect()
    }

    fn results(&self, task: usize, outcome: Outcome) -> Result<Vec<Value>, Failure> {
        let results = &self.grid.results;
        let path = self
            .tasks
            .join(format!("{task:06}"))
            .join(self.record_name());
        let record = match (outcome, read_input(&path, MAX_TEXT_BYTES)) {
            (Outcome::Refused, _) => return Ok(vec![Value::Null; results.len()]),
            (_, Ok(bytes)) => serde_json::from_slice(&bytes).unwrap_or_default(),
            (_, Err(error)) => {
                let message = format!("cannot read {}: {error}", path.display());
                return Err(Failure::running(message));
            }
        };
        let found = results
            .iter()
            .map(|result| match result_at(&record, result) {
                Ok(value) => Ok(value.clone()),
                Err(_) if outcome == Outcome::NothingMeasured => Ok(Value::Null),
                Err(keys) => Err(Failure::input(
                    format!("`results`: {} has no \"{result}\"", path.display()),
                    format!("it has {keys}"),
                )),
            });
        found.collect()
    }

    /// The name of the file in which the command leaves its numbers.
    fn record_name(&self) -> String {
        match self.grid.command {
            Swept::Budget => "budget.json".to_owned(),
            Swept::Render => format!("{}.json", output::name(&self.grid.file, "scene")),
            Swept::Triangulate => "measurement.json".to_owned(),
        }
    }

    /// A number that changes with the inputs of a task.
    fn fingerprint(&self, task: usize) -> String {
        let inputs = (&self.fingerprint, self.changes(task));
        format!("{:x}", md5::compute(format!("{inputs:?}")))
    }

    fn row_path(&self, task: usize) -> PathBuf {
        self.rows.join(format!("{task:06}.json"))
    }
}
