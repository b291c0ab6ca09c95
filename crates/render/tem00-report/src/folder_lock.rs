//! Lock of a folder, into which a single process writes at a time.

use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, Read, Seek, Write},
    path::{Path, PathBuf},
    thread::sleep,
    time::Duration,
};

/// The file in the folder that is locked. The operating system releases the lock when the process
/// ends, in any way.
const NAME: &str = ".tem00.lock";

/// The number of attempts at a shared lock, and the time between them. A process that takes the
/// lock first holds it alone for a moment, to write down the work that it shares.
const TRIES: u32 = 40;
const PAUSE: Duration = Duration::from_millis(25);

/// The right to write into a folder, for as long as it lives.
#[derive(Debug)]
pub struct FolderLock {
    path: PathBuf,
    /// The locked file; `None` where the file system has no locks.
    file: Option<File>,
}

/// The reason why a folder may not be written into.
#[derive(Debug)]
pub enum Refused {
    /// Another process uses it; its number, if it is known.
    InUse(Option<u32>),
    /// The file system refuses.
    Io(io::Error),
}

impl From<io::Error> for Refused {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl FolderLock {
    /// Locks a folder for this process alone.
    pub fn alone(folder: &Path) -> Result<Self, Refused> {
        Self::by_file(folder.join(NAME))
    }

    /// Locks for this process alone the resource that a file stands for; the file is created and
    /// removed.
    pub fn by_file(path: PathBuf) -> Result<Self, Refused> {
        loop {
            let mut file = open(&path)?;
            match file.try_lock() {
                Ok(()) if is_at(&file, &path) => {
                    write_holder(&mut file, "")?;
                    return Ok(Self::new(path, Some(file)));
                }
                // The file was removed between opening and locking it.
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(in_use(&mut file)),
                Err(TryLockError::Error(error)) => return without_lock(path, error),
            }
        }
    }

    /// Locks a folder for this process and others that do parts of the same `work`, a single line
    /// of text.
    pub fn shared(folder: &Path, work: &str) -> Result<Self, Refused> {
        let path = folder.join(NAME);
        for _ in 0..TRIES {
            let mut file = open(&path)?;
            match file.try_lock() {
                Ok(()) if is_at(&file, &path) => {
                    write_holder(&mut file, work)?;
                    file.unlock()?;
                }
                Ok(()) => continue,
                Err(TryLockError::WouldBlock) => {}
                Err(TryLockError::Error(error)) => return without_lock(path, error),
            }
            // Only a process that holds the lock alone writes to the file, so its content holds for
            // as long as the lock is shared.
            match file.try_lock_shared() {
                Ok(()) if !is_at(&file, &path) => {}
                Ok(()) if holder(&mut file).1 == work => return Ok(Self::new(path, Some(file))),
                Ok(()) => return Err(in_use(&mut file)),
                Err(TryLockError::WouldBlock) => sleep(PAUSE),
                Err(TryLockError::Error(error)) => return without_lock(path, error),
            }
        }
        Err(in_use(&mut open(&path)?))
    }

    const fn new(path: PathBuf, file: Option<File>) -> Self {
        Self { path, file }
    }

    /// Returns whether the file system has locks.
    pub const fn is_held(&self) -> bool {
        self.file.is_some()
    }
}

/// Removes the file, unless others share it.
impl Drop for FolderLock {
    fn drop(&mut self) {
        if let Some(file) = &self.file {
            // A file that stays does no harm: it is no longer locked.
            let alone = file.unlock().is_ok() && file.try_lock().is_ok();
            if alone && is_at(file, &self.path) {
                let _ = fs::remove_file(&self.path);
            }
        }
    }
}

/// Opens the file, or creates it if it is missing, without changing its content: it may be a link
/// to another file.
fn open(path: &Path) -> io::Result<File> {
    let plain = |error: io::Error| io::Error::from(error.kind());
    let mut options = OpenOptions::new();
    options.read(true).write(true);
    loop {
        match options.clone().create_new(true).open(path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            opened => return opened.map_err(plain),
        }
        match fs::symlink_metadata(path) {
            Ok(found) if !is_own(&found) => {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let message = format!("its {name} is a link or no regular file: remove it");
                return Err(io::Error::other(message));
            }
            // Removed between both.
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(plain(error)),
            _ => {}
        }
        match options.open(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            opened => return opened.map_err(plain),
        }
    }
}

/// Returns whether a file has only one name and lies where its path says.
#[cfg(unix)]
fn is_own(found: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    found.is_file() && found.nlink() == 1
}

#[cfg(not(unix))]
fn is_own(found: &fs::Metadata) -> bool {
    found.is_file()
}

/// Returns whether the open file is the file at `path` itself, and not another file to which a link
/// leads.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |found: fs::Metadata| (found.dev(), found.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(open), Ok(there)) => identity(open) == identity(there),
        _ => false,
    }
}

