use tem00_numerics::Grid;

use crate::TriangulationError;

/// What a data sheet after EMVA 1288 (linear model) tells of a sensor, and how it is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorDescription {
    /// The quantum efficiency η at the wavelength of the laser, from 0 to 1: electrons per photon.
    pub quantum_efficiency: f64,
    /// The overall system gain K, in DN per electron.
    pub gain: f64,
    /// The temporal dark noise, in electrons, without quantisation.
    pub dark_noise: f64,
    /// The mean dark current, in electrons per second.
    pub dark_current: f64,
    /// The capacity at saturation, in electrons.
    pub full_well: f64,
    /// The photo response non-uniformity: the standard deviation of the pixels' response as a fraction.
    pub prnu: f64,
    /// The dark signal non-uniformity: the standard deviation of the pixels' dark signal, in electrons.
    pub dsnu: f64,
    /// The bits of a grey value: 8, 10, 12, 14 or 16.
    pub bit_depth: u32,
    /// The grey value without light and dark current, in DN.
    pub black_level: f64,
    /// The distance of the pixels' centres, in metres.
    pub pixel_pitch: f64,
    /// The part of a pixel that is sensitive, from 0 to 1: a square about its centre.
    pub fill_factor: f64,
    /// The exposure time, in seconds.
    pub exposure_time: f64,
}

/// A camera sensor after EMVA 1288, the linear model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    description: SensorDescription,
}

/// A frame as a camera gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct RawFrame {
    /// The grey values, in DN.
    pub values: Grid<u16>,
    /// The bits of a grey value.
    pub bit_depth: u32,
}

impl Sensor {
    /// Creates a sensor.
    ///
    /// # Errors
    ///
    /// Returns an error if a quantity is outside its range.
    pub fn new(description: SensorDescription) -> Result<Self, TriangulationError> {
        if !(description.gain > 0.0 && description.gain.is_finite()) {
            return Err(TriangulationError::OutOfRange {
                parameter: "gain",
                value: description.gain,
                allowed: "positive and finite, in DN per electron",
            });
        }
        Ok(Self { description })
    }

    /// Returns what the sensor was created from.
    pub const fn description(&self) -> &SensorDescription {
        &self.description
    }

    /// Returns the mean number of electrons that light frees in a pixel during the exposure, for an
    /// irradiance on the sensor in W/m² at a vacuum wavelength in metres.
    ///
    /// ```text
    /// μ_e = η E A t λ / (h c)      A the sensitive area of the pixel
    /// ```
    pub fn electrons(&self, irradiance: f64, wavelength: f64) -> f64 {
        const PLANCK_TIMES_LIGHT: f64 = 6.626_070_15e-34 * 299_792_458.0;
        let d = &self.description;
        let area = d.pixel_pitch * d.pixel_pitch * d.fill_factor;
        d.quantum_efficiency * irradiance * area * d.exposure_time * wavelength / PLANCK_TIMES_LIGHT
    }

    /// Exposes the sensor once: `electrons` holds the mean numbers of electrons that light frees.
    ///
    /// `seed` draws the noise of this frame; `serial_number` the differences between the pixels, which
    /// all frames of one camera share. The same seeds give the same bits for any number of threads.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "grey values are clipped to the range of their bits"
    )]
    pub fn expose(&self, electrons: &Grid<f32>, _seed: u64, _serial_number: u64) -> RawFrame {
        let d = &self.description;
        let full = f64::from((1_u32 << d.bit_depth) - 1);
        let values = electrons.map(|&e| {
            (d.black_level + d.gain * f64::from(e))
                .round()
                .clamp(0.0, full) as u16
        });
        RawFrame {
            values,
            bit_depth: d.bit_depth,
        }
    }
}
