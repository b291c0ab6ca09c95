use core::slice;

use numpy::{
    Element, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    prelude::*,
    types::{PyFloat, PyInt},
};

use super::results::check_copy;
use crate::error::refused;

/// A number, or an array of real numbers of any shape, as an argument of a function.
///
/// Arrays that are not in `float64`, row by row, are copied. What is not a number (text, truth
/// values, complex numbers) is a `TypeError`, which names the argument.
#[derive(Debug)]
pub(crate) enum Numbers<'py> {
    /// A number.
    One(f64),
    /// An array, aligned and row by row.
    Array(PyReadonlyArrayDyn<'py, f64>),
}

/// An array of one axis: the components of a vector, or a list.
pub(crate) type Components<'py> = Numbers<'py>;

/// An array whose last axes hold vectors.
pub(crate) type Vectors<'py> = Numbers<'py>;

impl<'py> FromPyObject<'_, 'py> for Numbers<'py> {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(number) = argument.cast::<PyFloat>() {
            return Ok(Self::One(number.value()));
        }
        if let Ok(number) = argument.cast_exact::<PyInt>() {
            return Ok(Self::One(number.extract()?));
        }
        Ok(Self::Array(row_by_row(&argument, b"iuf")?))
    }
}

impl Numbers<'_> {
    /// Returns all values, row by row.
    pub(crate) fn values(&self) -> PyResult<&[f64]> {
        match self {
            Self::One(number) => Ok(slice::from_ref(number)),
            Self::Array(array) => Ok(array.as_slice()?),
        }
    }

    /// Returns the lengths of the axes.
    pub(crate) fn shape(&self) -> &[usize] {
        match self {
            Self::One(_) => &[],
            Self::Array(array) => array.shape(),
        }
    }

    /// Returns all values, row by row, where they are finite.
    ///
    /// # Errors
    ///
    /// Refuses the argument of this name if one is not.
    pub(crate) fn finite(&self, name: &'static str) -> PyResult<&[f64]> {
        let values = self.values()?;
        match values.iter().find(|value| !value.is_finite()) {
            Some(value) => Err(refused(
                name,
                format!("{name} is {value}, but must be finite everywhere"),
            )),
            None => Ok(values),
        }
    }

    /// Checks that all values are 0 or more.
    ///
    /// # Errors
    ///
    /// Refuses the argument of this name if one is not.
    pub(crate) fn not_negative(&self, name: &'static str) -> PyResult<()> {
        self.check(name, "0 or more", |value| value >= 0.0)
    }

    /// Checks that all values are positive.
    ///
    /// # Errors
    ///
    /// Refuses the argument of this name if one is not.
    pub(crate) fn positive(&self, name: &'static str) -> PyResult<()> {
        self.check(name, "positive", |value| value > 0.0)
    }

    /// Checks that all values are as the words of `allowed` say.
    ///
    /// # Errors
    ///
    /// Refuses the argument of this name if one is not.
    pub(crate) fn check(
        &self,
        name: &'static str,
        allowed: &str,
        is_allowed: impl Fn(f64) -> bool,
    ) -> PyResult<()> {
        match self.values()?.iter().find(|&&value| !is_allowed(value)) {
            Some(bad) => Err(refused(
                name,
                format!("{name} must be {allowed}, got {bad:?}"),
            )),
            None => Ok(()),
        }
    }

    /// Returns a vector of `K` finite components.
    ///
    /// # Errors
    ///
    /// Refuses the argument of this name if it has another shape or a component that is not finite.
    pub(crate) fn vector<const K: usize>(&self, name: &'static str) -> PyResult<[f64; K]> {
        if self.shape() != [K] {
            let shape = self.shape();
            let message = format!("{name} has the shape {shape:?}, but must have [{K}]");
            return Err(refused(name, message));
        }
        self.finite(name)?
            .try_into()
            .map_err(|_| PyValueError::new_err("a component is missing"))
    }
}

/// Returns a length in metres that is positive and finite.
///
/// # Errors
///
/// Refuses the argument of this name if it is not.
pub(crate) fn length(name: &'static str, value: f64) -> PyResult<f64> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    let message = format!("{name} must be positive and finite, got {value:?} m");
    Err(refused(name, message))
}

/// Returns an array of `T` that is aligned and lies in memory row by row: the argument itself where
/// it is one, else a copy. `kinds` are NumPy's letters for the kinds of numbers that are allowed.
/// Masked elements are a `ValueError`: the memory behind them holds anything.
pub(super) fn row_by_row<'py, T: Element>(
    argument: &Bound<'py, PyAny>,
    kinds: &[u8],
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let py = argument.py();
    let numpy = py.import("numpy")?;
    if !argument.is_exact_instance_of::<PyUntypedArray>() && argument.hasattr("mask")? {
        let masks = numpy.getattr("ma")?;
        if masks.call_method1("is_masked", (argument,))?.is_truthy()? {
            let message = "some elements are masked: pass its `compressed()` or `filled(…)`";
            return Err(PyValueError::new_err(message));
        }
    }
    if let Ok(array) = argument.cast::<PyArrayDyn<T>>()
        && array.is_c_contiguous()
        && array.is_aligned()
    {
        return Ok(array.try_readonly()?);
    }
    let any = numpy.call_method1("asarray", (argument,))?;
    let dtype = any.cast::<PyUntypedArray>()?.dtype();
    if !kinds.contains(&dtype.kind()) {
        let message = format!("expected numbers, got {dtype}");
        return Err(PyTypeError::new_err(message));
    }
    // A broadcast array has more elements than bytes.
    check_copy(any.cast::<PyUntypedArray>()?.shape(), size_of::<T>())?;
    let wanted = (any, numpy::dtype::<T>(py), ["C_CONTIGUOUS", "ALIGNED"]);
    let array = numpy.call_method1("require", wanted)?;
    Ok(array.cast::<PyArrayDyn<T>>()?.try_readonly()?)
}
