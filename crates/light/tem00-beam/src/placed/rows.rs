//! Checks of the fields of a light, and their rows of four.

use tem00_numerics::check;

use crate::Refusal;
use crate::real::Real;
use crate::real::sealed::Scalar;

/// The cut-off of a freshly placed light, in beam radii.
pub(super) const DEFAULT_CUTOFF: f64 = 4.0;

/// Rounds the fields of a light to `f32`, unless one of them overflows.
pub(super) fn to_single<const N: usize>(rows: [[f64; 4]; N]) -> Result<[[f32; 4]; N], Refusal> {
    let overflow = |field: &&f64| !<f32 as Scalar>::of(**field).is_finite();
    match rows.as_flattened().iter().find(overflow) {
        Some(&field) => Err(too_large_for_single(field)),
        None => Ok(rows.map(|row| row.map(<f32 as Scalar>::of))),
    }
}

/// A field of a placed light is outside the range that single precision can carry.
pub(crate) fn too_large_for_single(field: f64) -> Refusal {
    let allowed = "able to hold all fields of the light in f32";
    Refusal::new("single_precision", field, allowed)
}

pub(super) fn row<T: Real>([x, y, z]: [T; 3], w: T) -> [T; 4] {
    [x, y, z, w]
}

pub(super) fn first_three<T: Real>([x, y, z, _]: [T; 4]) -> [T; 3] {
    [x, y, z]
}

/// Checks that `f32` holds all digits of the quantities that a light divides by.
pub(super) fn check_digits<const N: usize>(quantities: [f64; N]) -> Result<(), Refusal> {
    for quantity in quantities {
        let dark = quantity.abs() < f64::MIN_POSITIVE;
        if !(<f32 as Scalar>::of(quantity).is_normal() || dark) {
            return Err(too_large_for_single(quantity));
        }
    }
    Ok(())
}

/// Returns the power, if no light concentrates it so far that an irradiance overflows.
pub(super) fn checked_power(power: f64) -> Result<f64, Refusal> {
    check::range("power", power, [0.0, 1e100], "W")
}
