use core::f64::consts::PI;

use crate::{StatisticsError, laws::contrast_of_phasor_sum};

/// Distribution of the intensity of a sum of few phasors of equal length and random phase.
///
/// ```text
/// I    = |Σ exp(iφⱼ)|² / N                   N phasors; mean 1, at most N
/// p(I) = ½ ∫₀^∞ J₀(ω√I) J₀(ω/√N)ᴺ ω dω       the integral of Kluyver
/// C    = √(1 − 1/N)
/// ```
///
/// Examples are the speckle of a surface with only N scatterers, or facets, in a resolution cell of
/// the optics, and a pattern computed from N unit phasors in the pupil.
///
/// # Validity
///
/// All phasors have the same length. The density is exact to 10⁻⁶ from eight phasors on and to 10⁻⁹
/// from sixteen on, the distribution function to a hundredth of these values; for fewer than eight
/// the integral converges too slowly. An intensity above 49, whose probability is below 10⁻²¹,
/// counts as impossible.
///
/// # Examples
///
/// Ten phasors are brighter than four times their mean less often than fully developed speckle,
/// whose probability is e⁻⁴ = 0.0183:
///
/// ```
/// use tem00_statistics::laws::PhasorSum;
///
/// let law = PhasorSum::new(10)?;
/// assert!((law.contrast() - 0.9_f64.sqrt()).abs() < 1e-15);
/// assert!((1.0 - law.cumulative(4.0) - 0.014_263).abs() < 1e-6);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - J. C. Kluyver, *A local probability problem*, 1905.
/// - R. Barakat, *First-order statistics of combined random sinusoidal waves with applications to
///   laser speckle patterns*, 1974.
#[derive(Clone, Debug, PartialEq)]
pub struct PhasorSum {
    count: usize,
    /// The largest amplitude, in units of its root mean square.
    reach: f64,
    terms: Vec<Term>,
}

/// A term of the Fourier–Bessel series of the density on the disc of the amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Term {
    /// The zero of J₀.
    zero: f64,
    /// J₀(zero / reach / √N)ᴺ / J₁(zero)².
    weight: f64,
}

/// exp(−7²) is the probability of a larger amplitude, if there is one.
const LARGEST_AMPLITUDE: f64 = 7.0;

/// The largest number of terms of the series, which eight phasors need.
const LARGEST_TERM_COUNT: u32 = 2_500;

impl PhasorSum {
    /// Creates the distribution for the sum of `count` phasors.
    ///
    /// # Errors
    ///
    /// Returns an error unless `8 ≤ count ≤ 10⁶`.
    pub fn new(count: usize) -> Result<Self, StatisticsError> {
        let power = match i32::try_from(count) {
            Ok(power @ 8..=1_000_000) => power,
            _ => {
                return Err(StatisticsError::refused(
                    "count",
                    count as f64,
                    "from 8 to 1000000 phasors",
                ));
            }
        };
        let root = f64::from(power).sqrt();
        let reach = root.min(LARGEST_AMPLITUDE);
        let terms = (1..=LARGEST_TERM_COUNT)
            .map(bessel_zero)
            .take_while(|zero| !is_negligible(zero / reach / root, power))
            .map(|zero| Term {
                zero,
                weight: libm::j0(zero / reach / root).powi(power) / libm::j1(zero).powi(2),
            })
            .collect();
        Ok(Self {
            count,
            reach,
            terms,
        })
    }

    /// Returns the number N of phasors.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Returns the contrast, standard deviation over mean: `√(1 − 1/N)`.
    pub fn contrast(&self) -> f64 {
        contrast_of_phasor_sum(self.count)
    }

    /// Returns the probability density of the intensity, in units of the mean intensity.
    pub fn density(&self, intensity: f64) -> f64 {
        let amplitude = intensity.max(0.0).sqrt();
        if intensity < 0.0 || amplitude >= self.reach {
            return 0.0;
        }
        let ratio = amplitude / self.reach;
        let wave = |term: &Term| term.weight * libm::j0(term.zero * ratio);
        let sum: f64 = self.terms.iter().map(wave).sum();
        // Where the density vanishes the omitted terms can make it negative.
        (sum / (self.reach * self.reach)).max(0.0)
    }

