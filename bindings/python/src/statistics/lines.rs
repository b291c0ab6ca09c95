use pyo3::{prelude::*, types::PyAny};
use tem00_statistics as physics;

use crate::arrays::{Numbers, map};

/// Return the speckle length of rows.
///
/// The integral, over all distances across the rows, of the autocovariance of speckle that is averaged
/// over a row's height along the line, in units of the speckle size.
///
/// Parameters
/// ----------
/// row_height : float or array
///     Extent of a pixel along the line in units of the speckle size, 0 or more.
#[pyfunction]
pub(super) fn speckle_length<'py>(
    py: Python<'py>,
    row_height: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    row_height.not_negative("row_height")?;
    map(py, [("row_height", &row_height)], |[p]| {
        physics::speckle_length(p)
    })
}

/// Return the standard deviation of the centroid of a wide laser line under speckle.
///
/// Parameters
/// ----------
/// radius, row_height : float or array
///     1/e² half-width of the line and extent of a pixel along it, in units of the speckle size as the
///     result, 0 or more. They are broadcast together.
#[pyfunction]
pub(super) fn line_centroid_deviation<'py>(
    py: Python<'py>,
    radius: Numbers<'py>,
    row_height: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    radius.not_negative("radius")?;
    row_height.not_negative("row_height")?;
    let named = [("radius", &radius), ("row_height", &row_height)];
    map(py, named, |[w, p]| physics::line_centroid_deviation(w, p))
}

/// Return the standard deviation of the centroid of a laser line on a rough surface that a lens images.
///
/// First order in the fluctuations, for lines of any width.
///
/// Parameters
/// ----------
/// radius, row_height : float or array
///     1/e² half-width of the line and extent of a pixel along it, in units of the speckle size as the
///     result, 0 or more. They are broadcast together.
#[pyfunction]
pub(super) fn imaged_line_centroid_deviation<'py>(
    py: Python<'py>,
    radius: Numbers<'py>,
    row_height: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    radius.not_negative("radius")?;
    row_height.not_negative("row_height")?;
    let named = [("radius", &radius), ("row_height", &row_height)];
    map(py, named, |[w, p]| {
        physics::imaged_line_centroid_deviation(w, p)
    })
}

/// Return the standard deviation of the centroid of a round Gaussian spot under speckle, along one axis.
///
/// Parameters
/// ----------
/// radius : float or array
///     1/e² radius in units of the speckle size, as the result, 0 or more.
#[pyfunction]
pub(super) fn gaussian_spot_centroid_deviation<'py>(
    py: Python<'py>,
    radius: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    radius.not_negative("radius")?;
    map(py, [("radius", &radius)], |[w]| {
        physics::gaussian_spot_centroid_deviation(w)
    })
}

/// Return the standard deviation of the centroid of a uniform round spot under speckle, along one axis.
///
/// Parameters
/// ----------
/// radius : float or array
///     Radius in units of the speckle size, as the result, 0 or more.
#[pyfunction]
pub(super) fn disc_spot_centroid_deviation<'py>(
    py: Python<'py>,
    radius: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    radius.not_negative("radius")?;
    map(py, [("radius", &radius)], |[a]| {
        physics::disc_spot_centroid_deviation(a)
    })
}
