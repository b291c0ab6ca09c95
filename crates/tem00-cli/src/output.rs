//! What the commands share: where their files go, and the threads that they work on.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::{atomic::create_writable_folder, failure::Failure};

/// Returns the name of an input file without folder and ending, or `otherwise` if it has none.
pub(crate) fn name(input: &Path, otherwise: &str) -> String {
    input.file_stem().map_or_else(
        || otherwise.to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}

/// Returns the folder that was asked for, or `out/<name>`.
pub(crate) fn folder(asked: Option<&Path>, name: &str) -> PathBuf {
    asked.map_or_else(|| Path::new("out").join(name), Path::to_path_buf)
}

/// Makes sure, before the work, that files can be written into the folder, and makes it if need be.
///
/// # Errors
///
/// Returns a failure if they cannot.
pub(crate) fn prepare(folder: &Path) -> Result<(), Failure> {
    create_writable_folder(folder).map_err(|error| {
        Failure::input(
            format!("cannot write into the folder {}: {error}", folder.display()),
            "name a folder that may be written with -o",
        )
    })
}

/// Removes files of an earlier run that this one does not write: each of the names with each ending.
///
/// # Errors
///
/// Returns a failure if one is there and cannot be removed.
pub(crate) fn remove(folder: &Path, names: &[&str], endings: &[&str]) -> Result<(), Failure> {
    for (name, ending) in names
        .iter()
        .flat_map(|name| endings.iter().map(move |e| (name, e)))
    {
        let path = folder.join(format!("{name}.{ending}"));
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(Failure::running(format!(
                    "cannot remove {}: {error}",
                    path.display()
                )));
            }
            _ => (),
        }
    }
    Ok(())
}

static QUIET: AtomicBool = AtomicBool::new(false);

/// Leaves out all notes and all progress from now on.
pub(crate) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Returns whether notes and progress are left out.
pub(crate) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Writes a line to standard error, unless notes are left out or there is nobody to read it.
pub(crate) fn note(text: &str) {
    if !is_quiet() {
        let _ = writeln!(io::stderr(), "{text}");
    }
}

/// Starts the threads that were asked for, or one per core.
///
/// # Errors
///
/// Returns a failure if the operating system refuses.
pub(crate) fn thread_pool(threads: Option<u16>) -> Result<ThreadPool, Failure> {
    ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::running(format!("cannot start the threads: {error}")))
}
