use tem00_numerics::check;

use crate::{StatisticsError, exponential_cumulative, exponential_density};

/// Distribution of the intensity of partially polarised speckle.
///
/// ```text
/// p(I) = (exp(−2I/(1 + P)) − exp(−2I/(1 − P))) / P     I in units of its mean
/// C    = √((1 + P²) / 2)
/// ```
///
/// P is the degree of polarisation of the scattered light: along two orthogonal polarisations its
/// fields are uncorrelated and carry the fractions (1 ± P)/2 of the power. P = 1 is the exponential
/// distribution, P = 0 the sum of two equal patterns.
///
/// # Validity
///
/// The speckle is fully developed in both polarisations.
///
/// # Examples
///
/// A rough dielectric that depolarises completely lowers the contrast to 1/√2:
///
/// ```
/// use tem00_statistics::PartiallyPolarised;
///
/// let law = PartiallyPolarised::new(0.0)?;
/// assert!((law.contrast() - 0.5_f64.sqrt()).abs() < 1e-15);
/// // 1 − 3 e⁻² of the points are darker than the mean.
/// assert!((law.cumulative(1.0) - 0.593_994).abs() < 1e-6);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Statistical properties of laser speckle patterns*, 1975, §2.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartiallyPolarised {
    degree: f64,
}

impl PartiallyPolarised {
    /// Creates the law from the degree of polarisation P.
    ///
    /// # Errors
    ///
    /// Returns an error unless `0 ≤ degree ≤ 1`.
    pub fn new(degree: f64) -> Result<Self, StatisticsError> {
        let (holds, allowed) = (
            (0.0..=1.0).contains(&degree),
            "a degree of polarisation from 0 to 1",
        );
        check::that(holds, "degree", degree, "", allowed)?;
        Ok(Self { degree })
    }

    /// Returns the degree of polarisation P.
    pub const fn degree(&self) -> f64 {
        self.degree
    }

    /// Returns the contrast, standard deviation over mean: `√((1 + P²) / 2)`.
    pub fn contrast(&self) -> f64 {
        (0.5 * (1.0 + self.degree * self.degree)).sqrt()
    }

    /// Returns the probability density of the intensity, in units of the mean intensity.
    pub fn density(&self, intensity: f64) -> f64 {
        let p = self.degree;
        if p >= 1.0 {
            return exponential_density(intensity);
        }
        if intensity <= 0.0 || intensity.is_infinite() {
            return 0.0;
        }
        let tail = (-2.0 * intensity / (1.0 + p)).exp();
        let slope = 4.0 / ((1.0 - p) * (1.0 + p));
        if tail <= 0.0 {
            0.0
        } else if p < 0.5 {
            tail * slope * intensity * saturation(p * slope * intensity)
        } else {
            tail * -(-p * slope * intensity).exp_m1() / p
        }
    }

    /// Returns the probability that the intensity is at most `intensity`, in units of the mean.
    pub fn cumulative(&self, intensity: f64) -> f64 {
        let p = self.degree;
        if p >= 1.0 {
            return exponential_cumulative(intensity);
        }
        if intensity <= 0.0 {
            return 0.0;
        }
        // 1 − F = exp(−t) (1 + t (1 − exp(−y)) / y), with positive terms only.
        let strong = 2.0 * intensity / (1.0 + p);
        let excess = 4.0 * p * intensity / ((1.0 - p) * (1.0 + p));
        let tail = (-strong).exp();
        if tail > 0.0 {
            1.0 - tail * (1.0 + strong * saturation(excess))
        } else {
            1.0
        }
    }
}

/// Returns (1 − exp(−y)) / y, 1 at y = 0.
fn saturation(y: f64) -> f64 {
    if y > 0.0 { -(-y).exp_m1() / y } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use tem00_testkit::assert_absolute;

    use super::*;
    use crate::GammaIntensity;
    use tem00_numerics::quadrature::integrate;

    #[test]
    fn density_has_mean_one_and_the_stated_contrast() {
        for (degree, contrast) in [(0.1, 0.710_63), (0.3, 0.738_24), (0.7, 0.863_13)] {
            let law = PartiallyPolarised::new(degree).unwrap();
            // The probability exp(−2 · 40/1.7) = 4e−21 lies beyond; the steeper exponential falls
            // by e in 0.15.
            let moment = |k| integrate(|x| law.density(x) * x.powi(k), [0.0, 40.0], 0.5);
            assert_absolute(moment(0), 1.0, 1e-13);
            assert_absolute(moment(1), 1.0, 1e-13);
            assert_absolute((moment(2) - 1.0).sqrt(), law.contrast(), 1e-13);
            // Five digits, computed by hand.
            assert_absolute(law.contrast(), contrast, 5e-6);
        }
    }

    #[test]
    fn distribution_is_the_integral_of_the_density() {
        for degree in [0.0, 1e-12, 1e-3, 0.4999, 0.5001, 0.95] {
            let law = PartiallyPolarised::new(degree).unwrap();
            for intensity in [1e-3, 0.4, 1.0, 7.0] {
                let area = integrate(|x| law.density(x), [0.0, intensity], 0.05);
                assert_absolute(law.cumulative(intensity), area, 1e-14);
            }
        }
    }

    #[test]
    fn unpolarised_and_polarised_light_are_the_known_laws() {
        let (none, all) = (
            PartiallyPolarised::new(0.0).unwrap(),
            PartiallyPolarised::new(1.0).unwrap(),
        );
        let two = GammaIntensity::new(2.0).unwrap();
        for x in [-1.0, 0.0, 0.1, 1.0, 5.0, 800.0] {
            assert_absolute(none.density(x), two.density(x), 1e-14);
            assert_absolute(none.cumulative(x), two.cumulative(x), 1e-14);
            assert_absolute(all.density(x), exponential_density(x), 1e-15);
            assert_absolute(all.cumulative(x), exponential_cumulative(x), 1e-15);
        }
        // The closed forms join continuously: 1 − P changes the law by the same amount.
        let nearly = PartiallyPolarised::new(1.0 - 1e-12).unwrap();
        assert_absolute(nearly.density(0.7), all.density(0.7), 1e-11);
    }

    proptest! {
        #[test]
        fn law_is_finite_and_a_probability(
            degree in 0.0_f64..=1.0,
            intensity in 0.0_f64..f64::MAX,
        ) {
            let law = PartiallyPolarised::new(degree).unwrap();
            for x in [intensity, intensity.ln().abs(), intensity.recip(), 0.0, f64::INFINITY] {
                prop_assert!(law.density(x).is_finite() && law.density(x) >= 0.0, "{x}");
                prop_assert!((0.0..=1.0).contains(&law.cumulative(x)), "{x}");
            }
        }
    }
}
