use numpy::{
    Complex32, Complex64, Element, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods,
    PyUntypedArrayMethods,
};
use pyo3::{exceptions::PyMemoryError, prelude::*};
use tem00_numerics::{Grid, cast::to_f32};

use super::numbers::row_by_row;
use crate::{arguments::kind, error::refused};

/// A number that images are of, and the one of twice the precision that it is rounded from.
pub(crate) trait Pixel: Element + Copy {
    type Wide: Element;

    /// NumPy's letters for the kinds of numbers that an image may hold.
    const KINDS: &[u8];

    fn rounded(wide: &Self::Wide) -> Self;

    fn is_finite(&self) -> bool;
}

impl Pixel for f32 {
    type Wide = f64;

    const KINDS: &[u8] = b"iuf";

    fn rounded(wide: &f64) -> Self {
        to_f32(*wide)
    }

    fn is_finite(&self) -> bool {
        Self::is_finite(*self)
    }
}

impl Pixel for Complex32 {
    type Wide = Complex64;

    const KINDS: &[u8] = b"iufc";

    fn rounded(wide: &Complex64) -> Self {
        Self::new(to_f32(wide.re), to_f32(wide.im))
    }

    fn is_finite(&self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}

/// Copies an image, a two-dimensional array [row, column] of numbers, into a grid.
///
/// # Errors
///
/// Refuses the argument of this name unless it has two axes, pixels, and only finite ones.
pub(crate) fn image<S: Pixel>(
    argument: &Bound<'_, PyAny>,
    name: &'static str,
) -> PyResult<Grid<S>> {
    if argument.cast::<PyArrayDyn<S>>().is_ok() {
        let array = row_by_row::<S>(argument, S::KINDS).map_err(|error| kind(name, error))?;
        return grid(name, array.shape(), array.as_slice()?.iter().copied());
    }
    let array = row_by_row::<S::Wide>(argument, S::KINDS).map_err(|error| kind(name, error))?;
    grid(
        name,
        array.shape(),
        array.as_slice()?.iter().map(S::rounded),
    )
}

fn grid<S: Pixel>(
    name: &'static str,
    shape: &[usize],
    values: impl ExactSizeIterator<Item = S>,
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
    if !pixels.iter().all(S::is_finite) {
        let message = format!("{name} must be finite in single precision everywhere");
        return Err(refused(name, message));
    }
    Grid::from_vec(width, height, pixels)
        .map_err(|error| refused(name, format!("{name} must hold pixels: {error}")))
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
