//! Ranges that arguments are held to: their squares, products and quotients stay within `f64`.

use tem00_numerics::{Refusal, check};

/// The largest length and coordinate, in metres.
const LARGEST: f64 = 1e30;

/// Returns a length from 1e−30 m to 1e30 m.
pub(crate) fn length(parameter: &'static str, x: f64) -> Result<f64, Refusal> {
    check::range(parameter, x, [LARGEST.recip(), LARGEST], "m")
}

/// Returns a coordinate within ±1e30 m.
pub(crate) fn coordinate(parameter: &'static str, x: f64) -> Result<f64, Refusal> {
    check::range(parameter, x, [-LARGEST, LARGEST], "m")
}

/// Returns the curvature `1/R` of a wavefront or a surface, within ±1e30 m⁻¹.
pub(crate) fn curvature(x: f64) -> Result<f64, Refusal> {
    check::range("curvature", x, [-LARGEST, LARGEST], "m⁻¹")
}
