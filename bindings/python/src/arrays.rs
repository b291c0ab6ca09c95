//! Arrays in and out: numbers of any shape, broadcast together as NumPy does it, and images.
//!
//! What lies in memory row by row in the right type is read where it is; anything else NumPy copies
//! first. Results are moved to Python without a copy. While a function works, the interpreter is free
//! for other threads; these must leave its arguments alone.

mod blocks;
mod columns;
mod floats;
mod images;
mod numbers;
mod results;
mod whole;

use pyo3::prelude::*;

pub(crate) use columns::{Column, columns, evaluate};
pub(crate) use floats::{Floats, fill_in_kind};
pub(crate) use images::{ComplexImage, Image, image_array};
pub(crate) use numbers::{
    Components, Named, Numbers, Samples, Table, Vectors, length, wavelength_of_light,
};
pub(crate) use results::{Array, Matrix, Values, Vector, array, vector_array};
pub(crate) use whole::Whole;

/// Applies `f` to `N` arguments broadcast together, without the interpreter's lock: a float for
/// numbers, an array of the common shape for arrays.
///
/// # Errors
///
/// Refuses arguments that are not finite, and shapes that do not fit together.
pub(crate) fn map<'py, const N: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl Fn([f64; N]) -> f64 + Send + Sync,
) -> PyResult<Values<'py>> {
    let [values] = map_many(py, arguments, |x| [f(x)])?;
    Ok(values)
}

/// As [`map`], for functions with `M` values.
pub(crate) fn map_many<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl Fn([f64; N]) -> [f64; M] + Send + Sync,
) -> PyResult<[Values<'py>; M]> {
    fill(py, arguments, |columns, mut out| {
        for i in 0..columns[0].len() {
            let values = f(columns.map(|column| column[i]));
            for (out, value) in out.iter_mut().zip(values) {
                out[i] = value;
            }
        }
    })
}

/// As [`map`], for a function of one argument that can fail: `raise` makes the exception of its first error.
pub(crate) fn try_map<'py, E: Send>(
    py: Python<'py>,
    argument: Named<'_, 'py>,
    f: impl Fn(f64) -> Result<f64, E> + Send + Sync,
    raise: impl FnOnce(E) -> PyErr,
) -> PyResult<Values<'py>> {
    let mut first_error = Ok(());
    let [values] = fill(py, [argument], |[x], [out]| {
        for (out, &x) in out.iter_mut().zip(x) {
            match f(x) {
                Ok(value) => *out = value,
                Err(error) if first_error.is_ok() => first_error = Err(error),
                Err(_) => {}
            }
        }
    })?;
    first_error.map(|()| values).map_err(raise)
}

/// Hands `N` arguments of numbers, broadcast together, to `f`: [`evaluate`] for arguments of any size
/// and for results that are numbers.
///
/// # Errors
///
/// Refuses arguments that are not finite, shapes that do not fit together, and what memory does not
/// hold.
pub(crate) fn fill<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl FnMut([&[f64]; N], [&mut [f64]; M]) + Send,
) -> PyResult<[Values<'py>; M]> {
    evaluate(py, columns(arguments, f64::MAX)?, [&[]; M], f)
}
