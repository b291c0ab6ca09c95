//! Common to the examples: two columns of numbers from a CSV file.

use std::{fmt, fs};

/// Failure of an example. Returned from `main`, it is printed as a sentence and not as a value.
pub(crate) struct Failure(String);

impl<E: fmt::Display> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

impl fmt::Debug for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Reads the first two columns of a CSV file.
pub(crate) fn read(path: &str) -> Result<[Vec<f64>; 2], Failure> {
    let text = fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    parse(&text).map_err(|error| format!("{path}:{error}").into())
}

/// Returns the first two columns of a table, or the line of it that is none.
///
/// Cells are separated by semicolons, tabs or commas; beside the first two, a comma is a decimal
/// comma. The first line may be a heading; empty lines and those that begin with # do not count.
pub(crate) fn parse(text: &str) -> Result<[Vec<f64>; 2], String> {
    let mut columns = [Vec::new(), Vec::new()];
    // Some spreadsheets begin a file with a byte order mark.
    let text = text.trim_start_matches('\u{feff}');
    for (index, line) in text.lines().enumerate() {
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        match numbers(line) {
            Some(row) => {
                for (column, number) in columns.iter_mut().zip(row) {
                    column.push(number);
                }
            }
            None if index == 0 && is_heading(line) => (),
            None => {
                let line_number = index + 1;
                return Err(format!(
                    "{line_number}: two finite numbers are expected, got {line:?}"
                ));
            }
        }
    }
    Ok(columns)
}

/// Returns the smallest and the largest of the values.
pub(crate) fn range(values: &[f64]) -> [f64; 2] {
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    let wider = |[low, high]: [f64; 2], &x: &f64| [low.min(x), high.max(x)];
    values.iter().fold(ends, wider)
}

fn numbers(line: &str) -> Option<[f64; 2]> {
    let mut cells = cells(line).map(|cell| cell.parse().ok().filter(|x: &f64| x.is_finite()));
    Some([cells.next()??, cells.next()??])
}

fn is_heading(line: &str) -> bool {
    cells(line).all(|cell| cell.parse::<f64>().is_err())
}

fn cells(line: &str) -> impl Iterator<Item = String> {
    let separators: &[char] = if line.contains([';', '\t']) {
        &[';', '\t']
    } else {
        &[',']
    };
    let cells = line.split(separators);
    cells.map(|cell| cell.trim().replace(',', "."))
}
