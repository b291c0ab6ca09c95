//! Arrays in and out: numbers of any shape, broadcast together as NumPy does it, and images.
//!
//! What lies in memory row by row in the right type is read where it is; anything else NumPy copies
//! first. Results are moved to Python without a copy. While a function works, the interpreter is free
//! for other threads; these must leave its arguments alone.

mod blocks;
mod columns;
mod images;
mod numbers;
mod results;
mod whole;

use numpy::Complex64;
use pyo3::{prelude::*, types::PyComplex};

pub(crate) use columns::{Column, columns, evaluate};
pub(crate) use images::{ComplexImage, Image, ImageArray};
pub(crate) use numbers::{Components, Named, Numbers, Vectors, length};
pub(crate) use results::{
    Array, List, Matrix, Values, Vector, add_named, named_class, named_tuple,
};
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

/// Applies `f` to columns; its values lie in the shape `inner` in the last axes of the result.
pub(crate) fn map_inner<'py, const N: usize, const K: usize>(
    py: Python<'py>,
    columns: [Column<'_>; N],
    inner: &[usize],
    f: impl Fn([f64; N]) -> [f64; K] + Send + Sync,
) -> PyResult<Values<'py>> {
    let [values] = evaluate(py, columns, [inner], |columns, [out]| {
        for (i, out) in out.chunks_exact_mut(K).enumerate() {
            out.copy_from_slice(&f(columns.map(|column| column[i])));
        }
    })?;
    Ok(values)
}

/// As [`map_inner`], for complex values by their real and imaginary parts: a complex number for numbers.
pub(crate) fn map_complex<'py, const N: usize>(
    py: Python<'py>,
    columns: [Column<'_>; N],
    f: impl Fn([f64; N]) -> Complex64 + Send + Sync,
) -> PyResult<Values<'py>> {
    let [re, im] = evaluate(py, columns, [&[]; 2], |columns, [re, im]| {
        for i in 0..re.len() {
            let value = f(columns.map(|column| column[i]));
            (re[i], im[i]) = (value.re, value.im);
        }
    })?;
    re.add(im.mul(PyComplex::from_doubles(py, 0.0, 1.0))?)
}
