use pyo3::{prelude::*, types::PyAny};
use tem00_statistics as physics;

use crate::{
    arrays::{Numbers, map},
    error::refused,
};

/// Return the normalised autocovariance of speckle behind a circular pupil.
///
/// Parameters
/// ----------
/// lag : float or array
///     Lag in units of the speckle size.
#[pyfunction]
pub(super) fn airy_autocovariance<'py>(
    py: Python<'py>,
    lag: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    map(py, [("lag", &lag)], |[lag]| {
        physics::airy_autocovariance(lag)
    })
}

/// Return the power spectrum of speckle behind a circular pupil, per unit variance.
///
/// Parameters
/// ----------
/// frequency : float or array
///     Cycles per speckle size.
///
/// Returns
/// -------
/// float or array
///     Spectrum in units of the squared speckle size, in the shape of `frequency`.
#[pyfunction]
pub(super) fn airy_power_spectrum<'py>(
    py: Python<'py>,
    frequency: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    map(py, [("frequency", &frequency)], |[f]| {
        physics::airy_power_spectrum(f)
    })
}

/// Return how often the intensity rises through a level, per speckle size of a straight line.
///
/// Parameters
/// ----------
/// level : float or array
///     Level in units of the mean intensity.
#[pyfunction]
pub(super) fn level_crossings<'py>(
    py: Python<'py>,
    level: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    map(py, [("level", &level)], |[level]| {
        physics::level_crossings(level)
    })
}

/// Return the share of the area of fully developed speckle that is brighter than a level.
///
/// Parameters
/// ----------
/// level : float or array
///     Level in units of the mean intensity.
#[pyfunction]
pub(super) fn area_fraction_above<'py>(
    py: Python<'py>,
    level: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    map(py, [("level", &level)], |[level]| {
        physics::area_fraction_above(level)
    })
}

/// Return the speckle size before square pixels widened it to `measured`, both in pixels.
///
/// `None` if it was below 0.95 pixels, where the pixels hide it.
#[pyfunction]
pub(super) fn size_before_pixels(measured: f64) -> PyResult<Option<f64>> {
    if !(measured > 0.0 && measured.is_finite()) {
        let message = format!("measured must be positive and finite, got {measured:?} pixels");
        return Err(refused("measured", message));
    }
    Ok(physics::size_before_pixels(measured))
}
