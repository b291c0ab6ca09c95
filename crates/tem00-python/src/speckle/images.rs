//! Images in and out: grids as two-dimensional arrays [row, column].

use numpy::{
    Element, PyArray2, PyArrayMethods, PyReadonlyArray2,
    ndarray::{Array2, ArrayView2},
};
use pyo3::{
    exceptions::{PyMemoryError, PyRuntimeError},
    intern,
    prelude::*,
};
use tem00_numerics::{Grid, available_memory};

use crate::error::refused;

/// An image as an argument: a two-dimensional array of any number type, or what NumPy makes one of.
#[derive(Debug)]
pub(crate) struct Image<'py, T: Element>(PyReadonlyArray2<'py, T>);

impl<'py, T: Element> FromPyObject<'_, 'py> for Image<'py, T> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let py = object.py();
        let numpy = py.import(intern!(py, "numpy"))?;
        let array = numpy.call_method1(intern!(py, "asarray"), (object, T::get_dtype(py)))?;
        Ok(Self(array.extract()?))
    }
}

/// Returns a read-only array over the values of `grid`, which belongs to `owner`.
///
/// # Safety
///
/// `grid` must live in the memory of `owner`, an object that never changes.
pub(crate) unsafe fn view<'py, T: Element>(
    owner: Bound<'py, PyAny>,
    grid: &Grid<T>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let rows = (grid.height(), grid.width());
    let values = ArrayView2::from_shape(rows, grid.values())
        .map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    // SAFETY: the array keeps `owner` alive, and with it the values, which nobody changes: not Rust,
    // as the caller promises, and not Python, for which they are made read-only here.
    let array = unsafe { PyArray2::borrow_from_array(&values, owner) };
    drop(array.try_readwrite()?.make_nonwriteable());
    Ok(array)
}

/// Returns an array that takes over the values of `grid`.
pub(crate) fn moved<T: Element>(py: Python<'_>, grid: Grid<T>) -> PyResult<Bound<'_, PyArray2<T>>> {
    let rows = (grid.height(), grid.width());
    let values = Array2::from_shape_vec(rows, grid.into_values())
        .map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    Ok(PyArray2::from_owned_array(py, values))
}

/// Returns a grid with the values of an image.
///
/// # Errors
///
/// Refuses an image without values.
pub(crate) fn grid<T: Element + Copy>(name: &str, image: &Image<'_, T>) -> PyResult<Grid<T>> {
    let image = image.0.as_array();
    let (height, width) = image.dim();
    Grid::from_vec(width, height, image.iter().copied().collect()).map_err(|_| {
        let message = format!("{name} must have values, got the shape ({height}, {width})");
        refused(name, message)
    })
}

/// Refuses an image with so many bytes for each of its samples, and another complex one to work
/// with, if the machine does not have them.
///
/// A machine that grants what it does not have ends the program later.
pub(crate) fn check_room([width, height]: [usize; 2], bytes_each: u64) -> PyResult<()> {
    const COMPLEX: u64 = 8;
    let samples = (width as u64).saturating_mul(height as u64);
    let needed = samples.saturating_mul(bytes_each + COMPLEX);
    match available_memory() {
        Some(available) if needed > available => Err(PyMemoryError::new_err(format!(
            "{needed} bytes for {width} x {height} samples are more than the machine has to give"
        ))),
        _ => Ok(()),
    }
}
