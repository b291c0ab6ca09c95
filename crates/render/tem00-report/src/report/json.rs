//! Reports as JSON.

use std::{io::Write as _, path::Path};

use serde_json::{Map, Value};

use super::{Block, Report, Section, Table, cell::Cell};
use crate::{failure::Failure, output};

impl Report {
    /// Returns the report as JSON.
    pub fn json(&self) -> String {
        format!("{:#}", Value::Object(self.values()))
    }

    /// Writes the report as JSON.
    ///
    /// # Errors
    ///
    /// Returns a failure if the file cannot be written.
    pub fn save_json(&self, path: &Path) -> Result<(), Failure> {
        output::save(path, |file| writeln!(file, "{}", self.json()))
    }

    fn values(&self) -> Map<String, Value> {
        let mut map = self.data.clone();
        for section in &self.sections {
            let values = section.values();
            match section.key {
                Some(key) => drop(map.insert(key.to_owned(), values.into())),
                None => map.extend(values),
            }
        }
        for (key, lines) in [
            ("verdicts", &self.verdicts),
            ("warnings", &self.warnings),
            ("notes", &self.notes),
        ] {
            map.insert(key.to_owned(), lines.clone().into());
        }
        map
    }
}

impl Section {
    fn values(&self) -> Map<String, Value> {
        let mut map = Map::new();
        for block in &self.blocks {
            match block {
                Block::Fact(key, _, cell) => {
                    map.insert((*key).to_owned(), cell.data.clone());
                }
                Block::Data(key, value) => {
                    map.insert(key.clone(), value.clone());
                }
                Block::Table(table) => {
                    let rows = table.rows.iter().map(|row| table.object(row)).collect();
                    let key = table.key.map(str::to_owned);
                    map.extend(key.map(|key| (key, rows)));
                }
                Block::Paragraph(_)
                | Block::Drawing { .. }
                | Block::Picture { .. }
                | Block::File(..) => (),
            }
        }
        map
    }
}

impl Table {
    fn object(&self, row: &[Cell]) -> Value {
        let columns = self.columns.iter().zip(row);
        let values = columns.filter_map(|(column, cell)| {
            let key = column.key.clone()?;
            Some((key, cell.data.clone()))
        });
        Value::Object(values.collect())
    }
}
