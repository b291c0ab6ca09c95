use pyo3::prelude::*;
use tem00_statistics as physics;

use super::phasors::checked_order;
use crate::arrays::{Numbers, Values, Whole, map};

/// The joint law of the intensities at two points of fully developed speckle, or at one point of two
/// correlated patterns.
///
/// Parameters
/// ----------
/// amplitude_correlation : float
///     Magnitude of the correlation of the two amplitudes, from 0 to below 1.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointIntensity(physics::JointIntensity);

#[pymethods]
impl JointIntensity {
    /// Return the joint density of two intensities.
    ///
    /// Parameters
    /// ----------
    /// intensities : pair of float or array_like
    ///     The intensities in units of their mean, broadcast together.
    fn density<'py>(
        &self,
        py: Python<'py>,
        intensities: [Numbers<'py>; 2],
    ) -> PyResult<Values<'py>> {
        let [first, second] = &intensities;
        let named = [("intensities", first), ("intensities", second)];
        map(py, named, |pair| self.0.density(pair))
    }

    /// Return the moment ⟨I₁ᵐ I₂ⁿ⟩ of the orders (m, n), each at most 20.
    fn moment(&self, orders: [Whole<'_>; 2]) -> PyResult<f64> {
        let [m, n] = &orders;
        let orders = [checked_order("orders", m)?, checked_order("orders", n)?];
        Ok(self.0.moment(orders))
    }
}

methods! {
    impl JointIntensity as this: this.0;

    make new(amplitude_correlation);

    /// Magnitude of the correlation of the amplitudes.
    get amplitude_correlation -> f64;

    /// Correlation of the intensities, the square of that of the amplitudes.
    get intensity_correlation -> f64;

    /// Return the density of the intensity at one point where that at the other is ``given``.
    ///
    /// Parameters
    /// ----------
    /// intensity, given : float or array_like
    ///     Intensities in units of their mean, broadcast together.
    map conditional_density(intensity, given: not_negative);

    /// Return the probability of at most ``intensity`` at one point where the other has ``given``.
    ///
    /// Parameters
    /// ----------
    /// intensity, given : float or array_like
    ///     Intensities in units of their mean, broadcast together.
    map conditional_cumulative(intensity, given: not_negative);

    /// Return the mean of the intensity at one point where that at the other is ``given``.
    map conditional_mean(given: not_negative);

    /// Return the variance of the intensity at one point where that at the other is ``given``.
    map conditional_variance(given: not_negative);

    made_by new(amplitude_correlation);
}
