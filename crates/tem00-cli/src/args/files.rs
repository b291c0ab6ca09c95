//! What the commands share that read scene files and set-up files.

use clap::Args;
use tem00_tracer::document::FileAccess;

/// From where files may be read that a scene file or a set-up file names.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct FileArgs {
    /// Let the file include files that lie outside of its folder, and glTF meshes take data from outside
    /// of theirs.
    #[arg(long)]
    allow_outside: bool,
}

impl FileArgs {
    /// Returns from where files may be read.
    pub(crate) const fn access(self) -> FileAccess {
        if self.allow_outside {
            FileAccess::Anywhere
        } else {
            FileAccess::WithinFolder
        }
    }
}
