//! Numbers from C, checked before the library sees them.

use core::fmt::Display;

use crate::{pointers::read, status::Failure};

/// The largest coordinate, in metres: up to here no square leaves the range of a double. It is the
/// number that 1e30 becomes in single precision.
const LARGEST: f64 = 1.000_000_015_047_466_2e30;

/// Largest deviation from 1 of the length of a vector that is taken for a unit vector as it is: a
/// direction in single precision is nearer.
const UNIT_TOLERANCE: f64 = 1e-4;

/// Checks that all numbers are finite and within ±1e30.
pub(crate) fn check_coordinates<T: Into<f64> + Copy>(
    name: &str,
    values: &[T],
) -> Result<(), Failure> {
    check_all(name, values, "finite and within ±1e30", |x| {
        x.abs() <= LARGEST
    })
}

/// Checks that a number is finite and within ±1e30.
pub(crate) fn check_coordinate(name: &str, value: f64) -> Result<f64, Failure> {
    check_coordinates(name, &[value]).map(|()| value)
}

/// Checks that a number is finite.
pub(crate) fn check_number(name: &str, value: f64) -> Result<f64, Failure> {
    check_all(name, &[value], "finite", f64::is_finite).map(|()| value)
}

/// Checks a random number.
pub(crate) fn check_variate(name: &str, value: f64) -> Result<f64, Failure> {
    check_variates(name, &[value]).map(|()| value)
}

/// Checks random numbers.
pub(crate) fn check_variates(name: &str, values: &[f64]) -> Result<(), Failure> {
    check_all(name, values, "inside [0, 1)", |x| (0.0..1.0).contains(&x))
}

/// Checks a length that may be zero.
pub(crate) fn check_length(name: &str, value: f64) -> Result<f64, Failure> {
    let is_length = |x| (0.0..=LARGEST).contains(&x);
    check_all(name, &[value], "from 0 to 1e30", is_length).map(|()| value)
}

/// Checks a length of a relief that is finer than a speckle.
pub(crate) fn check_relief(name: &str, value: f64) -> Result<(), Failure> {
    check_all(name, &[value], "from 0 to 1e-3", |x| {
        (0.0..=1e-3).contains(&x)
    })
}

/// Checks a size: a length that is not zero.
pub(crate) fn check_size(name: &str, value: f64) -> Result<f64, Failure> {
    let is_size = |x| x > 0.0 && x <= LARGEST;
    check_all(name, &[value], "above 0 and at most 1e30", is_size).map(|()| value)
}

/// Checks that no result is NaN, as it may be where the numbers that lead to it overflow.
pub(crate) fn check_result(name: &str, values: &[f64]) -> Result<(), Failure> {
    if values.iter().any(|x| x.is_nan()) {
        let message =
            format!("{name} overflows: the numbers are too far apart to be of one camera");
        return Err(Failure::argument(name, message));
    }
    Ok(())
}

/// Returns the unit vector along a vector: the vector itself where its length is 1 but for
/// rounding.
pub(crate) fn unit_vector(name: &str, vector: [f64; 3]) -> Result<[f64; 3], Failure> {
    check_coordinates(name, &vector)?;
    let length = vector.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
    if (length - 1.0).abs() <= UNIT_TOLERANCE {
        return Ok(vector);
    }
    if length > 0.0 {
        return Ok(vector.map(|x| x / length));
    }
    Err(Failure::argument(name, format!("{name} must not be zero")))
}

/// Reads the coordinates of a point.
///
/// # Safety
///
/// The pointer is null or valid for `N` numbers.
pub(crate) unsafe fn read_point<T: Into<f64> + Copy, const N: usize>(
    name: &str,
    pointer: *const T,
) -> Result<[T; N], Failure> {
    // SAFETY: by the contract of this function.
    let point = unsafe { read(name, pointer) }?;
    check_coordinates(name, &point).map(|()| point)
}

/// Reads a direction of any length as a unit vector.
///
/// # Safety
///
/// The pointer is null or valid for three numbers.
pub(crate) unsafe fn read_direction(name: &str, pointer: *const f64) -> Result<[f64; 3], Failure> {
    // SAFETY: by the contract of this function.
    unit_vector(name, unsafe { read(name, pointer) }?)
}

/// Reads random numbers.
///
/// # Safety
///
/// The pointer is null or valid for `N` numbers.
pub(crate) unsafe fn read_variates<const N: usize>(
    name: &str,
    pointer: *const f64,
) -> Result<[f64; N], Failure> {
    // SAFETY: by the contract of this function.
    let u = unsafe { read(name, pointer) }?;
    check_variates(name, &u).map(|()| u)
}

/// Takes no early exit where all is well, so that the loop fills the vector units.
fn check_all<T: Into<f64> + Copy>(
    name: &str,
    values: &[T],
    allowed: impl Display,
    is_allowed: impl Fn(f64) -> bool,
) -> Result<(), Failure> {
    if values
        .iter()
        .fold(true, |all, &x| all & is_allowed(x.into()))
    {
        return Ok(());
    }
    let refused = values.iter().position(|&x| !is_allowed(x.into()));
    let index = refused.unwrap_or_default();
    let place = match values {
        [_] => String::new(),
        _ => format!("[{index}]"),
    };
    let value: f64 = values[index].into();
    Err(Failure::argument(
        name,
        format!("{name}{place} must be {allowed}, got {value:e}"),
    ))
}

/// A number that stands for one of the values of an enumeration of the header.
pub(crate) fn code<T: Copy>(name: &str, code: u32, values: &[T]) -> Result<T, Failure> {
    let value = usize::try_from(code).ok().and_then(|code| values.get(code));
    value.copied().ok_or_else(|| {
        let last = values.len() - 1;
        Failure::argument(name, format!("{name} must be 0 to {last}, got {code}"))
    })
}

#[cfg(test)]
mod tests;
