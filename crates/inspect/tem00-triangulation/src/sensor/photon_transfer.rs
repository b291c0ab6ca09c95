use tem00_numerics::{Grid, cast::to_f32};

use super::{RawFrame, Sensor};
use crate::TriangulationError;

impl Sensor {
    /// Exposes the sensor to light that is the same in all pixels and frees `electrons` of them on
    /// average: a frame of a photon transfer series. With 0 it is a dark frame.
    ///
    /// # Errors
    ///
    /// Returns an error if the number of electrons is negative or NaN, or if a side is zero.
    pub fn uniform_frame(
        &self,
        [width, height]: [usize; 2],
        electrons: f64,
        seed: u64,
    ) -> Result<RawFrame, TriangulationError> {
        if width == 0 || height == 0 {
            return Err(TriangulationError::TooFew {
                what: "pixels along each side",
                got: 0,
                needed: 1,
            });
        }
        self.expose(&Grid::filled(width, height, to_f32(electrons)), seed)
    }
}

/// A point of the photon transfer curve: what two frames under the same light show about a sensor.
///
/// Above the dark frames, the ratio of the variance to the mean grey value is the gain K.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonTransferPoint {
    /// The mean grey value, in DN.
    pub mean: f64,
    /// The temporal variance of the grey values, in DN².
    pub variance: f64,
}

impl PhotonTransferPoint {
    /// Measures two frames A and B. Differences between the pixels that both frames share cancel.
    ///
    /// ```text
    /// μ_y  = (⟨A⟩ + ⟨B⟩) / 2
    /// σ_y² = ⟨(A − B)²⟩ / 2 − (⟨A⟩ − ⟨B⟩)² / 2
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if the frames have less than two pixels or not the same size.
    pub fn of_pair(a: &RawFrame, b: &RawFrame) -> Result<Self, TriangulationError> {
        let of = |frame: &RawFrame| frame.values.width() * frame.values.height();
        let same = a.values.width() == b.values.width() && of(a) == of(b);
        if !same || of(a) < 2 {
            return Err(TriangulationError::TooFew {
                what: "pixels that both frames have",
                got: if same { of(a) } else { 0 },
                needed: 2,
            });
        }
        let pairs = a.values.values().iter().zip(b.values.values());
        // Whole numbers: the sums are exact in any order.
        let (mut sum, mut difference, mut squares) = (0_u64, 0_i64, 0_u64);
        for (&a, &b) in pairs {
            let apart = i64::from(a) - i64::from(b);
            sum += u64::from(a) + u64::from(b);
            difference += apart;
            squares += apart.unsigned_abs() * apart.unsigned_abs();
        }
        let n = of(a) as f64;
        let apart = difference as f64 / n;
        Ok(Self {
            mean: 0.5 * sum as f64 / n,
            variance: 0.5 * (squares as f64 / n - apart * apart),
        })
    }
}
