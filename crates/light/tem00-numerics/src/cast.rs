//! Conversions of numbers that `From` and `TryFrom` do not cover, each with its rounding stated.
//!
//! A count or an index becomes a number by `n as f64`, exact below 2⁵³.

use num_complex::Complex;

/// Returns `x` in single precision, rounded to nearest; infinite above [`f32::MAX`], NaN for NaN.
#[expect(clippy::cast_possible_truncation, reason = "rounded on purpose")]
#[inline]
pub const fn to_f32(x: f64) -> f32 {
    x as f32
}

/// Returns `z` in single precision, each part as by [`to_f32`].
#[inline]
pub const fn to_c32(z: Complex<f64>) -> Complex<f32> {
    Complex::new(to_f32(z.re), to_f32(z.im))
}

/// Returns `z` in double precision, exactly.
#[inline]
pub const fn to_c64(z: Complex<f32>) -> Complex<f64> {
    Complex::new(z.re as f64, z.im as f64)
}

/// Returns the whole part of a number that is known to be an index or a count.
///
/// Numbers below 1 and NaN give 0, and numbers above [`usize::MAX`] give `usize::MAX`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates, as documented"
)]
#[inline]
pub const fn to_usize(x: f64) -> usize {
    x as usize
}

/// Returns the whole part of a number that is known to be an integer far below 2⁶³, towards zero.
///
/// NaN gives 0, and numbers out of range give the nearer end.
#[expect(clippy::cast_possible_truncation, reason = "saturates, as documented")]
#[inline]
pub const fn to_i64(x: f64) -> i64 {
    x as i64
}

/// Returns a count or an index as a signed number; [`i64::MAX`] for larger counts, which no memory
/// can hold.
#[expect(clippy::cast_possible_wrap, reason = "larger numbers are left out")]
#[inline]
pub const fn to_signed(n: usize) -> i64 {
    if n as u64 > i64::MAX as u64 {
        i64::MAX
    } else {
        n as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_precision_is_rounded_to_nearest() {
        // 1 + 2⁻²⁴ lies midway and rounds to even.
        assert_eq!(to_f32(1.0 + 2.0_f64.powi(-24)).to_bits(), 1.0_f32.to_bits());
        let above = 1.0 + 1.5 * 2.0_f64.powi(-24);
        assert_eq!(to_f32(above).to_bits(), 1.0_f32.next_up().to_bits());
        assert_eq!(to_f32(1e39).to_bits(), f32::INFINITY.to_bits());
        assert!(to_f32(f64::NAN).is_nan(), "NaN stays NaN");
    }

    #[test]
    fn integers_are_cut_towards_zero_and_saturate() {
        assert_eq!([3.99, 0.5, -7.0, f64::NAN].map(to_usize), [3, 0, 0, 0]);
        assert_eq!(to_usize(f64::INFINITY), usize::MAX);
        assert_eq!([3.99, -3.99, f64::NAN].map(to_i64), [3, -3, 0]);
        assert_eq!([-1e300, 1e300].map(to_i64), [i64::MIN, i64::MAX]);
        assert_eq!([0, 7, usize::MAX].map(to_signed), [0, 7, i64::MAX]);
    }
}
