use core::f64::consts::SQRT_2;

use statrs::function::erf::erf_inv;
use tem00_numerics::{Grid, check, parallel::map_pieces};

use crate::{StatisticsError, space::second_order::pixels_per_contrast_sample};

/// Mean and standard deviation of samples.
///
/// # Bias
///
/// The mean is unbiased, whether the samples are independent or not. The variance, with the divisor
/// n − 1, is unbiased for independent samples; for the pixels of one image it is too small by the
/// fraction 4h² / πnₚ, where h is the speckle size and nₚ the number of pixels, both in pixels.
///
/// # Examples
///
/// ```
/// use tem00_statistics::Moments;
///
/// let moments = Moments::from_samples(&[1.0, 2.0, 3.0, 4.0])?;
/// assert_eq!(moments.mean(), 2.5);
/// assert!((moments.standard_deviation() - 1.290_994).abs() < 1e-6); // √(5/3)
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    count: usize,
    mean: f64,
    standard_deviation: f64,
}

impl Moments {
    /// Estimates the moments from `samples`.
    ///
    /// # Errors
    ///
    /// Returns an error if there are fewer than two samples or one is not finite.
    pub fn from_samples<T>(samples: &[T]) -> Result<Self, StatisticsError>
    where
        T: Copy + Into<f64> + Sync,
    {
        let scaled = Scaled::new(samples)?;
        Ok(Self {
            count: samples.len(),
            mean: scaled.mean * scaled.unit,
            standard_deviation: scaled.standard_deviation * scaled.unit,
        })
    }

    /// Returns the number of samples.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Returns the mean.
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Returns the standard deviation.
    pub const fn standard_deviation(&self) -> f64 {
        self.standard_deviation
    }

    /// Returns the standard error of the mean, `s / √n`, for independent samples.
    pub fn standard_error(&self) -> f64 {
        self.standard_deviation / (self.count as f64).sqrt()
    }
}

/// Contrast of samples, their standard deviation divided by their mean, with its standard error.
///
/// ```text
/// C = s / m         1 for fully developed speckle
/// ```
///
/// # Bias
///
/// For n independent samples of fully developed speckle the expectation is 1 − 1/n to first order.
/// Nothing is corrected. For an image, n is in order of magnitude the number of pixels divided by
/// the number of pixels per sample in [`with_speckle_size`](Self::with_speckle_size).
///
/// # Independence
///
/// The standard error is valid for independent samples of any distribution. Neighbouring pixels are
/// not independent: [`with_speckle_size`](Self::with_speckle_size) gives the error of an image.
///
/// # Examples
///
/// ```
/// use tem00_statistics::Contrast;
///
/// let contrast = Contrast::from_samples(&[1.0, 3.0])?;
/// assert!((contrast.value() - 0.5_f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contrast {
    value: f64,
    standard_error: f64,
}

impl Contrast {
    /// Estimates the contrast from `samples`.
    ///
    /// # Errors
    ///
    /// Returns an error if there are fewer than two samples, one is not finite, or the mean is not
    /// positive.
    pub fn from_samples<T>(samples: &[T]) -> Result<Self, StatisticsError>
    where
        T: Copy + Into<f64> + Sync,
    {
        let scaled = Scaled::new(samples)?;
        let (mean, deviation) = (scaled.mean, scaled.standard_deviation);
        scaled.check_mean()?;
        let value = deviation / mean;
        // The influence of one sample on s / m, (Δ² − s²) / 2sm − Δ s / m².
        let influence = |sample: T| {
            let delta = (sample.into() / scaled.unit - mean) / deviation;
            value * (0.5 * (delta * delta - 1.0) - delta * value)
        };
        let squares = if deviation > 0.0 {
            sum(samples, |x| influence(x).powi(2))
        } else {
            0.0
        };
        Ok(Self {
            value,
            standard_error: f64::sqrt(squares) / samples.len() as f64,
        })
    }

    /// Returns this contrast with the standard error for all pixels of an image whose speckles are
    /// `speckle_size` pixels large.
    ///
    /// ```text
    /// n pixels count as n / 0.585 h² independent samples
    /// ```
    ///
    /// # Validity
    ///
    /// The speckle is fully developed behind a circular pupil, the image is many speckles across,
    /// and each pixel is a point sample. Below two pixels the factor 0.585 h² is replaced by the
    /// sum of the squared Airy autocovariance over the pixels, which goes to 1.
    ///
    /// # Errors
    ///
    /// Returns an error unless `speckle_size` is positive and finite.
    pub fn with_speckle_size(self, speckle_size: f64) -> Result<Self, StatisticsError> {
        let holds = speckle_size > 0.0 && speckle_size.is_finite();
        let allowed = "positive and finite, in pixels";
        check::that(holds, "speckle_size", speckle_size, "", allowed)?;
        Ok(Self {
            standard_error: self.standard_error * pixels_per_contrast_sample(speckle_size).sqrt(),
            ..self
        })
    }

