use core::ops::Range;
use std::path::{Path, PathBuf};

use toml::de::DeTable;

use crate::error::{Location, Problem, line_column};

/// The key by which a file names others that belong to it.
pub(crate) const INCLUDE: &str = "include";

/// Text of a document: the file itself, or an included one.
#[derive(Debug)]
pub(crate) struct Source {
    /// The index among all texts of the document, in which the file itself is the first.
    pub(crate) index: usize,
    pub(crate) path: Option<PathBuf>,
    /// The canonical path, if the text came from a file.
    pub(crate) canonical: Option<PathBuf>,
    pub(crate) directory: PathBuf,
    pub(crate) text: String,
    /// The text of the file, where changes have replaced parts of it.
    pub(crate) written: Option<String>,
    /// Whether the text lies outside the folder of the file, and is therefore not quoted.
    pub(crate) is_outside: bool,
}

impl Source {
    /// Returns the text.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Returns the path of a file that this text names.
    pub(crate) fn beside(&self, name: &str) -> PathBuf {
        self.directory.join(name)
    }

    /// Returns a location in this text.
    pub(crate) const fn location(&self, span: Range<usize>) -> Location {
        Location {
            source: self.index,
            span,
        }
    }

    /// Names a location as compilers do: "lights.toml:3:1".
    pub(crate) fn describe(&self, location: &Location) -> String {
        let file = self.path.as_deref().unwrap_or(Path::new("text"));
        match line_column(&self.text, location.span.start) {
            Some((line, column)) => format!("{}:{line}:{column}", file.display()),
            None => file.display().to_string(),
        }
    }

    /// Parses the text, or returns a problem at the place where it is not TOML.
    pub(crate) fn parse(&self) -> Result<toml::Spanned<DeTable<'_>>, Problem> {
        DeTable::parse(&self.text).map_err(|error| {
            let problem = Problem::new(format!("this is not valid TOML: {}", error.message()));
            match error.span() {
                Some(span) => problem.at(self.location(span)),
                None => problem.at(self.location(0..0)),
            }
        })
    }
}
