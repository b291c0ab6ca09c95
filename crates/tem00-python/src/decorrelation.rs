use pyo3::prelude::*;

/// Imaging geometry, and how speckle moves and changes.
#[pymodule(submodule)]
pub(crate) mod decorrelation {}
