use pyo3::{prelude::*, types::PyAny};
use tem00_statistics as physics;

use crate::{
    arrays::{Numbers, map},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// Return the probability density of the intensity of fully developed speckle, exp(−I).
///
/// Parameters
/// ----------
/// intensity : float or array
///     Intensity in units of its mean.
///
/// Returns
/// -------
/// float or array
///     Density, in the shape of `intensity`; 0 below zero.
#[pyfunction]
pub(super) fn exponential_density<'py>(
    py: Python<'py>,
    intensity: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    map(py, [("intensity", &intensity)], |[i]| {
        physics::exponential_density(i)
    })
}

/// Return the probability that the intensity of fully developed speckle is at most `intensity`.
///
/// Parameters
/// ----------
/// intensity : float or array
///     Intensity in units of its mean.
///
/// Returns
/// -------
/// float or array
///     Probability 1 − exp(−I), in the shape of `intensity`.
#[pyfunction]
pub(super) fn exponential_cumulative<'py>(
    py: Python<'py>,
    intensity: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    map(py, [("intensity", &intensity)], |[i]| {
        physics::exponential_cumulative(i)
    })
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

#[pymethods]
impl GammaIntensity {
    #[new]
    fn new(shape: f64) -> PyResult<Self> {
        Ok(Self(physics::GammaIntensity::new(shape).or_raise()?))
    }

    /// Return the law that has a contrast between 0.001 and 1.
    #[staticmethod]
    fn from_contrast(contrast: f64) -> PyResult<Self> {
        let law = physics::GammaIntensity::from_contrast(contrast).or_raise()?;
        Ok(Self(law))
    }

    /// Shape, the number of degrees of freedom.
    #[getter]
    fn shape(&self) -> f64 {
        self.0.shape()
    }

    /// Contrast, standard deviation over mean.
    #[getter]
    fn contrast(&self) -> f64 {
        self.0.contrast()
    }

    /// Return the probability density at intensities in units of their mean, in their shape.
    fn density<'py>(
        &self,
        py: Python<'py>,
        intensity: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("intensity", &intensity)], |[i]| self.0.density(i))
    }

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    fn cumulative<'py>(
        &self,
        py: Python<'py>,
        intensity: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("intensity", &intensity)], |[i]| self.0.cumulative(i))
    }

    fn __repr__(&self) -> String {
        format!("GammaIntensity(shape={:?})", self.0.shape())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.0.shape(),))
    }
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

#[pymethods]
impl PartiallyPolarised {
    #[new]
    fn new(degree: f64) -> PyResult<Self> {
        Ok(Self(physics::PartiallyPolarised::new(degree).or_raise()?))
    }

    /// Degree of polarisation of the scattered light.
    #[getter]
    fn degree(&self) -> f64 {
        self.0.degree()
    }

    /// Contrast, standard deviation over mean.
    #[getter]
    fn contrast(&self) -> f64 {
        self.0.contrast()
    }

    /// Return the probability density at intensities in units of their mean, in their shape.
    fn density<'py>(
        &self,
        py: Python<'py>,
        intensity: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("intensity", &intensity)], |[i]| self.0.density(i))
    }

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    fn cumulative<'py>(
        &self,
        py: Python<'py>,
        intensity: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("intensity", &intensity)], |[i]| self.0.cumulative(i))
    }

    fn __repr__(&self) -> String {
        format!("PartiallyPolarised(degree={:?})", self.0.degree())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.0.degree(),))
    }
}

/// The law of the intensity of a sum of independent speckle patterns of any mean intensities.
///
/// Parameters
/// ----------
/// weights : array of shape (n,)
///     Mean intensities of the patterns, in any unit, none negative and not all zero, of at most
///     65,536 different values. Each of these takes some 10 µs of the time of a density.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WeightedSum {
    law: physics::WeightedSum,
    weights: Vec<f64>,
}

#[pymethods]
impl WeightedSum {
    #[new]
    fn new(weights: Numbers<'_>) -> PyResult<Self> {
        let weights = weights.values()?.to_vec();
        let law = physics::WeightedSum::new(&weights).or_raise()?;
        Ok(Self { law, weights })
    }

    /// Contrast, standard deviation over mean.
    #[getter]
    fn contrast(&self) -> f64 {
        self.law.contrast()
    }

    /// Return the probability density at intensities in units of their mean, in their shape.
    fn density<'py>(
        &self,
        py: Python<'py>,
        intensity: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("intensity", &intensity)], |[i]| self.law.density(i))
    }

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    fn cumulative<'py>(
        &self,
        py: Python<'py>,
        intensity: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("intensity", &intensity)], |[i]| {
            self.law.cumulative(i)
        })
    }

    fn __repr__(&self) -> String {
        format!("WeightedSum(weights={:?})", self.weights)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.weights.clone(),))
    }
}

/// The law of the intensity of speckle on a coherent background, such as a specular reflection.
///
/// Parameters
/// ----------
/// `beam_ratio` : float
///     Background over mean of the speckle, finite and not negative.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoherentBackground(physics::CoherentBackground);

#[pymethods]
impl CoherentBackground {
    #[new]
    fn new(beam_ratio: f64) -> PyResult<Self> {
        let law = physics::CoherentBackground::new(beam_ratio).or_raise()?;
        Ok(Self(law))
    }

    /// Return the law that has a contrast between 0.001 and 1.
    #[staticmethod]
    fn from_contrast(contrast: f64) -> PyResult<Self> {
        let law = physics::CoherentBackground::from_contrast(contrast).or_raise()?;
        Ok(Self(law))
    }

    /// Beam ratio, background over mean of the speckle.
    #[getter]
    fn beam_ratio(&self) -> f64 {
        self.0.beam_ratio()
    }

    /// Contrast, standard deviation over mean.
    #[getter]
    fn contrast(&self) -> f64 {
        self.0.contrast()
    }

    /// Return the probability density at intensities in units of their mean, in their shape.
    fn density<'py>(
        &self,
        py: Python<'py>,
        intensity: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("intensity", &intensity)], |[i]| self.0.density(i))
    }

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    fn cumulative<'py>(
        &self,
        py: Python<'py>,
        intensity: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("intensity", &intensity)], |[i]| self.0.cumulative(i))
    }

    fn __repr__(&self) -> String {
        format!("CoherentBackground(beam_ratio={:?})", self.0.beam_ratio())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.0.beam_ratio(),))
    }
}
