use numpy::ndarray::{ArrayViewD, Axis};
use pyo3::{exceptions::PyRuntimeError, prelude::*};

use super::{
    blocks::{BLOCK, Walk, common_shape},
    numbers::Numbers,
    results::{self, element_count},
};
use crate::error::refused;

/// The values of an argument, or of one component of an argument that holds vectors.
pub(crate) struct Column<'a> {
    /// The name of the argument.
    pub(crate) name: &'static str,
    /// The values, in a shape that broadcasts with the others.
    pub(crate) values: ArrayViewD<'a, f64>,
    /// The largest magnitude that is allowed; infinite where any value is, also one that is no
    /// number.
    pub(crate) limit: f64,
}

impl Column<'_> {
    /// Refuses values beyond the limit, and such that are not finite.
    fn check(&self, values: &[f64]) -> PyResult<()> {
        if self.limit == f64::INFINITY {
            return Ok(());
        }
        let allowed = |value: &f64| value.abs() <= self.limit;
        match values.iter().find(|value| !allowed(value)) {
            None => Ok(()),
            Some(&value) => {
                let (name, limit) = (self.name, self.limit);
                let within = match limit {
                    f64::MAX => String::new(),
                    _ => format!(" and within ±{limit:e}"),
                };
                let message = format!("{name} must be finite{within}, got {value:e}");
                Err(refused(name, message))
            }
        }
    }
}

/// The largest magnitude of an argument that need only be finite.
pub(crate) const LIMIT: f64 = f64::MAX;

/// The number of columns of an argument of vectors of `size` components, 0 for numbers.
pub(crate) const fn width(size: usize) -> usize {
    if size == 0 { 1 } else { size }
}

/// Takes arguments of numbers up to a magnitude, and the components of those that hold vectors of a
/// size above 0 in their last axis: `N` columns together.
pub(crate) fn columns<'a, const N: usize>(
    arguments: &[(&'static str, &'a Numbers<'_>, usize)],
    limit: f64,
) -> PyResult<[Column<'a>; N]> {
    let mut columns = Vec::with_capacity(N);
    for &(name, numbers, size) in arguments {
        let shape = numbers.shape();
        let values = view(shape, numbers)?;
        if size == 0 {
            columns.push(Column {
                name,
                values,
                limit,
            });
            continue;
        }
        if !shape.ends_with(&[size]) {
            let message = format!("{name} must end in the shape [{size}], but has {shape:?}");
            return Err(refused(name, message));
        }
        let axis = Axis(shape.len() - 1);
        columns.extend((0..size).map(|k| Column {
            name,
            values: values.clone().index_axis_move(axis, k),
            limit,
        }));
    }
    columns
        .try_into()
        .map_err(|_| PyRuntimeError::new_err("an argument is missing"))
}

/// Hands columns, broadcast together, to `f` block by block as slices of equal length, and returns
/// what it writes to the `M` slices beside them: in the common shape, followed by the shape `inner`
/// of each result, which is empty for a number. Floats for numbers. Without the interpreter's lock.
///
/// Only the results take memory. `f` is called with at most 4096 elements at a time; not at all
/// where there are none.
///
/// # Errors
///
/// Refuses values beyond their limit or not finite, shapes that do not fit together, and what
/// memory does not hold.
pub(crate) fn evaluate<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    columns: [Column<'_>; N],
    inner: [&[usize]; M],
    mut f: impl FnMut([&[f64]; N], [&mut [f64]; M]) + Send,
) -> PyResult<[results::Values<'py>; M]> {
    let names = columns.each_ref().map(|column| column.name);
    let shape = common_shape(&columns)?;
    let mut left = element_count(&shape)?;
    let shapes = inner.map(|inner| [shape.as_slice(), inner].concat());
    let sizes = inner.map(|inner| inner.iter().product::<usize>());
    let wide = columns
        .each_ref()
        .map(|c| c.values.broadcast(shape.as_slice()));
    let filled = py.detach(|| {
        let mut out = results::zeros_of(shapes.each_ref().map(Vec::as_slice))?;
        let mut rest = out.each_mut().map(Vec::as_mut_slice);
        let mut walks = wide.each_ref().map(|view| Walk::new(view.as_ref(), left));
        let mut outcome = Ok(());
        while left > 0 && outcome.is_ok() {
            let count = left.min(BLOCK);
            let values = walks.each_mut().map(|walk| walk.next(count));
            let mut place = 0;
            let mut block = rest.each_mut().map(|rest| {
                let (block, after) = core::mem::take(rest).split_at_mut(count * sizes[place]);
                place += 1;
                *rest = after;
                block
            });
            outcome = columns.iter().zip(values).try_for_each(|(c, v)| c.check(v));
            if outcome.is_ok() {
                f(values, block.each_mut().map(|block| &mut **block));
                outcome = check_numbers(names, values, &block);
            }
            left -= count;
        }
        outcome.map(|()| out)
    })?;
    let mut arrays = Vec::with_capacity(M);
    for (shape, values) in shapes.iter().zip(filled) {
        arrays.push(results::array_or_float(py, shape, values)?);
    }
    arrays
        .try_into()
        .map_err(|_| PyRuntimeError::new_err("an array is missing"))
}

/// Refuses results that are not numbers.
fn check_numbers<const N: usize>(
    names: [&'static str; N],
    values: [&[f64]; N],
    results: &[&mut [f64]],
) -> PyResult<()> {
    for result in results {
        if let Some(place) = result.iter().position(|&value| value.is_nan()) {
            let index = place * values[0].len() / result.len();
            return Err(nan_result(names, values.map(|column| column[index])));
        }
    }
    Ok(())
}

fn view<'a>(shape: &[usize], numbers: &'a Numbers<'_>) -> PyResult<ArrayViewD<'a, f64>> {
    ArrayViewD::from_shape(shape, numbers.values()?)
        .map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// The exception for finite arguments so extreme that the result of a formula is NaN.
fn nan_result<const N: usize>(names: [&'static str; N], values: [f64; N]) -> PyErr {
    let pairs = names.iter().zip(values);
    let all: Vec<String> = pairs
        .map(|(name, value)| format!("{name} = {value:e}"))
        .collect();
    let message = format!("{} must be less extreme to have a result", all.join(", "));
    refused(names.first().copied().unwrap_or_default(), message)
}
