mod description;
mod exposure;
mod photon_transfer;
mod response;
#[cfg(test)]
mod tests;

use crate::TriangulationError;

pub use description::SensorDescription;
pub use exposure::RawFrame;
pub use photon_transfer::PhotonTransferPoint;

/// A camera sensor after EMVA 1288, the linear model.
///
/// ```text
/// μ_p = E A t λ / (h c)                  photons on a pixel of the area A during the exposure t
/// μ_e = η μ_p                            electrons that light frees
/// μ_y = y₀ + K (μ_e + μ_I t)             grey value, with the dark current μ_I
/// σ_y² = K² (σ_d² + μ_e + μ_I t) + 1/12  its variance over time: dark, shot and quantisation noise
/// ```
///
/// # Validity
///
/// The response is linear up to the full well. The grey values' rounding counts as noise of the
/// variance 1/12 DN², which holds from a noise of about 0.3 DN on.
///
/// # References
///
/// - European Machine Vision Association, *EMVA Standard 1288, Release 4.0 Linear*, 2021: the
///   camera model and the definitions of signal, noise, saturation and dynamic range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    description: SensorDescription,
}

impl Sensor {
    /// Creates a sensor.
    ///
    /// # Errors
    ///
    /// Returns an error if a quantity is outside its range.
    pub fn new(description: SensorDescription) -> Result<Self, TriangulationError> {
        description.check()?;
        Ok(Self { description })
    }

    /// Returns the description that the sensor was created from.
    pub const fn description(&self) -> &SensorDescription {
        &self.description
    }

    /// Returns another camera of the same series: its pixels differ in another way.
    #[must_use]
    pub const fn with_serial_number(mut self, serial_number: u64) -> Self {
        self.description.serial_number = serial_number;
        self
    }

    /// Returns half the side of the sensitive part of a pixel, in units of the pixel pitch:
    /// `√f / 2` for the fill factor `f`.
    ///
    /// A renderer integrates over what a pixel sees with a box filter of this radius about the
    /// pixel's centre; its mean irradiance there is what [`electrons`](Self::electrons) takes.
    pub fn sensitive_half_width(&self) -> f64 {
        0.5 * self.description.fill_factor.sqrt()
    }

    /// Returns the mean number of photons that fall on a pixel during the exposure, for an
    /// irradiance on the sensor in W/m² at a vacuum wavelength in metres.
    ///
    /// ```text
    /// μ_p = E A t λ / (h c)      A the whole area of the pixel
    /// ```
    pub fn photons(&self, irradiance: f64, wavelength: f64) -> f64 {
        let d = &self.description;
        let energy = irradiance * d.pixel_pitch * d.pixel_pitch * d.exposure_time;
        energy * wavelength / PLANCK_TIMES_LIGHT
    }

    /// Returns the mean number of electrons that light frees in a pixel during the exposure, for an
    /// irradiance on the sensor in W/m² at a vacuum wavelength in metres: `μ_e = η μ_p`.
    pub fn electrons(&self, irradiance: f64, wavelength: f64) -> f64 {
        self.description.quantum_efficiency * self.photons(irradiance, wavelength)
    }

    /// Returns the mean number of electrons of the dark current in a pixel during the exposure.
    pub fn dark_electrons(&self) -> f64 {
        self.description.dark_current * self.description.exposure_time
    }
}

/// Planck's constant times the speed of light in vacuum, in J m: both are exact in the SI
/// since 2019.
const PLANCK_TIMES_LIGHT: f64 = 6.626_070_15e-34 * 299_792_458.0;
