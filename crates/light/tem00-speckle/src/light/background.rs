use num_complex::Complex;
use tem00_numerics::{cast::to_c64, cast::to_f32};

use crate::{SpeckleError, SpeckleField, SpecklePattern};

/// The largest beam ratio. The contrast it leaves, 1.4e−6, nears the rounding of `f32`.
const MAX_BEAM_RATIO: f64 = 1e12;

impl SpeckleField {
    /// Returns the intensity on a uniform wave that interferes: partially developed speckle.
    ///
    /// ```text
    /// I = |U + √r e^{iφ}|² / (1 + r)
    /// ```
    ///
    /// `beam_ratio` is r, the intensity of the background over the mean of the speckle, and `phase` φ in
    /// radians. The wave is the specular reflection of a surface that is not quite rough, or the reference of a
    /// hologram and of speckle interferometry. The expected mean is 1; that of one tile fluctuates by
    /// `√(2r/N) / (1 + r)` for N phasors in the pupil. Contrast and law are those of
    /// `tem00_statistics::CoherentBackground`.
    ///
    /// # Validity
    ///
    /// A background of one amplitude and phase over the pattern, of the polarisation of the speckle. Light that
    /// does not interfere adds [by intensities](SpecklePattern::weighted_mean).
    ///
    /// # Errors
    ///
    /// Returns an error unless `0 ≤ beam_ratio ≤ 1e12` and `phase` is finite.
    ///
    /// # Examples
    ///
    /// A surface that reflects half of its light like a mirror:
    ///
    /// ```
    /// use tem00_speckle::PupilField;
    ///
    /// let field = PupilField::new(256, 128, 3)?.field();
    /// let pattern = field.on_background(1.0, 0.0)?;
    /// let values = pattern.values().values().iter().map(|&i| f64::from(i));
    /// let square = values.map(|i| (i - 1.0).powi(2)).sum::<f64>() / 65_536.0;
    /// assert!((square.sqrt() - 0.75_f64.sqrt()).abs() < 0.02);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    ///
    /// # References
    ///
    /// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (a known phasor plus a random
    ///   phasor sum).
    pub fn on_background(
        &self,
        beam_ratio: f64,
        phase: f64,
    ) -> Result<SpecklePattern, SpeckleError> {
        if !(0.0..=MAX_BEAM_RATIO).contains(&beam_ratio) {
            let allowed = "0 to 1e12";
            return Err(SpeckleError::out_of_range(
                "beam_ratio",
                beam_ratio,
                allowed,
            ));
        }
        if !phase.is_finite() {
            let allowed = "finite, in radians";
            return Err(SpeckleError::out_of_range("phase", phase, allowed));
        }
        let wave = Complex::from_polar(beam_ratio.sqrt(), phase);
        let values = self
            .values()
            .map(|&u| to_f32((to_c64(u) + wave).norm_sqr() / (1.0 + beam_ratio)));
        Ok(SpecklePattern::new(values, self.speckle_size()))
    }
}

#[cfg(test)]
mod tests;
