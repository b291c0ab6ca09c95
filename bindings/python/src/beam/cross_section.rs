//! The irradiance over a plane across a beam.

use numpy::PyArray1;
use pyo3::prelude::*;
use tem00_beam as physics;

use super::arguments::{OrRaiseAs, columns, components, map, map_inner, try_map};
use crate::{
    arrays::Numbers,
    pickling::{Recipe, by_constructor},
};

/// The irradiance of a Gaussian beam of 1 W over a plane across it.
///
/// The principal axes of the distribution are x and y, its centre is the origin. Powers are fractions
/// of the whole, from 0 to 1; an aperture of negative size holds nothing.
///
/// Parameters
/// ----------
/// radii : (float, float)
///     Principal radii (1/e²) along x and y, in metres, from 1e-30 to 1e30.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CrossSection(pub(super) physics::CrossSection);

#[pymethods]
impl CrossSection {
    #[new]
    fn new(radii: [f64; 2]) -> PyResult<Self> {
        let section = physics::CrossSection::new(radii);
        Ok(Self(section.or_raise_as(&[("radius", "radii")])?))
    }

    /// Principal radii (1/e²), in metres, shape (2,).
    #[getter]
    fn radii<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.radii())
    }

    /// This cross-section with its axes exchanged.
    #[getter]
    fn transposed(&self) -> Self {
        Self(self.0.transposed())
    }

    /// Full widths at half maximum along x and y, in metres, shape (2,).
    #[getter]
    fn fwhm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.fwhm())
    }

    /// D4σ widths along x and y, in metres, shape (2,).
    #[getter]
    fn d4_sigma<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.d4_sigma())
    }

    /// Distances, in metres, shape (2,), by which a knife edge moves along x and y between the
    /// positions that leave 10 % and 90 % of the power.
    #[getter]
    fn knife_edge_width<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.knife_edge_width())
    }

    /// Effective area ``π w_x w_y``, in m².
    #[getter]
    fn effective_area(&self) -> f64 {
        self.0.effective_area()
    }

    /// Return the irradiance per watt of beam power, in 1/m².
    ///
    /// Parameters
    /// ----------
    /// x, y : float or array_like
    ///     Coordinates along the principal axes, in metres; they broadcast together.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Irradiance per watt, in the common shape.
    fn irradiance_per_watt<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("x", &x), ("y", &y)], |point| {
            self.0.irradiance_per_watt(point)
        })
    }

    /// Return the fraction of the power within a centred circle.
    ///
    /// Parameters
    /// ----------
    /// radius : float or array_like
    ///     Radius of the circle, in metres.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Fraction from 0 to 1, in the shape of ``radius``.
    fn power_in_circle<'py>(
        &self,
        py: Python<'py>,
        radius: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("radius", &radius)], |[radius]| {
            self.0.power_in_circle(radius)
        })
    }

    /// Return the fraction of the power within a circle anywhere.
    ///
    /// Parameters
    /// ----------
    /// centre : array_like, shape (..., 2)
    ///     Centre of the circle, in metres.
    /// radius : float or array_like
    ///     Radius of the circle, in metres; it broadcasts with ``centre[..., 0]``.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Fraction from 0 to 1, in the common shape.
    fn power_in_circle_at<'py>(
        &self,
        py: Python<'py>,
        centre: Numbers<'py>,
        radius: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [x, y] = components(("centre", &centre))?;
        let [radius] = columns([("radius", &radius)])?;
        let columns = [x, y, radius];
        map_inner(py, columns, &[], |[x, y, radius]| {
            [self.0.power_in_circle_at([x, y], radius)]
        })
    }

    /// Return the radius of the centred circle that holds a fraction of the power, in metres.
    ///
    /// Parameters
    /// ----------
    /// fraction : float or array_like
    ///     Fraction of the power, in [0, 1).
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Radius in metres, in the shape of ``fraction``.
    fn circle_radius<'py>(
        &self,
        py: Python<'py>,
        fraction: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let argument = ("fraction", &fraction);
        try_map(py, argument, |fraction| self.0.circle_radius(fraction))
    }

    /// Return the fraction of the power within a centred square, the ensquared power.
    ///
    /// Parameters
    /// ----------
    /// side : float or array_like
    ///     Length of the sides, in metres.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Fraction from 0 to 1, in the shape of ``side``.
    fn power_in_square<'py>(
        &self,
        py: Python<'py>,
        side: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("side", &side)], |[side]| self.0.power_in_square(side))
    }

    /// Return the fraction of the power within a rectangle.
    ///
    /// Parameters
    /// ----------
    /// centre : array_like, shape (..., 2)
    ///     Centre of the rectangle, in metres.
    /// size : array_like, shape (..., 2)
    ///     Full lengths of its sides along x and y, in metres.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Fraction from 0 to 1, in the common shape of the leading axes.
    fn power_in_rectangle<'py>(
        &self,
        py: Python<'py>,
        centre: Numbers<'py>,
        size: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [x, y] = components(("centre", &centre))?;
        let [width, height] = components(("size", &size))?;
        map_inner(py, [x, y, width, height], &[], |[x, y, width, height]| {
            [self.0.power_in_rectangle([x, y], [width, height])]
        })
    }

    /// Return the fraction of the power that passes a slit across x.
    ///
    /// Parameters
    /// ----------
    /// centre, width : float or array_like
    ///     Middle of the slit on x and its full width, in metres; they broadcast together.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Fraction from 0 to 1, in the common shape.
    fn power_in_slit<'py>(
        &self,
        py: Python<'py>,
        centre: Numbers<'py>,
        width: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let arguments = [("centre", &centre), ("width", &width)];
        map(py, arguments, |[centre, width]| {
            self.0.power_in_slit(centre, width)
        })
    }

    /// Return the fraction of the power that passes a knife edge across x.
    ///
    /// Parameters
    /// ----------
    /// position : float or array_like
    ///     Place of the edge on x, in metres; it covers everything below.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Fraction from 0 to 1, in the shape of ``position``.
    fn power_past_knife_edge<'py>(
        &self,
        py: Python<'py>,
        position: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("position", &position)], |[position]| {
            self.0.power_past_knife_edge(position)
        })
    }

    fn __repr__(&self) -> String {
        format!("CrossSection(radii={:?})", self.0.radii())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.0.radii(),))
    }
}
