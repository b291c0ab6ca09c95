use core::fmt;

use tem00_config::Dimension;

use crate::{SetupDescription, SetupQuantity};

/// A number of a set-up that a search may vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DesignParameter {
    /// The f-number of the lens: the size of the pupil.
    FNumber,
    /// The angle between optical axis and the upright, in radians.
    Angle,
    /// The full 1/e² thickness of the line on the part, in metres.
    LineThickness,
    /// The vacuum wavelength of the laser, in metres.
    Wavelength,
    /// The linewidth of the laser, in metres.
    Linewidth,
    /// The half-angle of the source as the part sees it, in radians.
    SourceHalfAngle,
    /// The power in the line, in watts.
    Power,
    /// The exposure time, in seconds.
    Exposure,
    /// The distance of the pixels' centres, in metres; their number, capacity and noise stay.
    PixelPitch,
    /// The focal length of the lens, in metres; its f-number stays.
    FocalLength,
    /// The distance from the entrance pupil to the line, in metres.
    Distance,
}

impl DesignParameter {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::FNumber,
        Self::Angle,
        Self::LineThickness,
        Self::Wavelength,
        Self::Linewidth,
        Self::SourceHalfAngle,
        Self::Power,
        Self::Exposure,
        Self::PixelPitch,
        Self::FocalLength,
        Self::Distance,
    ];

    /// Returns the name, as set-up files have it.
    pub const fn name(self) -> &'static str {
        let [_, key] = self.quantity().path();
        key
    }

    /// Returns the value in a set-up, in SI units.
    pub fn value_in(self, description: &SetupDescription) -> f64 {
        self.quantity().value_in(description)
    }

    /// Returns the set-up with another value, in SI units, whether or not it is possible then. An exposure
    /// that is set is no longer chosen by the light.
    #[must_use]
    pub fn set(self, description: &SetupDescription, value: f64) -> SetupDescription {
        let mut description = description.clone();
        self.quantity().set(&mut description, value);
        description
    }

    /// Returns its kind of quantity.
    pub(crate) const fn dimension(self) -> &'static Dimension {
        self.quantity().dimension()
    }

    /// Returns the symbol of the unit that it is usually written in.
    pub(crate) const fn unit(self) -> &'static str {
        self.quantity().unit()
    }

    const fn quantity(self) -> SetupQuantity {
        match self {
            Self::FNumber => SetupQuantity::FNumber,
            Self::Angle => SetupQuantity::Angle,
            Self::LineThickness => SetupQuantity::LineThickness,
            Self::Wavelength => SetupQuantity::Wavelength,
            Self::Linewidth => SetupQuantity::Linewidth,
            Self::SourceHalfAngle => SetupQuantity::SourceHalfAngle,
            Self::Power => SetupQuantity::Power,
            Self::Exposure => SetupQuantity::Exposure,
            Self::PixelPitch => SetupQuantity::PixelPitch,
            Self::FocalLength => SetupQuantity::FocalLength,
            Self::Distance => SetupQuantity::Distance,
        }
    }
}

impl fmt::Display for DesignParameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