    /// Returns the confidence interval of the ensemble's contrast at the confidence `level`, from
    /// its lower to its upper end.
    ///
    /// ```text
    /// C exp(± z s_C / C)         s_C the standard error, z the normal quantile: 1.96 for 0.95
    /// ```
    ///
    /// The logarithm of C is assumed to be normally distributed, which keeps the interval positive.
    ///
    /// # Validity
    ///
    /// The interval needs many independent samples. For fully developed speckle an interval of the
    /// level 0.95 contains the contrast in 0.90 of all cases with a hundred samples, and in 0.94
    /// with a thousand: the error is estimated from the same samples, and if these happen to lack
    /// bright ones, both contrast and error are too small.
    ///
    /// # Errors
    ///
    /// Returns an error unless `0 < level < 1`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_statistics::Contrast;
    ///
    /// let quantile = |i| -(1.0 - (f64::from(i) + 0.5) / 10_000.0_f64).ln();
    /// let samples: Vec<f64> = (0..10_000).map(quantile).collect();
    ///
    /// let [low, high] = Contrast::from_samples(&samples)?.confidence_interval(0.95)?;
    /// assert!((low - 0.98).abs() < 2e-3 && (high - 1.02).abs() < 2e-3); // ± 1.96 / √n
    /// # Ok::<(), tem00_statistics::StatisticsError>(())
    /// ```
    pub fn confidence_interval(&self, level: f64) -> Result<[f64; 2], StatisticsError> {
        let holds = level > 0.0 && level < 1.0;
        check::that(holds, "level", level, "", "between 0 and 1")?;
        if self.value <= 0.0 {
            return Ok([self.value; 2]);
        }
        let quantile = SQRT_2 * erf_inv(level);
        let factor = (quantile * self.standard_error / self.value).exp();
        Ok([self.value / factor, self.value * factor])
    }

    /// Returns the contrast.
    pub const fn value(&self) -> f64 {
        self.value
    }

    /// Returns the standard error of the contrast.
    pub const fn standard_error(&self) -> f64 {
        self.standard_error
    }
}

/// Returns Pearson's correlation coefficient of two grids of the same size, in [−1, 1].
///
/// ```text
/// r = Σ (a − ā)(b − b̄) / √(Σ (a − ā)² Σ (b − b̄)²)
/// ```
///
/// For two speckle patterns it estimates the correlation γ of their intensities.
///
/// # Bias
///
/// The bias is of the order of 1/n for n independent pairs of samples, and zero if the grids are
/// independent.
///
/// # Independence
///
/// No independence is assumed for the value. If the two grids are independent speckle patterns of
/// the size h, in pixels, its standard deviation is `√(0.585 h² / nₚ)` for nₚ pixels.
///
/// # Errors
///
/// Returns an error if the grids differ in size, hold fewer than two samples, a sample is not
/// finite or all samples of a grid are the same.
///
/// # Examples
///
/// ```
/// use tem00_numerics::Grid;
/// use tem00_statistics::pearson_correlation;
///
/// let ramp = Grid::from_fn(4, 4, |x, y| (x + y) as f32);
/// let inverted = ramp.map(|value| 1.0 - 2.0 * value);
/// assert!((pearson_correlation(&ramp, &inverted)? + 1.0).abs() < 1e-14);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
pub fn pearson_correlation(first: &Grid<f32>, second: &Grid<f32>) -> Result<f64, StatisticsError> {
    let size = |grid: &Grid<f32>| (grid.width(), grid.height());
    if size(first) != size(second) {
        let (width, height) = size(first);
        let got = <[usize; 2]>::from(size(second)).map(|side| side as f64);
        let allowed = format!("{width} wide and {height} high, like the first grid");
        return Err(StatisticsError::refused("second", got, allowed));
    }
    let a = Scaled::new(first.values())?;
    let b = Scaled::new(second.values())?;
    a.check_varies()?;
    b.check_varies()?;
    let product = |(&x, &y): (&f32, &f32)| a.standardise(x) * b.standardise(y);
    let pairs = first.values().iter().zip(second.values());
    let sum: f64 = pairs.map(product).sum();
    // Rounding can carry the quotient past ±1.
    Ok((sum / (first.values().len() - 1) as f64).clamp(-1.0, 1.0))
}

