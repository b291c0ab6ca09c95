//! The units in which people read quantities.

use super::cell::Cell;
use crate::digits::rounded;

/// A unit in which a quantity is shown, and the number of digits shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The symbol; empty for numbers.
    symbol: &'static str,
    /// Its size in SI units, or in pixels.
    size: f64,
    digits: u8,
}

pub const NUMBER: Unit = Unit::new("", 1.0);
pub const PERCENT: Unit = Unit::new("%", 0.01);
pub const PIXELS: Unit = Unit::new("px", 1.0);
pub const METRES: Unit = Unit::new("m", 1.0);
pub const MILLIMETRES: Unit = Unit::new("mm", 1e-3);
pub const MICROMETRES: Unit = Unit::new("µm", 1e-6);
pub const NANOMETRES: Unit = Unit::new("nm", 1e-9);
pub const MILLISECONDS: Unit = Unit::new("ms", 1e-3);
pub const MILLIRADIANS: Unit = Unit::new("mrad", 1e-3);
pub const DEGREES: Unit = Unit::new("°", core::f64::consts::PI / 180.0);

impl Unit {
    /// Creates a unit, whose values are shown with four digits, from its symbol and its size in SI
    /// units.
    pub const fn new(symbol: &'static str, size: f64) -> Self {
        let digits = 4;
        Self {
            symbol,
            size,
            digits,
        }
    }

    /// Returns the unit that suits a length in metres.
    pub const fn of_length(metres: f64) -> Self {
        match metres {
            long if long >= 1.0 => METRES,
            long if long >= 1e-3 => MILLIMETRES,
            long if long >= 1e-6 => MICROMETRES,
            _ => NANOMETRES,
        }
    }

    /// Returns the unit for values with `digits` significant digits.
    pub const fn with_digits(self, digits: u8) -> Self {
        Self { digits, ..self }
    }

    /// Returns the unit for a value with this uncertainty, with digits up to the second digit of
    /// the uncertainty.
    pub fn with_digits_known(self, value: f64, uncertainty: f64) -> Self {
        let place = |number: f64| number.abs().log10().floor();
        let digits = place(value) - place(uncertainty) + 2.0;
        if !digits.is_finite() {
            return self;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the number of digits lies in [1, 9]"
        )]
        self.with_digits(digits.clamp(1.0, 9.0) as u8)
    }

    /// Returns a value in SI units in this unit.
    pub fn of(self, value: f64) -> f64 {
        value / self.size
    }

    /// Returns a name with the unit: "range (mm)".
    pub fn label(self, name: &str) -> String {
        if self.symbol.is_empty() {
            name.to_owned()
        } else {
            format!("{name} ({})", self.symbol)
        }
    }

    /// Writes a value in SI units with the unit.
    pub fn text(self, value: f64) -> String {
        let text = rounded(self.of(value), self.digits);
        match self.symbol {
            "" => text,
            "°" => format!("{text}°"),
            symbol => format!("{text} {symbol}"),
        }
    }

    /// Returns a value in SI units, shown with the unit.
    pub fn quantity(self, value: f64) -> Cell {
        Cell::new(value, self.text(value))
    }

    /// Returns a value in SI units for a column that has the unit in its heading.
    pub fn cell(self, value: f64) -> Cell {
        Cell::new(value, rounded(self.of(value), self.digits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_shown_in_the_unit_that_suits() {
        for (metres, text) in [
            (0.3, "300 mm"),
            (5.672_7e-6, "5.673 µm"),
            (650e-9, "650 nm"),
            (2.0, "2 m"),
            (3.125e-3, "3.125 mm"),
        ] {
            assert_eq!(Unit::of_length(metres).text(metres), text);
        }
    }

    #[test]
    fn programs_get_si_units_and_people_a_unit_that_suits() {
        let cell = MICROMETRES.quantity(38.431e-6);
        assert_eq!(cell, Cell::new(38.431e-6, "38.43 µm"));
        assert_eq!(PERCENT.with_digits(3).cell(0.994_21).text(), "99.4");
        assert_eq!(MICROMETRES.label("height"), "height (µm)");
    }

    #[test]
    fn an_uncertain_value_ends_where_its_uncertainty_does() {
        for (value, uncertainty, text) in [
            (11.07e-6, 3.3e-6, "11.1 µm"),
            (25.86e-6, 13e-6, "26 µm"),
            (3.472e-6, 20e-6, "3 µm"),
            (3.472e-6, 0.0, "3.472 µm"),
        ] {
            let unit = MICROMETRES.with_digits_known(value, uncertainty);
            assert_eq!(unit.text(value), text);
        }
        let unit = NUMBER.with_digits_known(1.000_08, 1.75e-4);
        assert_eq!(unit.text(1.000_08), "1.00008");
    }
}
