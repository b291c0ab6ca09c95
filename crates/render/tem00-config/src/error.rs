use core::{error, fmt, ops::Range};
use std::path::{Path, PathBuf};

use crate::printable::printable_line;

/// The maximum number of characters of a message.
const MAX_CHARS: usize = 1000;

/// An error of a file, or of one that it includes, and its location there.
///
/// The message names the key, its value and what is allowed. [`Display`](fmt::Display) puts file,
/// line and column in front of it, as compilers do:
///
/// ```text
/// examples/scenes/spot.toml:12:14: `wavelength` must be positive, got "-650 nm"
/// ```
///
/// A program that can do better prints [`source_text`](Self::source_text) with a label under
/// [`span`](Self::span), and [`help`](Self::help) below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigError {
    path: Option<PathBuf>,
    source_text: String,
    problem: Box<Problem>,
}

impl ConfigError {
    pub(crate) fn new(path: Option<&Path>, source_text: &str, problem: Problem) -> Self {
        Self {
            path: path.map(Path::to_path_buf),
            source_text: source_text.to_owned(),
            problem: Box::new(problem),
        }
    }

    /// Returns the path of the file with the error: the requested file or one that it includes, or
    /// `--set` for a [`Change`](crate::Change); `None` if the text did not come from a file.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Returns the description of the error, in one sentence without the location.
    pub fn message(&self) -> &str {
        &self.problem.message
    }

    /// Returns how to correct the error, if there is more to say than the message does.
    pub fn help(&self) -> Option<&str> {
        self.problem.help.as_deref()
    }

    /// Returns the text of the file, or of the change, with the error; empty if it could not be
    /// read.
    pub fn source_text(&self) -> &str {
        &self.source_text
    }

    /// Returns whether a file could not be read, which says nothing about the content of the files.
    pub const fn is_unreadable(&self) -> bool {
        self.problem.is_unreadable
    }

    /// Returns the location of the error as a range of bytes of the source text, or `None` if the
    /// error has no location, such as a missing section.
    pub fn span(&self) -> Option<Range<usize>> {
        self.problem
            .location
            .as_ref()
            .map(|location| location.span.clone())
    }

    /// Returns the line and the column, in characters, where the error begins; both count from 1.
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let location = self.problem.location.as_ref()?;
        line_column(&self.source_text, location.span.start)
    }
}

/// Returns the line and the column, in characters, of a byte of `text`; both count from 1.
pub(crate) fn line_column(text: &str, start: usize) -> Option<(usize, usize)> {
    let before = text.get(..start)?;
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.matches('\n').count() + 1;
    let column = before[line_start..].chars().count() + 1;
    Some((line, column))
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.path {
            Some(path) => write!(f, "{}:", path.display())?,
            None => f.write_str("text:")?,
        }
        if let Some((line, column)) = self.line_column() {
            write!(f, "{line}:{column}:")?;
        }
        write!(f, " {}", self.problem.message)
    }
}

impl error::Error for ConfigError {}

/// A range of bytes of one of the texts of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Location {
    pub(crate) source: usize,
    pub(crate) span: Range<usize>,
}

/// A [`ConfigError`] before it knows the file it belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    pub(crate) message: String,
    pub(crate) location: Option<Location>,
    pub(crate) help: Option<String>,
    pub(crate) is_unreadable: bool,
}

impl Problem {
    /// Creates a problem without a location. Characters that cannot be printed are escaped, and a
    /// long message is cut, since it may quote the file.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            message: printable_line(&message.into(), MAX_CHARS),
            location: None,
            help: None,
            is_unreadable: false,
        }
    }

    /// Places the problem.
    pub(crate) fn at(mut self, location: Location) -> Self {
        self.location = Some(location);
        self
    }

    /// Marks the problem as one of a file that cannot be read: see [`ConfigError::is_unreadable`].
    #[must_use]
    pub const fn unreadable(mut self, is_unreadable: bool) -> Self {
        self.is_unreadable = is_unreadable;
        self
    }

    /// Adds advice on how to correct the problem.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(printable_line(&help.into(), MAX_CHARS));
        self
    }

    /// Returns the message, without its location.
    pub fn message(&self) -> String {
        self.message.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(span: Range<usize>) -> Problem {
        Problem::new("no").at(Location { source: 0, span })
    }

    fn error(text: &str, span: Range<usize>) -> ConfigError {
        ConfigError::new(Some(Path::new("a.toml")), text, at(span))
    }

    #[test]
    fn lines_and_columns_count_characters_from_one() {
        let text = "a = 1\nµ = 2\nb = 3\n";
        let location = |needle: &str| {
            let start = text.find(needle).unwrap();
            error(text, start..start + 1).line_column()
        };
        assert_eq!(location("a"), Some((1, 1)), "first character");
        // µ takes two bytes, so a count of bytes would give column 6.
        assert_eq!(location("2"), Some((2, 5)), "behind a two-byte character");
        assert_eq!(location("b"), Some((3, 1)), "start of a line");
    }

    #[test]
    fn a_location_at_the_end_of_the_text_has_a_line() {
        assert_eq!(error("ab\n", 3..3).line_column(), Some((2, 1)), "end");
        assert_eq!(error("", 0..0).line_column(), Some((1, 1)), "empty text");
    }

    #[test]
    fn display_starts_with_file_line_and_column() {
        assert_eq!(error("x\ny", 2..3).to_string(), "a.toml:2:1: no", "placed");
        let nowhere = ConfigError::new(Some(Path::new("a.toml")), "", Problem::new("no"));
        assert_eq!(nowhere.to_string(), "a.toml: no", "without a location");
        let unnamed = ConfigError::new(None, "x", at(0..1));
        assert_eq!(unnamed.to_string(), "text:1:1: no", "without a file");
    }
}
