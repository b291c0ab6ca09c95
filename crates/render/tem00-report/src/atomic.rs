//! Files that appear complete or not at all.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use tempfile::NamedTempFile;

/// The start and the end of the names of temporary files.
const PREFIX: &str = ".tem00-";
const SUFFIX: &str = ".part";

/// Temporary files that are being written now.
static PENDING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Writes the file `path` with `write`, so that no reader ever sees an incomplete file.
///
/// The content goes to a temporary file in the same folder, which takes the name `path` only when
/// it is complete and on the disk. If `write` fails, the temporary file is removed and an earlier
/// file at `path` stays as it was. A temporary file is locked while it is written, so that
/// [`remove_abandoned`] can recognise files that no process writes any more.
///
/// # Errors
///
/// Returns the error of `write` or of the file system.
pub(crate) fn write_atomically<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    let folder = folder_of(path);
    let temporary = temporary_file_in(folder)?;
    let _pending = Pending::register(temporary.path());
    let mut writer = BufWriter::new(temporary.as_file().try_clone()?);
    write(&mut writer)?;
    writer.flush()?;
    drop(writer);
    // Otherwise a name could be on the disk before its content is.
    temporary.as_file().sync_all()?;
    temporary.persist(path).map_err(|failed| failed.error)?;
    sync_folder(folder);
    Ok(())
}

/// Removes the temporary files of processes that were killed while they wrote into the folder.
pub fn remove_abandoned(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && name.starts_with(PREFIX) && name.ends_with(SUFFIX) {
            remove_if_abandoned(&entry.path());
        }
    }
}

/// Removes a temporary file that no process has locked. A failure to remove it is ignored.
fn remove_if_abandoned(path: &Path) {
    if let Ok(file) = OpenOptions::new().write(true).open(path)
        && file.try_lock().is_ok()
    {
        let _ = fs::remove_file(path);
    }
}

/// Writes the names in a folder to the disk, where the system can be asked to do so.
fn sync_folder(folder: &Path) {
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}

/// Creates the folder with its parents and checks that files can be written into it.
///
/// # Errors
///
/// Returns the error of the file system, before any work was done.
pub fn create_writable_folder(folder: &Path) -> io::Result<()> {
    if folder.exists() && !folder.is_dir() {
        return Err(io::ErrorKind::NotADirectory.into());
    }
    fs::create_dir_all(folder)?;
    temporary_file_in(folder)?.close()
}

/// Checks that a file can be written at `path`, without touching a file that exists there, and
/// removes the temporary files next to it that a killed process left.
///
/// # Errors
///
/// Returns the error of the file system.
pub fn probe_writable(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    let folder = folder_of(path);
    temporary_file_in(folder)?.close()?;
    remove_abandoned(folder);
    Ok(())
}

/// Removes the temporary files that are being written: the last step before the process ends.
pub fn discard_pending() {
    discard(|_| true);
}

fn discard(chosen: impl Fn(&Path) -> bool) {
    let pending = PENDING.lock().unwrap_or_else(PoisonError::into_inner);
    for path in pending.iter().filter(|path| chosen(path)) {
        // Nothing is left to do about a file that cannot be removed.
        let _ = fs::remove_file(path);
    }
}

/// Keeps a temporary file in the list of pending ones for as long as it lives.
struct Pending(PathBuf);

impl Pending {
    fn register(path: &Path) -> Self {
        let mut pending = PENDING.lock().unwrap_or_else(PoisonError::into_inner);
        pending.push(path.to_path_buf());
        Self(path.to_path_buf())
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        let mut pending = PENDING.lock().unwrap_or_else(PoisonError::into_inner);
        pending.retain(|path| *path != self.0);
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// Makes a temporary file and locks it.
fn temporary_file_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    // Temporary files are private by default; the result is an ordinary file under the umask.
    #[cfg(unix)]
    let builder = {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666))
    };
    // The name of the temporary file, which nobody asked for, stays out of the error.
    fs::metadata(folder)?;
    loop {
        let file = builder
            .tempfile_in(folder)
            .map_err(|error| io::Error::from(error.kind()))?;
        match file.as_file().lock() {
            // Before the file was locked it looked abandoned, and may have been removed.
            Ok(()) if !file.path().exists() => {}
            Err(error) if error.kind() != io::ErrorKind::Unsupported => return Err(error),
            _ => return Ok(file),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder can be read");
        entries
            .map(|entry| entry.expect("the entry can be read").file_name())
            .map(|name| name.to_string_lossy().into_owned())
            .collect()
    }

    #[test]
    fn a_success_replaces_the_old_file_and_a_failure_leaves_it() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("image.png");
        write_atomically(&path, |writer| writer.write_all(b"old")).expect("written");
        write_atomically(&path, |writer| writer.write_all(b"new")).expect("written");
        let result = write_atomically(&path, |writer| {
            // A file that is being written stays.
            remove_abandoned(folder.path());
            assert_eq!(names(folder.path()).len(), 2);
            writer.write_all(b"half of the next")?;
            writer.flush()?;
            Err(io::Error::other("the disk is full"))
        });
        assert!(result.is_err(), "the failure is passed on");
        assert_eq!(fs::read(&path).expect("the file"), b"new");
        assert_eq!(names(folder.path()), ["image.png"]);
    }

    #[test]
    fn discarding_removes_what_is_being_written() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let result = write_atomically(&folder.path().join("image.png"), |writer| {
            writer.write_all(b"half")?;
            // Other tests write at the same time.
            discard(|path| path.starts_with(folder.path()));
            assert!(names(folder.path()).is_empty(), "the file is gone");
            Err(io::Error::other("killed"))
        });
        assert!(result.is_err(), "the failure is passed on");
        assert!(names(folder.path()).is_empty(), "nothing is left");
    }

    #[test]
    fn what_nobody_writes_any_more_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        for name in [".tem00-1.part", ".tem00-2.part", ".tem00-3", "a.part"] {
            fs::write(path(name), "half").expect("written");
        }
        fs::create_dir(path(".tem00-4.part")).expect("a folder");
        let other = File::open(path(".tem00-2.part")).expect("the file");
        other.lock().expect("locked");
        remove_abandoned(folder.path());
        let mut left = names(folder.path());
        left.sort();
        let others = [".tem00-2.part", ".tem00-3", ".tem00-4.part", "a.part"];
        assert_eq!(left, others);
        drop(other);
        probe_writable(&path("image.png")).expect("the folder can be written");
        assert!(!path(".tem00-2.part").exists(), "its writer has gone");
    }

    #[test]
    fn probing_touches_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        probe_writable(&folder.path().join("image.png")).expect("the folder can be written");
        assert!(names(folder.path()).is_empty(), "nothing is left");
        let refused = probe_writable(folder.path());
        assert!(refused.is_err(), "a folder is no file");
        let missing = folder.path().join("missing").join("image.png");
        let error = probe_writable(&missing).expect_err("the folder is missing");
        assert!(!error.to_string().contains(".tem00-"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_what_the_umask_allows() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_atomically(&ours, |writer| writer.write_all(b"x")).expect("the write succeeds");
        fs::write(&plain, "x").expect("the write succeeds");
        let mode = |path: &Path| fs::metadata(path).map(|found| found.permissions().mode());
        assert_eq!(mode(&ours).ok(), mode(&plain).ok());
    }
}
