//! Arguments of the queries of beams and lights, and what becomes of them.

use pyo3::prelude::*;
use tem00_beam::Refusal;

use crate::{
    arrays::{self, Column, Named, Numbers, Values, columns, evaluate},
    error::{IntoPython, refused},
};

/// The largest magnitude of a coordinate: within it no square of a length overflows.
const LIMIT: f64 = 1e30;

/// A coordinate, if it is one.
pub(super) fn coordinate(name: &str, value: f64) -> PyResult<f64> {
    if value.abs() <= LIMIT {
        return Ok(value);
    }
    let message = format!("{name} must be finite and within ±{LIMIT:e}, got {value:e}");
    Err(refused(name, message))
}

/// The values of an argument that is a list of numbers.
pub(super) fn list<'a>(name: &'static str, numbers: &'a Numbers<'_>) -> PyResult<&'a [f64]> {
    match numbers.shape() {
        [_] => numbers.values(),
        shape => {
            let message = format!("{name} must have one axis, but has the shape {shape:?}");
            Err(refused(name, message))
        }
    }
}

/// Arguments of numbers that are coordinates.
pub(super) fn coordinates<'a, const N: usize>(
    arguments: [Named<'a, '_>; N],
) -> PyResult<[Column<'a>; N]> {
    columns(arguments, LIMIT)
}

/// The components of an argument that holds vectors in its last axis.
pub(super) fn components<'a, const K: usize>(argument: Named<'a, '_>) -> PyResult<[Column<'a>; K]> {
    Column::components(argument, &[K], LIMIT)
}

/// Uniform variates in [0, 1), `K` for each draw, in the last axis of the argument `u`.
pub(super) fn uniforms<'a, const K: usize>(u: &'a Numbers<'_>) -> PyResult<[Column<'a>; K]> {
    let outside = |value: &&f64| !(0.0..1.0).contains(*value);
    match u.values()?.iter().find(outside) {
        Some(value) => Err(refused("u", format!("u must lie in [0, 1), got {value:e}"))),
        None => components(("u", u)),
    }
}

/// Applies `f` to numbers, broadcast together.
pub(super) fn map<'py, const N: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl Fn([f64; N]) -> f64 + Send + Sync,
) -> PyResult<Values<'py>> {
    map_inner(py, coordinates(arguments)?, &[], |x| [f(x)])
}

/// Applies `f` to numbers, broadcast together; its vectors lie in the last axis of the result.
pub(super) fn map_vector<'py, const N: usize, const K: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl Fn([f64; N]) -> [f64; K] + Send + Sync,
) -> PyResult<Values<'py>> {
    map_inner(py, coordinates(arguments)?, &[K], f)
}

/// Applies `f` to columns; its values lie in the shape `inner` in the last axes of the result.
pub(super) fn map_inner<'py, const N: usize, const K: usize>(
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

/// Applies `f` to numbers, and raises the first error it returns.
pub(super) fn try_map<'py>(
    py: Python<'py>,
    argument: Named<'_, 'py>,
    f: impl Fn(f64) -> Result<f64, Refusal> + Send + Sync,
) -> PyResult<Values<'py>> {
    let name = argument.0;
    arrays::try_map(py, argument, f, |error| named(name, error))
}

/// The exception for an error of the argument `name`.
pub(super) fn named(name: &str, error: Refusal) -> PyErr {
    if error.parameter() == name {
        error.into_python()
    } else {
        refused(name, format!("{name}: {error}"))
    }
}

/// `?` for results of the beam crate, where the caller knows the names of the arguments better.
pub(super) trait OrRaiseAs<T> {
    /// Returns the value, or the error as an exception. The parameter `from` is called `to`.
    fn or_raise_as(self, names: &[(&str, &str)]) -> PyResult<T>;
}

impl<T> OrRaiseAs<T> for Result<T, Refusal> {
    fn or_raise_as(self, names: &[(&str, &str)]) -> PyResult<T> {
        self.map_err(|error| {
            let name = error.parameter();
            let renamed = names.iter().find(|(from, _)| *from == name);
            named(renamed.map_or(name, |(_, to)| to), error)
        })
    }
}
