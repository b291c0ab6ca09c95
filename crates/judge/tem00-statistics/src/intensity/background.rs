use core::f64::consts::SQRT_2;

use tem00_numerics::check;

use crate::{
    StatisticsError,
    intensity::bessel::{rician_cumulative, scaled_bessel_i0},
};

/// Distribution of the intensity of speckle on a coherent background: partially developed speckle.
///
/// ```text
/// p(I) = (1 + r) exp(−(1 + r) I − r) I₀(2√(r (1 + r) I))     I in units of its mean
/// F(I) = 1 − Q₁(√(2r), √(2 (1 + r) I))                       Q₁ Marcum's function
/// C    = √(1 + 2r) / (1 + r)
/// r    = I_s / ⟨I_n⟩                                         beam ratio
/// ```
///
/// `I_s` is the uniform intensity of the background, the specular reflection of a surface that is
/// not quite rough or the reference wave of a hologram, and `⟨I_n⟩` is the mean of the speckle. The
/// amplitude has a Rice distribution. r = 0 is the exponential distribution.
///
/// # Validity
///
/// The background has one phase and one intensity over the area considered, and the same
/// polarisation and coherence as the speckle, which is fully developed by itself. A surface whose
/// phase varies by less than some radians adds a part that is not circular, which is neglected.
///
/// # Examples
///
/// Background and speckle of equal power:
///
/// ```
/// use tem00_statistics::CoherentBackground;
///
/// let law = CoherentBackground::new(1.0)?;
/// assert!((law.contrast() - 3.0_f64.sqrt() / 2.0).abs() < 1e-15);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - S. O. Rice, *Mathematical analysis of random noise*, 1945, §3.10.
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (a known phasor plus a random
///   phasor sum).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoherentBackground {
    beam_ratio: f64,
}

impl CoherentBackground {
    /// Creates the law from the beam ratio r, the background divided by the mean of the speckle.
    ///
    /// # Errors
    ///
    /// Returns an error unless `beam_ratio` is finite and not negative.
    pub fn new(beam_ratio: f64) -> Result<Self, StatisticsError> {
        let beam_ratio = check::not_negative("beam_ratio", beam_ratio, "")?;
        Ok(Self { beam_ratio })
    }

    /// Creates the law with the contrast C: `r = s (1 + s) / C²` with `s = √(1 − C²)`.
    ///
    /// # Errors
    ///
    /// Returns an error unless `0.001 ≤ contrast ≤ 1`.
    pub fn from_contrast(contrast: f64) -> Result<Self, StatisticsError> {
        let contrast = check::range("contrast", contrast, [1e-3, 1.0], "")?;
        let root = ((1.0 - contrast) * (1.0 + contrast)).sqrt();
        Ok(Self {
            beam_ratio: root * (1.0 + root) / (contrast * contrast),
        })
    }

    /// Returns the beam ratio r, the background divided by the mean of the speckle.
    pub const fn beam_ratio(&self) -> f64 {
        self.beam_ratio
    }

    /// Returns the contrast, standard deviation over mean: `√(1 + 2r) / (1 + r)`.
    pub fn contrast(&self) -> f64 {
        let share = (1.0 + self.beam_ratio).recip();
        // r / (1 + r) is 1 − share, which never overflows.
        ((2.0 - share) * share).sqrt()
    }

    /// Returns the probability density of the intensity, in units of the mean intensity.
    pub fn density(&self, intensity: f64) -> f64 {
        if intensity < 0.0 || intensity.is_infinite() {
            return 0.0;
        }
        let scale = 1.0 + self.beam_ratio;
        let (background, amplitude) = (self.beam_ratio.sqrt(), scale.sqrt() * intensity.sqrt());
        let distance = amplitude - background;
        let tail = (-distance * distance).exp();
        scale * tail * scaled_bessel_i0(2.0 * background * amplitude)
    }

    /// Returns the probability that the intensity is at most `intensity`, in units of the mean.
    ///
    /// The absolute error is below 10⁻¹⁴.
    pub fn cumulative(&self, intensity: f64) -> f64 {
        if intensity <= 0.0 {
            return 0.0;
        }
        let amplitude = (1.0 + self.beam_ratio).sqrt() * intensity.sqrt();
        rician_cumulative(SQRT_2 * self.beam_ratio.sqrt(), SQRT_2 * amplitude)
    }
}

#[cfg(test)]
mod tests {

    use proptest::prelude::*;

    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::{exponential_cumulative, exponential_density};
    use tem00_numerics::quadrature::integrate;

    #[test]
    fn density_has_mean_one_and_the_stated_contrast() {
        for ratio in [0.0, 0.3, 1.0, 5.0, 300.0] {
            let law = CoherentBackground::new(ratio).unwrap();
            // Beyond 40/(1 + r) and 12 standard deviations there is less than 1e−15.
            let end = 1.0 + 45.0 / (1.0 + ratio) + 12.0 * law.contrast();
            let moment = |k| {
                integrate(
                    |x| law.density(x) * x.powi(k),
                    [0.0, end],
                    0.2 * law.contrast(),
                )
            };
            assert_absolute(moment(0), 1.0, 1e-12);
            assert_absolute(moment(1), 1.0, 1e-12);
            let contrast = (moment(2) - 1.0).sqrt();
            assert_absolute(contrast, law.contrast(), 1e-11);
        }
    }

    #[test]
    fn distribution_is_the_integral_of_the_density() {
        for ratio in [0.0, 1e-6, 0.5, 20.0] {
            let law = CoherentBackground::new(ratio).unwrap();
            for x in [0.01, 0.5, 1.0, 1.7] {
                let area = integrate(|x| law.density(x), [0.0, x], 0.05);
                assert_absolute(law.cumulative(x), area, 1e-13);
            }
        }
    }

    #[test]
    fn no_background_is_the_exponential_law() {
        let law = CoherentBackground::from_contrast(1.0).unwrap();
        for x in [-1.0, 0.0, 0.3, 2.0, 30.0] {
            assert_absolute(law.density(x), exponential_density(x), 1e-15);
            assert_absolute(law.cumulative(x), exponential_cumulative(x), 1e-14);
        }
    }

    #[test]
    fn contrast_and_beam_ratio_are_inverse() {
        for contrast in [0.001, 0.1, 0.866, 0.999_999, 1.0] {
            let law = CoherentBackground::from_contrast(contrast).unwrap();
            assert_relative(law.contrast(), contrast, 1e-12);
        }
    }

    proptest! {
        #[test]
        fn law_is_finite_and_a_probability(
            ratio in prop_oneof![
                (-300.0_f64..300.0).prop_map(|e| 10.0_f64.powf(e)),
                Just(f64::MAX),
            ],
            intensity in 0.0_f64..f64::MAX,
        ) {
            let law = CoherentBackground::new(ratio).unwrap();
            prop_assert!((0.0..=1.0).contains(&law.contrast()), "{}", law.contrast());
            for x in [intensity, intensity.ln().abs(), intensity.recip(), 0.0, 1.0] {
                prop_assert!(law.density(x).is_finite() && law.density(x) >= 0.0, "{x}");
                prop_assert!((0.0..=1.0).contains(&law.cumulative(x)), "{x}");
            }
        }
    }
}
