use pyo3::prelude::*;

/// Closed forms of speckle theory, estimators and hypothesis tests.
#[pymodule(submodule)]
pub(crate) mod statistics {}
