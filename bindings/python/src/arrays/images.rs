use numpy::{
    Complex32, Complex64, Element, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods,
    PyReadonlyArrayDyn, PyUntypedArrayMethods,
};
use pyo3::{exceptions::PyMemoryError, prelude::*};
use tem00_numerics::{Grid, cast::to_f32};

use super::numbers::row_by_row;
use crate::error::refused;

/// An image as an argument: a two-dimensional array [row, column] of real numbers.
#[derive(Debug)]
pub(crate) struct Image<'py>(Pixels<'py, f32, f64>);

/// A complex image as an argument: a two-dimensional array [row, column] of numbers.
#[derive(Debug)]
pub(crate) struct ComplexImage<'py>(Pixels<'py, Complex32, Complex64>);

/// Pixels as they are stored, or in the precision of everything else.
#[derive(Debug)]
enum Pixels<'py, S: Element, D: Element> {
    Single(PyReadonlyArrayDyn<'py, S>),
    Double(PyReadonlyArrayDyn<'py, D>),
}

impl<'py, S: Element, D: Element> Pixels<'py, S, D> {
    fn of(argument: &Bound<'py, PyAny>, kinds: &[u8]) -> PyResult<Self> {
        Ok(if argument.cast::<PyArrayDyn<S>>().is_ok() {
            Self::Single(row_by_row(argument, kinds)?)
        } else {
            Self::Double(row_by_row(argument, kinds)?)
        })
    }

    /// Copies the pixels into a grid.
    fn grid(
        &self,
        name: &'static str,
        single: impl Fn(&D) -> S,
        is_finite: impl Fn(&S) -> bool,
    ) -> PyResult<Grid<S>>
    where
        S: Copy,
    {
        match self {
            Self::Single(array) => {
                let values = array.as_slice()?.iter().copied();
                grid(name, array.shape(), values, is_finite)
            }
            Self::Double(array) => {
                let values = array.as_slice()?.iter().map(single);
                grid(name, array.shape(), values, is_finite)
            }
        }
    }
}

fn grid<S>(
    name: &'static str,
    shape: &[usize],
    values: impl ExactSizeIterator<Item = S>,
    is_finite: impl Fn(&S) -> bool,
) -> PyResult<Grid<S>> {
    let &[height, width] = shape else {
        let message = format!("{name} has the shape {shape:?}, but must have two axes");
        return Err(refused(name, message));
    };
    let mut pixels = Vec::new();
    pixels
        .try_reserve_exact(values.len())
        .map_err(|error| PyMemoryError::new_err(error.to_string()))?;
    pixels.extend(values);
    if !pixels.iter().all(is_finite) {
        let message = format!("{name} must be finite in single precision everywhere");
        return Err(refused(name, message));
    }
    Grid::from_vec(width, height, pixels)
        .map_err(|error| refused(name, format!("{name} must hold pixels: {error}")))
}

impl<'py> FromPyObject<'_, 'py> for Image<'py> {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(Pixels::of(&argument, b"iuf")?))
    }
}

impl<'py> FromPyObject<'_, 'py> for ComplexImage<'py> {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(Pixels::of(&argument, b"iufc")?))
    }
}

impl Image<'_> {
    /// Copies the image into a grid.
    ///
    /// # Errors
    ///
    /// Refuses the argument of this name unless it has two axes, pixels, and only finite ones.
    pub(crate) fn grid(&self, name: &'static str) -> PyResult<Grid<f32>> {
        self.0
            .grid(name, |&pixel| to_f32(pixel), |pixel| pixel.is_finite())
    }
}

impl ComplexImage<'_> {
    /// Copies the image into a grid.
    ///
    /// # Errors
    ///
    /// As [`Image::grid`].
    pub(crate) fn grid(&self, name: &'static str) -> PyResult<Grid<Complex32>> {
        let narrow = |pixel: &Complex64| Complex32::new(to_f32(pixel.re), to_f32(pixel.im));
        let is_finite = |pixel: &Complex32| pixel.re.is_finite() && pixel.im.is_finite();
        self.0.grid(name, narrow, is_finite)
    }
}

/// An image as a result, in Python an array [row, column].
#[derive(Debug)]
pub(crate) struct ImageArray<T>(Grid<T>);

impl<T> From<Grid<T>> for ImageArray<T> {
    fn from(grid: Grid<T>) -> Self {
        Self(grid)
    }
}

impl<'py, T: Element> IntoPyObject<'py> for ImageArray<T> {
    type Target = PyArray2<T>;
    type Output = Bound<'py, PyArray2<T>>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        let shape = [self.0.height(), self.0.width()];
        PyArray1::from_vec(py, self.0.into_values()).reshape(shape)
    }
}
