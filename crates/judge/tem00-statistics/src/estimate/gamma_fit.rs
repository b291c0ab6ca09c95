use statrs::function::gamma::digamma;

use crate::{GammaIntensity, StatisticsError, estimate::moments::Scaled};

/// A Gamma distribution fitted to samples: their mean and the shape M, the number of degrees of
/// freedom.
///
/// # Independence
///
/// Mean and shape are valid for any samples, the standard error for independent samples of a Gamma
/// distribution: use [`decorrelated_samples`](crate::estimate::decorrelated_samples). A hypothesis
/// test of the samples against the law fitted to them overstates the agreement.
///
/// # Examples
///
/// The quantiles of an exponential law have the shape 1:
///
/// ```
/// use tem00_statistics::estimate::GammaFit;
///
/// let quantile = |i| -(1.0 - (f64::from(i) + 0.5) / 10_000.0_f64).ln();
/// let samples: Vec<f64> = (0..10_000).map(quantile).collect();
///
/// let fit = GammaFit::by_likelihood(&samples)?;
/// assert!((fit.shape() - 1.0).abs() < fit.standard_error());
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - H. C. S. Thom, *A note on the gamma distribution*, 1958.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GammaFit {
    mean: f64,
    shape: f64,
    standard_error: f64,
}

impl GammaFit {
    /// Fits the law to the mean and the variance: `M = (m / s)²`, one over the squared contrast.
    ///
    /// ```text
    /// standard error of M = √(2M (M + 1) / n)      for n → ∞
    /// ```
    ///
    /// # Bias
    ///
    /// M is too large by the fraction `(2 + 3/M) / n`, to first order in 1/n.
    ///
    /// # Errors
    ///
    /// Returns an error if there are fewer than two samples, one is not finite, all are the same or
    /// the mean is not positive.
    pub fn by_moments<T>(samples: &[T]) -> Result<Self, StatisticsError>
    where
        T: Copy + Into<f64> + Sync,
    {
        let scaled = checked(samples)?;
        let root = scaled.mean / scaled.standard_deviation;
        let shape = root * root;
        let variance = 2.0 * shape * (shape + 1.0) / samples.len() as f64;
        Ok(Self {
            mean: scaled.mean * scaled.unit,
            shape,
            standard_error: variance.sqrt(),
        })
    }

    /// Fits the distribution by maximum likelihood, which gives dark samples more weight than the
    /// moments do: `ln M − ψ(M) = ln ⟨I⟩ − ⟨ln I⟩`, with ψ the digamma function.
    ///
    /// ```text
    /// standard error of M = 1 / √(n (ψ′(M) − 1/M))      for n → ∞
    /// ```
    ///
    /// No unbiased fit has a smaller error; the error of the fit by moments is 1.6 times as large
    /// at M = 1.
    ///
    /// # Bias
    ///
    /// M is too large by a fraction below 3/n, to first order in 1/n. A noise floor or a wrong
    /// black level changes the logarithm of dark samples and thereby M.
    ///
    /// # Errors
    ///
    /// Returns an error if there are fewer than two samples, one is not finite or not positive, or
    /// all are the same to all digits.
    pub fn by_likelihood<T>(samples: &[T]) -> Result<Self, StatisticsError>
    where
        T: Copy + Into<f64> + Sync,
    {
        let scaled = checked(samples)?;
        if let Some(index) = samples.iter().position(|&sample| sample.into() <= 0.0) {
            return Err(StatisticsError::NotPositive {
                index,
                value: samples[index].into(),
            });
        }
        let count = samples.len() as f64;
        let deficit = |&sample: &T| (sample.into() / scaled.unit / scaled.mean).ln();
        let excess = -samples.iter().map(deficit).sum::<f64>() / count;
        let mean = scaled.mean * scaled.unit;
        if excess <= f64::EPSILON {
            return Err(StatisticsError::refused(
                "samples",
                mean,
                StatisticsError::VARIED,
            ));
        }
        let shape = shape_of_excess(excess);
        let information = (trigamma(shape) - shape.recip()) * count;
        Ok(Self {
            mean,
            shape,
            standard_error: information.sqrt().recip(),
        })
    }

