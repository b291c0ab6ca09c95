use std::fs;
use std::path::{Path, PathBuf};

use toml::de::DeTable;

use crate::input_file::{
    FileAccess, MAX_TEXT_BYTES, is_standard_input, read_input, read_text as read_text_file,
};

use super::change::{self, Change, Reading};
use super::error::{Place, Problem, SceneError, line_column};
use super::format::Format;
use super::section::Section;

/// The key by which a scene file names others that belong to it.
pub(super) const INCLUDE: &str = "include";

/// The most files that may stand between a scene file and one that it includes.
const DEEPEST: usize = 16;

/// One text of a scene: the scene file itself, or a file that it includes.
#[derive(Debug)]
pub(super) struct Source {
    /// The place among all texts of the scene, in which the scene file itself is the first.
    index: usize,
    path: Option<PathBuf>,
    directory: PathBuf,
    text: String,
    /// Whether it lies outside of the folder of the scene file, and is therefore not quoted.
    is_outside: bool,
}

impl Source {
    /// Returns the text.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Returns the path of a file that this text names.
    pub(super) fn beside(&self, name: &str) -> PathBuf {
        self.directory.join(name)
    }

    /// Returns a place in this text.
    pub(super) const fn place(&self, span: core::ops::Range<usize>) -> Place {
        Place {
            source: self.index,
            span,
        }
    }

    /// Names a place as compilers do: "lights.toml:3:1".
    pub(super) fn describe(&self, place: &Place) -> String {
        let file = self.path.as_deref().unwrap_or(Path::new("scene"));
        match line_column(&self.text, place.span.start) {
            Some((line, column)) => format!("{}:{line}:{column}", file.display()),
            None => file.display().to_string(),
        }
    }

    /// Returns the document and tells where it is no TOML.
    pub(super) fn parse(&self) -> Result<toml::Spanned<DeTable<'_>>, Problem> {
        DeTable::parse(&self.text).map_err(|error| {
            let problem = Problem::new(format!("this is not valid TOML: {}", error.message()));
            match error.span() {
                Some(span) => problem.at(self.place(span)),
                None => problem.at(self.place(0..0)),
            }
        })
    }
}

/// The texts of a scene.
#[derive(Debug)]
pub(super) struct Sources {
    format: Format,
    folder: SceneFolder,
    all: Vec<Source>,
    /// The order in which they are put together: what is included stands before what includes it.
    order: Vec<usize>,
    /// The texts that are being read, outermost first.
    open: Vec<usize>,
    /// The canonical paths of the texts that came from files.
    canonical: Vec<Option<PathBuf>>,
}

impl Sources {
    /// Reads a scene file and all that it includes.
    pub(super) fn of_file(
        path: &Path,
        reading: Reading<'_>,
        format: Format,
    ) -> Result<Self, SceneError> {
        let text = read_text(path, &format)?;
        let directory = path.parent().unwrap_or(Path::new(""));
        let mut sources = Self::of_text(text, Some(path), (directory, reading.access), format)?;
        match sources.change(reading.changes) {
            Ok(()) => Ok(sources),
            Err(problem) => Err(sources.locate(problem)),
        }
    }

    /// Puts values in the place of those that the texts have.
    fn change(&mut self, changes: &[Change]) -> Result<(), Problem> {
        if changes.is_empty() {
            return Ok(());
        }
        let in_order = self.order.iter().filter_map(|&index| self.all.get(index));
        let mut texts: Vec<String> = in_order.map(|source| source.text.clone()).collect();
        // What is included stands before the scene file.
        let main = texts.len().saturating_sub(1);
        change::apply(changes, &mut texts, main)?;
        for (&index, text) in self.order.iter().zip(texts) {
            self.all[index].text = text;
        }
        Ok(())
    }

    /// Reads all that a text includes.
    pub(super) fn of_text(
        text: String,
        path: Option<&Path>,
        (directory, access): (&Path, FileAccess),
        format: Format,
    ) -> Result<Self, SceneError> {
        let mut sources = Self {
            format,
            folder: SceneFolder::new(directory, access),
            all: Vec::new(),
            order: Vec::new(),
            open: Vec::new(),
            canonical: Vec::new(),
        };
        let canonical = path.and_then(|path| fs::canonicalize(path).ok());
        let source = Source {
            index: 0,
            path: path.map(Path::to_path_buf),
            directory: directory.to_path_buf(),
            text,
            is_outside: false,
        };
        match sources.add(source, canonical) {
            Ok(()) => Ok(sources),
            Err(problem) => Err(sources.locate(problem)),
        }
    }

    /// Returns the texts in the order in which they are put together.
    pub(super) fn in_order(&self) -> impl Iterator<Item = &Source> {
        self.order.iter().filter_map(|&index| self.all.get(index))
    }

    /// Returns the kind of file.
    pub(super) const fn format(&self) -> &Format {
        &self.format
    }

