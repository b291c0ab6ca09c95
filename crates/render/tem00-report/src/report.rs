//! Reports: the results of a command as one value, shown on a terminal, as JSON and as a page.

mod cell;
mod cloud;
mod escape;
mod html;
mod json;
mod style;
mod table;
mod terminal;
pub mod units;

use serde::Serialize;
use serde_json::{Map, Value};

pub use self::{
    cell::Cell,
    table::{Column, Table},
    units::Unit,
};
pub use self::{
    cloud::Cloud,
    escape::{escaped, is_unwanted},
};

/// The results of a command.
///
/// Each number is stated once, with its key, its name and its unit:
///
/// - a terminal shows the sections that are not [details](Section::in_detail), the first one last,
///   and then the verdicts, so that what matters stands above the prompt;
/// - JSON has every quantity and table under its key, in SI units, and `null` where nothing is
///   known;
/// - a page shows the verdicts, then the sections with their drawings, in one file that opens
///   offline.
///
/// Every text appears exactly as it was given. The same calls give the same bytes.
#[derive(Clone, Debug)]
pub struct Report {
    title: String,
    /// Values for programs, in addition to the sections.
    data: Map<String, Value>,
    verdicts: Vec<String>,
    warnings: Vec<String>,
    notes: Vec<String>,
    sections: Vec<Section>,
}

/// A part of a report under one heading.
#[derive(Clone, Debug)]
pub struct Section {
    heading: String,
    /// The key of the object that holds its quantities; `None` for quantities of the report itself.
    key: Option<&'static str>,
    in_detail: bool,
    blocks: Vec<Block>,
}

/// A piece of a section.
#[derive(Clone, Debug)]
enum Block {
    /// A quantity with its key and its name.
    Fact(&'static str, String, Cell),
    /// A value for programs alone.
    Data(String, Value),
    Table(Table),
    /// An explanation, on pages alone.
    Paragraph(String),
    /// The text of an SVG file of this program and its caption, on pages alone, and whether the
    /// reader may turn it.
    Drawing {
        svg: String,
        caption: String,
        turns: bool,
    },
    /// The content of a PNG file with its number of columns and its caption, on pages alone.
    Picture {
        png: Vec<u8>,
        columns: usize,
        caption: String,
    },
    /// The name and the text of a file, on pages alone.
    File(String, String),
}

impl Report {
    /// Starts a report with its title.
    pub fn new(title: impl Into<String>) -> Self {
        let program = concat!("tem00 ", env!("CARGO_PKG_VERSION"));
        let mut report = Self {
            title: title.into(),
            data: Map::new(),
            verdicts: Vec::new(),
            warnings: Vec::new(),
            notes: Vec::new(),
            sections: Vec::new(),
        };
        report.data("program", program);
        report
    }

    /// Adds a value that only programs get; a number that is not finite becomes `null`.
    pub fn data(&mut self, key: &str, value: impl Serialize) {
        self.data.insert(key.to_owned(), cell::value(value));
    }

    /// Adds a sentence with a conclusion of the report; the first is the result.
    pub fn verdict(&mut self, sentence: impl Into<String>) {
        self.verdicts.push(sentence.into());
    }

    /// Adds a reason to doubt the result.
    pub fn warning(&mut self, text: impl Into<String>) {
        self.warnings.push(text.into());
    }

    /// Adds an assumption of the result.
    pub fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }

    /// Starts a section.
    pub fn section(&mut self, heading: impl Into<String>) -> &mut Section {
        let index = self.sections.len();
        self.sections.push(Section {
            heading: heading.into(),
            key: None,
            in_detail: false,
            blocks: Vec::new(),
        });
        &mut self.sections[index]
    }
}

impl Section {
    /// Puts the quantities and tables into a separate object in JSON.
    pub const fn under(&mut self, key: &'static str) -> &mut Self {
        self.key = Some(key);
        self
    }

    /// Leaves the section out on a terminal.
    pub const fn in_detail(&mut self) -> &mut Self {
        self.in_detail = true;
        self
    }

    /// Adds a quantity.
    pub fn fact(
        &mut self,
        key: &'static str,
        name: impl Into<String>,
        value: impl Into<Cell>,
    ) -> &mut Self {
        self.push(Block::Fact(key, name.into(), value.into()))
    }

    /// Adds a value that only programs get; a number that is not finite becomes `null`.
    pub fn data(&mut self, key: &str, value: impl Serialize) -> &mut Self {
        self.push(Block::Data(key.to_owned(), cell::value(value)))
    }

    /// Adds a table.
    pub fn table(&mut self, table: Table) -> &mut Self {
        self.push(Block::Table(table))
    }

    /// Adds an explanation.
    pub fn paragraph(&mut self, text: impl Into<String>) -> &mut Self {
        self.push(Block::Paragraph(text.into()))
    }

    /// Adds a drawing with its caption. `svg` is the text of an SVG file of this program.
    pub fn drawing(&mut self, svg: impl Into<String>, caption: impl Into<String>) -> &mut Self {
        self.push(Block::Drawing {
            svg: svg.into(),
            caption: caption.into(),
            turns: false,
        })
    }

    /// Adds points in space that the reader may turn, if there are any.
    pub fn cloud(&mut self, cloud: Cloud<'_>) -> &mut Self {
        let turns = true;
        match cloud.draw() {
            Some((svg, caption)) => self.push(Block::Drawing {
                svg,
                caption,
                turns,
            }),
            None => self,
        }
    }

    /// Adds a picture with its caption, a small one enlarged. `png` is the content of a PNG file of
    /// `columns` columns.
    pub fn picture(
        &mut self,
        png: Vec<u8>,
        columns: usize,
        caption: impl Into<String>,
    ) -> &mut Self {
        let caption = caption.into();
        self.push(Block::Picture {
            png,
            columns,
            caption,
        })
    }

    /// Adds a file as it is, under its name.
    pub fn file(&mut self, name: impl Into<String>, text: impl Into<String>) -> &mut Self {
        self.push(Block::File(name.into(), text.into()))
    }

    fn push(&mut self, block: Block) -> &mut Self {
        self.blocks.push(block);
        self
    }
}

#[cfg(test)]
mod tests;
