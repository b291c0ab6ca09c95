use std::fs;
use std::path::{Path, PathBuf};

use crate::{
    Change, ConfigError, FileAccess, Folder, Format, Problem, Reading, Section, change,
    error::{Location, line_column},
    folder::OUTSIDE,
    input_file::{MAX_TEXT_BYTES, is_standard_input, read_input, read_text as read_text_file},
    source::{INCLUDE, Source},
};

/// The maximum number of files between a file and one that it includes.
const DEEPEST: usize = 16;

/// The texts of a document.
#[derive(Debug)]
pub(crate) struct Sources {
    format: Format,
    folder: Folder,
    all: Vec<Source>,
    /// The order in which they are put together: an included text stands before the text that
    /// includes it.
    order: Vec<usize>,
    /// The texts that are being read, outermost first.
    open: Vec<usize>,
    changes: Vec<Change>,
}

impl Sources {
    /// Reads a file and all that it includes.
    pub(crate) fn of_file(
        path: &Path,
        reading: Reading<'_>,
        format: Format,
    ) -> Result<Self, ConfigError> {
        let text = read_text(path, &format)?;
        let directory = path.parent().unwrap_or(Path::new(""));
        let mut sources = Self::of_text(text, Some(path), (directory, reading.access), format)?;
        let changed = sources.change(reading.changes);
        changed.map_err(|problem| sources.locate(problem))?;
        Ok(sources)
    }

    /// Replaces values of the texts.
    fn change(&mut self, changes: &[Change]) -> Result<(), Problem> {
        if changes.is_empty() {
            return Ok(());
        }
        let in_order = self.order.iter().filter_map(|&index| self.all.get(index));
        let mut texts: Vec<String> = in_order.map(|source| source.text.clone()).collect();
        // Included texts stand before the file itself.
        let main = texts.len().saturating_sub(1);
        change::apply(changes, &mut texts, main)?;
        for (&index, text) in self.order.iter().zip(texts) {
            let source = &mut self.all[index];
            source.written = Some(core::mem::replace(&mut source.text, text));
        }
        changes.clone_into(&mut self.changes);
        Ok(())
    }

    /// Reads all that a text includes.
    pub(crate) fn of_text(
        text: String,
        path: Option<&Path>,
        (directory, access): (&Path, FileAccess),
        format: Format,
    ) -> Result<Self, ConfigError> {
        let mut sources = Self {
            format,
            folder: Folder::new(directory, access),
            all: Vec::new(),
            order: Vec::new(),
            open: Vec::new(),
            changes: Vec::new(),
        };
        let source = Source {
            index: 0,
            path: path.map(Path::to_path_buf),
            canonical: path.and_then(|path| fs::canonicalize(path).ok()),
            directory: directory.to_path_buf(),
            text,
            written: None,
            is_outside: false,
        };
        let added = sources.add(source);
        added.map_err(|problem| sources.locate(problem))?;
        Ok(sources)
    }

    /// Returns the texts in the order in which they are put together.
    pub(crate) fn in_order(&self) -> impl Iterator<Item = &Source> {
        self.order.iter().filter_map(|&index| self.all.get(index))
    }

    /// Returns the kind of file.
    pub(crate) const fn format(&self) -> &Format {
        &self.format
    }

