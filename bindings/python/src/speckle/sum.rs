use pyo3::prelude::*;
use tem00_speckle as physics;

use crate::{
    arrays::{Array, Components, Whole, array},
    error::OrRaise,
};

/// Return the fractions of the light in independent speckle patterns whose intensities add.
///
/// Parameters
/// ----------
/// patterns : int
///     Number of equal patterns.
/// polarisation : float
///     Degree of polarisation of the light that reaches the sensor, 0 to 1.
/// weights : array_like, shape (n,)
///     Mean intensities in any unit of the parts of each: of several lasers, or of the coherent modes of
///     a broad spectrum.
///
/// Returns
/// -------
/// ndarray
///     Fractions of sum 1, float64, at most 1024 of them.
#[pyfunction]
pub(super) fn incoherent_fractions<'py>(
    py: Python<'py>,
    patterns: Whole<'py>,
    polarisation: f64,
    weights: Components<'py>,
) -> PyResult<Array<'py>> {
    let (patterns, weights) = (patterns.unsigned("patterns")?, weights.finite("weights")?);
    let fractions = physics::incoherent_fractions(patterns, polarisation, weights).or_raise()?;
    Ok(array(py, &[fractions.len()], fractions)?.into_any())
}
