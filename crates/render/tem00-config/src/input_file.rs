//! External files: regular files of a bounded size.

use std::{
    fs::{self, File, Metadata},
    io::{self, Read},
    path::Path,
};

use tem00_numerics::check_memory;

/// The maximum number of bytes of a document or of a file that it includes: 16 MiB.
pub const MAX_TEXT_BYTES: u64 = 16 << 20;

/// The maximum number of bytes of a mesh file, of a file with its data, and of a radiance map: 4
/// GiB.
pub const MAX_ASSET_BYTES: u64 = 4 << 30;

/// The name that stands for standard input where a text is read.
const STANDARD_INPUT: &str = "-";

/// The locations of the files that a document may name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FileAccess {
    /// Files that the document includes lie below its own folder, and the data of a glTF file below
    /// the folder of the glTF file, with symbolic links followed. Meshes and radiance maps may lie
    /// anywhere.
    #[default]
    WithinFolder,
    /// Files may be anywhere.
    Anywhere,
}

/// Opens a regular file of at most `max_bytes`.
///
/// Reading a device or a pipe might never end, and opening a pipe waits for a writer.
///
/// # Errors
///
/// Returns an error if the path is not a regular file, or if the file is longer or cannot be
/// opened.
pub fn open_input(path: &Path, max_bytes: u64) -> io::Result<File> {
    check(&fs::metadata(path)?, max_bytes)?;
    let file = File::open(path)?;
    // The file may have been replaced meanwhile.
    check(&file.metadata()?, max_bytes)?;
    Ok(file)
}

/// Reads a regular file of at most `max_bytes`.
///
/// # Errors
///
/// Returns the errors of [`open_input`], and an error if the file cannot be read or too little
/// memory is available.
pub fn read_input(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let file = open_input(path, max_bytes)?;
    check_memory(file.metadata()?.len())
        .map_err(|error| io::Error::new(io::ErrorKind::OutOfMemory, error))?;
    read_bounded(file, max_bytes)
}

/// Reads a text of [at most 16 MiB](MAX_TEXT_BYTES): a regular file, or standard input for the path
/// `-`.
pub(crate) fn read_text(path: &Path) -> io::Result<Vec<u8>> {
    if is_standard_input(path) {
        read_bounded(io::stdin().lock(), MAX_TEXT_BYTES)
    } else {
        read_input(path, MAX_TEXT_BYTES)
    }
}

/// Returns whether a path stands for standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new(STANDARD_INPUT)
}

/// Returns a text without the byte order mark of UTF-8 that some editors and spreadsheets put in
/// front of it.
pub fn without_byte_order_mark(content: &[u8]) -> &[u8] {
    content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content)
}

fn read_bounded(reader: impl Read, max_bytes: u64) -> io::Result<Vec<u8>> {
    let mut content = Vec::new();
    let read = reader.take(max_bytes + 1).read_to_end(&mut content)?;
    check_length(read as u64, max_bytes)?;
    Ok(content)
}

fn check(found: &Metadata, max_bytes: u64) -> io::Result<()> {
    if found.is_dir() {
        return Err(io::Error::new(
            io::ErrorKind::IsADirectory,
            "it is a directory",
        ));
    }
    if !found.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    check_length(found.len(), max_bytes)
}

fn check_length(bytes: u64, max_bytes: u64) -> io::Result<()> {
    if bytes <= max_bytes {
        return Ok(());
    }
    Err(io::Error::new(
        io::ErrorKind::FileTooLarge,
        format!("it exceeds the maximum of {} MiB", max_bytes >> 20),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(result: io::Result<Vec<u8>>) -> String {
        result.expect_err("it is refused").to_string()
    }

    #[test]
    fn a_file_has_at_most_the_bytes_that_are_allowed() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a");
        let file = File::create(&path).expect("a file");
        file.set_len(3 << 20).expect("a file without content");
        assert_eq!(
            read_input(&path, 3 << 20).expect("it is read").len(),
            3 << 20
        );
        let told = message(read_input(&path, (3 << 20) - 1));
        assert_eq!(told, "it exceeds the maximum of 2 MiB");
        let endless = message(read_bounded(io::repeat(b'a'), 1 << 20));
        assert_eq!(endless, "it exceeds the maximum of 1 MiB");
    }

    #[test]
    fn what_is_no_regular_file_is_refused() {
        let told = message(read_input(Path::new("."), 1));
        assert_eq!(told, "it is a directory");
        if cfg!(unix) {
            let told = message(read_input(Path::new("/dev/zero"), 1));
            assert_eq!(told, "it is not a regular file");
        }
    }
}