    /// Returns the probability that the intensity is at most `intensity`, in units of the mean.
    pub fn cumulative(&self, intensity: f64) -> f64 {
        let amplitude = intensity.max(0.0).sqrt();
        if amplitude >= self.reach {
            return 1.0;
        }
        let ratio = amplitude / self.reach;
        let wave = |term: &Term| term.weight * libm::j1(term.zero * ratio) / term.zero;
        let sum: f64 = self.terms.iter().map(wave).sum();
        // The omitted terms can make it leave [0, 1].
        (2.0 * ratio * sum).clamp(0.0, 1.0)
    }
}

/// Returns whether a term and all following terms are negligible, from |J₀(x)| ≤ √(2/πx).
fn is_negligible(x: f64, power: i32) -> bool {
    (2.0 / (PI * x)).sqrt().powi(power) < 1e-14
}

/// Returns the zero number `index` ≥ 1 of J₀ by Newton's method, from its expansion for large
/// zeros.
fn bessel_zero(index: u32) -> f64 {
    let beta = (f64::from(index) - 0.25) * PI;
    let mut zero = beta + 0.125 / beta;
    // The starting value has an error of 1e−3, which each step squares.
    for _ in 0..3 {
        zero += libm::j0(zero) / libm::j1(zero);
    }
    zero
}

