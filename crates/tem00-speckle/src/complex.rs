//! Complex numbers from one precision to the other.

use num_complex::Complex;
use tem00_numerics::cast::to_f32;

/// The same number in double precision.
pub(crate) fn to_c64(z: Complex<f32>) -> Complex<f64> {
    Complex::new(f64::from(z.re), f64::from(z.im))
}

/// The nearest number in single precision.
pub(crate) const fn to_c32(z: Complex<f64>) -> Complex<f32> {
    Complex::new(to_f32(z.re), to_f32(z.im))
}
