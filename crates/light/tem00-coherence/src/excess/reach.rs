//! Limits of integrals over the lags of heights.

use core::f64::consts::TAU;

/// Squared phases above which lags beyond the width of the excess no longer matter.
pub(super) const STEEP: f64 = 50.0;

/// Returns whether the excess vanishes at a displacement: kernels have no frequency above 1 per
/// speckle, and the excess hardly any above 1 per `width`.
pub(super) fn is_beyond(shift: f64, width: f64) -> bool {
    TAU * (shift - 1.0) * width > 12.0
}
