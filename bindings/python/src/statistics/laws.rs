use pyo3::prelude::*;
use tem00_statistics as physics;

use crate::{
    arrays::{Components, map},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

functions! {
    /// Return the probability density of the intensity of fully developed speckle, exp(−I).
    ///
    /// Parameters
    /// ----------
    /// intensity : float or array_like
    ///     Intensity in units of its mean.
    map exponential_density(intensity);

    /// Return the probability that the intensity of fully developed speckle is at most ``intensity``.
    ///
    /// Parameters
    /// ----------
    /// intensity : float or array_like
    ///     Intensity in units of its mean.
    map exponential_cumulative(intensity);
}

/// The law of the intensity after speckle has been averaged: a Gamma distribution of mean 1.
///
/// Parameters
/// ----------
/// shape : float
///     Number of degrees of freedom, from 1 to 10⁶.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GammaIntensity(pub(super) physics::GammaIntensity);

methods! {
    impl GammaIntensity as this: this.0;

    make new(shape);

    /// Return the law that has a contrast between 0.001 and 1.
    make from_contrast(contrast);

    /// Shape, the number of degrees of freedom.
    get shape -> f64;

    /// Contrast, standard deviation over mean.
    get contrast -> f64;

    /// Return the probability density at intensities in units of their mean, in their shape.
    map density(intensity);

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    map cumulative(intensity);

    made_by new(shape);
}

/// The law of the intensity of partially polarised speckle.
///
/// Parameters
/// ----------
/// degree : float
///     Degree of polarisation, from 0 to 1.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PartiallyPolarised(physics::PartiallyPolarised);

methods! {
    impl PartiallyPolarised as this: this.0;

    make new(degree);

    /// Degree of polarisation of the scattered light.
    get degree -> f64;

    /// Contrast, standard deviation over mean.
    get contrast -> f64;

    /// Return the probability density at intensities in units of their mean, in their shape.
    map density(intensity);

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    map cumulative(intensity);

    made_by new(degree);
}

/// The law of the intensity of a sum of independent speckle patterns of any mean intensities.
///
/// Parameters
/// ----------
/// weights : array_like, shape (n,)
///     Mean intensities of the patterns, in any unit, none negative and not all zero, of at most
///     65,536 different values. Each of these takes some 10 µs of the time of a density.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IncoherentSum {
    law: physics::IncoherentSum,
    weights: Vec<f64>,
}

#[pymethods]
impl IncoherentSum {
    #[new]
    fn new(weights: Components<'_>) -> PyResult<Self> {
        let weights = weights.values()?.to_vec();
        let law = physics::IncoherentSum::new(&weights).or_raise()?;
        Ok(Self { law, weights })
    }

    fn __repr__(&self) -> String {
        format!("IncoherentSum(weights={:?})", self.weights)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.weights.clone(),))
    }
}

methods! {
    impl IncoherentSum as this: this.law;

    /// Contrast, standard deviation over mean.
    get contrast -> f64;

    /// Return the probability density at intensities in units of their mean, in their shape.
    map density(intensity);

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    map cumulative(intensity);
}

/// The law of the intensity of speckle on a coherent background, such as a specular reflection.
///
/// Parameters
/// ----------
/// beam_ratio : float
///     Background over mean of the speckle, finite and not negative.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoherentBackground(physics::CoherentBackground);

methods! {
    impl CoherentBackground as this: this.0;

    make new(beam_ratio);

    /// Return the law that has a contrast between 0.001 and 1.
    make from_contrast(contrast);

    /// Beam ratio, background over mean of the speckle.
    get beam_ratio -> f64;

    /// Contrast, standard deviation over mean.
    get contrast -> f64;

    /// Return the probability density at intensities in units of their mean, in their shape.
    map density(intensity);

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    map cumulative(intensity);

    made_by new(beam_ratio);
}
