use pyo3::{prelude::*, types::PyAny};
use tem00_statistics as physics;

use crate::{
    arrays::{Count, Numbers, map},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// The largest order of a moment.
const LARGEST_ORDER: usize = 20;

/// The law of the intensity of a sum of few phasors of equal length and random phase.
///
/// Parameters
/// ----------
/// count : int
///     Number of phasors, from 8 to 10⁶.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PhasorSum(physics::PhasorSum);

#[pymethods]
impl PhasorSum {
    #[new]
    fn new(py: Python<'_>, count: Count) -> PyResult<Self> {
        let count = count.value("count")?;
        let law = py.detach(|| physics::PhasorSum::new(count)).or_raise()?;
        Ok(Self(law))
    }

    /// Number of phasors.
    #[getter]
    fn count(&self) -> usize {
        self.0.count()
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
        format!("PhasorSum(count={})", self.0.count())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.0.count(),))
    }
}

/// Return the contrast of the intensity of a sum of `count` phasors, √(1 − 1/count).
#[pyfunction]
pub(super) fn contrast_of_phasor_sum(count: Count) -> PyResult<f64> {
    let count = count.within("count", [1, usize::MAX])?;
    Ok(physics::contrast_of_phasor_sum(count))
}

/// Return a moment ⟨I^order⟩ of the intensity of a sum of phasors, in units of the mean.
///
/// Parameters
/// ----------
/// count : int
///     Number of phasors of equal length and random phase, at least 1.
/// order : int
///     Order of the moment, at most 20.
#[pyfunction]
pub(super) fn moment_of_phasor_sum(count: Count, order: Count) -> PyResult<f64> {
    let count = count.within("count", [1, usize::MAX])?;
    Ok(physics::moment_of_phasor_sum(
        count,
        checked_order("order", &order)?,
    ))
}

/// Returns the order of a moment that is not too large.
pub(super) fn checked_order(name: &'static str, order: &Count) -> PyResult<u32> {
    let order = order.within(name, [0, LARGEST_ORDER])?;
    Ok(u32::try_from(order)?)
}
