use std::io;

use thiserror::Error;

/// Error of reading a NumPy file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NpyError {
    /// The file is not a NumPy file.
    #[error("not a NumPy file (NPY)")]
    Foreign,
    /// The version of the format is unknown: the numbers before and after the point.
    #[error("version of the NPY format must be 1.0, 2.0 or 3.0, got {0}.{1}")]
    Version(u8, u8),
    /// The header breaks a rule of the format: the rule.
    #[error("header of the NPY file: {0}")]
    Header(String),
    /// The file ends before the array does.
    #[error("NPY file ends before its array does")]
    Truncated,
    /// The values are of another type.
    #[error("values must be {allowed}, got the type {found}")]
    ElementType {
        /// The type as the file names it.
        found: String,
        /// The types that are allowed.
        allowed: &'static str,
    },
    /// The array does not have two dimensions, or has no values.
    #[error("array must have 2 dimensions of at least 1 each, got the shape {0:?}")]
    Shape(Vec<u64>),
    /// A value is not finite, or too large for single precision: its row and column.
    #[error("values must be finite and below 3.4e38, got another at the index {0:?}")]
    NotFinite([usize; 2]),
    /// The array takes more memory than allowed.
    #[error("memory for the array must be at most {limit} bytes, got {needed}")]
    MemoryLimit {
        /// The bytes that the array takes while it is read.
        needed: u64,
        /// The bytes that it may take.
        limit: u64,
    },
    /// The memory of the array, of this number of bytes, could not be allocated.
    #[error("memory for the array refused: {0} bytes")]
    Memory(u64),
    /// The reader failed.
    #[error("file could not be read: {0}")]
    Io(#[source] io::Error),
}

impl From<io::Error> for NpyError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Self::Truncated,
            _ => Self::Io(error),
        }
    }
}
