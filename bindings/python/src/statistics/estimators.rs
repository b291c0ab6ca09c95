use super::physics::{self, Boundary};
use numpy::Complex32;
use pyo3::prelude::*;
use tem00_numerics::{Grid, cast::to_usize};

use super::laws::GammaIntensity;
use crate::{arguments::Samples, arrays::named_tuple, error::OrRaise};

class! {
    /// The contrast of samples, their standard deviation over their mean, and its uncertainty.
    "tem00.statistics" Contrast(physics::Contrast): Copy
}

methods! {
    impl Contrast as this: this.0;

    unmade "from_samples";

    /// Estimate the contrast, with the standard error of independent samples.
    ///
    /// Parameters
    /// ----------
    /// samples : array_like
    ///     At least two finite samples of a positive mean.
    make from_samples(samples: Samples) = physics::Contrast::from_samples(&samples.0);

    /// Return this contrast with the standard error of an image of speckles this many pixels large.
    try with_speckle_size(speckle_size: f64) -> Contrast = this.0.with_speckle_size(speckle_size);

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
    try confidence_interval(level: f64) -> (f64, f64) = this.0.confidence_interval(level);

    /// Contrast.
    get value -> f64;

    /// Standard error of the contrast.
    get standard_error -> f64;

    shown value, standard_error;
}

#[pymethods]
impl Contrast {
    /// Both numbers, to two digits of the error.
    fn __str__(&self) -> String {
        let (value, error) = (self.0.value(), self.0.standard_error());
        let digits = to_usize((1.0 - error.log10().floor()).clamp(0.0, 17.0));
        format!("{value:.digits$} ± {error:.digits$}")
    }
}

class! {
    /// A Gamma law fitted to samples: their mean and the shape, the number of degrees of freedom.
    "tem00.statistics" GammaFit(physics::GammaFit): Copy
}

methods! {
    impl GammaFit as this: this.0;

    unmade "by_moments or by_likelihood";

    /// Fit the law to the mean and the variance of samples.
    make by_moments(samples: Samples) = physics::GammaFit::by_moments(&samples.0);

    /// Fit the law of the largest likelihood to positive samples.
    make by_likelihood(samples: Samples) = physics::GammaFit::by_likelihood(&samples.0);

    /// Return the law of the intensity in units of the mean; its shape must be 1 at least.
    try distribution() -> GammaIntensity = this.0.distribution();

    /// Mean of the samples.
    get mean -> f64;

    /// Shape, the number of degrees of freedom.
    get shape -> f64;

    /// Standard error of the shape, for independent samples.
    get standard_error -> f64;

    shown mean, shape, standard_error;
}

class! {
    /// An estimate of the number of phase singularities per area.
    "tem00.statistics" VortexDensity(physics::VortexDensity): Copy
}

methods! {
    impl VortexDensity as this: this.0;

    unmade "from_field";

    /// Count the singularities of a field.
    ///
    /// Parameters
    /// ----------
    /// field : complex array_like, shape (rows, columns)
    ///     The field.
    /// boundary : {"periodic", "finite"}
    ///     Whether the field repeats, or nothing is known beyond its edges.
    make from_field(field: Grid<Complex32>, boundary: Boundary) =
        physics::VortexDensity::from_field(&field, boundary)
            .or_raise_renamed(&["samples"], "field");

    /// Number of singularities.
    get count -> usize;

    /// Number of singularities per squared sample.
    get value -> f64;

    /// Standard error of the density, per squared sample.
    get standard_error -> f64;

    /// Speckle size that makes this density, in samples; ``None`` without singularities.
    get speckle_size -> Option<f64>;

    shown count, value, standard_error;
}

named_tuple! { Singularity(physics::Singularity) as found: (found.x, found.y, found.charge) }

functions! {
    /// Find the phase singularities of a sampled field, cell by cell, in the order of its rows.
    ///
    /// Parameters
    /// ----------
    /// field : complex array_like, shape (rows, columns)
    ///     The field.
    /// boundary : {"periodic", "finite"}
    ///     Whether the field repeats, or nothing is known beyond its edges.
    ///
    /// Returns
    /// -------
    /// list of Singularity
    try phase_singularities(field: Grid<Complex32>, boundary: Boundary) -> Vec<Singularity> = {
        let found = physics::phase_singularities(&field, boundary);
        found
            .or_raise_renamed(&["samples"], "field")
            .map(|found| found.into_iter().map(Singularity::from).collect::<Vec<_>>())
    };

    /// Return Pearson's correlation coefficient of two images of the same shape, in [−1, 1].
    ///
    /// Parameters
    /// ----------
    /// first, second : array_like, shape (rows, columns)
    ///     The images.
    try pearson_correlation(first: Grid<f32>, second: Grid<f32>) -> f64 =
        physics::pearson_correlation(&first, &second);
}
