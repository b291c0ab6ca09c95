use numpy::{
    PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods, ndarray::ArrayViewD,
};
use pyo3::{exceptions::PyRuntimeError, prelude::*};

use super::{
    columns::{Column, columns, evaluate},
    numbers::{Named, Numbers, row_by_row},
    results::Values,
};

/// As [`Numbers`], for functions that answer arrays in `float32` in `float32`: these are read where
/// they lie.
#[derive(Debug)]
pub(crate) enum Floats<'py> {
    Single(PyReadonlyArrayDyn<'py, f32>),
    Other(Numbers<'py>),
}

impl<'py> FromPyObject<'_, 'py> for Floats<'py> {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match argument.cast::<PyArrayDyn<f32>>() {
            Ok(array) if array.is_c_contiguous() && array.is_aligned() => {
                Ok(Self::Single(array.try_readonly()?))
            }
            _ => Ok(Self::Other(argument.extract()?)),
        }
    }
}

/// Hands arguments, broadcast together, to `single` where their arrays are in `float32`, and to `double`
/// where one is not or there is none. A Python number goes with either.
///
/// # Errors
///
/// Refuses arguments that are not finite, shapes that do not fit together, and what memory does not
/// hold.
pub(crate) fn fill_in_kind<'py, const N: usize>(
    py: Python<'py>,
    arguments: [(&'static str, Floats<'py>); N],
    mut single: impl FnMut([&[f32]; N], &mut [f32]) + Send,
    mut double: impl FnMut([&[f64]; N], &mut [f64]) + Send,
) -> PyResult<Values<'py>> {
    let is_single = |floats: &Floats<'_>| matches!(floats, Floats::Single(_));
    let is_wide = |floats: &Floats<'_>| matches!(floats, Floats::Other(Numbers::Array(_)));
    let any_of = |kind: &dyn Fn(&Floats<'_>) -> bool| arguments.iter().any(|(_, x)| kind(x));
    if any_of(&is_single) && !any_of(&is_wide) {
        let numbers = arguments.each_ref().map(|(_, floats)| rounded(floats));
        let mut columns = Vec::with_capacity(N);
        for ((name, floats), number) in arguments.iter().zip(&numbers) {
            let values = match floats {
                Floats::Single(array) => array.as_array(),
                Floats::Other(_) => ArrayViewD::from_shape(&[][..], number).map_err(missing)?,
            };
            let limit = f64::MAX;
            columns.push(Column {
                name,
                values,
                limit,
            });
        }
        let columns = columns.try_into().map_err(|_| missing("a column"))?;
        let [values] = evaluate::<f32, N, 1>(py, columns, [&[]], |x, [out]| {
            single(x, out);
        })?;
        return Ok(values);
    }
    let mut wide = Vec::with_capacity(N);
    for (name, floats) in arguments {
        let numbers = match floats {
            Floats::Single(array) => Numbers::Array(row_by_row(array.as_any(), b"f")?),
            Floats::Other(numbers) => numbers,
        };
        wide.push((name, numbers));
    }
    let named = wide.iter().map(|(name, numbers)| (*name, numbers));
    let named: Vec<Named<'_, 'py>> = named.collect();
    let named = named.try_into().map_err(|_| missing("an argument"))?;
    let [values] = evaluate(py, columns(named, f64::MAX)?, [&[]], |x, [out]| {
        double(x, out);
    })?;
    Ok(values)
}

/// A Python number in single precision.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a number goes with the arrays"
)]
fn rounded(floats: &Floats<'_>) -> [f32; 1] {
    match floats {
        Floats::Other(Numbers::One(number)) => [*number as f32],
        _ => [0.0],
    }
}

fn missing(what: impl ToString) -> PyErr {
    PyRuntimeError::new_err(what.to_string())
}
