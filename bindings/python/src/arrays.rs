//! Arrays in and out: numbers of any shape, broadcast together as NumPy does it, and images.
//!
//! What lies in memory row by row in the right type is read where it is; anything else NumPy copies
//! first. Results are moved to Python without a copy. While a function works, the interpreter is
//! free for other threads; these must leave its arguments alone.

mod blocks;
mod columns;
mod images;
mod numbers;
mod results;
mod whole;

use numpy::Complex64;
use pyo3::{prelude::*, types::PyComplex};

pub(crate) use columns::{Column, LIMIT, columns, evaluate, width};
pub(crate) use images::{ImageArray, Pixel, image};
pub(crate) use numbers::{Components, Numbers, Vectors, length};
pub(crate) use results::{Array, Floats, Values, add_named, named_class, named_tuple};
pub(crate) use whole::Whole;

use crate::error::{IntoPython, OrRaise};

/// Applies a function that can fail to an argument, and raises its first error, which names the
/// argument.
pub(crate) fn try_map<'py, E: IntoPython + Send>(
    py: Python<'py>,
    (name, argument): (&'static str, &Numbers<'py>),
    f: impl Fn(f64) -> Result<f64, E> + Send + Sync,
) -> PyResult<Values<'py>> {
    let mut first_error = Ok(());
    let [values] = evaluate(
        py,
        columns(&[(name, argument, 0)], LIMIT)?,
        [&[]],
        |[x], [out]| {
            for (out, &x) in out.iter_mut().zip(x) {
                match f(x) {
                    Ok(value) => *out = value,
                    Err(error) if first_error.is_ok() => first_error = Err(error),
                    Err(_) => {}
                }
            }
        },
    )?;
    first_error.or_raise_of(name)?;
    Ok(values)
}

/// Applies `f` to columns, broadcast together, without the interpreter's lock; its values lie in
/// the shape `inner` in the last axes of the result.
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

/// Maps complex values, by real and imaginary parts, otherwise as [`map_inner`]; numbers give a
/// complex number.
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
