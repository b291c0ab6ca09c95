//! Errors of files as exceptions of Python.

use std::io;

use pyo3::prelude::*;
use tem00_speckle::StackFileError;

use crate::error::{IntoPython, refused};

/// `?` for results of reading a file.
pub(crate) trait OrRaiseFile<T> {
    /// Returns the value, or the error as an exception: `OSError` if the file could not be read,
    /// `MemoryError` for want of memory, else one that names the argument `file`.
    fn or_raise_file(self) -> PyResult<T>;
}

impl<T> OrRaiseFile<T> for Result<T, StackFileError> {
    fn or_raise_file(self) -> PyResult<T> {
        self.map_err(|error| match error {
            StackFileError::Io(error) => raised(error),
            StackFileError::Stack(error) => error.into_python(),
            other => refused("file", other.to_string()),
        })
    }
}

fn raised(error: io::Error) -> PyErr {
    error.into()
}