    /// Returns the files that were read, the file itself first; standard input is not one of them.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let paths = self.all.iter().filter_map(|source| source.path.clone());
        paths.filter(|path| !is_standard_input(path)).collect()
    }

    /// Turns a problem into an error that knows its file.
    pub(crate) fn locate(&self, problem: Problem) -> ConfigError {
        let index = problem
            .location
            .as_ref()
            .map_or(0, |location| location.source);
        let source = self.all.get(index);
        let path = source.and_then(|source| source.path.as_deref());
        match source {
            Some(source) if source.is_outside => {
                ConfigError::new(path, "", unquoted(source, &problem))
            }
            Some(source) => match source.written.as_deref() {
                Some(written) => self.as_written(source, written, problem),
                None => ConfigError::new(path, &source.text, problem),
            },
            None => ConfigError::new(path, "", problem),
        }
    }

    /// Returns the error at its place in the file as it is written, or in the change that has
    /// written that place.
    fn as_written(&self, source: &Source, written: &str, mut problem: Problem) -> ConfigError {
        let path = source.path.as_deref();
        let Some(Location { span, .. }) = &mut problem.location else {
            return ConfigError::new(path, written, problem);
        };
        let before = source.text.get(..span.start).unwrap_or_default();
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let number = before.matches('\n').count();
        if let Some(start) = line_as_written(&source.text, written, number) {
            *span = span.start - line_start + start..span.end - line_start + start;
            return ConfigError::new(path, written, problem);
        }
        let line = source.text[line_start..].lines().next().unwrap_or_default();
        let what = source.text.get(span.clone()).unwrap_or_default();
        let texts = self.in_order().filter_map(|source| source.written.clone());
        let texts: Vec<_> = texts.collect();
        let place = self.order.iter().position(|&index| index == source.index);
        match place.and_then(|place| change::writer(&self.changes, &texts, place, line)) {
            Some(change) => {
                *span = change.span_of(what);
                ConfigError::new(Some(Path::new("--set")), change.text(), problem)
            }
            None => ConfigError::new(path, &source.text, problem),
        }
    }

    /// Returns the folder of the file.
    pub(crate) const fn folder(&self) -> &Folder {
        &self.folder
    }

    fn add(&mut self, mut source: Source) -> Result<(), Problem> {
        // Some editors begin a text with a byte order mark, which would shift the first line by a
        // column.
        if source.text.starts_with('\u{feff}') {
            source.text.remove(0);
        }
        let index = source.index;
        let includes = includes_of(&source, &self.format);
        self.all.push(source);
        self.open.push(index);
        for include in includes? {
            self.include(include)?;
        }
        self.open.pop();
        self.order.push(index);
        Ok(())
    }

    fn include(&mut self, include: Include) -> Result<(), Problem> {
        let Include { path, .. } = &include;
        let unreadable = |error| {
            let problem = include.problem(format_args!("cannot be read: {error}"));
            problem.unreadable(true)
        };
        let canonical = fs::canonicalize(path).map_err(unreadable)?;
        let is_outside = !self.folder.holds(&canonical);
        if is_outside && self.folder.access == FileAccess::WithinFolder {
            return Err(include
                .problem(format_args!(
                    "lies outside of the folder of the {} file",
                    self.format.noun
                ))
                .with_help(OUTSIDE));
        }
        self.check_new(&canonical, &include)?;
        let bytes = read_input(path, MAX_TEXT_BYTES).map_err(unreadable)?;
        let text =
            String::from_utf8(bytes).map_err(|_| include.problem("must be text in UTF-8"))?;
        let source = Source {
            index: self.all.len(),
            directory: path.parent().unwrap_or(Path::new("")).to_path_buf(),
            path: Some(include.path),
            canonical: Some(canonical),
            text,
            written: None,
            is_outside,
        };
        self.add(source)
    }

    /// Refuses a file that was read before, and a file at the end of too long a chain of includes.
    fn check_new(&self, canonical: &Path, include: &Include) -> Result<(), Problem> {
        let mut read = self.all.iter();
        match read.position(|source| source.canonical.as_deref() == Some(canonical)) {
            Some(index) if self.open.contains(&index) => {
                Err(include.problem("would include itself"))
            }
            Some(_) => Err(include.problem("is part of the document already")),
            None if self.open.len() > DEEPEST => Err(include.problem(format_args!(
                "would be more than {DEEPEST} files away from the first"
            ))),
            None => Ok(()),
        }
    }
}

/// Returns a problem in a file outside the document's folder, without a quotation from that file.
fn unquoted(source: &Source, problem: &Problem) -> Problem {
    let location = problem.location.as_ref();
    let location = location.and_then(|location| line_column(&source.text, location.span.start));
    let location = location.map_or_else(String::new, |(line, column)| {
        format!(" in line {line}, column {column}")
    });
    Problem::new(format!(
        "there is a mistake{location}; the file lies outside of the document's folder and is not \
         quoted"
    ))
    .unreadable(problem.is_unreadable)
}

