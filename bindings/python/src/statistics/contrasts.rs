use core::cell::RefCell;

use super::physics;
use pyo3::{prelude::*, types::PyAny};

use crate::error::refused;

functions! {
    /// Return the contrast of fully developed speckle seen by square pixels.
    ///
    /// Parameters
    /// ----------
    /// pixel_size : float or array_like
    ///     Side of the pixels in units of the speckle size, 0 or more.
    map pixel_contrast(pixel_size: not_negative);

    /// Return the contrast of fully developed speckle seen by rectangular pixels.
    ///
    /// Parameters
    /// ----------
    /// width, height : float or array_like
    ///     Sides of the pixels in units of the speckle size, 0 or more, broadcast together.
    map rectangular_pixel_contrast(width: not_negative, height: not_negative) =
        physics::rectangular_pixel_contrast([width, height]);

    /// Return the contrast of fully developed speckle behind a Gaussian filter.
    ///
    /// Parameters
    /// ----------
    /// spread : float or array_like
    ///     Standard deviation of the filter along either axis, in units of the speckle size, 0 or
    ///     more.
    map gaussian_filter_contrast(spread: not_negative);

    /// Return the contrast of an exposure during which speckle boils and the image stands still.
    ///
    /// Parameters
    /// ----------
    /// drift : float or array_like
    ///     Shift of the light across a circular pupil during the exposure, in pupil diameters, 0 or
    ///     more.
    map boiling_contrast(drift: not_negative);

    /// Return the contrast of an exposure during which the pattern moves across the image.
    ///
    /// Parameters
    /// ----------
    /// drift : float or array_like
    ///     Motion of the pattern during the exposure, in units of the speckle size, 0 or more.
    map translation_contrast(drift: not_negative);

    /// Return the standard deviation of the squared contrast from pattern to pattern.
    ///
    /// Parameters
    /// ----------
    /// speckles_across : float or array_like
    ///     Width and height of the pattern in units of the speckle size, positive.
    map contrast_squared_spread(speckles_across: positive);
}

/// Return the contrast of an exposure during which the pattern changes in any way.
///
/// Parameters
/// ----------
/// correlation : callable
///     Takes the fraction t of the exposure between two moments, a float in [0, 1], and returns the
///     correlation of the intensities then, in [−1, 1]. It is called a thousand times.
#[pyfunction]
pub(super) fn contrast_of_exposure(correlation: Bound<'_, PyAny>) -> PyResult<f64> {
    let failure = RefCell::new(None);
    let contrast = physics::contrast_of_exposure(|t| {
        if failure.borrow().is_some() {
            return 0.0;
        }
        correlation_at(&correlation, t).unwrap_or_else(|error| {
            *failure.borrow_mut() = Some(error);
            0.0
        })
    });
    failure.into_inner().map_or(Ok(contrast), Err)
}

fn correlation_at(correlation: &Bound<'_, PyAny>, t: f64) -> PyResult<f64> {
    let value: f64 = correlation.call1((t,))?.extract()?;
    if (-1.0..=1.0).contains(&value) {
        return Ok(value);
    }
    let message = format!("correlation must return values in [-1, 1], got {value} at {t}");
    Err(refused("correlation", message))
}
