use core::fmt;
use std::{error, io};

use crate::SpeckleError;

/// Why a stack could not be read from a file.
#[derive(Debug)]
#[non_exhaustive]
pub enum StackFileError {
    /// The file does not begin like a stack.
    Foreign,
    /// The file is of a version that came after this library.
    Newer {
        /// The version of the file.
        version: u32,
    },
    /// The file ends before the stack does.
    Truncated,
    /// The bytes are not those that were written.
    Damaged,
    /// An entry of the header has a value without a meaning.
    Entry {
        /// The name of the entry.
        name: &'static str,
        /// The rejected value.
        value: u64,
    },
    /// The header describes a stack that cannot be.
    Stack(SpeckleError),
    /// The reader failed.
    Io(io::Error),
}

impl fmt::Display for StackFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign => write!(f, "file must be a speckle stack, got something else"),
            Self::Newer { version } => write!(
                f,
                "file version must be at most {}, got {version}: written by a newer library",
                super::fixed::VERSION
            ),
            Self::Truncated => write!(f, "file must hold all of the stack, got a part of it"),
            Self::Damaged => write!(f, "file must be as it was written, got other bytes"),
            Self::Entry { name, value } => {
                write!(
                    f,
                    "{name} in the header of the file must have a meaning, got {value}"
                )
            }
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