/// Returns where a line of a changed text starts in the text before the changes, or `None` if a
/// change has written the line.
fn line_as_written(changed: &str, written: &str, number: usize) -> Option<usize> {
    let mut before = written.split_inclusive('\n').peekable();
    let mut start = 0;
    let mut lines = changed.split_inclusive('\n').enumerate().peekable();
    while let Some((index, line)) = lines.next() {
        let same = before.peek() == Some(&line);
        if index == number {
            return same.then_some(start);
        }
        let after = lines.peek().map(|&(_, line)| line);
        let replaced = !same && after != before.peek().copied() && after == before.clone().nth(1);
        if same || replaced {
            start += before.next().map_or(0, str::len);
        }
    }
    None
}

/// An included file, and the location that includes it.
struct Include {
    path: PathBuf,
    location: Location,
}

impl Include {
    fn problem(&self, what: impl core::fmt::Display) -> Problem {
        let name = self.path.display();
        Problem::new(format!("`include`: {name} {what}")).at(self.location.clone())
    }
}

fn includes_of(source: &Source, format: &Format) -> Result<Vec<Include>, Problem> {
    let document = source.parse()?;
    let root = Section::root(document.get_ref(), source, format)?;
    if !format.keys.contains(&INCLUDE) {
        return Ok(Vec::new());
    }
    let Some(list) = root.optional(INCLUDE) else {
        return Ok(Vec::new());
    };
    let include = |file: &crate::value::Value<'_>| {
        Ok(Include {
            path: source.beside(file.string()?),
            location: file.location(),
        })
    };
    let files = list.list("a list of files, such as [\"lights.toml\"]")?;
    files.iter().map(include).collect()
}

fn read_text(path: &Path, format: &Format) -> Result<String, ConfigError> {
    let unreadable = |why: &dyn core::fmt::Display| {
        let problem = Problem::new(format!("the {} file cannot be read: {why}", format.noun))
            .with_help(format.help)
            .unreadable(true);
        ConfigError::new(Some(path), "", problem)
    };
    let bytes = read_text_file(path).map_err(|why| unreadable(&why))?;
    String::from_utf8(bytes).map_err(|not_utf8| {
        let valid = not_utf8.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&not_utf8.as_bytes()[..valid]);
        let location = Location {
            source: 0,
            span: valid..valid,
        };
        let problem =
            Problem::new(format!("the {} file must be text in UTF-8", format.noun)).at(location);
        ConfigError::new(Some(path), &text, problem)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_no_change_has_written_are_those_of_the_file() {
        let written = "a = 1\n[b]\nc = 2\n\n[[d]]\ne = 3\n";
        for changed in [
            "a = 1\n[b]\nc = 9 #\n\n[[d]]\ne = 3\n",
            "a = 1\n[b]\nc = 2\nf = 4 #\ng = 5 #\n\n[[d]]\ne = 3\n",
            "h = {} #\na = 1\n[b]\nc = 2\n\n[[d]]\ne = 8 #\ni = 7 #\n",
        ] {
            for (number, line) in changed.lines().enumerate() {
                let found = line_as_written(changed, written, number);
                let expected = written.find(line).filter(|_| !line.is_empty());
                assert!(line.is_empty() || found == expected, "{line}: {found:?}");
            }
        }
    }

    #[test]
    fn an_error_of_a_change_lies_in_the_change_that_wrote_its_line() {
        let text = "[[laser]]\npower = 1\n[[laser]]\npower = 1\n".to_owned();
        let place = (Path::new(""), FileAccess::WithinFolder);
        let format = Format {
            noun: "scene",
            keys: &["laser"],
            uncertain: &[],
            help: "",
        };
        let mut sources = Sources::of_text(text, None, place, format).unwrap();
        let changes = ["laser[0].power=-1", "laser[1].power=2"].map(|text| text.parse().unwrap());
        sources.change(&changes).unwrap();
        let start = sources.all[0].text.find("-1").unwrap();
        let location = sources.all[0].location(start..start + 2);
        let error = sources.locate(Problem::new("no").at(location));
        assert_eq!(error.to_string(), "--set:1:16: no");
        assert_eq!(error.source_text(), "laser[0].power=-1");
    }
}
