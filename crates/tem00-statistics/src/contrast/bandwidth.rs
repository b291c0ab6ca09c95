use core::f64::consts::{LN_2, PI};

use crate::StatisticsError;

/// Light of a narrow Gaussian spectrum, and the contrast of the speckle it makes.
///
/// ```text
/// C  = (1 + 4π (σ_L / l_c)²)^(−1/4)
/// l_c = √(2 ln 2 / π) λ² / Δλ = 0.664 λ² / Δλ        coherence length
/// ```
///
/// `σ_L` is the standard deviation of the optical path over the light that meets in one point of the
/// image: [`path_spread_of_reflection`] gives it for a rough surface. Each wavelength makes its own
/// pattern, and patterns whose wave numbers differ by Δk have the intensity correlation
/// `exp(−Δk² σ_L²)`; averaged over all pairs of wavelengths that is C². Δλ is the full width at
/// half maximum of the power per wavelength.
///
/// # Validity
///
/// Paths of Gaussian spread that is large against the wavelength, so that each wavelength alone
/// makes fully developed speckle; a linewidth small against the wavelength. That a pattern also
/// grows with its wavelength is left out: near the axis of free propagation, or in the image of a
/// lens, it does not matter.
///
/// # Examples
///
/// A laser diode of 1 nm linewidth loses hardly any contrast on paper, an LED of 20 nm much of it:
///
/// ```
/// use tem00_statistics::{GaussianSpectrum, path_spread_of_reflection};
///
/// let path_spread = path_spread_of_reflection(5e-6, [0.0, 0.0]);
/// let laser = GaussianSpectrum::new(650e-9, 1e-9)?;
/// assert!((laser.coherence_length() - 281e-6).abs() < 1e-6);
/// assert!((laser.contrast(path_spread) - 0.996).abs() < 1e-3);
/// let led = GaussianSpectrum::new(650e-9, 20e-9)?;
/// assert!((led.contrast(path_spread) - 0.607).abs() < 1e-3);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - G. Parry, *Speckle patterns in partially coherent light*, in *Laser Speckle and Related
///   Phenomena*, ed. J. C. Dainty, 1975.
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 6 (wavelength dependence).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianSpectrum {
    wavelength: f64,
    linewidth: f64,
}

/// The largest linewidth in wavelengths: to here the spectrum in wave number is as Gaussian as that
/// in wavelength to a tenth.
const LARGEST_RELATIVE_WIDTH: f64 = 0.1;

impl GaussianSpectrum {
    /// Creates the spectrum from its central wavelength λ and its linewidth Δλ, the full width at
    /// half maximum, both in metres.
    ///
    /// # Errors
    ///
    /// Returns an error unless both are positive and finite and `linewidth ≤ 0.1 wavelength`. The
    /// last check also catches swapped arguments.
    pub fn new(wavelength: f64, linewidth: f64) -> Result<Self, StatisticsError> {
        if !(wavelength > 0.0 && wavelength.is_finite()) {
            return Err(StatisticsError::refused(
                "wavelength",
                wavelength,
                "positive and finite, in metres",
            ));
        }
        let maximum = LARGEST_RELATIVE_WIDTH * wavelength;
        if linewidth > 0.0 && linewidth <= maximum {
            Ok(Self {
                wavelength,
                linewidth,
            })
        } else {
            Err(StatisticsError::refused(
                "linewidth",
                linewidth,
                "positive and at most a tenth of the wavelength, in metres; the two may be swapped",
            ))
        }
    }

    /// Returns the central wavelength λ, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the linewidth Δλ, the full width at half maximum, in metres.
    pub const fn linewidth(&self) -> f64 {
        self.linewidth
    }

    /// Returns the coherence length `l_c = 0.664 λ² / Δλ`, in metres: the squared degree of
    /// coherence, integrated over the path difference from −∞ to ∞.
    pub fn coherence_length(&self) -> f64 {
        (2.0 * LN_2 / PI).sqrt() * self.wavelength * (self.wavelength / self.linewidth)
    }

    /// Returns the correlation of the intensities of the patterns at the central wavelength and at
    /// one that is longer by `shift`, in metres: `exp(−(2π σ_L shift / λ²)²)`.
    pub fn correlation(&self, shift: f64, path_spread: f64) -> f64 {
        let phase = 2.0 * PI * (path_spread / self.wavelength) * (shift / self.wavelength);
        (-phase * phase).exp()
    }

    /// Returns the contrast of the speckle in this light where the optical path varies by the
    /// standard deviation `path_spread`, in metres.
    pub fn contrast(&self, path_spread: f64) -> f64 {
        let ratio = (4.0 * PI).sqrt() * path_spread / self.coherence_length();
        1.0_f64.hypot(ratio).sqrt().recip()
    }
}

