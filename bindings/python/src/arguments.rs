//! Arguments of Python as values of the library.

use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    prelude::*,
};
use tem00_decorrelation::{DMat3, DVec2, DVec3};
use tem00_numerics::Grid;

use crate::{
    arrays::{Numbers, Pixel, Whole, image},
    error::refused,
};

/// A value of the library that an argument of Python gives.
pub(crate) trait Take<'py>: Sized {
    /// Returns the value of the argument `name`.
    ///
    /// # Errors
    ///
    /// Refuses by its name what is no such value, and by a `TypeError` what is of another kind.
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self>;
}

/// Returns an argument as an object of a class.
pub(crate) fn object<'a, 'py, T: pyo3::PyClass>(
    given: &'a Bound<'py, PyAny>,
    name: &str,
) -> PyResult<&'a Bound<'py, T>> {
    given.cast().map_err(|error| kind(name, PyErr::from(error)))
}

/// Names the argument in the `TypeError` or `ValueError` of something that is read without a name.
pub(crate) fn kind(name: &str, error: PyErr) -> PyErr {
    Python::attach(|py| {
        let message = format!("argument '{name}': {}", error.value(py));
        if error.is_instance_of::<PyTypeError>(py) {
            PyTypeError::new_err(message)
        } else if error.get_type(py).is(py.get_type::<PyValueError>()) {
            refused(name, message)
        } else {
            error
        }
    })
}

/// Returns the value of an argument that may be left out.
pub(crate) fn optional<'py, T: Take<'py>>(
    given: Option<Bound<'py, PyAny>>,
    name: &'static str,
) -> PyResult<Option<T>> {
    given.map(|given| T::take(&given, name)).transpose()
}

/// Extracts an argument.
pub(crate) fn extracted<'a, 'py, T: FromPyObject<'a, 'py>>(
    given: &'a Bound<'py, PyAny>,
    name: &str,
) -> PyResult<T> {
    T::extract(given.as_borrowed()).map_err(|error| kind(name, error.into()))
}

/// A number. One by the name `wavelength` must be a wavelength of light, and not one in nanometres.
impl<'py> Take<'py> for f64 {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        let value = extracted(given, name)?;
        if name != "wavelength" || (10e-9..=1e-3).contains(&value) {
            return Ok(value);
        }
        let message = format!("{name} must be from 10 nm to 1 mm, in metres, got {value:?} m");
        Err(refused(name, message))
    }
}

impl<'py> Take<'py> for Numbers<'py> {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        extracted(given, name)
    }
}

impl<'py> Take<'py> for Option<f64> {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        extracted(given, name)
    }
}

/// A list of numbers.
impl<'py> Take<'py> for Vec<f64> {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        let numbers: Numbers<'_> = extracted(given, name)?;
        match numbers.shape() {
            [_] => Ok(numbers.values()?.to_vec()),
            shape => {
                let message = format!("{name} must have one axis, but has the shape {shape:?}");
                Err(refused(name, message))
            }
        }
    }
}

impl<'py, const K: usize> Take<'py> for [f64; K] {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        extracted::<Numbers<'_>>(given, name)?.vector(name)
    }
}

impl<'py> Take<'py> for DVec2 {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        Ok(<[f64; 2]>::take(given, name)?.into())
    }
}

impl<'py> Take<'py> for DVec3 {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        Ok(<[f64; 3]>::take(given, name)?.into())
    }
}

/// Rows of three numbers.
impl<'py, const N: usize> Take<'py> for [DVec3; N] {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        let numbers: Numbers<'_> = extracted(given, name)?;
        let values = numbers.finite(name)?;
        if numbers.shape() == [N, 3] {
            return Ok(core::array::from_fn(|i| {
                DVec3::from_slice(&values[3 * i..])
            }));
        }
        let shape = numbers.shape();
        let message = format!("{name} has the shape {shape:?}, but must have [{N}, 3]");
        Err(refused(name, message))
    }
}

impl<'py> Take<'py> for DMat3 {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        // Rows of NumPy are columns of the transpose.
        let [x, y, z] = <[DVec3; 3]>::take(given, name)?;
        Ok(Self::from_cols(x, y, z).transpose())
    }
}

/// Samples in any shape.
pub(crate) struct Samples(pub(crate) Vec<f64>);

impl<'py> Take<'py> for Samples {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        Ok(Self(
            extracted::<Numbers<'_>>(given, name)?.values()?.to_vec(),
        ))
    }
}

/// An image as an array [row, column].
impl<'py, S: Pixel> Take<'py> for Grid<S> {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        image(given, name)
    }
}

macro_rules! counts {
    ($($count:ty),+) => {$(
        impl<'py> Take<'py> for $count {
            fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
                extracted::<Whole<'_>>(given, name)?.unsigned(name)
            }
        }

        /// A width and a height, or any two counts.
        impl<'py> Take<'py> for [$count; 2] {
            fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
                let [x, y]: [Whole<'_>; 2] = extracted(given, name)?;
                Ok([x.unsigned(name)?, y.unsigned(name)?])
            }
        }
    )+};
}

counts!(u32, u64, usize);

/// Defines choices that Python names by strings.
macro_rules! choices {
    ($($type:ty: $($choice:literal = $value:expr),+;)+) => {$(
        impl<'py> $crate::arguments::Take<'py> for $type {
            fn take(
                given: &pyo3::Bound<'py, pyo3::PyAny>,
                name: &'static str,
            ) -> pyo3::PyResult<Self> {
                match $crate::arguments::extracted::<String>(given, name)?.as_str() {
                    $($choice => Ok($value),)+
                    other => {
                        let allowed = [$($choice),+].join("', '");
                        let message = format!("{name} must be one of '{allowed}', got '{other}'");
                        Err($crate::error::refused(name, message))
                    }
                }
            }
        }
    )+};
}

pub(crate) use choices;
