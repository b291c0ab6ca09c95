use tem00_numerics::check;

use crate::{
    StatisticsError, exponential_density,
    intensity::bessel::{rician_cumulative, scaled_bessel_i0},
};

/// Joint distribution of the intensities at two points of fully developed speckle, or at one point
/// of two correlated patterns.
///
/// ```text
/// p(I₁, I₂) = exp(−(I₁ + I₂)/(1 − μ²)) I₀(2μ√(I₁I₂)/(1 − μ²)) / (1 − μ²)
/// μ         magnitude of the correlation of the two amplitudes
/// γ = μ²    correlation of the two intensities
/// ```
///
/// Intensities are in units of their mean, which both points share. For two points at the distance
/// r, μ² is the [`airy_autocovariance`](crate::airy_autocovariance); for a pupil shifted by a
/// fraction of its diameter μ is the overlap of the two discs.
///
/// # Examples
///
/// The intensity next to a speckle five times as bright as the mean, where μ² = 1/2:
///
/// ```
/// use tem00_statistics::laws::JointIntensity;
///
/// let law = JointIntensity::new(0.5_f64.sqrt())?;
/// assert!((law.conditional_mean(5.0) - 3.0).abs() < 1e-14);
/// assert!((law.moment([1, 1]) - 1.5).abs() < 1e-14);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Statistical properties of laser speckle patterns*, 1975, §2.6.
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (joint statistics).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointIntensity {
    amplitude_correlation: f64,
}

/// The largest order of a moment: 20!² and the sum over it stay far from overflow.
const LARGEST_ORDER: u32 = 20;

impl JointIntensity {
    /// Creates the law from the magnitude μ of the correlation of the amplitudes.
    ///
    /// # Errors
    ///
    /// Returns an error unless `0 ≤ amplitude_correlation < 1`: at 1 the two intensities are equal
    /// and have no joint density.
    pub fn new(amplitude_correlation: f64) -> Result<Self, StatisticsError> {
        let holds = (0.0..1.0).contains(&amplitude_correlation);
        let (name, allowed) = ("amplitude_correlation", "at least 0 and below 1");
        check::that(holds, name, amplitude_correlation, "", allowed)?;
        Ok(Self {
            amplitude_correlation,
        })
    }

    /// Returns the magnitude μ of the correlation of the amplitudes.
    pub const fn amplitude_correlation(&self) -> f64 {
        self.amplitude_correlation
    }

    /// Returns the correlation `γ = μ²` of the intensities.
    pub const fn intensity_correlation(&self) -> f64 {
        self.amplitude_correlation * self.amplitude_correlation
    }

    /// Returns the joint density of two intensities, in units of their mean.
    pub fn density(&self, intensities: [f64; 2]) -> f64 {
        let [given, intensity] = intensities;
        exponential_density(given) * self.conditional_density(intensity, given)
    }

    /// Returns the density of the intensity at one point if the intensity at the other is `given`.
    ///
    /// It is the density for a coherent background of μ² times `given` with speckle of the mean 1 −
    /// μ².
    pub fn conditional_density(&self, intensity: f64, given: f64) -> f64 {
        if intensity < 0.0 || given < 0.0 || intensity.is_infinite() || given.is_infinite() {
            return 0.0;
        }
        let mu = self.amplitude_correlation;
        let width = self.independent_share();
        let (amplitude, background) = (intensity.sqrt(), mu * given.sqrt());
        let distance = amplitude - background;
        let bessel = scaled_bessel_i0(2.0 * amplitude * (background / width));
        bessel * (-distance * (distance / width)).exp() / width
    }

    /// Returns the probability that the intensity at one point is at most `intensity` if the
    /// intensity at the other is `given`: `1 − Q₁(μ√(2 given/(1 − μ²)), √(2 intensity/(1 − μ²)))`,
    /// with Marcum's function.
    pub fn conditional_cumulative(&self, intensity: f64, given: f64) -> f64 {
        if intensity <= 0.0 {
            return 0.0;
        }
        let unit = (2.0 / self.independent_share()).sqrt();
        let background = self.amplitude_correlation * given.max(0.0).sqrt();
        rician_cumulative(unit * background, unit * intensity.sqrt())
    }

    /// Returns the mean of the intensity at one point if the intensity at the other is `given`:
    /// `1 + (given − 1) μ²`.
    pub fn conditional_mean(&self, given: f64) -> f64 {
        self.independent_share() + given * self.intensity_correlation()
    }

    /// Returns the variance of the intensity at one point if the intensity at the other is `given`:
    /// `(1 − μ²)² + 2μ² (1 − μ²) given`.
    pub fn conditional_variance(&self, given: f64) -> f64 {
        let share = self.independent_share();
        share * (share + 2.0 * self.intensity_correlation() * given)
    }

