use std::path::PathBuf;

use crate::{Folder, Problem, Section, Value, sources::Sources};

/// A document as the sections of its files, the included files first.
#[derive(Debug)]
pub struct Document<'a> {
    files: Vec<Section<'a>>,
    sources: &'a Sources,
}

impl<'a> Document<'a> {
    /// Puts the files together, in order.
    pub(crate) const fn new(files: Vec<Section<'a>>, sources: &'a Sources) -> Self {
        Self { files, sources }
    }

    /// Returns the text of the file that includes the others.
    pub fn text(&self) -> &'a str {
        self.files.last().map_or("", Section::text)
    }

    /// Returns the folder of the file that includes the others.
    pub const fn folder(&self) -> &Folder {
        self.sources.folder()
    }

    /// Returns the files that were read, the one that includes the others first; standard input is
    /// not among them.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.sources.files()
    }

    /// Returns a value that stands outside of all sections, from the file that includes the others.
    pub fn value(&self, key: &'static str) -> Option<Value<'a>> {
        self.files.iter().rev().find_map(|file| file.optional(key))
    }

    /// Opens the table of a key, which one of the files may have.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in its file, if the table has another form, is given twice or has
    /// a key that is not allowed.
    pub fn table(
        &self,
        key: &'static str,
        keys: &'static [&'static str],
    ) -> Result<Option<Section<'a>>, Problem> {
        let mut given = self.files.iter().filter(|file| file.has(key));
        match (given.next(), given.next()) {
            (None, _) => Ok(None),
            (Some(file), None) => file.table(key, keys),
            (Some(first), Some(second)) => {
                let first = first.describe(key);
                let message = format!("[{key}] is given a second time, after {first}");
                Err(second
                    .problem_with(key, message)
                    .with_help("a file and those that it includes have one of it together"))
            }
        }
    }

    /// Opens every table of a key of which each file may have several.
    ///
    /// # Errors
    ///
    /// Returns a problem, placed in its file, if a table has another form, is given twice or has a
    /// key that is not allowed.
    pub fn tables(
        &self,
        key: &'static str,
        keys: &'static [&'static str],
    ) -> Result<Vec<Section<'a>>, Problem> {
        let of_files = self.files.iter().map(|file| file.tables(key, keys));
        let of_files: Vec<Vec<Section<'a>>> = of_files.collect::<Result<_, _>>()?;
        Ok(of_files.concat())
    }
}
