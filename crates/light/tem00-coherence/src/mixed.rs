use tem00_numerics::{check, disc_overlap, quadrature::integrate};

use crate::Refusal;

/// Mixture of the light of a pixel that met one rough surface, *single* light, with light that met
/// several, *multiple* light.
///
/// Each is a circular Gaussian field over the wave numbers, and the fields add. With the fractions
/// f of both, their degrees of polarisation P in the same two components, and the coherence c that
/// their paths share,
///
/// ```text
/// C² = f₁² c₁₁ (1 + P₁²)/2 + f₁ f₂ c₁₂ (1 + P₁ P₂) + f₂² c₂₂ (1 + P₂²)/2
/// cᵢⱼ = ∬ pᵢ(l) pⱼ(l') |γ(l − l')|² dl dl'
/// ```
///
/// The default is polarised light of one wavelength without multiple light: C = 1.
///
/// # Validity
///
/// A resolution cell contains many scatterers, and the lit part of the other surface is large
/// enough that its own speckle is much finer than the cell: see [`cascade_variance`].
///
/// # Examples
///
/// A corner with 30 parts of multiple light to 100 parts of single light, lit by a laser of one
/// wavelength and by a laser so broad that only the single light interferes:
///
/// ```
/// use tem00_coherence::MixedLight;
///
/// let coherent = MixedLight { multiple: 0.3 / 1.3, ..MixedLight::default() };
/// assert!((coherent.contrast()? - 1.0).abs() < 1e-12);
/// let broad = MixedLight { with_single: 0.0, within_multiple: 0.0, ..coherent };
/// assert!((broad.contrast()? - 1.0 / 1.3).abs() < 1e-12);
/// # Ok::<(), tem00_coherence::Refusal>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3: sums of patterns that are partly
///   correlated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixedLight {
    /// The fraction f₂ of the multiple light, from 0 to 1.
    pub multiple: f64,
    /// c₁₁, the squared contrast of the polarised single light alone, from 0 to 1, as
    /// [`PolychromaticSpeckle`](crate::PolychromaticSpeckle) gives it.
    pub within_single: f64,
    /// c₁₂ of single with multiple light, from 0 to 1. [`PathPairs`](crate::PathPairs) gives c₁₂
    /// and c₂₂.
    pub with_single: f64,
    /// c₂₂ of the multiple light with itself, from 0 to 1.
    pub within_multiple: f64,
    /// Degrees of polarisation of the single and of the multiple light, from 0 to 1.
    pub polarisation: [f64; 2],
}

impl Default for MixedLight {
    fn default() -> Self {
        Self {
            multiple: 0.0,
            within_single: 1.0,
            with_single: 1.0,
            within_multiple: 1.0,
            polarisation: [1.0; 2],
        }
    }
}

impl MixedLight {
    /// Returns the contrast, standard deviation over mean.
    ///
    /// # Errors
    ///
    /// Returns an error unless all fields lie between 0 and 1.
    pub fn contrast(&self) -> Result<f64, Refusal> {
        let [first, second] = self.polarisation;
        let fields = [
            ("multiple", self.multiple),
            ("within_single", self.within_single),
            ("with_single", self.with_single),
            ("within_multiple", self.within_multiple),
            ("polarisation", first),
            ("polarisation", second),
        ];
        for (name, value) in fields {
            check::range(name, value, [0.0, 1.0], "")?;
        }
        let single = 1.0 - self.multiple;
        // The trace of the product of two coherency matrices with these degrees of polarisation.
        let shared = |a: f64, b: f64| 0.5 * (1.0 + a * b);
        let squared = single.powi(2) * self.within_single * shared(first, first)
            + 2.0 * single * self.multiple * self.with_single * shared(first, second)
            + self.multiple.powi(2) * self.within_multiple * shared(second, second);
        Ok(squared.sqrt())
    }
}

/// Returns the relative variance 1/M, over a resolution cell, of the light that the cell receives
/// from a small lit part of another surface, due to the speckle of that part.
///
/// ```text
/// 1/M = ∫ chat²(ν) chat(ν/r) ν dν / ∫ chat(ν/r) ν dν
/// C²  = 1 + 2/M                                         multiple light alone, of one wavelength
/// ```
///
/// for a round part of the half-angle α seen from the cell, r = sin α / sin u. A part much smaller
/// than the aperture of the camera, r → 0, makes the squared contrast 3, as for a K distribution:
/// speckle of speckle. With single light and a finite linewidth, the term f₂² (1 + c₂₂) / M is
/// added to the squared contrast of [`MixedLight`].
///
/// # Errors
///
/// Returns an error if r is negative or not a number.
///
/// # Examples
///
/// The speckle of a wall that fills ten times the aperture is invisible:
///
/// ```
/// use tem00_coherence::cascade_variance;
///
/// assert!((1.0 + 2.0 * cascade_variance(0.1)?).sqrt() > 1.66);
/// assert!((1.0 + 2.0 * cascade_variance(10.0)?).sqrt() < 1.005);
/// # Ok::<(), tem00_coherence::Refusal>(())
/// ```
pub fn cascade_variance(relative_aperture: f64) -> Result<f64, Refusal> {
    let r = relative_aperture;
    let allowed = "0 or positive, the sine of the lit part's half-angle over the aperture's";
    check::that(r >= 0.0, "relative_aperture", r, "", allowed)?;
    // Lengths are relative to the wider of the two spectra; the narrower one ends the integral.
    let (of_pupil, of_part) = if r < 1.0 { (r, 1.0) } else { (1.0, r.recip()) };
    let integrand = |t: f64| disc_overlap(of_pupil * t).powi(2) * disc_overlap(of_part * t) * t;
    // ∫ chat(t) t dt = 1/8.
    Ok(8.0 * of_part.powi(2) * integrate(integrand, [0.0, 1.0], 0.25))
}

#[cfg(test)]
mod tests;
