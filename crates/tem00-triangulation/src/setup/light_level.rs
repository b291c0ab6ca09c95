use tem00_statistics::rectangular_pixel_contrast;

use super::Setup;

/// Whether the sensor gets the light that it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LightLevel {
    /// The line hardly stands out of the dark noise, or is below the least peak of the detector.
    Dark,
    /// All is well.
    Good,
    /// The mean of the brightest pixels fits, single bright grains of speckle do not.
    SaturatedGrains,
    /// The mean of the brightest pixels exceeds what the sensor can hold or tell.
    Saturated,
}

impl LightLevel {
    /// Returns what to call it in a table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dark => "too dark",
            Self::Good => "good",
            Self::SaturatedGrains => "bright grains saturate",
            Self::Saturated => "saturated",
        }
    }

    /// Returns what it means and what to change.
    pub const fn advice(self) -> &'static str {
        match self {
            Self::Dark => {
                "the line hardly stands out of the noise: raise the exposure, the power or the pupil \
                 (smaller f-number), or lower `least_peak` in [detector]"
            }
            Self::Good => "the line uses the range of the sensor without leaving it",
            Self::SaturatedGrains => {
                "pixels of bright grains are cut off, and their columns do not count as valid: lower \
                 the exposure or the power by as much as the brightest grains exceed the range"
            }
            Self::Saturated => {
                "the crest of the line is cut off and its place is wrong: lower the exposure or the \
                 power, or raise the f-number"
            }
        }
    }
}

/// By how many times its noise a line must stand out of the dark.
const LEAST_SIGNAL: f64 = 10.0;
/// How many standard deviations of speckle above the mean bright grains are: of fully developed speckle
/// in small pixels 2 % are brighter.
const BRIGHT_GRAINS: f64 = 3.0;

impl Setup {
    /// Returns whether the sensor gets the light that it needs.
    ///
    /// A line is too dark below ten times the dark noise of a pixel, or the detector's least peak. Its
    /// bright grains are those at three standard deviations of speckle above the mean.
    pub fn light_level(&self) -> LightLevel {
        let d = &self.description().sensor;
        let dark = self.sensor().dark_electrons();
        let signal = self.peak_electrons() - dark;
        let noise = (d.dark_noise.powi(2) + dark + d.dsnu.powi(2)).sqrt();
        let least = self.description().detector.least_peak;
        let grains = self.saturation_of(dark + signal * (1.0 + BRIGHT_GRAINS * self.contrast()));
        if self.saturation() >= 1.0 {
            LightLevel::Saturated
        } else if signal < LEAST_SIGNAL * noise || d.gain * signal < least {
            LightLevel::Dark
        } else if grains >= 1.0 {
            LightLevel::SaturatedGrains
        } else {
            LightLevel::Good
        }
    }

    /// Returns the contrast of the speckle in the pixels, which average over it.
    pub fn contrast(&self) -> f64 {
        let line = self.line();
        let side = |size: f64| line.sensitive_height / size;
        let pixel = rectangular_pixel_contrast(line.speckle_size.map(side));
        self.description().surface.contrast() * pixel
    }

    /// Returns a number of electrons as a part of what the sensor can hold or tell.
    pub(super) fn saturation_of(&self, electrons: f64) -> f64 {
        let sensor = &self.description().sensor;
        let full = ((1_u64 << sensor.bit_depth) - 1) as f64;
        let grey = (sensor.black_level + sensor.gain * electrons) / full;
        grey.max(electrons / sensor.full_well)
    }
}
