use std::collections::HashMap;

use super::physics;
use numpy::PyArray1;
use pyo3::{prelude::*, types::PyAny};

use crate::{
    arguments::Samples,
    arrays::{Floats, LIMIT, Numbers, named_tuple},
    error::{OrRaise, refused},
};

named_tuple! {
    TestOutcome(physics::TestOutcome) as outcome: (outcome.statistic, outcome.p_value)
}

functions! {
    /// Test whether the expectation of independent samples is ``mean``, after Student; two-sided.
    ///
    /// Parameters
    /// ----------
    /// samples : array_like
    ///     At least two finite samples that differ.
    /// mean : float
    ///     The expectation to be tested.
    ///
    /// Returns
    /// -------
    /// TestOutcome
    try t_test_mean(samples: Samples, mean: f64) -> TestOutcome =
        physics::t_test_mean(&samples.0, mean);
}

class! {
    /// The values that the pixels of a rounded image take.
    "tem00.statistics" GreyLevels(physics::GreyLevels)
}

methods! {
    impl GreyLevels as this: this.0;

    unmade "from_values";

    /// Return the samples in ascending order, those of each level spread evenly over its cell.
    try spread(samples: Samples) -> Floats =
        checked(&samples.0).map(|samples| this.0.spread(samples));

    /// Number of levels.
    get count -> usize;

    /// Smallest difference of two levels.
    get step -> f64;

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

    shown count, step;
}

#[pymethods]
impl GreyLevels {
    /// Find the levels of an image; ``None`` if it is not rounded.
    #[staticmethod]
    fn from_values(py: Python<'_>, values: Bound<'_, PyAny>) -> PyResult<Option<Self>> {
        take!(values: Samples);
        let levels = py.detach(|| physics::GreyLevels::from_values(&values.0));
        Ok(levels.map(Self))
    }
}

class! {
    /// Agreement of samples, rounded or not, with a law.
    ///
    /// Parameters
    /// ----------
    /// samples : array_like
    ///     Independent samples.
    /// cumulative : callable
    ///     The distribution function of the light, before it was rounded. It is called once with an
    ///     array of shape (n,) and returns probabilities in the same shape.
    /// levels : GreyLevels, optional
    ///     What the samples were rounded to.
    "tem00.statistics" GoodnessOfFit(physics::GoodnessOfFit)
}

#[pymethods]
impl GoodnessOfFit {
    fn __repr__(&self) -> String {
        match self.0.kolmogorov_smirnov() {
            Ok(test) => format!(
                "<GoodnessOfFit: kolmogorov_smirnov p_value={:?}>",
                test.p_value
            ),
            Err(_) => "<GoodnessOfFit: too few samples>".to_owned(),
        }
    }
}

methods! {
    impl GoodnessOfFit as this: this.0;

    #[new]
    #[pyo3(signature = (samples, cumulative, levels = None))]
    build new(_py;
        samples: Numbers<'py>, cumulative: Bound<'py, PyAny>, levels: Option<PyRef<'py, GreyLevels>>
    ) = {
        let samples = checked(samples.values()?)?;
        let Some(levels) = levels else {
            let places = probabilities(&cumulative, samples)?;
            let fit = physics::GoodnessOfFit::new(&places, |place| place);
            return Ok(Self(fit.or_raise()?));
        };
        let law = tabulated(&levels.0, &cumulative)?;
        // Every edge is in the table but one at infinity, which all of the light lies below.
        let law = |edge: f64| law.get(&edge.to_bits()).copied().unwrap_or(1.0);
        let fit = physics::GoodnessOfFit::of_rounded(samples, &levels.0, law);
        Ok(Self(fit.or_raise()?))
    };

    /// Test after Kolmogorov and Smirnov.
    ///
    /// Returns
    /// -------
    /// TestOutcome
    try kolmogorov_smirnov() -> TestOutcome = this.0.kolmogorov_smirnov();

    /// Test after Pearson, in up to 20 bins of about the same probability.
    ///
    /// Parameters
    /// ----------
    /// constraints : int
    ///     1 for the total and 1 for each parameter of the law that was fitted.
    ///
    /// Returns
    /// -------
    /// TestOutcome
    try chi_squared(constraints: usize) -> TestOutcome = this.0.chi_squared(constraints);
}

/// Returns finite samples, of which there is one at least.
fn checked(samples: &[f64]) -> PyResult<&[f64]> {
    let message = match samples.iter().position(|sample| !sample.is_finite()) {
        Some(index) => format!("samples must be finite, got {} at {index}", samples[index]),
        None if samples.is_empty() => "samples must be at least 1, got 0".to_owned(),
        None => return Ok(samples),
    };
    Err(refused("samples", message))
}

/// Asks a distribution function for the probabilities at samples.
fn probabilities(cumulative: &Bound<'_, PyAny>, samples: &[f64]) -> PyResult<Vec<f64>> {
    let given = PyArray1::from_slice(cumulative.py(), samples);
    let values: Numbers<'_> = cumulative.call1((given,))?.extract()?;
    if values.shape() != [samples.len()] {
        let shape = values.shape();
        let message = format!(
            "cumulative must return the shape [{}] of the samples, got {shape:?}",
            samples.len()
        );
        return Err(refused("cumulative", message));
    }
    let values = values.values()?.to_vec();
    let bad = |(_, value): &(&f64, &f64)| !(0.0..=1.0).contains(*value);
    match samples.iter().zip(&values).find(bad) {
        Some((sample, value)) => {
            let message = format!("cumulative must be from 0 to 1 at {sample}, got {value}");
            Err(refused("cumulative", message))
        }
        None => Ok(values),
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