/// Returns the moment ⟨Iᵏ⟩ of the intensity of a sum of `count` phasors of equal length and random
/// phase, in units of the mean intensity.
///
/// ```text
/// ⟨Iᵏ⟩ = k!² / Nᵏ · [xᵏ] (Σⱼ xʲ / j!²)ᴺ        [xᵏ] the coefficient of xᵏ
/// ⟨I²⟩ = 2 − 1/N,   ⟨I³⟩ = 6 − 9/N + 4/N²
/// ```
///
/// For N → ∞ it is k!, the moment of the exponential distribution.
///
/// # Panics
///
/// Panics unless `count > 0` and `order ≤ 20`.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::moment_of_phasor_sum;
///
/// assert!((moment_of_phasor_sum(4, 3) - 4.0).abs() < 1e-14);
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (a finite number of equal-length
///   components).
pub fn moment_of_phasor_sum(count: usize, order: u32) -> f64 {
    assert!(count > 0, "a sum of no phasors has no moments");
    assert!(order <= 20, "order {order} of a moment exceeds 20");
    let share = (count as f64).recip();
    let powers = (0..=order).scan(1.0, |power, _| {
        let this = *power;
        *power *= share;
        Some(this)
    });
    let mut group: Vec<f64> = powers.collect();
    let mut moments = vec![0.0; group.len()];
    moments[0] = 1.0;
    // Groups of 1, 2, 4 … phasors join the sum where the count has that bit.
    let mut left = count;
    while left > 0 {
        if left % 2 == 1 {
            moments = moments_of_two(&moments, &group);
        }
        group = moments_of_two(&group, &group);
        left /= 2;
    }
    moments[order as usize]
}

/// Returns the moments of the intensity of the sum of two independent fields of random phase from
/// the moments of each: ⟨|a + b|²ᵏ⟩ = Σⱼ (k j)² ⟨|a|²ʲ⟩ ⟨|b|²⁽ᵏ⁻ʲ⁾⟩.
fn moments_of_two(first: &[f64], second: &[f64]) -> Vec<f64> {
    let moment = |order: usize| {
        let mut sum = 0.0;
        let mut binomial = 1.0;
        for j in 0..=order {
            sum += binomial * binomial * first[j] * second[order - j];
            binomial *= (order - j) as f64 / (j + 1) as f64;
        }
        sum
    };
    (0..first.len()).map(moment).collect()
}

#[cfg(test)]
mod tests {

    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::{exponential_cumulative, exponential_density};
    use tem00_numerics::quadrature::integrate;

    #[test]
    fn moments_of_the_law_are_those_of_the_phasors() {
        for (count, tolerance) in [(8, 1e-6), (9, 1e-6), (16, 1e-9), (100, 1e-10)] {
            let law = PhasorSum::new(count).unwrap();
            let end = (count as f64).min(48.99);
            let moment = |k| integrate(|x| law.density(x) * x.powi(k), [0.0, end], 0.25);
            for order in 0..=3_u8 {
                let exact = moment_of_phasor_sum(count, u32::from(order));
                let value = moment(i32::from(order));
                assert_relative(value, exact, 6.0 * tolerance);
            }
        }
    }

    /// ½ ∫ J₀(ω√I) J₀(ω/√N)ᴺ ω dω up to `end` √N.
    fn density_by_kluyver(count: u8, intensity: f64, end: f64) -> f64 {
        let root = f64::from(count).sqrt();
        let wave = |omega: f64| {
            let phasors = libm::j0(omega / root).powi(i32::from(count));
            0.5 * libm::j0(omega * intensity.sqrt()) * phasors * omega
        };
        integrate(wave, [0.0, end * root], 1.0)
    }

    #[test]
    fn density_is_the_integral_of_kluyver() {
        // The tail falls as ω^(−N/2 + ½): beyond 400 √8 there is 3e−8, beyond 60 √16 less than
        // 1e−12.
        for (count, end, tolerance) in [(8, 400.0, 1e-6), (16, 60.0, 1e-9), (40, 6.0, 1e-13)] {
            let law = PhasorSum::new(usize::from(count)).unwrap();
            for intensity in [0.0, 0.3, 1.1, 2.7, 7.5] {
                let exact = density_by_kluyver(count, intensity, end);
                assert_absolute(law.density(intensity), exact, tolerance);
            }
        }
    }

    #[test]
    fn distribution_is_the_integral_of_the_density() {
        for (count, tolerance) in [(8, 1e-7), (16, 1e-10), (1_000, 1e-12)] {
            let law = PhasorSum::new(count).unwrap();
            for x in [0.1, 1.0, 3.0, 6.9] {
                let area = integrate(|x| law.density(x), [0.0, x], 0.25);
                assert_absolute(law.cumulative(x), area, tolerance);
            }
        }
    }

    #[test]
    fn many_phasors_are_fully_developed() {
        let law = PhasorSum::new(1_000_000).unwrap();
        for x in [0.0, 0.5, 2.0, 10.0] {
            // The first correction is e⁻ˣ (1 − 2x + x²/2) / 2N, below 1 / 2N.
            assert_absolute(law.density(x), exponential_density(x), 1e-6);
            assert_absolute(law.cumulative(x), exponential_cumulative(x), 1e-6);
        }
        assert!(law.cumulative(-1.0).abs() < f64::MIN_POSITIVE);
        assert_absolute(law.cumulative(1e30), 1.0, 1e-15);
        assert!(law.density(-1.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn few_phasors_have_the_moments_of_their_polynomials() {
        for count in [1_u8, 2, 4, 52] {
            let n = f64::from(count);
            let moment = |order| moment_of_phasor_sum(usize::from(count), order);
            assert_relative(moment(1), 1.0, 1e-15);
            assert_relative(moment(2), 2.0 - 1.0 / n, 1e-15);
            let contrast = contrast_of_phasor_sum(usize::from(count));
            assert_relative(1.0 + contrast * contrast, moment(2), 1e-15);
            let third = 6.0 - 9.0 / n + 4.0 / (n * n);
            assert_relative(moment(3), third, 1e-14);
        }
        // Two phasors: I = 1 + cos φ, whose moments are (2k k) / 2ᵏ.
        let exact = 137_846_528_820.0 / 1_048_576.0;
        assert_relative(moment_of_phasor_sum(2, 20), exact, 1e-13);
    }
}
