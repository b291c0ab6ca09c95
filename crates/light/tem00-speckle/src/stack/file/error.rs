use core::fmt;
use std::{error, io};

use crate::SpeckleError;

/// Error of reading a stack from a file.
#[derive(Debug)]
#[non_exhaustive]
pub enum StackFileError {
    /// The file is not the file of a stack.
    Foreign,
    /// The file is of a version that came after this library.
    Newer {
        /// The version of the file.
        version: u32,
        /// The newest version that this library reads.
        newest: u32,
    },
    /// The file ends before the stack does.
    Truncated,
    /// The bytes are not those that were written.
    Damaged,
    /// An entry of the header is outside its range.
    OutOfRange {
        /// The name of the entry.
        parameter: &'static str,
        /// The rejected value.
        value: u64,
        /// The allowed values.
        allowed: &'static str,
    },
    /// The header describes an impossible stack.
    Stack(SpeckleError),
    /// The reader failed.
    Io(io::Error),
}

impl fmt::Display for StackFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign => write!(f, "not the file of a speckle stack"),
            Self::Newer { version, newest } => write!(
                f,
                "file version must be at most {newest}, got {version}: written by a newer library"
            ),
            Self::Truncated => write!(f, "file ends before its stack does"),
            Self::Damaged => write!(
                f,
                "file has changed since it was written: its checksum is another"
            ),
            Self::OutOfRange {
                parameter,
                value,
                allowed,
            } => write!(
                f,
                "{parameter} in the header of the file must be {allowed}, got {value}"
            ),
            Self::Stack(error) => write!(f, "stack in the file: {error}"),
            Self::Io(error) => write!(f, "file could not be read: {error}"),
        }
    }
}

impl error::Error for StackFileError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            Self::Stack(error) => Some(error),
            Self::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<SpeckleError> for StackFileError {
    fn from(error: SpeckleError) -> Self {
        Self::Stack(error)
    }
}

impl From<io::Error> for StackFileError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Self::Truncated,
            _ => Self::Io(error),
        }
    }
}
