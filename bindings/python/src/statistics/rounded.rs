use std::collections::HashMap;

use numpy::PyArray1;
use pyo3::{prelude::*, types::PyAny};
use tem00_statistics as physics;

use super::hypotheses::{TestOutcome, checked, probabilities};
use crate::{
    arrays::{Samples, Whole, map},
    error::{OrRaise, refused},
};

/// The values that the pixels of a rounded image take.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GreyLevels(physics::GreyLevels);

#[pymethods]
impl GreyLevels {
    /// The fraction of the pixels at the largest level from which on an image counts as clipped.
    #[classattr]
    const CLIPPED_FRACTION: f64 = physics::GreyLevels::CLIPPED_FRACTION;

    /// Find the levels of an image, in any shape; ``None`` if it is not rounded.
    #[staticmethod]
    fn from_values(py: Python<'_>, values: Samples<'_>) -> PyResult<Option<Self>> {
        let values = values.values()?;
        Ok(py
            .detach(|| physics::GreyLevels::from_values(values))
            .map(Self))
    }

    /// Return the position of the largest level that is not above a value, or 0.
    fn index(&self, value: f64) -> usize {
        self.0.index(value)
    }

    /// Return the light, from and to, for which the level at an index stands.
    fn cell(&self, index: Whole<'_>) -> PyResult<(f64, f64)> {
        let last = self.0.count() - 1;
        Ok(self.0.cell(index.between("index", [0, last])?).into())
    }

    /// Return the edge of a level that is nearest to a value.
    fn nearest_edge(&self, value: f64) -> PyResult<f64> {
        if value.is_nan() {
            return Err(refused(
                "value",
                "value must be a number, got nan".to_owned(),
            ));
        }
        Ok(self.0.nearest_edge(value))
    }

    /// Return the samples in ascending order, those of each level spread evenly over its cell.
    fn spread<'py>(
        &self,
        py: Python<'py>,
        samples: Samples<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let spread = self.0.spread(samples.finite("samples")?);
        Ok(PyArray1::from_vec(py, spread))
    }

    fn __repr__(&self) -> String {
        let (count, step) = (self.0.count(), self.0.step());
        format!("<GreyLevels: count={count}, step={step:?}>")
    }
}

methods! {
    impl GreyLevels as this: this.0;

    unmade "from_values";

    /// Fraction of the pixels at the largest level.
    get share_of_largest -> f64;

    /// Number of levels.
    get count -> usize;

    /// Smallest difference of two levels.
    get step -> f64;

    /// True if all levels are whole multiples of the step.
    get are_multiples -> bool;

    /// Return the mean of the exponential law whose values, rounded to the levels, have a mean.
    ///
    /// Parameters
    /// ----------
    /// rounded : float or array_like
    ///     Mean of the rounded values, positive.
    map exponential_mean(rounded: positive);

    /// Return the contrast of an exponential law whose values, rounded to the levels, have a mean.
    ///
    /// Parameters
    /// ----------
    /// rounded : float or array_like
    ///     Mean of the rounded values, positive.
    map exponential_contrast(rounded: positive);
}

/// Agreement of samples, rounded or not, with a law.
///
/// Parameters
/// ----------
/// samples : array_like
///     Independent samples, in any shape.
/// cumulative : callable
///     The distribution function. It is called once with an array of shape (n,) and returns
///     probabilities in the same shape.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GoodnessOfFit(physics::GoodnessOfFit);

#[pymethods]
impl GoodnessOfFit {
    #[new]
    fn new(samples: Samples<'_>, cumulative: Bound<'_, PyAny>) -> PyResult<Self> {
        let places = probabilities(&cumulative, checked(samples.values()?)?)?;
        let fit = physics::GoodnessOfFit::new(&places, |place| place);
        Ok(Self(fit.or_raise()?))
    }

    /// Compare samples that were rounded to levels with a law.
    ///
    /// Parameters
    /// ----------
    /// samples : array_like
    ///     Independent samples, in any shape.
    /// levels : GreyLevels
    ///     What they were rounded to.
    /// cumulative : callable
    ///     The distribution function of the light before it was rounded. It is called once with an
    ///     array of shape (n,), the edges of the levels, and returns probabilities in that shape.
    #[staticmethod]
    fn of_rounded(
        samples: Samples<'_>,
        levels: PyRef<'_, GreyLevels>,
        cumulative: Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let samples = checked(samples.values()?)?;
        let law = tabulated(&levels.0, &cumulative)?;
        // Every edge is in the table but one at infinity, which all of the light lies below.
        let law = |edge: f64| law.get(&edge.to_bits()).copied().unwrap_or(1.0);
        let fit = physics::GoodnessOfFit::of_rounded(samples, &levels.0, law);
        Ok(Self(fit.or_raise()?))
    }

    /// Test after Kolmogorov and Smirnov.
    fn kolmogorov_smirnov(&self) -> PyResult<TestOutcome> {
        Ok(TestOutcome(self.0.kolmogorov_smirnov().or_raise()?))
    }

    /// Test after Pearson, in up to 20 bins of about the same probability.
    ///
    /// Parameters
    /// ----------
    /// constraints : int
    ///     1 for the total and 1 for each parameter of the law that was fitted.
    fn chi_squared(&self, constraints: Whole<'_>) -> PyResult<TestOutcome> {
        let constraints = constraints.unsigned("constraints")?;
        Ok(TestOutcome(self.0.chi_squared(constraints).or_raise()?))
    }

    fn __repr__(&self) -> String {
        match self.0.kolmogorov_smirnov() {
            Ok(test) => format!("<GoodnessOfFit: kolmogorov_smirnov={:?}>", test.p_value),
            Err(_) => "<GoodnessOfFit: too few samples>".to_owned(),
        }
    }
}

/// Asks a distribution function for the probabilities at the finite edges of levels.
fn tabulated(
    levels: &physics::GreyLevels,
    cumulative: &Bound<'_, PyAny>,
) -> PyResult<HashMap<u64, f64>> {
    let mut edges: Vec<f64> = (0..levels.count())
        .flat_map(|index| levels.cell(index))
        .filter(|edge| edge.is_finite())
        .collect();
    edges.dedup();
    let values = probabilities(cumulative, &edges)?;
    let bits = edges.into_iter().map(f64::to_bits);
    Ok(bits.zip(values).collect())
}
