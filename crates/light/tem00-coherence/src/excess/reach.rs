//! Limits of integrals over the lags of heights.

use core::f64::consts::TAU;

/// Squared phases above which heights that differ by more than the width no longer matter.
pub(super) const STEEP: f64 = 50.0;

/// Returns whether kernels, which have no frequency above 1 per speckle, and an excess that has
/// hardly any above 1 per `width` leave nothing at a displacement.
pub(super) fn is_beyond(shift: f64, width: f64) -> bool {
    TAU * (shift - 1.0) * width > 12.0
}
