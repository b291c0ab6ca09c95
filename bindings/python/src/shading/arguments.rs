//! Arguments that are vectors.

use pyo3::prelude::*;
use tem00_shading::DVec3;

use crate::arrays::{Column, Components, Vectors};

/// A vector of finite components, or what stands for one that is left out.
pub(super) fn vector<const K: usize>(
    name: &'static str,
    given: Option<&Components<'_>>,
    default: [f64; K],
) -> PyResult<[f64; K]> {
    given.map_or(Ok(default), |given| given.vector(name))
}

/// The components of vectors, whatever they are: the laws have an answer for NaN.
pub(super) fn any<'a>(name: &'static str, vectors: &'a Vectors<'_>) -> PyResult<[Column<'a>; 3]> {
    Column::components((name, vectors), &[3], f64::INFINITY)
}

/// The vectors with these components.
pub(super) fn vectors([x, y, z]: [&[f64]; 3]) -> Vec<DVec3> {
    (0..x.len()).map(|i| DVec3::new(x[i], y[i], z[i])).collect()
}
