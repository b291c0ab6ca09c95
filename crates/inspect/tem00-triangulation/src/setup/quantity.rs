use core::fmt;

use tem00_config::{ANGLE, DURATION, Dimension, LENGTH, NUMBER, POWER};

use super::SetupDescription;

/// Physical quantity of a set-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SetupQuantity {
    /// The vacuum wavelength of the laser, in metres.
    Wavelength,
    /// The linewidth of the laser, in metres.
    Linewidth,
    /// The half-angle of the source as the part sees it, in radians.
    SourceHalfAngle,
    /// The power in the line, in watts.
    Power,
    /// The full 1/e² thickness of the line on the part, in metres.
    LineThickness,
    /// The length of the line on the part, in metres.
    LineLength,
    /// The distance of the laser plane from the optical axis on the reference plane, in metres.
    LaserOffset,
    /// The angle of the laser plane from the upright, in radians.
    LaserTilt,
    /// The focal length of the lens, in metres.
    FocalLength,
    /// The f-number of the lens.
    FNumber,
    /// The distance of the pixels' centres, in metres.
    PixelPitch,
    /// The distance from the entrance pupil to the line, in metres.
    Distance,
    /// The angle between optical axis and the upright, in radians.
    Angle,
    /// The row of the image that the optical axis meets, in pixels.
    PrincipalRow,
    /// The electrons per photon.
    QuantumEfficiency,
    /// The exposure time, in seconds.
    Exposure,
    /// The electrons at saturation.
    FullWell,
    /// The grey value without light.
    BlackLevel,
    /// The grey values per electron.
    Gain,
    /// The temporal noise without light, in electrons.
    DarkNoise,
    /// The dark current, in electrons per second.
    DarkCurrent,
    /// The standard deviation of the pixels' responses.
    Prnu,
    /// The standard deviation of the pixels' dark signals, in electrons.
    Dsnu,
    /// The part of the pixel over which it integrates.
    FillFactor,
    /// The reflectance of the surface.
    Reflectance,
    /// The degree of polarisation of the scattered light.
    Polarisation,
    /// The standard deviation of the relief's heights, in metres.
    RmsHeight,
    /// The correlation length of the relief, in metres.
    CorrelationLength,
    /// The change of temperature since the calibration, in kelvins.
    TemperatureChange,
    /// The linear expansion of the base of camera and laser, per kelvin.
    BaseExpansion,
    /// The linear expansion of the mount of lens and sensor, per kelvin.
    MountExpansion,
}

impl SetupQuantity {
    /// All of them, in the order of a set-up file.
    pub const ALL: [Self; 31] = [
        Self::Wavelength,
        Self::Linewidth,
        Self::SourceHalfAngle,
        Self::Power,
        Self::LineThickness,
        Self::LineLength,
        Self::LaserOffset,
        Self::LaserTilt,
        Self::FocalLength,
        Self::FNumber,
        Self::PixelPitch,
        Self::Distance,
        Self::Angle,
        Self::PrincipalRow,
        Self::QuantumEfficiency,
        Self::Exposure,
        Self::FullWell,
        Self::BlackLevel,
        Self::Gain,
        Self::DarkNoise,
        Self::DarkCurrent,
        Self::Prnu,
        Self::Dsnu,
        Self::FillFactor,
        Self::Reflectance,
        Self::Polarisation,
        Self::RmsHeight,
        Self::CorrelationLength,
        Self::TemperatureChange,
        Self::BaseExpansion,
        Self::MountExpansion,
    ];

    /// Returns the section of a set-up file and the key in it.
    pub const fn path(self) -> [&'static str; 2] {
        match self {
            Self::Wavelength => ["laser", "wavelength"],
            Self::Linewidth => ["laser", "linewidth"],
            Self::SourceHalfAngle => ["laser", "source_half_angle"],
            Self::Power => ["laser", "power"],
            Self::LineThickness => ["laser", "line_thickness"],
            Self::LineLength => ["laser", "line_length"],
            Self::LaserOffset => ["laser", "offset"],
            Self::LaserTilt => ["laser", "tilt"],
            Self::FocalLength => ["camera", "focal_length"],
            Self::FNumber => ["camera", "f_number"],
            Self::PixelPitch => ["camera", "pixel_pitch"],
            Self::Distance => ["camera", "distance"],
            Self::Angle => ["camera", "angle"],
            Self::PrincipalRow => ["camera", "principal_row"],
            Self::QuantumEfficiency => ["sensor", "quantum_efficiency"],
            Self::Exposure => ["sensor", "exposure"],
            Self::FullWell => ["sensor", "full_well"],
            Self::BlackLevel => ["sensor", "black_level"],
            Self::Gain => ["sensor", "gain"],
            Self::DarkNoise => ["sensor", "dark_noise"],
            Self::DarkCurrent => ["sensor", "dark_current"],
            Self::Prnu => ["sensor", "prnu"],
            Self::Dsnu => ["sensor", "dsnu"],
            Self::FillFactor => ["sensor", "fill_factor"],
            Self::Reflectance => ["surface", "reflectance"],
            Self::Polarisation => ["surface", "polarisation"],
            Self::RmsHeight => ["surface", "rms_height"],
            Self::CorrelationLength => ["surface", "correlation_length"],
            Self::TemperatureChange => ["environment", "temperature_change"],
            Self::BaseExpansion => ["environment", "base_expansion"],
            Self::MountExpansion => ["environment", "mount_expansion"],
        }
    }

