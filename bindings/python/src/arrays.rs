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

use pyo3::{exceptions::PyRuntimeError, prelude::*};

pub(crate) use columns::{Column, evaluate};
pub(crate) use images::{ComplexImage, Image, image_array};
pub(crate) use numbers::{Count, Numbers, length};
pub(crate) use results::{Matrix3, Values, Vector, array, vector_array, zeros};

use crate::error::refused;
use blocks::Blocks;

/// An argument and its name.
pub(crate) type Named<'a, 'py> = (&'static str, &'a Numbers<'py>);

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
) -> PyResult<Bound<'py, PyAny>> {
    let [values] = map_many(py, arguments, |x| [f(x)])?;
    Ok(values)
}

/// As [`map`], for functions with `M` values.
pub(crate) fn map_many<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl Fn([f64; N]) -> [f64; M] + Send + Sync,
) -> PyResult<[Bound<'py, PyAny>; M]> {
    fill(py, arguments, |columns, mut out| {
        for i in 0..columns[0].len() {
            let values = f(columns.map(|column| column[i]));
            for (out, value) in out.iter_mut().zip(values) {
                out[i] = value;
            }
        }
    })
}

/// Hands `N` arguments, broadcast together, to `f` block by block as slices of equal length, and
/// returns what it writes to the `M` slices beside them, in the common shape; floats for numbers.
/// Without the interpreter's lock.
///
/// Only the results take memory. `f` is called with at most 4096 elements at a time; not at all where
/// there are none.
///
/// # Errors
///
/// Refuses arguments that are not finite, shapes that do not fit together, and what memory does not
/// hold.
pub(crate) fn fill<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    mut f: impl FnMut([&[f64]; N], [&mut [f64]; M]) + Send,
) -> PyResult<[Bound<'py, PyAny>; M]> {
    let names = arguments.map(|(name, _)| name);
    let blocks = Blocks::new(arguments)?;
    let filled = py.detach(|| {
        let mut out = zeros::<f64, M>(blocks.shape())?;
        let mut rest = out.each_mut().map(Vec::as_mut_slice);
        let mut outcome = Ok(());
        blocks.run(|columns| {
            let mut block = rest.each_mut().map(|rest| {
                let (block, after) = core::mem::take(rest).split_at_mut(columns[0].len());
                *rest = after;
                block
            });
            f(columns, block.each_mut().map(|block| &mut **block));
            for block in block {
                if let Some(index) = block.iter().position(|value| value.is_nan()) {
                    outcome = Err(no_number(names, columns.map(|column| column[index])));
                }
            }
        });
        outcome.map(|()| out)
    });
    let mut arrays = Vec::with_capacity(M);
    for values in filled? {
        arrays.push(results::array_or_float(py, blocks.shape(), values)?);
    }
    arrays
        .try_into()
        .map_err(|_| PyRuntimeError::new_err("an array is missing"))
}

/// The exception for finite arguments so extreme that the result of a formula is not a number.
fn no_number<const N: usize>(names: [&'static str; N], values: [f64; N]) -> PyErr {
    let pairs = names.iter().zip(values);
    let all: Vec<String> = pairs
        .map(|(name, value)| format!("{name} = {value:e}"))
        .collect();
    let message = format!("{} must be less extreme to have a result", all.join(", "));
    refused(names.first().copied().unwrap_or_default(), message)
}
