//! The units of parameters and figures.

use tem00_report::report::units::{
    DEGREES, MICROMETRES, MILLIMETRES, MILLIRADIANS, MILLISECONDS, MILLIWATTS, NANOMETRES, NUMBER,
    PERCENT, Unit,
};
use tem00_triangulation::{DesignFigure, DesignParameter};

/// Returns the unit of a parameter.
pub(super) const fn of_parameter(parameter: DesignParameter) -> Unit {
    match parameter {
        DesignParameter::Angle => DEGREES,
        DesignParameter::SourceHalfAngle => MILLIRADIANS,
        DesignParameter::Wavelength | DesignParameter::Linewidth => NANOMETRES,
        DesignParameter::PixelPitch => MICROMETRES,
        DesignParameter::Power => MILLIWATTS,
        DesignParameter::Exposure => MILLISECONDS,
        DesignParameter::LineThickness
        | DesignParameter::FocalLength
        | DesignParameter::Distance => MILLIMETRES,
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
        DesignFigure::Saturation | DesignFigure::GrainSaturation => PERCENT,
        _ => NUMBER,
    }
}

/// Returns the SI unit of a parameter, as headings of files end with it.
pub(super) const fn si_of_parameter(parameter: DesignParameter) -> &'static str {
    match parameter {
        DesignParameter::Angle | DesignParameter::SourceHalfAngle => "_rad",
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

/// Returns a quantity's name with its unit: "depth of field (mm)".
pub(super) fn label(unit: Unit, name: &str) -> String {
    unit.label(&words(name))
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
        assert_eq!(angle.text(core::f64::consts::FRAC_PI_6), "30°");
        let wavelength = of_parameter(DesignParameter::Wavelength);
        assert_eq!(wavelength.text(660e-9), "660 nm");
        assert_eq!(of_parameter(DesignParameter::FNumber).text(5.6), "5.6");
        assert_eq!(of_figure(DesignFigure::Saturation).text(0.9), "90 %");
        assert_eq!(
            label(of_figure(DesignFigure::DepthOfField), "depth_of_field"),
            "depth of field (mm)"
        );
    }
}
