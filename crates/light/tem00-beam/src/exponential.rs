//! Exponential function computed from additions and multiplications alone.
//!
//! It has no branch and no table, so that a loop over it fills the vector units, and uses no
//! library and no fused multiplication, so that its bits are the same on every platform.
//!
//! ```text
//! exp(x) = 2ᵏ exp(r)     with k = round(x / ln 2), r = x − k ln 2, |r| ≤ ln 2 / 2
//! ```

use core::f64::consts::LOG2_E;

/// Returns `exp(x)`, within 1.5 units of the last place; 0 below −708, where `exp(x)` is 3e−308.
///
/// The series ends at r¹³/13!, with a remainder of 0.347¹⁴/14! = 4e−18.
#[inline(always)]
pub(crate) fn exponential(x: f64) -> f64 {
    // Numbers near 1.5 · 2⁵² are 1 apart, so the sum rounds and has k in its lowest bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    // ln 2 as 32 bits, whose product with k is exact, and a remainder.
    const LN_2_HEAD: f64 = f64::from_bits(0x3FE6_2E42_FEE0_0000);
    const LN_2_TAIL: f64 = f64::from_bits(0x3DEA_39EF_3579_3C76);
    let rounded = x * LOG2_E + ROUND;
    let k = rounded - ROUND;
    let r = x - k * LN_2_HEAD - k * LN_2_TAIL;

    let r2 = r * r;
    let r4 = r2 * r2;
    let pair = |n: usize| INVERSE_FACTORIAL[n] + INVERSE_FACTORIAL[n + 1] * r;
    let low = pair(2) + pair(4) * r2;
    let middle = pair(6) + pair(8) * r2;
    let high = pair(10) + pair(12) * r2;
    let series = 1.0 + (r + r2 * (low + r4 * (middle + r4 * high)));

    // 2ᵏ⁻¹, so that the largest results, with k = 1024, need no exponent beyond the range.
    let scale = f64::from_bits(rounded.to_bits().wrapping_add(1_022) << 52);
    let scaled = 2.0 * series * scale;
    let at_most_infinite = if x > 710.0 { f64::INFINITY } else { scaled };
    if x < -708.0 { 0.0 } else { at_most_infinite }
}

/// 1/n!
const INVERSE_FACTORIAL: [f64; 14] = {
    let mut values = [1.0; 14];
    let mut n = 1;
    while n < 14 {
        values[n] = values[n - 1] / n as f64;
        n += 1;
    }
    values
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The fractional parts of the multiples of the golden ratio: an even spread.
    fn spread(from: f64, to: f64) -> impl Iterator<Item = f64> {
        (0..200_000).map(move |i| from + (to - from) * (f64::from(i) * 0.618_033_988_749).fract())
    }

    /// The error is 1.5 units at most: half a unit each in the last sum and in its summand, a
    /// quarter in `k ln 2`, and below 0.1 units from the truncated series. Libm errs by one unit.
    #[test]
    fn exponentials_are_those_of_libm_to_the_last_places() {
        for x in spread(-708.0, 709.78).chain(spread(-32.0, 0.0)) {
            let reference = libm::exp(x);
            let unit = reference.next_up() - reference;
            let error = (exponential(x) - reference).abs() / unit;
            assert!(error <= 2.0, "x = {x}: {error} units");
        }
    }

    #[test]
    fn exponentials_are_sane_at_the_ends() {
        for (x, expected) in [
            (0.0, 1.0),
            (-0.0, 1.0),
            (1e-20, 1.0),
            (-708.01, 0.0),
            (-1e6, 0.0),
            (f64::MIN, 0.0),
            (f64::NEG_INFINITY, 0.0),
            (709.79, f64::INFINITY),
            (1_500.0, f64::INFINITY),
            (f64::MAX, f64::INFINITY),
            (f64::INFINITY, f64::INFINITY),
        ] {
            assert_eq!(exponential(x).to_bits(), f64::to_bits(expected), "{x}");
        }
        assert!(exponential(f64::NAN).is_nan(), "NaN");
    }
}
