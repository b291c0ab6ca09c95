//! How objects travel between processes.

use pyo3::prelude::*;

/// A function and its arguments, from which pickle makes an object again.
pub(super) type Reduced<'py, Arguments> = (Bound<'py, PyAny>, Arguments);
