use pyo3::prelude::*;
use tem00_speckle::paper as physics;

use super::{
    arguments::{Whole, index},
    field::PupilField,
};
use crate::{
    arrays::{Numbers, map},
    error::OrRaise,
};

/// The look-up as printed in Bergmann et al. 2016, to reproduce its figures and show the difference.
#[pymodule(submodule)]
pub(crate) mod paper {
    #[pymodule_export]
    use super::BilinearStack;
}

/// A stack of intensity slices on the circular path, interpolated as printed.
#[pyclass(frozen, eq, module = "tem00.speckle.paper")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BilinearStack(physics::BilinearStack);

#[pymethods]
impl BilinearStack {
    /// Generate the slices of a field.
    ///
    /// Parameters
    /// ----------
    /// field : `PupilField`
    ///     Field that the slices are cut from.
    /// `half_period` : int
    ///     Half the number of slices.
    #[staticmethod]
    fn generate(py: Python<'_>, field: &PupilField, half_period: Whole<'_>) -> PyResult<Self> {
        let half_period = half_period.unsigned("half_period")?;
        let stack = py.detach(|| physics::BilinearStack::generate(&field.0, half_period));
        Ok(Self(stack.or_raise()?))
    }

    /// Number of slices.
    #[getter]
    const fn slice_count(&self) -> usize {
        self.0.slice_count()
    }

    /// Number of samples along x and y; as printed, the period is one less.
    #[getter]
    fn size(&self) -> (usize, usize) {
        self.0.size().into()
    }

    /// Return the intensity at positions and slice coordinates, as printed.
    ///
    /// Parameters
    /// ----------
    /// x, y : `array_like`
    ///     Position in samples, wrapped into [0, size - 1].
    /// u : `array_like`
    ///     Coordinate in slices, wrapped into [0, `slice_count` - 1].
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Intensity in the common shape of the arguments.
    fn intensity_at<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        u: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("x", &x), ("y", &y), ("u", &u)], |[x, y, u]| {
            self.0.intensity_at(x, y, u)
        })
    }

    /// Return the contrast that bilinear interpolation of the intensity leaves between samples.
    ///
    /// Parameters
    /// ----------
    /// fx, fy : `array_like`
    ///     Fractions of the way between samples along x and y.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Contrast in the common shape of the arguments.
    fn contrast_between_samples<'py>(
        &self,
        py: Python<'py>,
        fx: Numbers<'py>,
        fy: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("fx", &fx), ("fy", &fy)], |[fx, fy]| {
            self.0.contrast_between_samples(fx, fy)
        })
    }

    /// Return the contrast that the linear blend leaves between a slice and the next.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Slice; negative ones count from the last.
    /// f : `array_like`
    ///     Fraction of the way to the next slice.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Contrast in the shape of f.
    #[pyo3(signature = (index, f))]
    fn contrast_between_slices<'py>(
        &self,
        py: Python<'py>,
        index: Whole<'py>,
        f: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let slice = self.slice(&index)?;
        map(py, [("f", &f)], |[f]| {
            self.0.contrast_between_slices(slice, f)
        })
    }

    fn __repr__(&self) -> String {
        let (size, count) = (self.size(), self.0.slice_count());
        format!("<BilinearStack: size={size:?}, slice_count={count}>")
    }
}

impl BilinearStack {
    fn slice(&self, slice: &Whole<'_>) -> PyResult<usize> {
        index("index", slice, self.0.slice_count())
    }
}
