use num_complex::Complex;
use tem00_numerics::{cast::to_c64, cast::to_f32};

use crate::{SpeckleError, SpeckleField, SpecklePattern};

/// A uniform wave that interferes with the speckle: partially developed speckle.
///
/// ```text
/// I = |U + √r e^{iφ}|² / (1 + r)
/// C = √(1 + 2r) / (1 + r)
/// ```
///
/// r is the beam ratio, the intensity of the background over the mean of the speckle. It is the
/// specular reflection of a surface that is not quite rough, or the reference wave of a hologram and
/// of speckle interferometry; the amplitude then has Rice's law. The expected mean is 1; that of one
/// tile fluctuates by `√(2r/N) / (1 + r)` for N phasors in the pupil.
///
/// # Validity
///
/// A background of one amplitude and phase over the pattern, of the polarisation of the speckle.
/// Light that does not interfere is an [`IncoherentSum`](crate::IncoherentSum) or, if uniform, a
/// constant.
///
/// # Examples
///
/// A surface that reflects half of its light like a mirror:
///
/// ```
/// use tem00_speckle::{CoherentBackground, PupilField};
///
/// let background = CoherentBackground::new(1.0, 0.0)?;
/// assert!((background.contrast() - 0.866).abs() < 1e-3);
///
/// let field = PupilField::new(256, 128, 3)?;
/// let pattern = background.pattern(&field.field());
/// let values = pattern.values().values().iter().map(|&i| f64::from(i));
/// let square = values.map(|i| (i - 1.0).powi(2)).sum::<f64>() / 65_536.0;
/// assert!((square.sqrt() - 0.866).abs() < 0.02);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (a known phasor plus a random
///   phasor sum).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoherentBackground {
    beam_ratio: f64,
    phase: f64,
    /// The wave added to the amplitude.
    wave: Complex<f64>,
}

impl CoherentBackground {
    /// The largest beam ratio. The contrast it leaves, 1.4e−6, nears the rounding of `f32`.
    pub const MAX_BEAM_RATIO: f64 = 1e12;

    /// Creates the background from the beam ratio r, background over mean of the speckle, and its
    /// phase φ in radians.
    ///
    /// # Errors
    ///
    /// Returns an error unless `0 ≤ beam_ratio ≤ MAX_BEAM_RATIO` and `phase` is finite.
    pub fn new(beam_ratio: f64, phase: f64) -> Result<Self, SpeckleError> {
        if !(0.0..=Self::MAX_BEAM_RATIO).contains(&beam_ratio) {
            return Err(SpeckleError::out_of_range(
                "beam_ratio",
                beam_ratio,
                "0 to 1e12",
            ));
        }
        if !phase.is_finite() {
            return Err(SpeckleError::out_of_range(
                "phase",
                phase,
                "finite, in radians",
            ));
        }
        Ok(Self {
            beam_ratio,
            phase,
            wave: Complex::from_polar(beam_ratio.sqrt(), phase),
        })
    }

    /// Returns the beam ratio r, background over mean of the speckle.
    pub const fn beam_ratio(&self) -> f64 {
        self.beam_ratio
    }

    /// Returns the phase φ, in radians.
    pub const fn phase(&self) -> f64 {
        self.phase
    }

    /// Returns the contrast `√(1 + 2r) / (1 + r)` on fully developed speckle.
    pub fn contrast(&self) -> f64 {
        (1.0 + 2.0 * self.beam_ratio).sqrt() / (1.0 + self.beam_ratio)
    }

    /// Returns the intensity, with expected mean 1, where the speckle has the complex `amplitude`, of
    /// mean square 1.
    pub fn intensity(&self, amplitude: Complex<f32>) -> f64 {
        let amplitude = to_c64(amplitude);
        (amplitude + self.wave).norm_sqr() / (1.0 + self.beam_ratio)
    }

    /// Returns the intensity of `field` on the background.
    pub fn pattern(&self, field: &SpeckleField) -> SpecklePattern {
        let values = field.values().map(|&u| to_f32(self.intensity(u)));
        SpecklePattern::new(values, field.speckle_size())
    }
}

#[cfg(test)]
mod tests;
