use std::path::{Path, PathBuf};

/// The files other than text that a scene is made of.
#[derive(Debug, Default)]
pub(super) struct Assets {
    files: Vec<PathBuf>,
}

impl Assets {
    /// Notes that a file was read.
    pub(super) fn note(&mut self, path: &Path) {
        if !self.files.iter().any(|known| known == path) {
            self.files.push(path.to_path_buf());
        }
    }

    /// Returns the files in the order in which they were first read.
    pub(super) fn into_files(self) -> Vec<PathBuf> {
        self.files
    }
}
