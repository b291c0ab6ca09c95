use pyo3::prelude::*;

use super::arguments::{Choices, choice};
use crate::arrays::Whole;

/// What has speckle of its own: the number of its first seed, and the step from one to the next.
const PURPOSES: Choices<(u64, u64), 2> = [
    ("laser", (1, 0x9e37_79b9_7f4a_7c15)),
    ("body", (0, 0xd1b5_4a32_d192_ed03)),
];

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
    let (first, step) = choice("purpose", &PURPOSES, purpose)?;
    let (seed, index): (u64, u64) = (seed.unsigned("seed")?, index.unsigned("index")?);
    Ok(seed.wrapping_add(index.wrapping_add(first).wrapping_mul(step)))
}
