//! Files that appear whole or not at all.

use std::{
    fs::{self, File},
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use tempfile::NamedTempFile;

/// Temporary files that are being written now.
static PENDING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Writes the file `path` by `write`, so that nobody ever sees half of it.
///
/// The content goes to a temporary file in the same folder, which takes the name `path` only when
/// it is complete. If `write` fails the temporary file is removed and what stood at `path` before
/// stays as it was.
///
/// # Errors
///
/// Returns the error of `write` or of the file system.
pub(crate) fn write_atomically<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    let temporary = temporary_file_beside(path)?;
    let _pending = Pending::register(temporary.path());
    let mut writer = BufWriter::new(temporary.reopen()?);
    write(&mut writer)?;
    writer.flush()?;
    drop(writer);
    temporary.persist(path).map_err(|failed| failed.error)?;
    Ok(())
}

/// Creates the folder with its parents and makes sure that files can be written into it.
///
/// # Errors
///
/// Returns the error of the file system, before any work was done.
pub(crate) fn create_writable_folder(folder: &Path) -> io::Result<()> {
    if folder.exists() && !folder.is_dir() {
        return Err(io::ErrorKind::NotADirectory.into());
    }
    fs::create_dir_all(folder)?;
    temporary_file_in(folder)?.close()
}

/// Makes sure that a file can be written at `path`, without touching what stands there.
///
/// # Errors
///
/// Returns the error of the file system.
pub(crate) fn probe_writable(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    temporary_file_beside(path)?.close()
}

/// Removes the temporary files that are being written: the last act before the process is ended.
pub(crate) fn discard_pending() {
    let pending = PENDING.lock().unwrap_or_else(PoisonError::into_inner);
    for path in pending.iter() {
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

fn temporary_file_beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    temporary_file_in(folder.unwrap_or_else(|| Path::new(".")))
}

fn temporary_file_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".tem00-").suffix(".part");
    // Temporary files are private by default; the result is an ordinary file under the umask.
    #[cfg(unix)]
    let builder = {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666))
    };
    // The name of the temporary file, which nobody asked for, stays out of the error.
    fs::metadata(folder)?;
    builder
        .tempfile_in(folder)
        .map_err(|error| error.kind().into())
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
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("image.png");
        fs::write(&path, "old").expect("the old file");

        let result = write_atomically(&path, |writer| {
            writer.write_all(b"half of the new")?;
            writer.flush()?;
            Err(io::Error::other("the disk is full"))
        });

        assert!(result.is_err(), "the failure is passed on");
        assert_eq!(fs::read(&path).expect("the old file"), b"old");
        assert_eq!(names(folder.path()), ["image.png"]);
    }

    #[test]
    fn a_success_replaces_the_old_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("image.png");
        fs::write(&path, "old").expect("the old file");

        write_atomically(&path, |writer| writer.write_all(b"new")).expect("the write succeeds");

        assert_eq!(fs::read(&path).expect("the new file"), b"new");
        assert_eq!(names(folder.path()), ["image.png"]);
    }

    #[test]
    fn discarding_removes_what_is_being_written() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let result = write_atomically(&folder.path().join("image.png"), |writer| {
            writer.write_all(b"half")?;
            discard_pending();
            assert!(
                names(folder.path()).is_empty(),
                "the temporary file is gone"
            );
            Err(io::Error::other("killed"))
        });
        assert!(result.is_err(), "the failure is passed on");
        assert!(names(folder.path()).is_empty(), "nothing is left");
    }

    #[test]
    fn probing_touches_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        probe_writable(&folder.path().join("image.png")).expect("the folder can be written");
        assert!(names(folder.path()).is_empty(), "nothing is left");
        assert!(
            probe_writable(folder.path()).is_err(),
            "a folder is no file"
        );
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
