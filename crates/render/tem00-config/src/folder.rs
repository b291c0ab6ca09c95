use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::FileAccess;

/// Advice for a file that lies elsewhere than it may.
pub(crate) const OUTSIDE: &str =
    "put it below that folder, or allow files from everywhere with --allow-outside";

/// The folder of a file, below which the files lie that are its own.
#[derive(Clone, Debug)]
pub struct Folder {
    /// Its canonical path; `None` if there is no such folder.
    canonical: Option<PathBuf>,
    /// From where files may be read.
    pub access: FileAccess,
}

impl Folder {
    /// Finds a folder, of which an empty path is the current one.
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
