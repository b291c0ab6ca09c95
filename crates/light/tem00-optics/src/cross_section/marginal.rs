//! The distribution of the power along one axis: a normal distribution of 1/e² half-width `w`.

use core::f64::consts::{FRAC_2_SQRT_PI, SQRT_2};

/// Below this width, in units of the 1/e half-width, an interval is integrated by a series. The
/// first omitted term is below `2 NARROW⁶`; the difference of error functions loses a factor of
/// `1 / NARROW`.
const NARROW: f64 = 3e-3;

/// An interval of one axis, in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    /// The middle, not negative.
    middle: f64,
    /// Half the width, not negative.
    half: f64,
}

impl Interval {
    /// The interval of half-width `half` about `middle`, or its mirror image about 0. An interval
    /// of negative width is empty.
    pub(super) fn new(middle: f64, half: f64) -> Self {
        Self {
            middle: middle.abs(),
            half: half.max(0.0),
        }
    }

    /// The fraction of the power in this interval if the 1/e² half-width is `w`.
    ///
    /// It keeps its relative accuracy in the tails and for narrow intervals.
    pub(super) fn power(self, w: f64) -> f64 {
        let (m, h) = (in_units(self.middle, w), in_units(self.half, w));
        if h < NARROW && m * h < NARROW {
            return narrow(m, h);
        }
        let (low, high) = (
            in_units(self.middle - self.half, w),
            in_units(self.middle + self.half, w),
        );
        if low > 0.0 {
            0.5 * (libm::erfc(low) - libm::erfc(high))
        } else {
            0.5 * (libm::erf(high) - libm::erf(low))
        }
    }
}

/// The fraction of the power at coordinates greater than `x`.
pub(super) fn power_beyond(x: f64, w: f64) -> f64 {
    0.5 * libm::erfc(in_units(x, w))
}

/// A length in units of the 1/e half-width.
fn in_units(x: f64, w: f64) -> f64 {
    x / w * SQRT_2
}

/// `∫ exp(−t²) dt / √π` from m − h to m + h, as a power series in h.
///
/// The even derivatives of `exp(−t²)` are Hermite polynomials of m; here they are written in
/// `(m h)²` and `h²`, which stay finite.
fn narrow(m: f64, h: f64) -> f64 {
    let (p, q) = ((m * h).powi(2), h * h);
    let second = (2.0 * p - q) / 3.0;
    let fourth = (4.0 * p * p - 12.0 * p * q + 3.0 * q * q) / 30.0;
    FRAC_2_SQRT_PI * h * (-m * m).exp() * (1.0 + second + fourth)
}
