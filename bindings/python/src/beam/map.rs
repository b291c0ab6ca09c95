//! Coordinates of the queries of beams and lights.

use pyo3::prelude::*;

use crate::{arrays::Numbers, error::refused};

/// The largest magnitude of a coordinate: within it no square of a length overflows.
pub(super) const LIMIT: f64 = 1e30;

/// A coordinate, if it is one.
pub(super) fn coordinate(name: &str, value: f64) -> PyResult<f64> {
    if value.abs() <= LIMIT {
        return Ok(value);
    }
    let message = format!("{name} must be finite and within ±{LIMIT:e}, got {value:e}");
    Err(refused(name, message))
}

/// Checks uniform variates in [0, 1).
pub(super) fn check_uniforms(u: &Numbers<'_>) -> PyResult<()> {
    let outside = |value: &&f64| !(0.0..1.0).contains(*value);
    match u.values()?.iter().find(outside) {
        Some(value) => Err(refused("u", format!("u must lie in [0, 1), got {value:e}"))),
        None => Ok(()),
    }
}
