//! Images that Python sees where they lie, [row, column].

use numpy::{Element, PyArray2, ndarray::ArrayView2};
use pyo3::{
    PyClass,
    exceptions::{PyMemoryError, PyRuntimeError},
    prelude::*,
    pyclass::boolean_struct::True,
    types::PyDict,
};
use tem00_numerics::{Grid, available_memory};

/// A read-only array [row, column], or None.
pub(crate) type View<'py, T> = Option<Bound<'py, PyArray2<T>>>;

/// Returns a read-only array over the values of a grid that lies in `owner`, an object that never
/// changes; None where there is no grid.
pub(crate) fn view<'py, C: PyClass<Frozen = True> + Sync, T: Element>(
    owner: &Bound<'py, C>,
    grid: impl for<'a> FnOnce(&'a C) -> Option<&'a Grid<T>>,
) -> PyResult<View<'py, T>> {
    let Some(grid) = grid(owner.get()) else {
        return Ok(None);
    };
    let rows = (grid.height(), grid.width());
    let values = ArrayView2::from_shape(rows, grid.values())
        .map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    // SAFETY: the array keeps `owner` alive, and with it the values, which nobody changes: not
    // Rust, since `owner` is frozen, and not Python, for which they are made read-only here.
    let array = unsafe { PyArray2::borrow_from_array(&values, owner.clone().into_any()) };
    // Not through a borrow to write, which fails while another thread reads the same values.
    array.call_method1("setflags", (false,))?;
    Ok(Some(array))
}

/// Returns the values of an object as its ``__array__`` gives them to NumPy.
pub(crate) fn array<'py>(
    owner: &Bound<'py, PyAny>,
    dtype: Option<Bound<'py, PyAny>>,
    copy: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = owner.py();
    let keywords = PyDict::new(py);
    keywords.set_item("dtype", dtype)?;
    keywords.set_item("copy", copy)?;
    let array = py.import("numpy")?.getattr("array")?;
    array.call((owner.getattr("values")?,), Some(&keywords))
}

/// Checks that the machine has memory for an image of `bytes_each` bytes for each of its samples,
/// and for another complex one to work with: one that grants more nevertheless ends the program
/// later.
pub(crate) fn check_room([width, height]: [usize; 2], bytes_each: u64) -> PyResult<()> {
    const COMPLEX: u64 = 8;
    let samples = (width as u64).saturating_mul(height as u64);
    let needed = samples.saturating_mul(bytes_each + COMPLEX);
    match available_memory() {
        Some(available) if needed > available => Err(PyMemoryError::new_err(format!(
            "{needed} bytes for the image are more than the machine has to give"
        ))),
        _ => Ok(()),
    }
}
