//! Ranges that arguments are held to.

use crate::BeamError;

/// The range of [`is_length`].
const LENGTH: &str = "between 1e-30 m and 1e30 m";
/// The range of [`is_coordinate`].
const COORDINATE: &str = "finite and within ±1e30 m";

/// The lengths whose squares, products and quotients stay within the range of `f64`.
pub(crate) fn is_length(x: f64) -> bool {
    (1e-30..=1e30).contains(&x)
}

/// The coordinates whose squares and products with lengths stay within the range of `f64`.
pub(crate) fn is_coordinate(x: f64) -> bool {
    x.abs() <= 1e30
}

pub(crate) fn check_length(parameter: &'static str, x: f64) -> Result<(), BeamError> {
    check(is_length(x), parameter, x, "m", LENGTH)
}

pub(crate) fn check_coordinate(parameter: &'static str, x: f64) -> Result<(), BeamError> {
    check(is_coordinate(x), parameter, x, "m", COORDINATE)
}

/// Checks the curvature `1/R` of a wavefront or a surface, in m⁻¹.
pub(crate) fn check_curvature(x: f64) -> Result<(), BeamError> {
    let allowed = "finite and within ±1e30 m⁻¹";
    check(is_coordinate(x), "curvature", x, "m⁻¹", allowed)
}

/// As [`check_length`], for the entries of a list.
pub(crate) fn check_lengths(parameter: &'static str, list: &[f64]) -> Result<(), BeamError> {
    check_list(is_length, parameter, list, "m", LENGTH)
}

/// As [`check_coordinate`], for the entries of a list.
pub(crate) fn check_coordinates(parameter: &'static str, list: &[f64]) -> Result<(), BeamError> {
    check_list(is_coordinate, parameter, list, "m", COORDINATE)
}

/// Refuses a number unless it is `valid`.
pub(crate) fn check(
    valid: bool,
    parameter: &'static str,
    value: f64,
    unit: &'static str,
    allowed: &'static str,
) -> Result<(), BeamError> {
    if valid {
        Ok(())
    } else {
        Err(BeamError::out_of_range(parameter, value, unit, allowed))
    }
}

/// Refuses a list unless all its entries are valid.
pub(crate) fn check_list(
    is_valid: impl Fn(f64) -> bool,
    parameter: &'static str,
    list: &[f64],
    unit: &'static str,
    allowed: &'static str,
) -> Result<(), BeamError> {
    match list.iter().position(|&value| !is_valid(value)) {
        Some(index) => Err(BeamError::Entry {
            parameter,
            index,
            value: list[index],
            unit,
            allowed,
        }),
        None => Ok(()),
    }
}
