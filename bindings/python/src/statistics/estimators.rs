use pyo3::prelude::*;
use tem00_statistics as physics;

use super::laws::GammaIntensity;
use crate::{
    arrays::{Image, Samples},
    error::OrRaise,
};

/// Mean and standard deviation of samples.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moments(physics::Moments);

#[pymethods]
impl Moments {
    /// Estimate the moments.
    ///
    /// Parameters
    /// ----------
    /// samples : array_like
    ///     At least two finite samples, in any shape.
    #[staticmethod]
    fn from_samples(py: Python<'_>, samples: Samples<'_>) -> PyResult<Self> {
        let samples = samples.values()?;
        let moments = py
            .detach(|| physics::Moments::from_samples(samples))
            .or_raise()?;
        Ok(Self(moments))
    }

    fn __repr__(&self) -> String {
        let (count, mean) = (self.0.count(), self.0.mean());
        let deviation = self.0.standard_deviation();
        format!("<Moments: count={count}, mean={mean:?}, standard_deviation={deviation:?}>")
    }
}

methods! {
    impl Moments as this: this.0;

    unmade "from_samples";

    /// Number of samples.
    get count -> usize;

    /// Mean.
    get mean -> f64;

    /// Standard deviation, with the divisor n − 1.
    get standard_deviation -> f64;

    /// Standard error of the mean, for independent samples.
    get standard_error -> f64;
}

/// The contrast of samples, their standard deviation over their mean, and its uncertainty.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contrast(physics::Contrast);

#[pymethods]
impl Contrast {
    /// Estimate the contrast, with the standard error of independent samples.
    ///
    /// Parameters
    /// ----------
    /// samples : array_like
    ///     At least two finite samples of a positive mean, in any shape.
    #[staticmethod]
    fn from_samples(py: Python<'_>, samples: Samples<'_>) -> PyResult<Self> {
        let samples = samples.values()?;
        let contrast = py
            .detach(|| physics::Contrast::from_samples(samples))
            .or_raise()?;
        Ok(Self(contrast))
    }

    /// Return this contrast with the standard error of an image of speckles this many pixels large.
    fn with_speckle_size(&self, speckle_size: f64) -> PyResult<Self> {
        Ok(Self(self.0.with_speckle_size(speckle_size).or_raise()?))
    }

    /// Return the interval that holds the contrast of the ensemble with a probability.
    ///
    /// Parameters
    /// ----------
    /// level : float
    ///     The probability, between 0 and 1.
    ///
    /// Returns
    /// -------
    /// (float, float)
    ///     Lower and upper end.
    fn confidence_interval(&self, level: f64) -> PyResult<(f64, f64)> {
        Ok(self.0.confidence_interval(level).or_raise()?.into())
    }

    fn __repr__(&self) -> String {
        let (value, error) = (self.0.value(), self.0.standard_error());
        format!("<Contrast: value={value:?}, standard_error={error:?}>")
    }
}

methods! {
    impl Contrast as this: this.0;

    unmade "from_samples";

    /// Contrast.
    get value -> f64;

    /// Standard error of the contrast.
    get standard_error -> f64;
}

/// A Gamma law fitted to samples: their mean and the shape, the number of degrees of freedom.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GammaFit(physics::GammaFit);

#[pymethods]
impl GammaFit {
    /// Fit the law to the mean and the variance of samples in any shape.
    #[staticmethod]
    fn by_moments(py: Python<'_>, samples: Samples<'_>) -> PyResult<Self> {
        let samples = samples.values()?;
        let fit = py.detach(|| physics::GammaFit::by_moments(samples));
        Ok(Self(fit.or_raise()?))
    }

    /// Fit the law of the largest likelihood to positive samples in any shape.
    #[staticmethod]
    fn by_likelihood(py: Python<'_>, samples: Samples<'_>) -> PyResult<Self> {
        let samples = samples.values()?;
        let fit = py.detach(|| physics::GammaFit::by_likelihood(samples));
        Ok(Self(fit.or_raise()?))
    }

    /// Return the law of the intensity in units of the mean; its shape must be 1 at least.
    fn distribution(&self) -> PyResult<GammaIntensity> {
        Ok(GammaIntensity(self.0.distribution().or_raise()?))
    }

    fn __repr__(&self) -> String {
        let (mean, shape) = (self.0.mean(), self.0.shape());
        let error = self.0.standard_error();
        format!("<GammaFit: mean={mean:?}, shape={shape:?}, standard_error={error:?}>")
    }
}

methods! {
    impl GammaFit as this: this.0;

    unmade "by_moments or by_likelihood";

    /// Mean of the samples.
    get mean -> f64;

    /// Shape, the number of degrees of freedom.
    get shape -> f64;

    /// Standard error of the shape, for independent samples.
    get standard_error -> f64;
}

/// Return Pearson's correlation coefficient of two images of the same shape, in [−1, 1].
///
/// Parameters
/// ----------
/// first, second : array_like, shape (rows, columns)
///     The images, in single precision.
#[pyfunction]
pub(super) fn pearson_correlation(
    py: Python<'_>,
    first: Image<'_>,
    second: Image<'_>,
) -> PyResult<f64> {
    let (first, second) = (first.grid("first")?, second.grid("second")?);
    py.detach(|| physics::pearson_correlation(&first, &second))
        .or_raise()
}
