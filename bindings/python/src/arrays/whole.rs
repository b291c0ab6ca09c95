use pyo3::{conversion::FromPyObjectOwned, exceptions::PyTypeError, intern, prelude::*};

use crate::error::refused;

/// A whole number of any size, as Python has it.
#[derive(Debug)]
pub(crate) struct Whole<'py>(Bound<'py, PyAny>);

impl<'py> FromPyObject<'_, 'py> for Whole<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let index = object.call_method0(intern!(object.py(), "__index__"));
        index.map(Self).map_err(|_| {
            let found = object.get_type();
            PyTypeError::new_err(format!("expected an integer, got {found}"))
        })
    }
}

impl<'py> Whole<'py> {
    /// Returns a count or a seed.
    pub(crate) fn unsigned<T: FromPyObjectOwned<'py>>(&self, name: &str) -> PyResult<T> {
        let allowed = match self.0.lt(0)? {
            true => "of 0 or more".to_owned(),
            false => format!("below 2**{}", 8 * size_of::<T>()),
        };
        self.extract_as(name, &allowed)
    }

    /// Returns a number of either sign.
    pub(crate) fn signed(&self, name: &str) -> PyResult<i64> {
        self.extract_as(name, "from -2**63 to 2**63 - 1")
    }

    fn extract_as<T: FromPyObjectOwned<'py>>(&self, name: &str, allowed: &str) -> PyResult<T> {
        self.0.extract().map_err(|_| {
            let message = format!("{name} must be a whole number {allowed}, got {}", self.0);
            refused(name, message)
        })
    }
}
