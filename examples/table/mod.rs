//! What the examples share: two columns of numbers from a CSV file.

use std::{error::Error, fs};

/// Reads the first two columns of a CSV file. Its first line may be a heading.
pub(crate) fn read(path: &str) -> Result<[Vec<f64>; 2], Box<dyn Error>> {
    let text = fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let mut columns = [Vec::new(), Vec::new()];
    for (index, line) in text.lines().enumerate() {
        if line.trim().is_empty() {
            continue;
        }
        match numbers(line) {
            Some(row) => {
                for (column, number) in columns.iter_mut().zip(row) {
                    column.push(number);
                }
            }
            None if index == 0 => (),
            None => {
                let place = format!("{path}:{}", index + 1);
                return Err(format!("{place}: two numbers are expected, got {line:?}").into());
            }
        }
    }
    Ok(columns)
}

fn numbers(line: &str) -> Option<[f64; 2]> {
    let mut cells = line.split([',', ';', '\t']).map(|cell| cell.trim().parse());
    Some([cells.next()?.ok()?, cells.next()?.ok()?])
}