    /// Returns the files that were read, the scene file first; standard input is none.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let paths = self.all.iter().filter_map(|source| source.path.clone());
        paths.filter(|path| !is_standard_input(path)).collect()
    }

    /// Turns a problem into an error that knows its file.
    pub(super) fn locate(&self, problem: Problem) -> SceneError {
        let index = problem.place.as_ref().map_or(0, |place| place.source);
        let source = self.all.get(index);
        let path = source.and_then(|source| source.path.as_deref());
        match source {
            Some(source) if source.is_outside => {
                SceneError::new(path, "", unquoted(source, &problem))
            }
            source => SceneError::new(path, source.map_or("", Source::text), problem),
        }
    }

    /// Returns the folder of the scene file.
    pub(super) const fn folder(&self) -> &SceneFolder {
        &self.folder
    }

    fn add(&mut self, source: Source, canonical: Option<PathBuf>) -> Result<(), Problem> {
        let index = source.index;
        self.all.push(source);
        self.canonical.push(canonical);
        self.open.push(index);
        for include in self.includes_of_last()? {
            self.include(include)?;
        }
        self.open.pop();
        self.order.push(index);
        Ok(())
    }

    fn includes_of_last(&self) -> Result<Vec<Include>, Problem> {
        match self.all.last() {
            Some(source) => includes_of(source, &self.format),
            None => Ok(Vec::new()),
        }
    }

    fn include(&mut self, include: Include) -> Result<(), Problem> {
        let Include { path, .. } = &include;
        let unreadable = |error| include.problem(format_args!("cannot be read: {error}"));
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
            text,
            is_outside,
        };
        self.add(source, Some(canonical))
    }

    /// Refuses a file that was read before, and one at the end of a long chain.
    fn check_new(&self, canonical: &Path, include: &Include) -> Result<(), Problem> {
        let mut read = self.canonical.iter();
        match read.position(|read| read.as_deref() == Some(canonical)) {
            Some(index) if self.open.contains(&index) => {
                Err(include.problem("would include itself"))
            }
            Some(_) => Err(include.problem("is part of the scene already")),
            None if self.open.len() > DEEPEST => Err(include.problem(format_args!(
                "would be more than {DEEPEST} files away from the scene"
            ))),
            None => Ok(()),
        }
    }
}

/// What to say of a file that lies elsewhere than it may.
pub(super) const OUTSIDE: &str =
    "put it below that folder, or allow files from everywhere with --allow-outside";

/// The folder of a scene file, below which the files lie that are a scene's own.
#[derive(Clone, Debug)]
pub(crate) struct SceneFolder {
    /// Its canonical path; `None` if there is no such folder.
    canonical: Option<PathBuf>,
    /// From where files may be read.
    pub(super) access: FileAccess,
}

impl SceneFolder {
    /// Finds a folder, of which an empty path is the current one.
    pub(crate) fn new(directory: &Path, access: FileAccess) -> Self {
        let is_current = directory.as_os_str().is_empty();
        let directory = if is_current {
            Path::new(".")
        } else {
            directory
        };
        Self {
            canonical: fs::canonicalize(directory).ok(),
            access,
        }
    }

    /// Returns whether a canonical path lies below the folder.
    pub(crate) fn holds(&self, canonical: &Path) -> bool {
        let folder = self.canonical.as_ref();
        folder.is_some_and(|folder| canonical.starts_with(folder))
    }
}

/// A problem in a file that is not the scene's own, without what stands there.
fn unquoted(source: &Source, problem: &Problem) -> Problem {
    let place = problem.place.as_ref();
    let place = place.and_then(|place| line_column(&source.text, place.span.start));
    let place = place.map_or_else(String::new, |(line, column)| {
        format!(" in line {line}, column {column}")
    });
    Problem::new(format!(
        "there is a mistake{place}; the file lies outside of the scene's folder and is not quoted"
    ))
}

/// A file that another one includes, and where it says so.
struct Include {
    path: PathBuf,
    place: Place,
}

impl Include {
    fn problem(&self, what: impl core::fmt::Display) -> Problem {
        let name = self.path.display();
        Problem::new(format!("`include`: {name} {what}")).at(self.place.clone())
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
    let include = |file: &super::value::Value<'_>| {
        Ok(Include {
            path: source.beside(file.string()?),
            place: file.place(),
        })
    };
    let files = list.list("a list of scene files, such as [\"lights.toml\"]")?;
    files.iter().map(include).collect()
}

fn read_text(path: &Path, format: &Format) -> Result<String, SceneError> {
    let unreadable = |why: &dyn core::fmt::Display| {
        let problem = Problem::new(format!("the {} file cannot be read: {why}", format.noun))
            .with_help(format.help);
        SceneError::new(Some(path), "", problem)
    };
    let bytes = read_text_file(path).map_err(|why| unreadable(&why))?;
    String::from_utf8(bytes).map_err(|not_utf8| {
        let valid = not_utf8.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&not_utf8.as_bytes()[..valid]);
        let place = Place {
            source: 0,
            span: valid..valid,
        };
        let problem =
            Problem::new(format!("the {} file must be text in UTF-8", format.noun)).at(place);
        SceneError::new(Some(path), &text, problem)
    })
}
