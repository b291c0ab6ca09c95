use pyo3::prelude::*;

/// Pupil fields, patterns, stacks and their look-up.
#[pymodule(submodule)]
pub(crate) mod speckle {}
