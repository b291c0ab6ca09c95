//! The options of the commands that read scene files and set-up files.

use clap::Args;
use tem00_config::{Change, FileAccess, Reading};

/// Options for reading a scene file or a set-up file.
#[derive(Args, Clone, Debug)]
pub struct FileArgs {
    /// Allow included files outside the folder of the file, and data of glTF meshes outside the
    /// folder of the mesh.
    #[arg(long)]
    allow_outside: bool,

    /// Override a value of the file, such as `camera.f_number=8` or, counted from 0,
    /// `laser[0].power=2mW`; may be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    changes: Vec<Change>,
}

impl FileArgs {
    /// Returns the options with further changes.
    pub fn with<'a>(&self, changes: impl IntoIterator<Item = &'a Change>) -> Self {
        let mut more = self.clone();
        more.changes.extend(changes.into_iter().cloned());
        more
    }

    /// Returns how the file is read.
    pub fn reading(&self) -> Reading<'_> {
        Reading {
            access: if self.allow_outside {
                FileAccess::Anywhere
            } else {
                FileAccess::WithinFolder
            },
            changes: &self.changes,
        }
    }
}
