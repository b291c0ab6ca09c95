use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, Poisson, StandardNormal};
use tem00_numerics::{Grid, Refusal};

use super::{Sensor, SensorDescription};
use crate::TriangulationError;

/// A frame as a camera gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct RawFrame {
    /// The grey values, in DN.
    pub values: Grid<u16>,
    /// The bits of a grey value.
    pub bit_depth: u32,
    /// The saturated pixels: their well is full or their grey value the largest.
    pub saturated: Grid<bool>,
}

impl RawFrame {
    /// Returns the number of saturated pixels.
    pub fn saturated_pixels(&self) -> usize {
        self.saturated.values().iter().filter(|&&is| is).count()
    }

    /// Returns the largest grey value that the bits allow, in DN.
    pub fn largest_value(&self) -> u16 {
        let unused = 16_u32.saturating_sub(self.bit_depth);
        u16::MAX.checked_shr(unused).unwrap_or(0)
    }

    /// Returns the grey values as numbers, in DN.
    pub fn grey_values(&self) -> Grid<f32> {
        self.values.map(|&value| value.into())
    }
}

impl Sensor {
    /// Exposes the sensor once: `electrons` holds the mean numbers of electrons that light frees.
    ///
    /// In a pixel of the response `1 + PRNU · g` and the offset `DSNU · d`, both normally
    /// distributed and the same in all frames of one camera, light and dark current free a Poisson
    /// distributed number of electrons. Electrons beyond the full well are lost, and the pixel is
    /// marked as saturated. The offset and the dark noise are added, the sum is amplified, and the
    /// grey value is rounded and clipped to its bits; a pixel at the largest grey value is marked
    /// as saturated, too.
    ///
    /// `seed` draws the noise of this frame, the serial number the differences between the pixels.
    /// The same seeds give the same bits for any number of threads.
    ///
    /// # Errors
    ///
    /// Returns an error if a number of electrons is negative or NaN.
    pub fn expose(&self, electrons: &Grid<f32>, seed: u64) -> Result<RawFrame, TriangulationError> {
        if let Some(&bad) = electrons.values().iter().find(|&&e| e.is_nan() || e < 0.0) {
            let bad = f64::from(bad);
            return Err(Refusal::new("electrons", bad, "at least 0 in every pixel").into());
        }
        let (width, height) = (electrons.width(), electrons.height());
        let mut pixels = Grid::filled(width, height, (0, false));
        pixels.for_each_row_mut(|y, pixels| self.expose_row(y, electrons.row(y), seed, pixels));
        Ok(RawFrame {
            values: pixels.map(|&(value, _)| value),
            saturated: pixels.map(|&(_, saturated)| saturated),
            bit_depth: self.description().bit_depth,
        })
    }

    fn expose_row(&self, y: usize, electrons: &[f32], seed: u64, pixels: &mut [(u16, bool)]) {
        let mut noise = stream(seed, Purpose::Noise, y);
        let mut pattern = stream(self.description().serial_number, Purpose::Pattern, y);
        for (pixel, &electrons) in pixels.iter_mut().zip(electrons) {
            let [response, offset]: [f64; 2] =
                [(); 2].map(|()| StandardNormal.sample(&mut pattern));
            *pixel = self.expose_pixel(electrons.into(), [response, offset], &mut noise);
        }
    }

    /// Returns the grey value and whether the pixel is saturated.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "grey values are clipped to the range of their bits"
    )]
    fn expose_pixel(
        &self,
        electrons: f64,
        [response, offset]: [f64; 2],
        noise: &mut ChaCha8Rng,
    ) -> (u16, bool) {
        let d = self.description();
        let mean = electrons * (1.0 + d.prnu * response) + self.dark_electrons();
        let charge = counted(d, mean, noise);
        let read: f64 = StandardNormal.sample(noise);
        let signal = charge + d.dsnu * offset + d.dark_noise * read;
        let value = (d.black_level + d.gain * signal).round();
        let largest = d.largest_value();
        (
            value.clamp(0.0, largest) as u16,
            charge >= d.full_well || value >= largest,
        )
    }
}

/// Returns a Poisson distributed number of electrons, or the full well if that is less.
fn counted(description: &SensorDescription, mean: f64, noise: &mut ChaCha8Rng) -> f64 {
    let full = description.full_well;
    // With twice the full well and 1000 electrons more on average a well that is not full has a
    // probability below e⁻³⁰⁰.
    if mean > 2.0 * full + 1e3 {
        return full;
    }
    // The Poisson distribution needs a positive mean; without light there are no electrons.
    let count = Poisson::new(mean).map_or(0.0, |poisson| poisson.sample(noise));
    count.min(full)
}

/// Purpose of random numbers: no two purposes share a stream.
#[derive(Clone, Copy)]
enum Purpose {
    Noise,
    Pattern,
}

fn stream(seed: u64, purpose: Purpose, row: usize) -> ChaCha8Rng {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(2 * row as u64 + purpose as u64);
    generator
}
