use numpy::PyArray1;
use pyo3::{prelude::*, types::PyAny};
use tem00_numerics::Refusal;
use tem00_statistics as physics;
use tem00_statistics::StatisticsError;

use crate::{
    arrays::{Components, Numbers, Samples, Whole},
    error::{OrRaise, refused},
};

/// Outcome of a test of a hypothesis.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TestOutcome(pub(super) physics::TestOutcome);

#[pymethods]
impl TestOutcome {
    fn __repr__(&self) -> String {
        let physics::TestOutcome { statistic, p_value } = self.0;
        format!("<TestOutcome: statistic={statistic:?}, p_value={p_value:?}>")
    }
}

methods! {
    impl TestOutcome as this: this.0;

    unmade "kolmogorov_smirnov, chi_squared or t_test_mean";

    /// The test's statistic: the larger, the further from the hypothesis.
    field statistic -> f64;

    /// The probability of a statistic at least as far from the hypothesis, were it true.
    field p_value -> f64;
}

/// Test whether samples follow a continuous distribution, after Kolmogorov and Smirnov.
///
/// Parameters
/// ----------
/// samples : array_like
///     Independent samples, in any shape.
/// cumulative : callable
///     The distribution function, fixed beforehand. It is called once with an array of shape (n,)
///     and returns probabilities in the same shape.
#[pyfunction]
pub(super) fn kolmogorov_smirnov(
    py: Python<'_>,
    samples: Samples<'_>,
    cumulative: Bound<'_, PyAny>,
) -> PyResult<TestOutcome> {
    let places = probabilities(&cumulative, checked(samples.values()?)?)?;
    // The distance is that of the probabilities from an even distribution.
    let outcome = py.detach(|| physics::kolmogorov_smirnov(&places, |place| place));
    Ok(TestOutcome(outcome.or_raise()?))
}

/// Test whether counts in bins agree with the expected ones, after Pearson.
///
/// Parameters
/// ----------
/// observed : array_like, shape (n,)
///     Counts, whole numbers.
/// expected : array_like, shape (n,)
///     Expected counts; bins are merged until each expects five.
/// constraints : int
///     What the expected counts were fitted to: 1 for the total, 1 more for each parameter.
#[pyfunction]
pub(super) fn chi_squared(
    observed: Components<'_>,
    expected: Components<'_>,
    constraints: Whole<'_>,
) -> PyResult<TestOutcome> {
    let observed = counts(observed.values()?)?;
    let constraints = constraints.unsigned("constraints")?;
    let outcome = physics::chi_squared(&observed, expected.values()?, constraints);
    Ok(TestOutcome(outcome.or_raise()?))
}

/// Test whether the expectation of independent samples is ``mean``, after Student; two-sided.
///
/// Parameters
/// ----------
/// samples : array_like
///     At least two finite samples that differ, in any shape.
/// mean : float
///     The expectation to be tested.
#[pyfunction]
pub(super) fn t_test_mean(
    py: Python<'_>,
    samples: Samples<'_>,
    mean: f64,
) -> PyResult<TestOutcome> {
    let samples = samples.values()?;
    let outcome = py.detach(|| physics::t_test_mean(samples, mean));
    Ok(TestOutcome(outcome.or_raise()?))
}

/// Returns finite samples, of which there is one at least.
pub(super) fn checked(samples: &[f64]) -> PyResult<&[f64]> {
    if samples.is_empty() {
        let (given, needed) = (0, 1);
        return Err(StatisticsError::Samples { given, needed }).or_raise();
    }
    match samples.iter().position(|sample| !sample.is_finite()) {
        Some(index) => {
            let value = samples[index];
            let refusal = Refusal::new("samples", value, "finite").at(index);
            Err(StatisticsError::from(refusal)).or_raise()
        }
        None => Ok(samples),
    }
}

/// Asks a distribution function for the probabilities at samples.
pub(super) fn probabilities(cumulative: &Bound<'_, PyAny>, samples: &[f64]) -> PyResult<Vec<f64>> {
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
        Some((sample, &value)) => {
            let allowed = format!("from 0 to 1 at {sample}");
            let refusal = Refusal::new("cumulative", value, allowed);
            Err(StatisticsError::from(refusal)).or_raise()
        }
        None => Ok(values),
    }
}

/// Returns whole numbers as such.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole numbers between 0 and 2⁵³ only"
)]
fn counts(observed: &[f64]) -> PyResult<Vec<u64>> {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let is_count = |&value: &f64| (0.0..=EXACT).contains(&value) && value.fract() == 0.0;
    match observed.iter().find(|value| !is_count(value)) {
        Some(value) => {
            let message = format!("observed must be whole numbers from 0 to 2^53, got {value}");
            Err(refused("observed", message))
        }
        None => Ok(observed.iter().map(|&value| value as u64).collect()),
    }
}
