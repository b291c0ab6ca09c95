use tem00_config::DURATION;
use tem00_numerics::check;
use tem00_statistics::rectangular_pixel_contrast;

use super::{ImagedLine, Setup};
use crate::{TriangulationError, named::named};

named! {
    /// Verdict on the amount of light that the sensor gets.
    #[non_exhaustive]
    LightLevel {
        /// The line hardly stands out of the dark noise, or is below the minimum peak of the
        /// detector.
        Dark = "too dark",
        /// Neither too dark nor saturated.
        Good = "good",
        /// The mean of the brightest pixels fits, single bright grains of speckle do not.
        SaturatedGrains = "bright grains saturate",
        /// The mean of the brightest pixels exceeds what the sensor can hold or represent.
        Saturated = "saturated",
    }
}

impl LightLevel {
    /// Returns an explanation and a change that helps.
    pub const fn advice(self) -> &'static str {
        match self {
            Self::Dark => {
                "the line hardly stands out of the noise: raise the exposure, the power or the \
                 pupil (smaller f-number), or lower `min_peak` in [detector]"
            }
            Self::Good => "the line uses the range of the sensor without leaving it",
            Self::SaturatedGrains => {
                "pixels of bright grains are cut off, and their columns do not count as valid: \
                 lower the exposure or the power by as much as the brightest grains exceed the \
                 range, or set `exposure = \"auto\"` in [sensor]"
            }
            Self::Saturated => {
                "the crest of the line is cut off and its position is wrong: lower the exposure or \
                 the power, raise the f-number, or set `exposure = \"auto\"` in [sensor]"
            }
        }
    }
}

/// The minimum signal of a line over its noise in the dark.
pub(crate) const MIN_SIGNAL: f64 = 10.0;
/// The fraction of what the sensor can hold that bright grains may fill.
pub(crate) const MAX_GRAIN_SATURATION: f64 = 1.0;
/// Height of bright grains above the mean, in standard deviations of speckle: of fully developed
/// speckle in small pixels 2 % are brighter.
const BRIGHT_GRAINS: f64 = 3.0;
/// The fraction of what the sensor can hold that bright grains fill with an exposure that is chosen
/// automatically: it leaves room for shot noise and for the different response of the pixels.
const CHOSEN_GRAIN_SATURATION: f64 = 0.9;

impl Setup {
    /// Returns the verdict on the light that the sensor gets.
    ///
    /// A line is too dark if its [signal](Self::signal) is below 10, or its peak below the
    /// detector's minimum. Bright grains saturate if they fill [more](Self::grain_saturation) than
    /// the sensor can hold.
    pub fn light_level(&self) -> LightLevel {
        self.light_level_of(self.line())
    }

    /// Returns the level of the light of an image of the line.
    pub(crate) fn light_level_of(&self, line: &ImagedLine) -> LightLevel {
        let signal = line.peak_electrons();
        let grey_values = self.description().sensor.gain * signal;
        if self.saturation_of(signal + self.sensor().dark_electrons()) >= 1.0 {
            LightLevel::Saturated
        } else if self.signal_of(line) < MIN_SIGNAL
            || grey_values < self.description().detector.min_peak
        {
            LightLevel::Dark
        } else if self.grain_saturation_of(line) > MAX_GRAIN_SATURATION {
            LightLevel::SaturatedGrains
        } else {
            LightLevel::Good
        }
    }

    /// Returns the contrast of the speckle in the pixels, which average over it.
    ///
    /// With a linewidth it is exact for pixels small against a speckle; larger pixels have somewhat
    /// more.
    pub fn contrast(&self) -> f64 {
        self.contrast_of(self.line())
    }

    fn contrast_of(&self, line: &ImagedLine) -> f64 {
        let side = |size: f64| line.sensitive_height / size;
        let pixel = rectangular_pixel_contrast(line.speckle_size.map(side));
        self.description().surface.contrast() * line.bandwidth.contrast * pixel
    }

    /// Returns the mean number of electrons in the brightest pixel, by light and dark current, for
    /// a line in the middle of a pixel.
    pub fn peak_electrons(&self) -> f64 {
        self.line().peak_electrons() + self.sensor().dark_electrons()
    }

    /// Returns the mean of the brightest pixel as a fraction of what the sensor can hold or
    /// represent, whichever is less: the full well, or the range of its grey values.
    ///
    /// Speckle makes single pixels brighter than the mean: several times, where pixels are small
    /// compared with a speckle. See [`grain_saturation`](Self::grain_saturation).
    pub fn saturation(&self) -> f64 {
        self.saturation_of(self.peak_electrons())
    }

    /// Returns the bright grains of speckle as a fraction of what the sensor can hold or represent:
    /// the brightest pixel at three standard deviations of speckle above its mean.
    pub fn grain_saturation(&self) -> f64 {
        self.grain_saturation_of(self.line())
    }

    fn grain_saturation_of(&self, line: &ImagedLine) -> f64 {
        let grains = line.peak_electrons() * (1.0 + BRIGHT_GRAINS * self.contrast_of(line));
        self.saturation_of(self.sensor().dark_electrons() + grains)
    }

    /// Returns the exposure time, in seconds, with which bright grains fill 0.9 of what the sensor
    /// can hold or represent, rounded down to two digits.
    ///
    /// Light and dark current grow with the time, the black level does not.
    ///
    /// # Errors
    ///
    /// Returns an error if the black level is above 0.9 of the largest grey value.
    pub(super) fn grain_exposure(&self) -> Result<f64, TriangulationError> {
        let sensor = &self.description().sensor;
        let grains = self.line().peak_electrons() * (1.0 + BRIGHT_GRAINS * self.contrast());
        let rate = (grains + self.sensor().dark_electrons()) / sensor.exposure_time;
        let full = sensor.largest_value();
        let (level, holds) = (
            sensor.black_level,
            sensor.black_level < CHOSEN_GRAIN_SATURATION * full,
        );
        let allowed = "below 0.9 of the largest grey value, for an exposure that is \"auto\"";
        check::that(holds, "black_level", level, "", allowed)?;
        let digital = (CHOSEN_GRAIN_SATURATION * full - sensor.black_level) / sensor.gain;
        let longest = digital.min(CHOSEN_GRAIN_SATURATION * sensor.full_well) / rate;
        let step = libm::exp10(libm::floor(libm::log10(longest)) - 1.0);
        Ok(DURATION.rounded((longest / step).floor() * step, step, "ms"))
    }

    /// Returns the mean light in the brightest pixel in units of the standard deviation of a pixel
    /// in the dark: by dark noise, dark current and DSNU.
    pub fn signal(&self) -> f64 {
        self.signal_of(self.line())
    }

    fn signal_of(&self, line: &ImagedLine) -> f64 {
        let d = &self.description().sensor;
        let dark = self.sensor().dark_electrons();
        let noise = (d.dark_noise.powi(2) + dark + d.dsnu.powi(2)).sqrt();
        line.peak_electrons() / noise
    }

    /// Returns a number of electrons as a fraction of what the sensor can hold or represent.
    fn saturation_of(&self, electrons: f64) -> f64 {
        let sensor = &self.description().sensor;
        let grey = (sensor.black_level + sensor.gain * electrons) / sensor.largest_value();
        grey.max(electrons / sensor.full_well)
    }
}
