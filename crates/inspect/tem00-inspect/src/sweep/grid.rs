//! The grid file of a sweep.

use std::path::{Path, PathBuf};

use tem00_config::{
    Change, ConfigError, Document, FileAccess, Format, Problem, Section, Value, read_document,
};

const GRID: Format = Format {
    noun: "grid",
    keys: &["sweep"],
    uncertain: &[],
    help: HELP,
};
pub(super) const HELP: &str = "examples/setups/sweeps/lens_and_line.toml is a grid file";
const KEYS: &[&str] = &["command", "file", "options", "results", "vary"];
const VARY: &[&str] = &["key", "values", "from", "to", "steps", "scale"];

/// The maximum number of tasks of a sweep: rows are numbered by six digits.
const MAX_TASKS: usize = 1_000_000;

/// A command that can be swept over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Swept {
    Budget,
    Render,
    Triangulate,
}

impl Swept {
    const ALL: [Self; 3] = [Self::Budget, Self::Render, Self::Triangulate];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Budget => "budget",
            Self::Render => "render",
            Self::Triangulate => "triangulate",
        }
    }

    /// Returns the results that are kept if the grid does not name any.
    fn usual_results(self) -> Vec<String> {
        let results: &[&str] = match self {
            Self::Budget => &["combined", "expanded", "dominant"],
            Self::Render => &["frames.0.lasers.0.power_on_target"],
            Self::Triangulate => &["uncertainty.combined", "uncertainty.expanded"],
        };
        results.iter().map(|&path| path.to_owned()).collect()
    }
}

/// A sweep: a command, and what varies.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub(super) command: Swept,
    /// The scene or the set-up.
    pub(super) file: PathBuf,
    /// Options of the command, the same for all tasks.
    pub(super) options: Vec<String>,
    /// The paths of the results in the record of the command.
    pub(super) results: Vec<String>,
    pub(super) axes: Vec<Axis>,
}

/// The values of a key.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) key: String,
    /// Values as in a file, strings without quotation marks.
    pub(super) values: Vec<String>,
}

impl Grid {
    /// Reads a grid file.
    ///
    /// # Errors
    ///
    /// Returns an error, placed in the file, if it is not a grid.
    pub(super) fn read(path: &Path) -> Result<Self, ConfigError> {
        read_document(path, FileAccess::WithinFolder, GRID, |document| {
            Self::of(document)
        })
    }

    fn of(document: &Document<'_>) -> Result<Self, Problem> {
        let section = document
            .table("sweep", KEYS)?
            .ok_or_else(|| Problem::new("the grid needs a section [sweep]").with_help(HELP))?;
        let command = section.required("command", "\"budget\"")?;
        let command = command.one_of(&Swept::ALL.map(|command| (command.name(), command)))?;
        let file = section.required("file", "\"data_sheet.toml\"")?.string()?;
        let axes = section.tables("vary", VARY)?;
        check_keys(&axes)?;
        let axes: Vec<Axis> = axes.iter().map(axis).collect::<Result<_, _>>()?;
        let grid = Self {
            command,
            file: section.beside(file),
            options: section.or("options", Vec::new(), strings)?,
            results: section.or("results", command.usual_results(), strings)?,
            axes,
        };
        if grid.axes.is_empty() {
            let help = "for example `key = \"camera.f_number\"` and `values = [4, 8, 16]` below it";
            return Err(section
                .problem("[sweep] needs [[sweep.vary]]")
                .with_help(help));
        }
        match grid.checked_count() {
            Some(1..=MAX_TASKS) => Ok(grid),
            _ => Err(section.problem(format_args!("a grid has at most {MAX_TASKS} tasks"))),
        }
    }

    fn checked_count(&self) -> Option<usize> {
        let lengths = self.axes.iter().map(|axis| axis.values.len());
        lengths.into_iter().try_fold(1, usize::checked_mul)
    }

