use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::FileAccess;

/// Advice for a file outside of the allowed folder.
pub(crate) const OUTSIDE: &str =
    "put it below that folder, or allow files from everywhere with --allow-outside";

/// The folder of a file, which holds the files that belong to it.
#[derive(Clone, Debug)]
pub struct Folder {
    /// Its canonical path; `None` if there is no such folder.
    canonical: Option<PathBuf>,
    /// The locations from which files may be read.
    pub access: FileAccess,
}

impl Folder {
    /// Finds a folder, where an empty path is the current folder.
    pub fn new(directory: &Path, access: FileAccess) -> Self {
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
    pub fn holds(&self, canonical: &Path) -> bool {
        let folder = self.canonical.as_ref();
        folder.is_some_and(|folder| canonical.starts_with(folder))
    }
}