    /// Returns the moment ⟨I₁ᵐ I₂ⁿ⟩ of the orders `[m, n]`.
    ///
    /// ```text
    /// ⟨I₁ᵐ I₂ⁿ⟩ = m! n! Σₖ (m k) (n k) μ²ᵏ       (m k) binomial coefficients
    /// ```
    ///
    /// # Panics
    ///
    /// Panics unless `m ≤ 20` and `n ≤ 20`.
    pub fn moment(&self, orders: [u32; 2]) -> f64 {
        let [m, n] = orders;
        assert!(
            m.max(n) <= LARGEST_ORDER,
            "orders {m} and {n} of a moment exceed 20"
        );
        let correlation = self.intensity_correlation();
        let (mut term, mut sum) = (1.0, 1.0);
        for k in 0..m.min(n) {
            let next = f64::from(k + 1);
            term *= f64::from(m - k) * f64::from(n - k) / (next * next) * correlation;
            sum += term;
        }
        factorial(m) * factorial(n) * sum
    }

    /// Returns 1 − μ² without cancellation.
    const fn independent_share(&self) -> f64 {
        (1.0 - self.amplitude_correlation) * (1.0 + self.amplitude_correlation)
    }
}

fn factorial(n: u32) -> f64 {
    (1..=n).map(f64::from).product()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    use tem00_numerics::quadrature::integrate;

    fn law(amplitude_correlation: f64) -> JointIntensity {
        JointIntensity::new(amplitude_correlation).unwrap()
    }

    /// ∫∫ p I₁ᵐ I₂ⁿ by quadrature; the omitted part is exp(−45).
    fn moment_by_quadrature(law: &JointIntensity, [m, n]: [i32; 2]) -> f64 {
        let inner = |first: f64| {
            integrate(
                |second| law.density([first, second]) * second.powi(n),
                [0.0, 60.0],
                3.0,
            )
        };
        integrate(|first| inner(first) * first.powi(m), [0.0, 60.0], 3.0)
    }

    #[test]
    fn moments_are_integrals_of_the_density() {
        for mu in [0.0, 0.4, 0.8] {
            let law = law(mu);
            for (m, n) in [(0_u8, 0_u8), (1, 0), (1, 1), (2, 1), (2, 2), (3, 2)] {
                let orders = [u32::from(m), u32::from(n)];
                let moment = moment_by_quadrature(&law, [i32::from(m), i32::from(n)]);
                assert_relative(moment, law.moment(orders), 1e-11);
            }
        }
    }

    #[test]
    fn low_moments_are_the_known_polynomials() {
        let mu = 0.6_f64;
        let (g, law) = (mu * mu, law(mu));
        assert_relative(law.moment([1, 1]), 1.0 + g, 1e-15);
        assert_relative(law.moment([2, 1]), 2.0 * (1.0 + 2.0 * g), 1e-15);
        let fourth = 4.0 * (1.0 + 4.0 * g + g * g);
        assert_relative(law.moment([2, 2]), fourth, 1e-15);
        assert_relative(law.moment([4, 0]), 24.0, 1e-15);
    }

    #[test]
    fn conditional_law_is_the_joint_over_the_given_one() {
        for mu in [0.0, 0.3, 0.9] {
            let law = law(mu);
            for given in [0.0, 0.7, 4.0] {
                let density = |x| law.density([given, x]) / exponential_density(given);
                let moment = |k| integrate(|x| density(x) * x.powi(k), [0.0, 60.0], 0.1);
                let mean = moment(1);
                assert_absolute(moment(0), 1.0, 1e-12);
                assert_absolute(mean, law.conditional_mean(given), 1e-12);
                let variance = moment(2) - mean * mean;
                assert_absolute(variance, law.conditional_variance(given), 1e-11);
                for intensity in [0.2, 1.0, 3.0] {
                    let area = integrate(density, [0.0, intensity], 0.1);
                    let cumulative = law.conditional_cumulative(intensity, given);
                    assert_absolute(cumulative, area, 1e-12);
                }
            }
        }
    }

    proptest! {
        #[test]
        fn law_is_finite_and_symmetric(
            mu in prop_oneof![0.0_f64..1.0, Just(1.0 - f64::EPSILON)],
            exponents in [-30.0_f64..30.0, -30.0_f64..30.0],
        ) {
            let law = law(mu);
            let [a, b] = exponents.map(|e| 10.0_f64.powf(e));
            for (a, b) in [(a, b), (a, a), (0.0, b), (exponents[0].abs(), exponents[1].abs())] {
                let (there, back) = (law.density([a, b]), law.density([b, a]));
                prop_assert!(there.is_finite() && there >= 0.0, "p({a}, {b}) = {there}");
                // Cancellation in the exponent (√a − μ√b)²/(1 − μ²) leaves an error of about ε a/(1
                // − μ²).
                if mu < 0.99 && a.max(b) < 40.0 {
                    prop_assert!((there - back).abs() <= 1e-12 * (there + back), "{there} {back}");
                }
                prop_assert!((0.0..=1.0).contains(&law.conditional_cumulative(a, b)), "{a} {b}");
            }
        }
    }
}
