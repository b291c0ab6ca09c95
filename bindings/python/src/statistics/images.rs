use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use tem00_statistics as physics;

use crate::{
    arrays::{Image, Whole, image_array},
    error::{OrRaise, refused},
};

/// Name of the values of an image in errors.
const VALUES: &[&str] = &["samples", "lags"];

/// Return the normalised autocovariance of an image at every lag, 1 at zero lag.
///
/// Parameters
/// ----------
/// image : array_like, shape (rows, columns)
///     The image, in single precision.
/// boundary : {"periodic", "finite"}
///     Whether the image repeats, as a computed pattern does, or nothing is known beyond its edges.
///
/// Returns
/// -------
/// float32 ndarray, shape (rows, columns) or (2 rows, 2 columns)
///     Lag (x, y) stands at [y, x], negative lags at the far end. Twice the shape for a finite image.
#[pyfunction]
pub(super) fn autocovariance<'py>(
    py: Python<'py>,
    image: Image<'py>,
    boundary: &str,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let (image, boundary) = (image.grid("image")?, boundary_of(boundary)?);
    let lags = py.detach(|| physics::autocovariance(&image, boundary));
    image_array(py, lags.or_raise_renamed(VALUES, "image")?)
}

/// Return the power spectrum of the fluctuations of a periodic image.
///
/// Parameters
/// ----------
/// image : array_like, shape (rows, columns)
///     The image, in single precision.
///
/// Returns
/// -------
/// float32 ndarray, shape (rows, columns)
///     Pixels² per unit variance. Frequency (kx / columns, ky / rows), in cycles per pixel, stands at
///     [ky, kx], negative ones at the far end.
#[pyfunction]
pub(super) fn power_spectrum<'py>(
    py: Python<'py>,
    image: Image<'py>,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let image = image.grid("image")?;
    let spectrum = py.detach(|| physics::power_spectrum(&image));
    image_array(py, spectrum.or_raise_renamed(VALUES, "image")?)
}

/// The average of a grid over a ring of lags or frequencies.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ring(physics::Ring);

#[pymethods]
impl Ring {
    fn __repr__(&self) -> String {
        let physics::Ring {
            radius,
            mean,
            count,
        } = self.0;
        format!("<Ring: radius={radius:?}, mean={mean:?}, count={count}>")
    }
}

methods! {
    impl Ring as this: this.0;

    unmade "radial_average";

    /// Mean distance of the cells from the origin.
    field radius -> f64;

    /// Mean of the values.
    field mean -> f64;

    /// Number of cells.
    field count -> usize;
}

/// Return the averages of a grid of lags or frequencies over rings about its origin.
///
/// Parameters
/// ----------
/// grid : array_like, shape (rows, columns)
///     Lags or frequencies, with the origin at [0, 0] and negative ones at the far end.
/// step : (float, float)
///     Size of a cell along x and y: (1, 1) for lags in pixels, (1 / columns, 1 / rows) for
///     frequencies in cycles per pixel.
///
/// Returns
/// -------
/// list of Ring
///     Ring k gathers the cells nearest to k times the larger step.
#[pyfunction]
pub(super) fn radial_average(
    py: Python<'_>,
    grid: Image<'_>,
    step: [f64; 2],
) -> PyResult<Vec<Ring>> {
    let grid = grid.grid("grid")?;
    let rings = py
        .detach(|| physics::radial_average(&grid, step))
        .or_raise()?;
    Ok(rings.into_iter().map(Ring).collect())
}

/// Return every ``stride``-th pixel of every ``stride``-th row.
///
/// Parameters
/// ----------
/// grid : array_like, shape (rows, columns)
///     The image, in single precision.
/// stride : int
///     Pixels from one sample to the next: 1.22 speckle sizes at least, for independent ones.
///
/// Returns
/// -------
/// ndarray, shape (n,)
///     The samples, without those of an incomplete last stride.
#[pyfunction]
pub(super) fn decorrelated_samples<'py>(
    py: Python<'py>,
    grid: Image<'py>,
    stride: Whole<'_>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (grid, stride) = (grid.grid("grid")?, stride.unsigned("stride")?);
    let samples = physics::decorrelated_samples(&grid, stride).or_raise()?;
    Ok(PyArray1::from_vec(py, samples))
}

