//! Checks of the fields of a light, and their rows of four.

use crate::BeamError;
use crate::range::check;
use crate::real::Real;
use crate::real::sealed::Scalar;

/// The cut-off of a freshly placed light, in beam radii.
pub(super) const DEFAULT_CUTOFF: f64 = 4.0;

/// Rounds the fields of a light to `f32`, unless one of them overflows.
pub(super) fn to_single<const N: usize>(rows: [[f64; 4]; N]) -> Result<[[f32; 4]; N], BeamError> {
    let overflow = |field: &&f64| !<f32 as Scalar>::of(**field).is_finite();
    match rows.as_flattened().iter().find(overflow) {
        Some(&field) => Err(BeamError::single_precision(field)),
        None => Ok(rows.map(|row| row.map(<f32 as Scalar>::of))),
    }
}

pub(super) fn row<T: Real>([x, y, z]: [T; 3], w: T) -> [T; 4] {
    [x, y, z, w]
}

pub(super) fn first_three<T: Real>([x, y, z, _]: [T; 4]) -> [T; 3] {
    [x, y, z]
}

/// Checks that `f32` holds all digits of the quantities that a light divides by.
pub(super) fn check_digits<const N: usize>(quantities: [f64; N]) -> Result<(), BeamError> {
    for quantity in quantities {
        let dark = quantity.abs() < f64::MIN_POSITIVE;
        if !(<f32 as Scalar>::of(quantity).is_normal() || dark) {
            return Err(BeamError::single_precision(quantity));
        }
    }
    Ok(())
}

/// Returns the power, if no light concentrates it so far that an irradiance overflows.
pub(super) fn checked_power(power: f64) -> Result<f64, BeamError> {
    let valid = (0.0..=1e100).contains(&power);
    check(valid, "power", power, "W", "between 0 W and 1e100 W")?;
    Ok(power)
}
