//! One task of a sweep.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

use clap::Parser;
use serde_json::Value;

use super::{
    grid::{Grid, Swept},
    row::{Outcome, Row, result_at},
};
use crate::{
    args::{Cli, Command},
    failure::Failure,
    output,
};

/// What does a command, as the program does.
pub(super) type RunCommand = fn(&Command, &mut dyn Write) -> Result<(), Failure>;

/// A sweep with the folder of its results.
pub(super) struct Sweep<'a> {
    pub(super) grid: &'a Grid,
    pub(super) folder: &'a Path,
    /// The text of the scene or the set-up.
    text: String,
    threads: Option<u16>,
    run_command: RunCommand,
}

impl<'a> Sweep<'a> {
    /// Reads the file that the grid names.
    pub(super) fn new(
        (grid, folder): (&'a Grid, &'a Path),
        threads: Option<u16>,
        run_command: RunCommand,
    ) -> Result<Self, Failure> {
        let text = fs::read_to_string(&grid.file).map_err(|error| {
            let message = format!("cannot read {}: {error}", grid.file.display());
            Failure::input(message, "the key `file` of the grid is relative to it")
        })?;
        Ok(Self {
            grid,
            folder,
            text,
            threads,
            run_command,
        })
    }

    /// Returns the row of a task, if it is there.
    pub(super) fn find(&self, task: usize) -> Option<Row> {
        Row::find(&self.row_path(task), &self.fingerprint(task))
    }

    /// Does a task and leaves its row.
    ///
    /// # Errors
    ///
    /// Returns the failures of the command but those that are an outcome; none leaves a row.
    pub(super) fn run(&self, task: usize) -> Result<Row, Failure> {
        let (outcome, reason) = match self.command(task) {
            Ok(()) => (Outcome::Done, None),
            Err(failure @ Failure::NoResult(_)) => (Outcome::NothingMeasured, Some(failure)),
            Err(failure @ Failure::Input(_)) => (Outcome::Refused, Some(failure)),
            Err(failure) => return Err(failure),
        };
        let row = Row {
            task,
            fingerprint: self.fingerprint(task),
            outcome,
            reason: reason.map(|failure| self.reason(&failure)),
            results: self.results(task, outcome)?,
        };
        row.write(&self.row_path(task))?;
        Ok(row)
    }

    fn command(&self, task: usize) -> Result<(), Failure> {
        let mut line = vec!["tem00".to_owned(), self.grid.command.name().to_owned()];
        line.push(self.grid.file.display().to_string());
        line.extend(self.grid.options.iter().cloned());
        for change in self.changes(task) {
            line.extend(["--set".to_owned(), change]);
        }
        line.extend(["-o".to_owned(), self.task_path(task).display().to_string()]);
        if let Some(threads) = self.threads {
            line.extend(["--threads".to_owned(), threads.to_string()]);
        }
        let cli = Cli::try_parse_from(line).map_err(|error| {
            let text = error.to_string();
            let message = text.trim_start_matches("error: ").replace('\n', " ");
            Failure::input(message, "the grid names the options and the keys")
        })?;
        (self.run_command)(&cli.command, &mut io::sink())
    }

    /// What a failure says, without the path of the file, which may differ from machine to machine.
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
        let path = self.task_path(task).join(self.record_name());
        let record = match (outcome, fs::read(&path)) {
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

    /// A number that changes with the program, the command, the file, options, values and results.
    fn fingerprint(&self, task: usize) -> String {
        let grid = self.grid;
        let inputs = (
            env!("CARGO_PKG_VERSION"),
            (grid.command.name(), &self.text, &grid.options),
            (self.changes(task), &grid.results),
        );
        format!("{:x}", md5::compute(format!("{inputs:?}")))
    }

    fn row_path(&self, task: usize) -> PathBuf {
        self.folder.join(format!("rows/{task:06}.json"))
    }

    fn task_path(&self, task: usize) -> PathBuf {
        self.folder.join(format!("tasks/{task:06}"))
    }
}
