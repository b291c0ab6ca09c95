use core::fmt;
use std::{error, io};

/// Error of reading a NumPy file.
#[derive(Debug)]
#[non_exhaustive]
pub enum NpyError {
    /// The file is not a NumPy file.
    Foreign,
    /// The version of the format is unknown.
    Version {
        /// The number before the point.
        major: u8,
        /// The number after the point.
        minor: u8,
    },
    /// The header breaks a rule of the format: the rule.
    Header(&'static str),
    /// The file ends before the array does.
    Truncated,
    /// The values are of another type.
    ElementType {
        /// The type as the file names it.
        found: String,
        /// The types that are allowed.
        allowed: &'static str,
    },
    /// The array does not have two dimensions, or has no values.
    Shape(Vec<u64>),
    /// A value is not finite, or too large for single precision.
    NotFinite {
        /// Row and column of the value.
        index: [usize; 2],
    },
    /// The array takes more memory than allowed.
    MemoryLimit {
        /// The bytes that the array takes while it is read.
        needed: u64,
        /// The bytes that it may take.
        limit: u64,
    },
    /// The machine refused the memory of the array.
    Memory {
        /// The bytes that were asked for.
        bytes: u64,
    },
    /// The reader failed.
    Io(io::Error),
}

impl fmt::Display for NpyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign => write!(f, "not a NumPy file (NPY)"),
            Self::Version { major, minor } => write!(
                f,
                "version of the NPY format must be 1.0, 2.0 or 3.0, got {major}.{minor}"
            ),
            Self::Header(rule) => write!(f, "header of the NPY file: {rule}"),
            Self::Truncated => write!(f, "NPY file ends before its array does"),
            Self::ElementType { found, allowed } => {
                write!(f, "values must be {allowed}, got the type {found}")
            }
            Self::Shape(shape) => write!(
                f,
                "array must have 2 dimensions of at least 1 each, got the shape {shape:?}"
            ),
            Self::NotFinite { index } => write!(
                f,
                "values must be finite and below 3.4e38, got another at the index {index:?}"
            ),
            Self::MemoryLimit { needed, limit } => write!(
                f,
                "memory for the array must be at most {limit} bytes, got {needed}"
            ),
            Self::Memory { bytes } => write!(f, "memory for the array refused: {bytes} bytes"),
            Self::Io(error) => write!(f, "file could not be read: {error}"),
        }
    }
}

impl error::Error for NpyError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for NpyError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Self::Truncated,
            _ => Self::Io(error),
        }
    }
}