    /// Returns the mean of the samples.
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Returns the shape M.
    pub const fn shape(&self) -> f64 {
        self.shape
    }

    /// Returns the standard error of the shape.
    pub const fn standard_error(&self) -> f64 {
        self.standard_error
    }

    /// Returns the law of the intensity in units of the mean.
    ///
    /// # Errors
    ///
    /// Returns an error unless `1 ≤ shape ≤ 10⁶`. A fit to few samples of fully developed speckle
    /// often falls just short of 1.
    pub fn distribution(&self) -> Result<GammaIntensity, StatisticsError> {
        GammaIntensity::new(self.shape)
    }
}

/// Returns mean and standard deviation of samples that vary about a positive mean.
fn checked<T>(samples: &[T]) -> Result<Scaled, StatisticsError>
where
    T: Copy + Into<f64> + Sync,
{
    let scaled = Scaled::new(samples)?;
    scaled.check_varies()?;
    scaled.check_mean()?;
    Ok(scaled)
}

/// Returns the M at which ln M − ψ(M) is `excess`, by bisection in ln M: the function is
/// decreasing.
fn shape_of_excess(excess: f64) -> f64 {
    // 1/2M < ln M − ψ(M) < 1/M.
    let (mut low, mut high) = (0.5 / excess, excess.recip());
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if log_less_digamma(middle) > excess {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Argument from which the asymptotic series are exact to rounding.
const ASYMPTOTIC_FROM: f64 = 20.0;

/// Returns ln x − ψ(x), for large x without cancellation.
fn log_less_digamma(x: f64) -> f64 {
    if x < ASYMPTOTIC_FROM {
        return x.ln() - digamma(x);
    }
    let q = x.powi(2).recip();
    0.5 / x + q * (1.0 / 12.0 - q * (1.0 / 120.0 - q * (1.0 / 252.0 - q / 240.0)))
}

/// Returns ψ′(x) by its asymptotic series after the recurrence ψ′(x) = ψ′(x + 1) + 1/x².
fn trigamma(mut x: f64) -> f64 {
    let mut sum = 0.0;
    while x < ASYMPTOTIC_FROM {
        sum += x.powi(2).recip();
        x += 1.0;
    }
    let q = x.powi(2).recip();
    let series = 1.0 / 6.0 - q * (1.0 / 30.0 - q * (1.0 / 42.0 - q / 30.0));
    sum + x.recip() + 0.5 * q + q / x * series
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::{Moments, synthetic::exponential_sample};

    /// Sums of `shape` exponential samples.
    fn gamma_samples(shape: u32, count: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
        let mut sum = || (0..shape).map(|_| exponential_sample(rng)).sum();
        (0..count).map(|_| sum()).collect()
    }

    #[test]
    fn trigamma_and_digamma_have_their_known_values() {
        // ψ′(1) = π²/6, ψ′(½) = π²/2; ψ(1) = −γ.
        assert_relative(trigamma(1.0), PI * PI / 6.0, 1e-14);
        assert_relative(trigamma(0.5), PI * PI / 2.0, 1e-14);
        let euler = 0.577_215_664_901_532_9;
        assert_relative(log_less_digamma(1.0), euler, 1e-13);
        // ψ(25) = −γ + Σ 1/k up to 24, on the series.
        let harmonic: f64 = (1..25).map(|k| f64::from(k).recip()).sum();
        let exact = 25.0_f64.ln() + euler - harmonic;
        assert_absolute(log_less_digamma(25.0), exact, 1e-15);
    }

    #[test]
    fn shape_of_the_excess_is_its_inverse() {
        for shape in [1e-3, 0.5, 1.0, 7.3, 19.9, 20.1, 1e9] {
            let found = shape_of_excess(log_less_digamma(shape));
            // Before the series takes over, ln M and ψ(M) near 3 cancel to 1/2M = 0.025.
            assert_relative(found, shape, 1e-12);
        }
    }

    #[test]
    fn fits_spread_and_err_as_stated() {
        const FITS: u32 = 1_500;
        const LENGTH: usize = 200;
        let n = LENGTH as f64;
        for shape in [1_u32, 4] {
            let m = f64::from(shape);
            let mut rng = ChaCha8Rng::seed_from_u64(u64::from(shape));
            let (mut moments, mut likelihood) = (Vec::new(), Vec::new());
            for _ in 0..FITS {
                let samples = gamma_samples(shape, LENGTH, &mut rng);
                moments.push(GammaFit::by_moments(&samples).unwrap().shape());
                likelihood.push(GammaFit::by_likelihood(&samples).unwrap().shape());
            }
            let by_moments = Moments::from_samples(&moments).unwrap();
            let by_likelihood = Moments::from_samples(&likelihood).unwrap();
            // A spread from 1500 fits has a relative standard error of 1.8 %, here times 3.3; the
            // first order has an error of 10/n.
            let tolerance = 3.3 * 0.018 + 10.0 / n;
            let spread = (2.0 * m * (m + 1.0) / n).sqrt();
            assert_relative(by_moments.standard_deviation(), spread, tolerance);
            let spread = (n * (trigamma(m) - m.recip())).sqrt().recip();
            assert_relative(by_likelihood.standard_deviation(), spread, tolerance);
            // ⟨u² − 2uv + v²⟩ of the relative errors u of the mean and v of the variance, which are
            // 1/nM, 2/nM and (2 + 6/M)/n. The next order of the bias is about 20/n², 5e−4.
            let bias = (2.0 * m + 3.0) / n;
            let tolerance = 3.3 * by_moments.standard_error() + 20.0 * m / (n * n);
            assert_absolute(by_moments.mean(), m + bias, tolerance);
            let excess = (by_likelihood.mean() / m - 1.0) * n;
            let tolerance = 3.3 * by_likelihood.standard_error() * n / m;
            assert!(excess - tolerance < 3.0, "{excess} ± {tolerance}");
            assert!(excess + tolerance > 2.0, "{excess} ± {tolerance}");
        }
    }

    #[test]
    fn fits_do_not_depend_on_the_unit() {
        let samples = gamma_samples(3, 100, &mut ChaCha8Rng::seed_from_u64(2));
        for unit in [1e-200, 1e200] {
            let scaled: Vec<f64> = samples.iter().map(|x| x * unit).collect();
            for fit in [GammaFit::by_moments::<f64>, GammaFit::by_likelihood::<f64>] {
                let (one, other) = (fit(&samples).unwrap(), fit(&scaled).unwrap());
                assert_relative(one.shape(), other.shape(), 1e-12);
                assert_relative(one.mean(), other.mean() / unit, 1e-14);
                assert_relative(one.standard_error(), other.standard_error(), 1e-12);
            }
        }
    }

    #[test]
    fn the_standard_error_and_the_law_are_those_of_the_shape() {
        let samples = gamma_samples(4, 400, &mut ChaCha8Rng::seed_from_u64(8));
        let fit = GammaFit::by_likelihood(&samples).unwrap();
        let exact = (400.0 * (trigamma(fit.shape()) - fit.shape().recip()))
            .sqrt()
            .recip();
        assert_relative(fit.standard_error(), exact, 1e-14);
        let fit = GammaFit::by_moments(&samples).unwrap();
        let exact = (fit.shape() * (fit.shape() + 1.0) / 200.0).sqrt();
        assert_relative(fit.standard_error(), exact, 1e-14);
        let contrast = crate::Contrast::from_samples(&samples).unwrap().value();
        assert_relative(fit.distribution().unwrap().contrast(), contrast, 1e-12);
    }
}