/// Returns the standard deviation of the optical path, in metres, of light reflected in air by a
/// rough surface whose height has the standard deviation `height_spread`, in metres.
///
/// ```text
/// σ_L = (cos θᵢ + cos θₒ) σ_h          2 σ_h at normal incidence and observation
/// ```
///
/// `angles` are those of incidence θᵢ and of observation θₒ to the normal of the mean surface, in
/// radians.
///
/// # Validity
///
/// A surface without steep slopes, shadows or multiple scattering, on an area whose depth as a whole
/// does not count: on a surface seen at an angle one resolution cell has a path spread of its own.
pub fn path_spread_of_reflection(height_spread: f64, angles: [f64; 2]) -> f64 {
    let [incidence, observation] = angles;
    (incidence.cos() + observation.cos()) * height_spread
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use tem00_numerics::quadrature::integrate;

    fn spectrum() -> GaussianSpectrum {
        GaussianSpectrum::new(650e-9, 3e-9).unwrap()
    }

    #[test]
    fn squared_contrast_is_the_correlation_averaged_over_pairs_of_wavelengths() {
        let spectrum = spectrum();
        // Full width 2√(2 ln 2) σ; 8 σ leave 1e−15 out.
        let sigma = 3e-9 / (8.0 * LN_2).sqrt();
        let power =
            |shift: f64| (-0.5 * (shift / sigma).powi(2)).exp() / (sigma * (2.0 * PI).sqrt());
        let range = [-8.0 * sigma, 8.0 * sigma];
        for path_spread in [0.0, 10e-6, 60e-6, 400e-6] {
            let inner = |first: f64| {
                let pair =
                    |second: f64| power(second) * spectrum.correlation(first - second, path_spread);
                integrate(pair, range, 0.25 * sigma)
            };
            let squared = integrate(|first| power(first) * inner(first), range, sigma);
            let contrast = spectrum.contrast(path_spread);
            assert_relative_eq!(contrast * contrast, squared, max_relative = 1e-12);
        }
    }

    #[test]
    fn coherence_length_is_the_integral_of_the_squared_coherence() {
        let spectrum = spectrum();
        // The degree of coherence at the path difference L is the Fourier transform of the
        // spectrum: exp(−(2πσL/λ²)²/2).
        let sigma = 3e-9 / (8.0 * LN_2).sqrt();
        let width = 650e-9 * 650e-9 / (2.0 * PI * sigma);
        let squared = |path: f64| (-(path / width).powi(2)).exp();
        let length = integrate(squared, [-8.0 * width, 8.0 * width], width);
        assert_relative_eq!(spectrum.coherence_length(), length, max_relative = 1e-13);
        // 0.664 λ²/Δλ.
        assert_relative_eq!(length, 93.55e-6, max_relative = 1e-4);
    }

    #[test]
    fn the_phase_of_a_path_varies_with_the_wave_number() {
        // ⟨exp(iΔk L)⟩ over a Gaussian L, squared, with Δk = 2π/λ − 2π/(λ + shift).
        let (spectrum, shift, spread) = (spectrum(), 1e-12, 30e-3);
        let wave_number = 2.0 * PI * (650e-9_f64.recip() - (650e-9_f64 + shift).recip());
        let law = |t: f64| (wave_number * spread * t).cos() * (-0.5 * t * t).exp();
        let mean = integrate(law, [-9.0, 9.0], 0.5) / (2.0 * PI).sqrt();
        // The shift is 1.5e−6 of the wavelength.
        let correlation = spectrum.correlation(shift, spread);
        assert_relative_eq!(correlation, mean * mean, max_relative = 2e-6, epsilon = 0.0);
        assert!((0.01..0.99).contains(&correlation), "{correlation}");
    }

    #[test]
    fn limits_of_the_contrast() {
        let spectrum = spectrum();
        assert_relative_eq!(spectrum.contrast(0.0), 1.0, epsilon = 1e-15);
        assert_relative_eq!(
            spectrum.contrast(-1e-3),
            spectrum.contrast(1e-3),
            epsilon = 1e-15
        );
        // (4π)^(−1/4) √(l_c / σ_L) for large spreads, without overflow.
        let far = spectrum.contrast(1e300);
        let exact = (spectrum.coherence_length() / 1e300).sqrt() / (4.0 * PI).sqrt().sqrt();
        assert_relative_eq!(far, exact, max_relative = 1e-13, epsilon = 0.0);
        let grazing = path_spread_of_reflection(1e-6, [0.0, PI / 3.0]);
        assert_relative_eq!(grazing, 1.5e-6, max_relative = 1e-15);
    }

    #[test]
    fn spectra_that_are_not_narrow_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let refused = GaussianSpectrum::new(bad, 1e-9);
            assert!(
                matches!(
                    refused,
                    Err(StatisticsError::OutOfRange {
                        parameter: "wavelength",
                        ..
                    })
                ),
                "{bad}"
            );
            let refused = GaussianSpectrum::new(650e-9, bad);
            assert!(
                matches!(
                    refused,
                    Err(StatisticsError::OutOfRange {
                        parameter: "linewidth",
                        ..
                    })
                ),
                "{bad}"
            );
        }
        let swapped = GaussianSpectrum::new(1e-9, 650e-9);
        assert!(
            matches!(
                swapped,
                Err(StatisticsError::OutOfRange {
                    parameter: "linewidth",
                    ..
                })
            ),
            "{swapped:?}"
        );
    }
}
