use pyo3::prelude::*;
use tem00_statistics as physics;

use crate::{
    arrays::{Whole, map},
    error::OrRaise,
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
    fn new(py: Python<'_>, count: Whole<'_>) -> PyResult<Self> {
        let count = count.unsigned("count")?;
        let law = py.detach(|| physics::PhasorSum::new(count)).or_raise()?;
        Ok(Self(law))
    }
}

methods! {
    impl PhasorSum as this: this.0;

    /// Number of phasors.
    get count -> usize;

    /// Contrast, standard deviation over mean.
    get contrast -> f64;

    /// Return the probability density at intensities in units of their mean, in their shape.
    map density(intensity);

    /// Return the probability of at most an intensity in units of the mean, in its shape.
    map cumulative(intensity);

    made_by new(count);
}

/// Return the contrast of the intensity of a sum of ``count`` phasors, √(1 − 1/count).
#[pyfunction]
pub(super) fn contrast_of_phasor_sum(count: Whole<'_>) -> PyResult<f64> {
    let count = count.between("count", [1, usize::MAX])?;
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
pub(super) fn moment_of_phasor_sum(count: Whole<'_>, order: Whole<'_>) -> PyResult<f64> {
    let count = count.between("count", [1, usize::MAX])?;
    Ok(physics::moment_of_phasor_sum(
        count,
        checked_order("order", &order)?,
    ))
}

/// Returns the order of a moment that is not too large.
pub(super) fn checked_order(name: &'static str, order: &Whole<'_>) -> PyResult<u32> {
    let order = order.between(name, [0, LARGEST_ORDER])?;
    Ok(u32::try_from(order)?)
}
