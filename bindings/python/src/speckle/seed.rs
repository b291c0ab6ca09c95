use pyo3::prelude::*;
use tem00_numerics::seed::{Purpose, derived};

use super::arguments::{Choices, choice};
use crate::arrays::Whole;

/// What has speckle of its own.
const PURPOSES: Choices<Purpose, 2> = [("laser", Purpose::Laser), ("body", Purpose::Body)];

/// Return the seed of one of several lasers or bodies, from a seed that they share: as ``tem00 render`` derives it.
///
/// Parameters
/// ----------
/// seed : int
///     Seed of the scene for lasers, or of a laser for the bodies in its light, 0 to 2**64 - 1.
/// purpose : str
///     "laser" or "body".
/// index : int
///     Number of the laser or of the body, from 0. The first body has the seed of the laser itself.
///
/// Returns
/// -------
/// int
///     Seed of the phasors, 0 to 2**64 - 1.
#[pyfunction]
pub(super) fn derived_seed(seed: Whole<'_>, purpose: &str, index: Whole<'_>) -> PyResult<u64> {
    let purpose = choice("purpose", &PURPOSES, purpose)?;
    let (seed, index) = (seed.unsigned("seed")?, index.unsigned("index")?);
    Ok(derived(seed, purpose, index))
}
