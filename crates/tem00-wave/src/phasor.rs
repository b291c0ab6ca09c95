use core::f64::consts::TAU;

use num_complex::Complex;

/// Returns `exp(2πi · turns)`.
///
/// Whole turns are taken off first, which is exact: the error is that of `turns` itself.
pub(crate) fn phasor(turns: f64) -> Complex<f64> {
    let (sin, cos) = (TAU * (turns - turns.round())).sin_cos();
    Complex::new(cos, sin)
}