/// Return the contrast of an image within a square window about every pixel.
///
/// Parameters
/// ----------
/// image : array_like, shape (rows, columns)
///     The image, in single precision.
/// window : int
///     Width and height of the window in pixels, at least 2.
///
/// Returns
/// -------
/// float32 ndarray, shape (rows − window + 1, columns − window + 1)
///     The value at [y, x] is that of the window whose first pixel is there.
#[pyfunction]
pub(super) fn local_contrast<'py>(
    py: Python<'py>,
    image: Image<'py>,
    window: Whole<'_>,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let (image, window) = (image.grid("image")?, window.unsigned("window")?);
    let map = py.detach(|| physics::local_contrast(&image, window));
    image_array(py, map.or_raise_renamed(VALUES, "image")?)
}

/// The speckle size along both axes of an image, in pixels.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpeckleSize(physics::SpeckleSize);

#[pymethods]
impl SpeckleSize {
    /// Measure the speckle size of an image.
    ///
    /// Parameters
    /// ----------
    /// image : array_like, shape (rows, columns)
    ///     The image, in single precision.
    /// boundary : {"periodic", "finite"}
    ///     Whether the image repeats, or nothing is known beyond its edges.
    #[staticmethod]
    fn from_image(py: Python<'_>, image: Image<'_>, boundary: &str) -> PyResult<Self> {
        let (image, boundary) = (image.grid("image")?, boundary_of(boundary)?);
        let size = py.detach(|| physics::SpeckleSize::from_image(&image, boundary));
        Ok(Self(size.or_raise_renamed(VALUES, "image")?))
    }

    /// Measure the speckle size from an autocovariance with zero lag at [0, 0].
    #[staticmethod]
    fn from_autocovariance(lags: Image<'_>) -> PyResult<Self> {
        let lags = lags.grid("lags")?;
        Ok(Self(
            physics::SpeckleSize::from_autocovariance(&lags).or_raise()?,
        ))
    }

    /// Measure the speckle size along one axis from an autocovariance with zero lag at [0, 0].
    ///
    /// Parameters
    /// ----------
    /// axis : {"x", "y"}
    ///     Along the rows, or along the columns.
    /// lags : array_like, shape (rows, columns)
    ///     The autocovariance.
    ///
    /// Returns
    /// -------
    /// float
    ///     Size in pixels.
    #[staticmethod]
    fn along(axis: &str, lags: Image<'_>) -> PyResult<f64> {
        let axis = match axis {
            "x" => physics::Axis::X,
            "y" => physics::Axis::Y,
            _ => {
                let message = format!("axis must be \"x\" or \"y\", got {axis:?}");
                return Err(refused("axis", message));
            }
        };
        physics::SpeckleSize::along(axis, &lags.grid("lags")?).or_raise()
    }

    fn __repr__(&self) -> String {
        format!("<SpeckleSize: x={:?}, y={:?}>", self.0.x(), self.0.y())
    }
}

methods! {
    impl SpeckleSize as this: this.0;

    unmade "from_image, from_autocovariance or along";

    /// Speckle size along the rows, in pixels.
    get x -> f64;

    /// Speckle size along the columns, in pixels.
    get y -> f64;

    /// Geometric mean of both sizes, in pixels.
    get mean -> f64;
}

/// Returns how an image continues beyond its edges.
pub(super) fn boundary_of(boundary: &str) -> PyResult<physics::Boundary> {
    match boundary {
        "periodic" => Ok(physics::Boundary::Periodic),
        "finite" => Ok(physics::Boundary::Finite),
        _ => {
            let message = format!("boundary must be \"periodic\" or \"finite\", got {boundary:?}");
            Err(refused("boundary", message))
        }
    }
}
