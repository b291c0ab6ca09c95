use tem00_numerics::check;

use crate::{SetupDescription, SetupQuantity, TriangulationError, setup::within};

/// Data sheet of a sensor after EMVA 1288 (linear model), and the settings that it is used with.
///
/// [`typical`](Self::typical) fills in values that a data sheet leaves open.
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorDescription {
    /// The quantum efficiency η at the wavelength of the laser, above 0 and at most 1: electrons
    /// per photon that falls on the whole area of a pixel, as EMVA 1288 measures it. Fill factor
    /// and microlenses are in it.
    pub quantum_efficiency: f64,
    /// The overall system gain K, in DN per electron.
    pub gain: f64,
    /// The temporal dark noise, in electrons, without quantisation and dark current.
    pub dark_noise: f64,
    /// The mean dark current, in electrons per second.
    pub dark_current: f64,
    /// The capacity at saturation, in electrons.
    pub full_well: f64,
    /// The photo response non-uniformity: the standard deviation of the pixels' response as a
    /// fraction.
    pub prnu: f64,
    /// The dark signal non-uniformity: the standard deviation of the pixels' dark signal, in
    /// electrons.
    pub dsnu: f64,
    /// The bits of a grey value: 8, 10, 12, 14 or 16.
    pub bit_depth: u32,
    /// The grey value without light and dark current, in DN.
    pub black_level: f64,
    /// The distance of the pixels' centres, in metres.
    pub pixel_pitch: f64,
    /// The fraction of a pixel that is sensitive, above 0 and at most 1: a square about its centre.
    /// It determines over which part of the image a pixel integrates, not how much light it takes;
    /// behind microlenses it is 1.
    pub fill_factor: f64,
    /// The exposure time, in seconds.
    pub exposure_time: f64,
    /// The number of the camera in its series: it draws the differences between the pixels.
    pub serial_number: u64,
}

impl SensorDescription {
    /// Returns an industrial CMOS sensor with global shutter, as data sheets have them around 2020
    /// for pixels of 3.45 µm: 10 500 electrons full well, 2.3 electrons dark noise, 0.5 % PRNU, 1
    /// electron DSNU, 3 electrons/s dark current at room temperature, quantum efficiency ½ in the
    /// red, 1 ms.
    ///
    /// The black level is 1/64 of the range of `bit_depth` bits, and the gain is such that a full
    /// well is the largest grey value. A bit depth that no sensor has is rejected by
    /// [`Sensor::new`](crate::Sensor::new), not here.
    pub fn typical(bit_depth: u32) -> Self {
        let (black_level, full_well) = (f64::from(bit_depth).exp2() / 64.0, 10_500.0);
        let typical = Self {
            quantum_efficiency: 0.5,
            gain: 0.0,
            dark_noise: 2.3,
            dark_current: 3.0,
            full_well,
            prnu: 0.005,
            dsnu: 1.0,
            bit_depth,
            black_level,
            pixel_pitch: 3.45e-6,
            fill_factor: 1.0,
            exposure_time: 1e-3,
            serial_number: 0,
        };
        Self {
            gain: typical.filling_gain(),
            ..typical
        }
    }

    /// Returns the gain, in DN per electron, with which a full well is the largest grey value.
    pub(crate) fn filling_gain(&self) -> f64 {
        (self.largest_value() - self.black_level) / self.full_well
    }

    /// Returns the largest grey value, `2^bits − 1`, in DN.
    pub fn largest_value(&self) -> f64 {
        f64::from(self.bit_depth).exp2() - 1.0
    }

    /// Returns the first quantity that is outside its range as an error.
    pub(super) fn check(&self) -> Result<(), TriangulationError> {
        let (bits, holds) = (
            f64::from(self.bit_depth),
            matches!(self.bit_depth, 8 | 10 | 12 | 14 | 16),
        );
        check::that(holds, "bit_depth", bits, "", "8, 10, 12, 14 or 16")?;
        let setup = SetupDescription {
            sensor: *self,
            ..SetupDescription::default()
        };
        SetupQuantity::of_section("sensor").try_for_each(|quantity| quantity.check(&setup))?;
        let allowed = "above 0 and at most 1, in metres";
        within(
            "pixel_pitch",
            self.pixel_pitch,
            (f64::MIN_POSITIVE, 1.0),
            allowed,
        )
    }
}

impl Default for SensorDescription {
    /// The typical sensor with 12 bits.
    fn default() -> Self {
        Self::typical(12)
    }
}
