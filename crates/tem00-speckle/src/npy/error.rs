use core::fmt;
use std::{error, io};

use crate::SpeckleError;

/// Why a NumPy file could not be read.
#[derive(Debug)]
#[non_exhaustive]
pub enum NpyError {
    /// The file does not begin like one of NumPy's.
    Foreign,
    /// The file is of an unknown version of the format.
    Version {
        /// The number before the point.
        major: u8,
        /// The number after the point.
        minor: u8,
    },
    /// The header does not say what it must: what is missing or wrong.
    Header(&'static str),
    /// The file ends before the array does.
    Truncated,
    /// The values are of another type.
    ElementType {
        /// The type as the file names it.
        found: String,
        /// The types that are allowed, in words.
        allowed: &'static str,
    },
    /// The array has another number of dimensions.
    Dimensions {
        /// The shape of the array.
        shape: Vec<u64>,
        /// The number of dimensions that it must have.
        needed: usize,
    },
    /// The array has no values.
    Empty {
        /// The shape of the array.
        shape: Vec<u64>,
    },
    /// The slices of a stack are more, fewer or of another size.
    Slices {
        /// The shape of the array.
        shape: Vec<u64>,
        /// The shape that it must have: slices, height, width.
        needed: [usize; 3],
    },
    /// A value is not finite, or too large for single precision.
    NotFinite {
        /// Where it stands, as NumPy counts: row and column, after the slice if there are any.
        index: Vec<usize>,
    },
    /// The mean square of a slice is far from 1.
    Brightness {
        /// The position of the slice.
        slice: usize,
        /// The mean square of its amplitude.
        mean: f64,
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
    /// A stack along that path cannot be.
    Stack(SpeckleError),
    /// The reader failed.
    Io(io::Error),
}

impl fmt::Display for NpyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign => write!(f, "file must be one of NumPy's (NPY), got something else"),
            Self::Version { major, minor } => write!(
                f,
                "version of the NPY format must be 1.0, 2.0 or 3.0, got {major}.{minor}"
            ),
            Self::Header(problem) => write!(f, "header of the NPY file: {problem}"),
            Self::Truncated => write!(f, "NPY file must hold all of its array, got a part of it"),
            Self::ElementType { found, allowed } => {
                write!(f, "values must be {allowed}, got the type {found}")
            }
            Self::Dimensions { shape, needed } => {
                write!(
                    f,
                    "array must have {needed} dimensions, got the shape {shape:?}"
                )
            }
            Self::Empty { shape } => {
                write!(f, "array must have values, got the shape {shape:?}")
            }
            Self::Slices { shape, needed } => write!(
                f,
                "array must have the shape {needed:?} (slices, height, width), got {shape:?}"
            ),
            Self::NotFinite { index } => write!(
                f,
                "values must be finite and below 3.4e38, got another at the index {index:?}"
            ),
            Self::Brightness { slice, mean } => write!(
                f,
                "mean square of each slice must be 0.1 to 10, got {mean:e} in slice {slice}: divide \
                 the amplitude by its root"
            ),
            Self::MemoryLimit { needed, limit } => write!(
                f,
                "memory for the array must be at most {limit} bytes, got {needed}"
            ),
            Self::Memory { bytes } => write!(f, "memory for the array refused: {bytes} bytes"),
            Self::Stack(error) => write!(f, "stack of the array: {error}"),
            Self::Io(error) => write!(f, "file could not be read: {error}"),
        }
    }
}

impl error::Error for NpyError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            Self::Stack(error) => Some(error),
            Self::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<SpeckleError> for NpyError {
    fn from(error: SpeckleError) -> Self {
        Self::Stack(error)
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
