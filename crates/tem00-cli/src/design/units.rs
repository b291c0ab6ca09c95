//! How quantities are shown.

use tem00_triangulation::{DesignFigure, DesignParameter};

use crate::table::rounded;

/// A unit in which a quantity is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    /// The symbol; empty for numbers.
    pub(super) symbol: &'static str,
    /// Its size in SI units.
    size: f64,
}

const fn unit(symbol: &'static str, size: f64) -> Unit {
    Unit { symbol, size }
}

const NUMBER: Unit = unit("", 1.0);
const MILLIMETRES: Unit = unit("mm", 1e-3);
/// The unit of uncertainties.
pub(super) const MICROMETRES: Unit = unit("µm", 1e-6);
const MILLIWATTS: Unit = unit("mW", 1e-3);
const MILLISECONDS: Unit = unit("ms", 1e-3);

impl Unit {
    /// Returns a value in SI units in this unit.
    pub(super) fn of(self, value: f64) -> f64 {
        value / self.size
    }

    /// Returns a quantity's name with the unit: "range (mm)".
    pub(super) fn label(self, name: &str) -> String {
        let name = words(name);
        if self.symbol.is_empty() {
            name
        } else {
            format!("{name} ({})", self.symbol)
        }
    }

    /// Writes a value in SI units with four digits, without the unit.
    pub(super) fn text(self, value: f64) -> String {
        digits(self.of(value))
    }

    /// Writes a value in SI units with four digits and the unit.
    pub(super) fn quantity(self, value: f64) -> String {
        let text = self.text(value);
        format!("{text} {}", self.symbol).trim_end().to_owned()
    }
}

/// Returns the unit of a parameter.
pub(super) const fn of_parameter(parameter: DesignParameter) -> Unit {
    match parameter {
        DesignParameter::Angle => unit("°", core::f64::consts::PI / 180.0),
        DesignParameter::Wavelength => unit("nm", 1e-9),
        DesignParameter::PixelPitch => MICROMETRES,
        DesignParameter::Power => MILLIWATTS,
        DesignParameter::Exposure => MILLISECONDS,
        DesignParameter::LineWidth | DesignParameter::FocalLength | DesignParameter::Distance => {
            MILLIMETRES
        }
        _ => NUMBER,
    }
}

/// Returns the unit of a figure.
pub(super) const fn of_figure(figure: DesignFigure) -> Unit {
    match figure {
        DesignFigure::Uncertainty | DesignFigure::ExpandedUncertainty => MICROMETRES,
        DesignFigure::Range | DesignFigure::DepthOfField | DesignFigure::FieldWidth => MILLIMETRES,
        DesignFigure::Power => MILLIWATTS,
        DesignFigure::Exposure => MILLISECONDS,
        DesignFigure::Saturation | DesignFigure::GrainSaturation => unit("%", 0.01),
        _ => NUMBER,
    }
}

/// Returns the SI unit of a parameter, as headings of files end with it.
pub(super) const fn si_of_parameter(parameter: DesignParameter) -> &'static str {
    match parameter {
        DesignParameter::Angle => "_rad",
        DesignParameter::Power => "_W",
        DesignParameter::Exposure => "_s",
        DesignParameter::FNumber => "",
        _ => "_m",
    }
}

/// Returns the SI unit of a figure, as headings of files end with it.
pub(super) const fn si_of_figure(figure: DesignFigure) -> &'static str {
    match figure {
        DesignFigure::Power => "_W",
        DesignFigure::Exposure => "_s",
        DesignFigure::Saturation | DesignFigure::GrainSaturation | DesignFigure::Signal => "",
        _ => "_m",
    }
}

/// Writes a number with four significant digits.
pub(super) fn digits(value: f64) -> String {
    rounded(value, 4)
}

/// Returns the words of a name: "depth of field", "f-number".
pub(super) fn words(name: &str) -> String {
    name.replace("f_number", "f-number").replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_shown_in_their_units() {
        let angle = of_parameter(DesignParameter::Angle);
        assert_eq!(angle.quantity(core::f64::consts::FRAC_PI_6), "30 °");
        assert_eq!(
            of_parameter(DesignParameter::Wavelength).quantity(660e-9),
            "660 nm"
        );
        assert_eq!(of_parameter(DesignParameter::FNumber).quantity(5.6), "5.6");
        assert_eq!(of_figure(DesignFigure::Saturation).quantity(0.9), "90 %");
        assert_eq!(
            of_figure(DesignFigure::DepthOfField).label("depth_of_field"),
            "depth of field (mm)"
        );
    }
}
