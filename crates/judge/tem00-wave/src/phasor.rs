use core::f64::consts::TAU;

use num_complex::Complex;

/// Returns `exp(2πi · turns)`.
///
/// Whole turns are subtracted first, which is exact: the error is the error of `turns` itself.
/// Infinitely many turns count as none.
pub(crate) fn phasor(turns: f64) -> Complex<f64> {
    let part = turns - turns.round();
    let (sin, cos) = (TAU * if part.is_finite() { part } else { 0.0 }).sin_cos();
    Complex::new(cos, sin)
}