    /// Returns the value in a set-up, in SI units.
    pub fn value_in(self, description: &SetupDescription) -> f64 {
        let mut description = description.clone();
        *self.field(&mut description)
    }

    /// Changes the value in a set-up, in SI units, whether or not it is possible then. An exposure that is
    /// set is no longer chosen by the light.
    pub fn set(self, description: &mut SetupDescription, value: f64) {
        description.auto_exposure &= self != Self::Exposure;
        *self.field(description) = value;
    }

    /// Returns the symbol of the unit that it is usually written in.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Angle | Self::LaserTilt => "deg",
            Self::SourceHalfAngle => "mrad",
            Self::Power => "mW",
            Self::Exposure => "ms",
            Self::Wavelength | Self::Linewidth | Self::RmsHeight => "nm",
            Self::PixelPitch | Self::CorrelationLength => "um",
            Self::LineThickness
            | Self::LineLength
            | Self::LaserOffset
            | Self::FocalLength
            | Self::Distance => "mm",
            Self::TemperatureChange => "K",
            Self::BaseExpansion | Self::MountExpansion => "1/K",
            _ => "",
        }
    }

    /// Returns its kind of quantity.
    pub(crate) const fn dimension(self) -> &'static Dimension {
        match self.unit().as_bytes() {
            b"deg" | b"mrad" => &ANGLE,
            b"mW" => &POWER,
            b"ms" => &DURATION,
            b"" | b"K" | b"1/K" => &NUMBER,
            _ => &LENGTH,
        }
    }

    fn field(self, description: &mut SetupDescription) -> &mut f64 {
        let (laser, camera) = (&mut description.laser, &mut description.camera);
        let (sensor, surface) = (&mut description.sensor, &mut description.surface);
        let environment = &mut description.environment;
        match self {
            Self::Wavelength => &mut laser.light.wavelength,
            Self::Linewidth => &mut laser.light.linewidth,
            Self::SourceHalfAngle => &mut laser.light.source_half_angle,
            Self::Power => &mut laser.power,
            Self::LineThickness => &mut laser.line_thickness,
            Self::LineLength => &mut laser.line_length,
            Self::LaserOffset => &mut laser.offset,
            Self::LaserTilt => &mut laser.tilt,
            Self::FocalLength => &mut camera.focal_length,
            Self::FNumber => &mut camera.f_number,
            Self::PixelPitch => &mut sensor.pixel_pitch,
            Self::Distance => &mut camera.distance,
            Self::Angle => &mut camera.angle,
            Self::PrincipalRow => {
                let middle = 0.5 * camera.resolution[1] as f64;
                camera.principal_row.get_or_insert(middle)
            }
            Self::QuantumEfficiency => &mut sensor.quantum_efficiency,
            Self::Exposure => &mut sensor.exposure_time,
            Self::FullWell => &mut sensor.full_well,
            Self::BlackLevel => &mut sensor.black_level,
            Self::Gain => &mut sensor.gain,
            Self::DarkNoise => &mut sensor.dark_noise,
            Self::DarkCurrent => &mut sensor.dark_current,
            Self::Prnu => &mut sensor.prnu,
            Self::Dsnu => &mut sensor.dsnu,
            Self::FillFactor => &mut sensor.fill_factor,
            Self::Reflectance => &mut surface.reflectance,
            Self::Polarisation => &mut surface.polarisation,
            Self::RmsHeight => &mut surface.relief.rms_height,
            Self::CorrelationLength => &mut surface.relief.correlation_length,
            Self::TemperatureChange => &mut environment.temperature_change,
            Self::BaseExpansion => &mut environment.base_expansion,
            Self::MountExpansion => &mut environment.mount_expansion,
        }
    }
}

impl fmt::Display for SetupQuantity {
    /// Writes the path of the key, as in `camera.angle`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [section, key] = self.path();
        write!(f, "{section}.{key}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SetupEnvironment, setup::tests::description};

    #[test]
    fn setting_a_quantity_changes_its_key_in_the_text_alone() {
        let mut base = description();
        // Numbers that are written, none as it is by default.
        base.laser.light.linewidth = 1e-9;
        SetupQuantity::SourceHalfAngle.set(&mut base, 2e-3);
        (base.laser.offset, base.laser.tilt) = (1e-3, 0.1);
        base.camera.principal_row = Some(230.0);
        (base.sensor.black_level, base.sensor.gain) = (17.0, 0.3);
        base.sensor.fill_factor = 0.7;
        base.surface.polarisation = 0.6;
        (
            base.surface.relief.rms_height,
            base.surface.relief.correlation_length,
        ) = (1e-6, 2e-6);
        base.environment = SetupEnvironment {
            temperature_change: 4.0,
            base_expansion: 2e-5,
            mount_expansion: 1e-5,
        };
        let before = base.to_toml();
        for quantity in SetupQuantity::ALL {
            let mut changed = base.clone();
            quantity.set(&mut changed, 1.25 * quantity.value_in(&base));
            let after = changed.to_toml();
            let lines = after
                .lines()
                .filter(|line| !before.lines().any(|old| old == *line));
            let lines: Vec<&str> = lines.collect();
            let [_, key] = quantity.path();
            let is_key = lines.len() == 1 && lines[0].starts_with(&format!("{key} = "));
            assert!(is_key, "{quantity}: {lines:?}");
        }
    }
}
