//! The units and the words of quantities.

use tem00_triangulation::QuantityUnit;

use tem00_report::report::units::Unit;

/// Returns the unit in which people read a quantity.
pub(crate) const fn shown(unit: &QuantityUnit) -> Unit {
    Unit::new(unit.shown, unit.size)
}

/// Returns the SI unit of a quantity, as headings of files end with it.
pub(crate) fn si_suffix(unit: &QuantityUnit) -> String {
    match unit.si {
        "" => String::new(),
        si => format!("_{si}"),
    }
}

/// Returns a quantity's name with its unit: "depth of field (mm)".
pub(crate) fn label(unit: &QuantityUnit, name: &str) -> String {
    shown(unit).label(&words(name))
}

/// Returns the words of a name: "depth of field", "f-number".
pub(crate) fn words(name: &str) -> String {
    name.replace("f_number", "f-number").replace('_', " ")
}

#[cfg(test)]
mod tests {
    use tem00_triangulation::{DesignFigure, SetupQuantity};

    use super::*;

    #[test]
    fn values_are_shown_in_their_units() {
        let shown = |unit, value| shown(unit).text(value);
        let angle = SetupQuantity::Angle.unit();
        assert_eq!(shown(angle, core::f64::consts::FRAC_PI_6), "30°");
        assert_eq!(shown(SetupQuantity::Wavelength.unit(), 660e-9), "660 nm");
        assert_eq!(shown(SetupQuantity::FNumber.unit(), 5.6), "5.6");
        assert_eq!(shown(DesignFigure::Saturation.unit(), 0.9), "90 %");
        let label = label(DesignFigure::DepthOfField.unit(), "depth_of_field");
        assert_eq!(label, "depth of field (mm)");
    }
}
