//! Fields of a light as rows of four.

use tem00_numerics::check;

use crate::Refusal;

/// The cut-off of a freshly placed light, in beam radii.
pub(super) const DEFAULT_CUTOFF: f64 = 4.0;

pub(super) fn row([x, y, z]: [f64; 3], w: f64) -> [f64; 4] {
    [x, y, z, w]
}

pub(super) fn first_three([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

/// Returns the power if no light can concentrate it so much that an irradiance overflows.
pub(super) fn checked_power(power: f64) -> Result<f64, Refusal> {
    check::range("power", power, [0.0, 1e100], "W")
}