/// Elsewhere an open file cannot be replaced by another.
#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

/// Writes the number of this process, and the work that it shares.
fn write_holder(file: &mut File, work: &str) -> io::Result<()> {
    file.set_len(0)?;
    file.rewind()?;
    write!(file, "{}\n{work}\n", std::process::id())
}

/// Returns the number of the process that wrote into the file, and the work that it shares.
fn holder(file: &mut File) -> (Option<u32>, String) {
    const LONGEST: u64 = 256;
    let mut text = String::new();
    let read = file
        .rewind()
        .and_then(|()| file.take(LONGEST).read_to_string(&mut text));
    let mut lines = text.lines();
    let process = lines.next().and_then(|line| line.parse().ok());
    match read {
        Ok(_) => (process, lines.next().unwrap_or_default().to_owned()),
        Err(_) => (None, String::new()),
    }
}

fn in_use(file: &mut File) -> Refused {
    Refused::InUse(holder(file).0)
}

/// Continues without a lock where the file system has no locks.
fn without_lock(path: PathBuf, error: io::Error) -> Result<FolderLock, Refused> {
    if error.kind() == io::ErrorKind::Unsupported {
        return Ok(FolderLock::new(path, None));
    }
    Err(error.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lock_file(folder: &Path) -> bool {
        folder.join(NAME).exists()
    }

    #[test]
    fn a_folder_is_taken_once_and_given_back() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path();
        let held = FolderLock::alone(path).expect("nobody has it");
        let own = Some(std::process::id());
        for second in [FolderLock::alone(path), FolderLock::shared(path, "a")] {
            let is_refused = matches!(second, Err(Refused::InUse(process)) if process == own);
            assert!(is_refused, "{second:?}");
        }
        drop(held);
        assert!(!lock_file(path), "nothing is left");
        FolderLock::alone(path).expect("nobody has it any more");
    }

    #[test]
    fn parts_of_the_same_work_share_a_folder_and_others_do_not() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path();
        let first = FolderLock::shared(path, "a").expect("nobody has it");
        let second = FolderLock::shared(path, "a").expect("the same work");
        assert!(FolderLock::shared(path, "b").is_err(), "other work");
        assert!(FolderLock::alone(path).is_err(), "all of it");
        drop(first);
        assert!(lock_file(path), "the second still has it");
        assert!(FolderLock::alone(path).is_err(), "the second still has it");
        drop(second);
        assert!(!lock_file(path), "nothing is left");
        FolderLock::shared(path, "b").expect("nobody has it any more");
    }

    #[cfg(unix)]
    #[test]
    fn no_link_is_followed() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (own, name) = (folder.path().join("own"), folder.path().join("precious"));
        fs::create_dir(&own).expect("a folder");
        fs::write(&name, "precious").expect("written");
        let missing = folder.path().join("missing");
        let link = own.join(NAME);
        let links: [(&str, &dyn Fn() -> io::Result<()>); 4] = [
            ("to a file", &|| symlink(&name, &link)),
            ("to nothing", &|| symlink(&missing, &link)),
            ("a second name", &|| fs::hard_link(&name, &link)),
            ("a folder", &|| fs::create_dir(&link)),
        ];
        for (kind, make) in links {
            make().expect("made");
            for taken in [FolderLock::alone(&own), FolderLock::shared(&own, "a")] {
                assert!(matches!(&taken, Err(Refused::Io(_))), "{kind}: {taken:?}");
            }
            assert_eq!(fs::read(&name).expect("read"), b"precious", "{kind}");
            assert!(!missing.exists(), "{kind}");
            fs::remove_file(&link)
                .or_else(|_| fs::remove_dir(&link))
                .expect("removed");
        }
    }

    #[test]
    fn what_a_killed_process_leaves_hinders_nobody() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join(NAME), "4000000000\nb\n").expect("written");
        FolderLock::alone(folder.path()).expect("nobody has it");
        fs::write(folder.path().join(NAME), [0xff; 300]).expect("written");
        FolderLock::shared(folder.path(), "a").expect("nobody has it");
    }
}
