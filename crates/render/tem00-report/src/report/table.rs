//! Tables of a report.

use super::cell::Cell;

/// A table: one description for columns on a terminal, an array of objects in JSON and a table on a
/// page.
#[derive(Clone, Debug)]
pub struct Table {
    pub(super) key: Option<&'static str>,
    pub(super) caption: String,
    pub(super) columns: Vec<Column>,
    pub(super) rows: Vec<Vec<Cell>>,
    /// The rows that sum up the rows above, which only people see.
    pub(super) totals: Vec<Vec<Cell>>,
}

/// A column: its key for programs, and its heading, with the unit, for people.
#[derive(Clone, Debug)]
pub struct Column {
    pub(super) key: Option<String>,
    pub(super) heading: Option<String>,
}

impl Column {
    /// A column with its key and its heading.
    pub fn new(key: impl Into<String>, heading: impl Into<String>) -> Self {
        Self {
            key: Some(key.into()),
            heading: Some(heading.into()),
        }
    }

    /// A column that only programs get.
    pub fn data(key: impl Into<String>) -> Self {
        Self {
            key: Some(key.into()),
            heading: None,
        }
    }

    /// A column that only people get.
    pub fn shown(heading: impl Into<String>) -> Self {
        Self {
            key: None,
            heading: Some(heading.into()),
        }
    }
}

impl Table {
    /// Starts a table with its caption and its columns.
    pub fn new(caption: impl Into<String>, columns: impl Into<Vec<Column>>) -> Self {
        Self {
            key: None,
            caption: caption.into(),
            columns: columns.into(),
            rows: Vec::new(),
            totals: Vec::new(),
        }
    }

    /// Gives the key of the array of rows; without one, JSON leaves the rows out.
    pub const fn under(mut self, key: &'static str) -> Self {
        self.key = Some(key);
        self
    }

    /// Adds a row. Missing cells stay empty, surplus cells are left out.
    pub fn row(&mut self, cells: impl Into<Vec<Cell>>) {
        self.rows.push(cells.into());
    }

    /// Adds a row that sums up the rows above, for people alone: in JSON, sums have their own keys.
    pub fn total(&mut self, cells: impl Into<Vec<Cell>>) {
        self.totals.push(cells.into());
    }

    /// Returns the headings of the columns that people see.
    pub(super) fn headings(&self) -> Vec<&str> {
        let columns = self.columns.iter();
        columns
            .filter_map(|column| column.heading.as_deref())
            .collect()
    }

    /// Returns the texts of a row that people see.
    pub(super) fn texts<'a>(&'a self, row: &'a [Cell]) -> impl Iterator<Item = &'a str> {
        let columns = self.columns.iter().enumerate();
        let shown = columns.filter(|(_, column)| column.heading.is_some());
        shown.map(|(index, _)| row.get(index).map_or("", Cell::text))
    }

    /// Returns all rows, the totals last.
    pub(super) fn all_rows(&self) -> impl Iterator<Item = &[Cell]> {
        self.rows.iter().chain(&self.totals).map(|row| &**row)
    }
}
