//! Coordinates of the queries of beams and lights, and walks through them.

use pyo3::prelude::*;
use tem00_beam::Refusal;

use crate::{
    arrays::{self, Column, Named, Numbers, Values, columns, map_inner},
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

/// Applies `f` to numbers, and raises the first error it returns.
pub(super) fn try_map<'py>(
    py: Python<'py>,
    argument: Named<'_, 'py>,
    f: impl Fn(f64) -> Result<f64, Refusal> + Send + Sync,
) -> PyResult<Values<'py>> {
    arrays::try_map(py, argument, f, |error| match error.parameter() {
        name if name == argument.0 => error.into_python(),
        _ => refused(argument.0, format!("{}: {error}", argument.0)),
    })
}
