//! Arguments that are checked where their name is known.

use pyo3::prelude::*;
use tem00_speckle::Phasors;

use crate::{arrays::Whole, error::refused};

/// A width and a height, or any two counts.
pub(crate) fn counts(name: &str, [x, y]: &[Whole<'_>; 2]) -> PyResult<[usize; 2]> {
    Ok([x.unsigned(name)?, y.unsigned(name)?])
}

/// An index into `count` things; negative ones count from the end, as in Python.
pub(crate) fn index(name: &str, index: &Whole<'_>, count: usize) -> PyResult<usize> {
    let given = index.signed(name)?;
    let length = i64::try_from(count).unwrap_or(i64::MAX);
    let place = if given < 0 { given + length } else { given };
    match usize::try_from(place) {
        Ok(place) if place < count => Ok(place),
        _ => {
            let message = format!("{name} must be -{count} to {}, got {given}", count - 1);
            Err(refused(name, message))
        }
    }
}

/// Refuses what is not a finite number.
pub(crate) fn finite(name: &str, x: f64) -> PyResult<f64> {
    if x.is_finite() {
        return Ok(x);
    }
    Err(refused(name, format!("{name} must be finite, got {x}")))
}

/// The same for two numbers along x and y.
pub(crate) fn finite_pair(name: &str, [x, y]: [f64; 2]) -> PyResult<[f64; 2]> {
    Ok([finite(name, x)?, finite(name, y)?])
}

/// The choices of a parameter that Python gives as a string, and their names.
pub(crate) type Choices<T, const N: usize> = [(&'static str, T); N];

pub(crate) const PHASORS: Choices<Phasors, 2> =
    [("unit", Phasors::Unit), ("gaussian", Phasors::Gaussian)];

/// The choice of that name.
pub(crate) fn choice<T: Copy, const N: usize>(
    parameter: &str,
    choices: &Choices<T, N>,
    name: &str,
) -> PyResult<T> {
    let found = choices.iter().find(|(own, _)| *own == name);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let allowed = choices.map(|(own, _)| own).join("', '");
        let message = format!("{parameter} must be one of '{allowed}', got '{name}'");
        refused(parameter, message)
    })
}

/// The name of a choice.
pub(crate) fn name_of<T: Copy + PartialEq, const N: usize>(
    choices: &Choices<T, N>,
    value: T,
) -> &'static str {
    let found = choices.iter().find(|(_, own)| *own == value);
    found.map_or("", |(name, _)| name)
}