/// Mean and standard deviation in units of a power of two near the largest magnitude, so that their
/// sums neither overflow nor underflow and the unit adds no rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scaled {
    pub(crate) unit: f64,
    pub(crate) mean: f64,
    pub(crate) standard_deviation: f64,
    constant: Option<f64>,
}

impl Scaled {
    pub(crate) fn new<T>(samples: &[T]) -> Result<Self, StatisticsError>
    where
        T: Copy + Into<f64> + Sync,
    {
        let (low, high) = range(samples)?;
        let unit = power_of_two_near(high.abs().max(low.abs()));
        if low >= high {
            return Ok(Self {
                unit,
                mean: low / unit,
                standard_deviation: 0.0,
                constant: Some(low),
            });
        }
        let count = samples.len() as f64;
        let mean = sum(samples, |x| x.into() / unit) / count;
        let squares = sum(samples, |x| (x.into() / unit - mean).powi(2));
        Ok(Self {
            unit,
            mean,
            standard_deviation: (squares / (count - 1.0)).sqrt(),
            constant: None,
        })
    }

    /// Returns an error if all samples were the same.
    pub(crate) fn check_varies(&self) -> Result<(), StatisticsError> {
        match self.constant {
            Some(value) => Err(StatisticsError::refused(
                "samples",
                value,
                StatisticsError::VARIED,
            )),
            None => Ok(()),
        }
    }

    /// Returns an error unless the mean is positive and above the rounding errors of the samples.
    pub(crate) fn check_mean(&self) -> Result<(), StatisticsError> {
        if self.mean > f64::EPSILON {
            return Ok(());
        }
        Err(StatisticsError::refused(
            "samples",
            self.mean * self.unit,
            StatisticsError::MEAN,
        ))
    }

    /// Returns the distance of a sample above the mean, in standard deviations.
    pub(crate) fn standardise(&self, sample: impl Into<f64>) -> f64 {
        (sample.into() / self.unit - self.mean) / self.standard_deviation
    }
}

fn power_of_two_near(magnitude: f64) -> f64 {
    if magnitude > 0.0 {
        libm::ldexp(1.0, libm::ilogb(magnitude))
    } else {
        1.0
    }
}

/// Returns the smallest and the largest of at least two finite samples.
fn range<T>(samples: &[T]) -> Result<(f64, f64), StatisticsError>
where
    T: Copy + Into<f64> + Sync,
{
    check_samples(samples, 2)?;
    let wider = |(low, high): (f64, f64), [l, h]: [f64; 2]| (low.min(l), high.max(h));
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let ranges = map_pieces(samples, |_, piece| {
        let values = piece.iter().map(|&x| [x.into(); 2]);
        values.fold(none, wider)
    });
    Ok(ranges.into_iter().map(<[f64; 2]>::from).fold(none, wider))
}

/// Returns the sum of a term of each sample, the same for any number of threads.
fn sum<T: Copy + Sync>(samples: &[T], term: impl Fn(T) -> f64 + Sync) -> f64 {
    let sums = map_pieces(samples, |_, piece| {
        piece.iter().map(|&x| term(x)).sum::<f64>()
    });
    sums.into_iter().sum()
}

/// Returns an error for fewer than `needed` samples, and at the first that is not finite.
pub(crate) fn check_samples<T>(samples: &[T], needed: usize) -> Result<(), StatisticsError>
where
    T: Copy + Into<f64> + Sync,
{
    if samples.len() < needed {
        return Err(StatisticsError::too_few_samples(samples.len(), needed));
    }
    check_finite(samples)
}

/// Returns an error at the first sample that is not finite.
pub(crate) fn check_finite<T>(samples: &[T]) -> Result<(), StatisticsError>
where
    T: Copy + Into<f64> + Sync,
{
    let bad = map_pieces(samples, |start, piece| {
        let bad = piece.iter().position(|&x| !x.into().is_finite());
        bad.map(|index| start + index)
    });
    match bad.into_iter().flatten().next() {
        Some(index) => Err(StatisticsError::refused_at(
            index,
            "samples",
            samples[index],
            "finite",
        )),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
