use pyo3::{
    PyErr,
    exceptions::{PyMemoryError, PyTypeError, PyValueError},
    prelude::*,
};
use tem00_numerics::Refusal;
use tem00_shading::ShadingError;
use tem00_speckle::SpeckleError;
use tem00_statistics::StatisticsError;

pyo3::create_exception!(
    tem00,
    ParameterError,
    PyValueError,
    "A parameter lies outside what is allowed.\n\nThe message names it, its value and what is \
     allowed; the attribute ``parameter`` is its name."
);

/// The exception that refuses `parameter`.
pub(crate) fn refused(parameter: &str, message: String) -> PyErr {
    let error = ParameterError::new_err(message);
    Python::attach(|py| match error.value(py).setattr("parameter", parameter) {
        Ok(()) => error.clone_ref(py),
        Err(other) => other,
    })
}

/// The exception for a class that is called, but made otherwise.
pub(crate) fn unmade(class: &str, by: &str) -> PyErr {
    PyTypeError::new_err(format!("{class}(…) makes nothing: it is made by {by}"))
}

/// The parameter that an exception refuses, if it does.
fn parameter_of(error: &PyErr) -> Option<String> {
    Python::attach(|py| error.value(py).getattr("parameter").ok()?.extract().ok())
}

/// Exceptions of Python for the errors of the physics crates.
pub(crate) trait IntoPython {
    /// Returns the exception.
    fn into_python(self) -> PyErr;
}

impl IntoPython for PyErr {
    fn into_python(self) -> PyErr {
        self
    }
}

impl IntoPython for Refusal {
    fn into_python(self) -> PyErr {
        refused(self.parameter(), self.to_string())
    }
}

impl IntoPython for StatisticsError {
    fn into_python(self) -> PyErr {
        refused(self.parameter(), self.to_string())
    }
}

impl IntoPython for SpeckleError {
    fn into_python(self) -> PyErr {
        match self {
            Self::MemoryLimit { .. } | Self::Memory { .. } => {
                PyMemoryError::new_err(self.to_string())
            }
            _ => refused(self.parameter(), self.to_string()),
        }
    }
}

impl IntoPython for ShadingError {
    fn into_python(self) -> PyErr {
        match self {
            Self::Speckle(SpeckleError::MemoryLimit { .. }) => {
                PyMemoryError::new_err(self.to_string())
            }
            Self::Speckle(source) => source.into_python(),
            Self::BeyondPoses { .. } => refused("surface", self.to_string()),
            _ => refused(self.parameter().unwrap_or("camera"), self.to_string()),
        }
    }
}

/// `?` for results of the physics crates.
pub(crate) trait OrRaise<T> {
    /// Returns the value, or the error as an exception.
    fn or_raise(self) -> PyResult<T>;

    /// Raises for a function of one argument, whatever name the error has; otherwise as
    /// [`or_raise`](Self::or_raise).
    fn or_raise_of(self, argument: &'static str) -> PyResult<T>;

    /// Raises for a function whose argument `to` has another name in the error, one of `from`;
    /// otherwise as [`or_raise`](Self::or_raise).
    fn or_raise_renamed(self, from: &[&str], to: &'static str) -> PyResult<T>;
}

impl<T, E: IntoPython> OrRaise<T> for Result<T, E> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(IntoPython::into_python)
    }

    fn or_raise_of(self, argument: &'static str) -> PyResult<T> {
        self.or_raise().map_err(|error| match parameter_of(&error) {
            Some(name) if name != argument => renamed(&error, argument),
            _ => error,
        })
    }

    fn or_raise_renamed(self, from: &[&str], to: &'static str) -> PyResult<T> {
        self.or_raise().map_err(|error| match parameter_of(&error) {
            Some(name) if from.contains(&name.as_str()) => renamed(&error, to),
            _ => error,
        })
    }
}

/// The refusal of the argument `to` by the message of another.
fn renamed(error: &PyErr, to: &'static str) -> PyErr {
    let message = Python::attach(|py| error.value(py).to_string());
    refused(to, format!("{to}: {message}"))
}