    /// Returns the number of tasks.
    pub(super) fn count(&self) -> usize {
        self.checked_count().unwrap_or(MAX_TASKS)
    }

    /// Returns the values of a task, in the order of the axes; the last one varies fastest.
    pub(super) fn values(&self, task: usize) -> Vec<&str> {
        let mut rest = task;
        let mut values: Vec<&str> = Vec::new();
        for axis in self.axes.iter().rev() {
            values.push(&axis.values[rest % axis.values.len()]);
            rest /= axis.values.len();
        }
        values.reverse();
        values
    }
}

fn strings(value: &Value<'_>) -> Result<Vec<String>, Problem> {
    let values = value.list("a list of strings")?;
    let strings = values.iter().map(|value| value.string().map(str::to_owned));
    strings.collect()
}

fn axis(section: &Section<'_>) -> Result<Axis, Problem> {
    let key = section.required("key", "\"camera.f_number\"")?;
    let key = key.string()?.to_owned();
    let values = match section.optional("values") {
        Some(values) => listed(&values)?,
        None => between(section)?,
    };
    Ok(Axis { key, values })
}

/// Checks that keys can be changed, and that no two change the same value.
fn check_keys(axes: &[Section<'_>]) -> Result<(), Problem> {
    let mut changes: Vec<Change> = Vec::new();
    for section in axes {
        let key = section.required("key", "\"camera.f_number\"")?;
        let name = key.string()?;
        let refused = |why: &str| key.problem(format_args!("`key`: {why}, got \"{name}\""));
        if name.contains('=') {
            return Err(refused("must be a key alone, such as camera.f_number"));
        }
        let change: Change = format!("{name}=0")
            .parse()
            .map_err(|why: String| refused(&why))?;
        if let Some(other) = changes.iter().find(|other| other.overlaps(&change)) {
            let other = other.to_string();
            let other = other.trim_end_matches("=0");
            return Err(refused(&format!("varies already, by \"{other}\"")));
        }
        changes.push(change);
    }
    Ok(())
}

const LIST: &str = "a list of values, such as [4, 8, 16]";

fn listed(values: &Value<'_>) -> Result<Vec<String>, Problem> {
    let listed: Vec<String> = values.list(LIST)?.iter().map(Value::text).collect();
    if listed.is_empty() {
        return Err(values.must_be(LIST));
    }
    Ok(listed)
}

/// The values of a range, whose ends have the same unit.
fn between(section: &Section<'_>) -> Result<Vec<String>, Problem> {
    let end = |key, example| {
        let value = section.required(key, example)?;
        let text = value.text();
        let number = text.trim_end_matches(|c: char| !c.is_ascii_digit() && c != '.');
        let unit = text[number.len()..].trim().to_owned();
        match number.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok((number, unit, value)),
            _ => Err(value.must_be("a number, with a unit or without")),
        }
    };
    let (from, unit, _) = end("from", "4")?;
    let (to, other, value) = end("to", "16")?;
    if unit != other {
        return Err(value.must_be(format_args!("in the unit of `from`, \"{unit}\"")));
    }
    let steps = section.required("steps", "5")?.integer(2..=10_000)?;
    let scales = [("linear", false), ("log", true)];
    let log = section.or("scale", false, |value| value.one_of(&scales))?;
    if log && !(from > 0.0 && to > 0.0) {
        return Err(section.problem_with("scale", "a scale \"log\" needs positive ends"));
    }
    Ok((0..steps)
        .map(|step| {
            let part = step as f64 / (steps - 1) as f64;
            let number = if log {
                from * (to / from).powf(part)
            } else {
                from + (to - from) * part
            };
            format!("{} {unit}", rounded(number)).trim_end().to_owned()
        })
        .collect())
}

/// Rounds to ten digits, so that 0.1 + 0.2 reads 0.3.
fn rounded(number: f64) -> f64 {
    format!("{number:.9e}").parse().unwrap_or(number)
}
