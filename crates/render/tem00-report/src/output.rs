//! Output folders, notes and threads, which the commands share.

use std::{
    fmt::{Arguments, Display},
    fs::{self, File},
    io::{self, BufWriter, Write},
    num::NonZero,
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    thread,
};

use rayon::{ThreadPool, ThreadPoolBuilder};
use tem00_config::{is_standard_input, printable};
use tem00_numerics::check_memory;

use crate::{
    atomic::{create_writable_folder, remove_abandoned, write_atomically},
    failure::Failure,
    folder_lock::{FolderLock, Refused},
};

/// Returns the name of an input file without folder and ending, or `otherwise` if it has none; the
/// name of standard input, `-`, is `standard_input`.
pub fn name(input: &Path, otherwise: &str) -> String {
    if is_standard_input(input) {
        return "standard_input".to_owned();
    }
    input.file_stem().map_or_else(
        || otherwise.to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}

/// Returns the requested folder, or `out/<name>`.
pub fn folder(asked: Option<&Path>, name: &str) -> PathBuf {
    asked.map_or_else(|| Path::new("out").join(name), Path::to_path_buf)
}

/// Checks, before the work starts, that files can be written into the folder, and keeps other
/// processes from writing there for as long as the returned lock lives. Creates the folder if
/// needed, and removes the temporary files that a killed process left there.
///
/// # Errors
///
/// Returns a failure if files cannot be written, or if another process has taken the folder.
pub fn prepare(folder: &Path) -> Result<FolderLock, Failure> {
    take(folder, FolderLock::alone)
}

/// Prepares a folder that other parts of the same `work` may share, otherwise as [`prepare`].
///
/// # Errors
///
/// Returns the failures of [`prepare`].
pub fn prepare_for_part(folder: &Path, work: &str) -> Result<FolderLock, Failure> {
    take(folder, |folder| FolderLock::shared(folder, work))
}

fn take(
    folder: &Path,
    lock: impl FnOnce(&Path) -> Result<FolderLock, Refused>,
) -> Result<FolderLock, Failure> {
    let refused = |error| not_writable(folder, &error);
    create_writable_folder(folder).map_err(refused)?;
    let lock = lock(folder).map_err(|why| match why {
        Refused::InUse(process) => in_use(folder, process),
        Refused::Io(error) => refused(error),
    })?;
    if !lock.is_held() {
        note(&format!(
            "{}: file locking is unavailable; make sure that no other tem00 writes there",
            folder.display()
        ));
    }
    remove_abandoned(folder);
    Ok(lock)
}

/// Returns the failure that nothing can be written into a folder.
pub fn not_writable(folder: &Path, error: &io::Error) -> Failure {
    Failure::unavailable(
        format!("cannot write into the folder {}: {error}", folder.display()),
        "name a folder that may be written with -o",
    )
}

/// Makes a folder within a folder of results, without the files that killed processes left there,
/// and returns its path.
///
/// # Errors
///
/// Returns a failure if it cannot be made, or is a link, which may lead anywhere.
pub fn subfolder(folder: &Path, name: &str) -> Result<PathBuf, Failure> {
    let path = folder.join(name);
    if fs::symlink_metadata(&path).is_ok_and(|found| found.is_symlink()) {
        return Err(Failure::unavailable(
            format!(
                "{} is a link, through which nothing is written",
                path.display()
            ),
            "remove it, or name another folder with -o",
        ));
    }
    create_writable_folder(&path).map_err(|error| not_writable(&path, &error))?;
    remove_abandoned(&path);
    Ok(path)
}

fn in_use(folder: &Path, process: Option<u32>) -> Failure {
    let process = process.map_or_else(String::new, |process| format!(", process {process},"));
    Failure::unavailable(
        format!(
            "another tem00{process} is writing into the folder {}",
            folder.display()
        ),
        "wait until it has ended, or name another folder with -o; only parts of one render, chosen \
         by --frames, may share a folder",
    )
}

/// Writes text for a terminal or a file: characters that would control a terminal are escaped,
/// since names of files and of surfaces may hold any characters.
#[derive(Debug)]
pub struct Printable<W>(pub(crate) W);

impl<W: Write> Write for Printable<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = String::from_utf8_lossy(bytes);
        self.0.write_all(printable(&text).as_bytes())?;
        Ok(bytes.len())
    }

    /// Formats all of it first, so that no character is written in two pieces.
    fn write_fmt(&mut self, arguments: Arguments<'_>) -> io::Result<()> {
        self.write_all(arguments.to_string().as_bytes())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// Writes a file, so that no reader ever sees an incomplete one: an earlier file stays as it was
/// until the new one is complete and on the disk, and where `write` fails.
///
/// # Errors
///
/// Returns a failure that names the file if it cannot be written.
pub fn save<E: From<io::Error> + Display>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), Failure> {
    write_atomically(path, write).map_err(|error| Failure::writing(path, error))
}

/// Removes files of an earlier run that this one does not write: each of the names with each
/// ending.
///
/// # Errors
///
/// Returns a failure if one is there and cannot be removed.
pub fn remove(folder: &Path, names: &[&str], endings: &[&str]) -> Result<(), Failure> {
    for (name, ending) in names
        .iter()
        .flat_map(|name| endings.iter().map(move |e| (name, e)))
    {
        let path = folder.join(format!("{name}.{ending}"));
        match fs::remove_file(&path) {
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
pub fn set_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Returns whether notes and progress are left out.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Writes a line to standard error, unless notes are left out or standard error is closed.
pub fn note(text: &str) {
    if !is_quiet() {
        let _ = writeln!(io::stderr(), "{}", printable(text));
    }
}

/// Checks, before the work starts, that memory is available for `what`.
///
/// # Errors
///
/// Returns a failure if the system reports less memory than is needed.
pub fn check_room(what: &str, bytes: u64, help: &str) -> Result<(), Failure> {
    check_memory(bytes).map_err(|error| Failure::unavailable(format!("{what}: {error}"), help))
}

/// The maximum number of threads for each thread that the machine runs at a time: more threads only
/// wait for each other.
const THREADS_PER_CORE: usize = 4;

/// Returns the requested number of threads, or the maximum that is useful here, with a note.
pub fn bounded(threads: Option<u16>) -> Option<u16> {
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let max = u16::try_from(THREADS_PER_CORE * cores).unwrap_or(u16::MAX);
    if let Some(asked) = threads.filter(|&asked| asked > max) {
        note(&format!(
            "--threads {asked}: this machine runs {cores} at a time; {max} are started"
        ));
    }
    threads.map(|asked| asked.min(max))
}

/// Starts the requested threads, or one per core.
///
/// # Errors
///
/// Returns a failure if the operating system refuses.
pub fn thread_pool(threads: Option<u16>) -> Result<ThreadPool, Failure> {
    ThreadPoolBuilder::new()
        .num_threads(bounded(threads).map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::running(format!("cannot start the threads: {error}")))
}
