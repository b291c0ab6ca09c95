use numpy::ndarray::{ArrayViewD, Axis};
use pyo3::{exceptions::PyRuntimeError, prelude::*};

use super::{
    blocks::Blocks,
    numbers::{Named, Numbers},
    results,
};
use crate::error::refused;

/// The values of an argument, or of one component of an argument that holds vectors.
pub(crate) struct Column<'a> {
    /// The name of the argument.
    pub(crate) name: &'static str,
    /// The values, in a shape that broadcasts with the others.
    pub(crate) values: ArrayViewD<'a, f64>,
    /// The largest magnitude that is allowed; infinite where any value is, also one that is no number.
    pub(crate) limit: f64,
}

impl<'a> Column<'a> {
    /// Takes an argument of numbers up to a magnitude.
    pub(crate) fn new((name, numbers): Named<'a, '_>, limit: f64) -> PyResult<Self> {
        Ok(Self {
            name,
            values: view(numbers)?,
            limit,
        })
    }

    /// Takes the `K` components, row by row, of an argument that holds arrays of the shape `inner` in
    /// its last axes.
    pub(crate) fn components<const K: usize>(
        (name, numbers): Named<'a, '_>,
        inner: &[usize],
        limit: f64,
    ) -> PyResult<[Self; K]> {
        let shape = numbers.shape();
        if !shape.ends_with(inner) {
            let message = format!("{name} must end in the shape {inner:?}, but has {shape:?}");
            return Err(refused(name, message));
        }
        let leading = [&shape[..shape.len() - inner.len()], &[K]].concat();
        let rows = view(numbers)?
            .into_shape_with_order(leading)
            .map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let axis = Axis(rows.ndim() - 1);
        Ok(std::array::from_fn(|k| Self {
            name,
            values: rows.clone().index_axis_move(axis, k),
            limit,
        }))
    }
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

/// Takes arguments of numbers up to a magnitude.
pub(crate) fn columns<'a, const N: usize>(
    arguments: [Named<'a, '_>; N],
    limit: f64,
) -> PyResult<[Column<'a>; N]> {
    let mut columns = Vec::with_capacity(N);
    for argument in arguments {
        columns.push(Column::new(argument, limit)?);
    }
    columns
        .try_into()
        .map_err(|_| PyRuntimeError::new_err("an argument is missing"))
}

/// Hands columns, broadcast together, to `f` block by block as slices of equal length, and returns what
/// it writes to the `M` slices beside them: in the common shape, followed by the shape `inner` of each
/// result, which is empty for a number. Floats for numbers. Without the interpreter's lock.
///
/// Only the results take memory. `f` is called with at most 4096 elements at a time; not at all where
/// there are none.
///
/// # Errors
///
/// Refuses values beyond their limit or not finite, shapes that do not fit together, and what memory
/// does not hold.
pub(crate) fn evaluate<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    columns: [Column<'_>; N],
    inner: [&[usize]; M],
    mut f: impl FnMut([&[f64]; N], [&mut [f64]; M]) + Send,
) -> PyResult<[results::Values<'py>; M]> {
    let names = columns.each_ref().map(|column| column.name);
    let blocks = Blocks::new(names, columns.each_ref().map(|column| column.values.view()))?;
    let shapes = inner.map(|inner| [blocks.shape(), inner].concat());
    let sizes = inner.map(|inner| inner.iter().product::<usize>());
    let filled = py.detach(|| {
        let mut out = results::zeros_of(shapes.each_ref().map(Vec::as_slice))?;
        let mut rest = out.each_mut().map(Vec::as_mut_slice);
        let mut outcome = Ok(());
        blocks.run(|values| {
            if outcome.is_ok() {
                let count = values[0].len();
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
            }
        });
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

fn view<'a>(numbers: &'a Numbers<'_>) -> PyResult<ArrayViewD<'a, f64>> {
    ArrayViewD::from_shape(numbers.shape(), numbers.values()?)
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
