use core::fmt;

use tem00_config::{ANGLE, DURATION, Dimension, LENGTH, NUMBER, POWER};

use crate::SetupDescription;

/// A number of a set-up that a search may vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DesignParameter {
    /// The f-number of the lens: the size of the pupil.
    FNumber,
    /// The angle between optical axis and laser plane, in radians.
    Angle,
    /// The full 1/e² thickness of the line on the part, in metres.
    LineThickness,
    /// The vacuum wavelength of the laser, in metres.
    Wavelength,
    /// The linewidth of the laser, in metres.
    Linewidth,
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
    pub const ALL: [Self; 10] = [
        Self::FNumber,
        Self::Angle,
        Self::LineThickness,
        Self::Wavelength,
        Self::Linewidth,
        Self::Power,
        Self::Exposure,
        Self::PixelPitch,
        Self::FocalLength,
        Self::Distance,
    ];

    /// Returns the name, as set-up files have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FNumber => "f_number",
            Self::Angle => "angle",
            Self::LineThickness => "line_thickness",
            Self::Wavelength => "wavelength",
            Self::Linewidth => "linewidth",
            Self::Power => "power",
            Self::Exposure => "exposure",
            Self::PixelPitch => "pixel_pitch",
            Self::FocalLength => "focal_length",
            Self::Distance => "distance",
        }
    }

    /// Returns the value in a set-up, in SI units.
    pub fn value_in(self, description: &SetupDescription) -> f64 {
        let mut description = description.clone();
        *self.field(&mut description)
    }

    /// Returns the set-up with another value, in SI units, whether or not it is possible then. An exposure
    /// that is set is no longer chosen by the light.
    #[must_use]
    pub fn set(self, description: &SetupDescription, value: f64) -> SetupDescription {
        let mut description = description.clone();
        description.auto_exposure &= self != Self::Exposure;
        *self.field(&mut description) = value;
        description
    }

    /// Returns its kind of quantity.
    pub(crate) const fn dimension(self) -> &'static Dimension {
        match self {
            Self::FNumber => &NUMBER,
            Self::Angle => &ANGLE,
            Self::Power => &POWER,
            Self::Exposure => &DURATION,
            Self::LineThickness
            | Self::Wavelength
            | Self::Linewidth
            | Self::PixelPitch
            | Self::FocalLength
            | Self::Distance => &LENGTH,
        }
    }

    /// Returns the symbol of the unit that it is usually written in.
    pub(crate) const fn unit(self) -> &'static str {
        match self {
            Self::FNumber => "",
            Self::Angle => "deg",
            Self::Power => "mW",
            Self::Exposure => "ms",
            Self::Wavelength | Self::Linewidth => "nm",
            Self::PixelPitch => "um",
            Self::LineThickness | Self::FocalLength | Self::Distance => "mm",
        }
    }

    const fn field(self, description: &mut SetupDescription) -> &mut f64 {
        match self {
            Self::FNumber => &mut description.camera.f_number,
            Self::Angle => &mut description.camera.angle,
            Self::LineThickness => &mut description.laser.line_thickness,
            Self::Wavelength => &mut description.laser.light.wavelength,
            Self::Linewidth => &mut description.laser.light.linewidth,
            Self::Power => &mut description.laser.power,
            Self::Exposure => &mut description.sensor.exposure_time,
            Self::PixelPitch => &mut description.sensor.pixel_pitch,
            Self::FocalLength => &mut description.camera.focal_length,
            Self::Distance => &mut description.camera.distance,
        }
    }
}

impl fmt::Display for DesignParameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
