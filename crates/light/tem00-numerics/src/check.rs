//! Checks of arguments, which return the argument or its refusal.

use std::borrow::Cow;

use crate::{Refusal, RefusedValue, Shown};

/// Refuses an argument unless `holds`.
///
/// # Errors
///
/// Returns the refusal of the argument if `holds` is false.
pub fn that(
    holds: bool,
    parameter: &'static str,
    value: impl Into<RefusedValue>,
    unit: &'static str,
    allowed: impl Into<Cow<'static, str>>,
) -> Result<(), Refusal> {
    if holds {
        Ok(())
    } else {
        Err(Refusal::new(parameter, value, allowed).in_unit(unit))
    }
}

/// Returns a number if it is finite.
///
/// # Errors
///
/// Returns the refusal of the argument otherwise.
pub fn finite(parameter: &'static str, x: f64, unit: &'static str) -> Result<f64, Refusal> {
    that(x.is_finite(), parameter, x, unit, "finite").map(|()| x)
}

/// Returns a number if it is positive and finite.
///
/// # Errors
///
/// Returns the refusal of the argument otherwise.
pub fn positive(parameter: &'static str, x: f64, unit: &'static str) -> Result<f64, Refusal> {
    let holds = x > 0.0 && x.is_finite();
    that(holds, parameter, x, unit, "positive and finite").map(|()| x)
}

/// Returns a number if it is finite and not negative.
///
/// # Errors
///
/// Returns the refusal of the argument otherwise.
pub fn not_negative(parameter: &'static str, x: f64, unit: &'static str) -> Result<f64, Refusal> {
    let holds = x >= 0.0 && x.is_finite();
    that(holds, parameter, x, unit, "finite and not negative").map(|()| x)
}

/// Returns a number if it is in a range, both ends included.
///
/// # Errors
///
/// Returns the refusal of the argument otherwise.
pub fn range(
    parameter: &'static str,
    x: f64,
    [min, max]: [f64; 2],
    unit: &'static str,
) -> Result<f64, Refusal> {
    if (min..=max).contains(&x) {
        return Ok(x);
    }
    let space = if unit.is_empty() { "" } else { " " };
    let [min, max] = [min, max].map(|end| format!("{}{space}{unit}", Shown(end)));
    that(false, parameter, x, unit, format!("from {min} to {max}")).map(|()| x)
}

/// Returns a length from 1e−30 m to 1e30 m: squares, products and quotients of such lengths stay
/// within `f64`.
///
/// # Errors
///
/// Returns the refusal of the argument otherwise.
pub fn length(parameter: &'static str, x: f64) -> Result<f64, Refusal> {
    range(parameter, x, [1e-30, 1e30], "m")
}

/// Returns a coordinate within ±1e30 m.
///
/// # Errors
///
/// Returns the refusal of the argument otherwise.
pub fn coordinate(parameter: &'static str, x: f64) -> Result<f64, Refusal> {
    range(parameter, x, [-1e30, 1e30], "m")
}

/// Checks every entry of a list.
///
/// # Errors
///
/// Returns the first refusal, with its index.
pub fn each(list: &[f64], check: impl Fn(f64) -> Result<f64, Refusal>) -> Result<(), Refusal> {
    for (index, &x) in list.iter().enumerate() {
        check(x).map_err(|refusal| refusal.at(index))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use tem00_testkit::refuses;

    use super::*;

    const INFINITE: [f64; 3] = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN];

    #[test]
    fn numbers_outside_are_refused() {
        let [up, down, nan] = INFINITE;
        refuses!(x = -1.0 => finite("x", x, "m"); x: [up, down, nan]);
        refuses!(x = 5e-324 => positive("x", x, "m"); x: [0.0, -1.0, up, nan]);
        refuses!(x = 0.0 => not_negative("x", x, "m"); x: [-5e-324, up, nan]);
        refuses!(x = 1.0 => range("x", x, [1.0, 2.0], "m"); x: [1.0_f64.next_down(), 2.1, up, nan]);
        refuses!(x = 2.0 => range("x", x, [1.0, 2.0], ""); x: [0.0, nan]);
        let refusal = range("x", 3.0, [1e-30, 2.0], "m").unwrap_err();
        assert_eq!(
            refusal.to_string(),
            "x must be from 1e-30 m to 2 m, got 3 m"
        );
        let list = each(&[1.0, -2.0, nan], |x| positive("x", x, ""));
        assert_eq!(list.unwrap_err().index, Some(1), "the first");
    }
}
