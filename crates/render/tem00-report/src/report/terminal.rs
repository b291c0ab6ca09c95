//! Reports on a terminal.

use std::{
    io::{self, Write},
    path::PathBuf,
};

use super::{Block, Report, Section, Table};
use crate::{failure::Failure, output::note};

impl Report {
    /// Prints the report: as JSON on request, or for people with the names of its files, and the
    /// reasons for doubt on standard error.
    ///
    /// # Errors
    ///
    /// Returns a failure if standard output cannot be written.
    pub fn print(
        &self,
        as_json: bool,
        files: &[PathBuf],
        out: &mut impl Write,
    ) -> Result<(), Failure> {
        let printed = if as_json {
            writeln!(out, "{}", self.json())
        } else {
            self.print_warnings();
            self.write_text(files, out)
        };
        printed.map_err(|error| Failure::stdout(&error))
    }

    /// Writes the verdicts to standard error, for commands that print only the names of files.
    pub fn tell_verdicts(&self) {
        self.verdicts.iter().for_each(|line| note(line));
    }

    /// Prints warnings and notes; of many, only the first few.
    fn print_warnings(&self) {
        const TOLD: usize = 8;
        for (kind, lines) in [("warning", &self.warnings), ("note", &self.notes)] {
            for line in lines.iter().take(TOLD) {
                note(&format!("{kind}: {line}"));
            }
            if lines.len() > TOLD {
                note(&format!(
                    "{kind}: and {} more of this kind",
                    lines.len() - TOLD
                ));
            }
        }
    }

    fn write_text(&self, files: &[PathBuf], out: &mut impl Write) -> io::Result<()> {
        let mut is_first = true;
        for section in self.sections.iter().rev().filter(|s| !s.in_detail) {
            section.write_text(&mut is_first, out)?;
        }
        separate(&mut is_first, !self.verdicts.is_empty(), out)?;
        for line in &self.verdicts {
            writeln!(out, "{line}")?;
        }
        separate(&mut is_first, !files.is_empty(), out)?;
        let mut files = files.iter();
        files.try_for_each(|path| writeln!(out, "{}", path.display()))
    }
}

/// Writes an empty line between pieces.
fn separate(is_first: &mut bool, there_is_more: bool, out: &mut impl Write) -> io::Result<()> {
    if !there_is_more || core::mem::take(is_first) {
        return Ok(());
    }
    writeln!(out)
}

impl Section {
    fn write_text(&self, is_first: &mut bool, out: &mut impl Write) -> io::Result<()> {
        let facts = self.blocks.iter().filter_map(|block| match block {
            Block::Fact(_, name, value) => Some((name, value)),
            _ => None,
        });
        separate(is_first, facts.clone().next().is_some(), out)?;
        for (name, value) in facts {
            writeln!(out, "{name}: {}", value.text)?;
        }
        for block in &self.blocks {
            if let Block::Table(table) = block {
                separate(is_first, true, out)?;
                table.write_text(out)?;
            }
        }
        Ok(())
    }
}

impl Table {
    /// Writes the table as columns, two spaces apart, under a line of headings.
    pub fn write_text(&self, out: &mut impl Write) -> io::Result<()> {
        let rows = self.all_rows().map(|row| self.texts(row).collect());
        let lines: Vec<Vec<&str>> = core::iter::once(self.headings()).chain(rows).collect();
        let width = |column: usize| {
            let cells = lines.iter().map(|line| line[column].chars().count());
            cells.max().unwrap_or(0)
        };
        let widths: Vec<_> = (0..lines[0].len()).map(width).collect();
        for line in lines {
            let cells = line.iter().zip(&widths);
            let padded: Vec<_> = cells
                .map(|(cell, &width)| format!("{cell:width$}"))
                .collect();
            writeln!(out, "{}", padded.join("  ").trim_end())?;
        }
        Ok(())
    }
}
