use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use tem00_speckle as physics;

use crate::arrays::Vector;

/// The closed forms of a slice, for look-ups that run where no library can be called.
///
/// With the fraction f of the way between the slices i and i + 1, and fx, fy between samples::
///
///     U = (1 - f) U_i + f U_{i+1} exp(2 pi i (turns[0] x + turns[1] y))
///     I = |U|**2 / ((1 - f)**2 v_i + f**2 v_{i+1} + 2 f (1 - f) w_i)
///     v = sum of mean_square[ny, nx] s[ny](fy) s[nx](fx)
///     w = sum of covariance[ny, nx] s[ny](fy) s[nx](fx)
///     s(f) = 1, p, p**2, p**3, o, o p        p = f (1 - f),  o = p (1 - 2 f)
///
/// x and y lie in one period, from 0 to the size. For the nearest sample both are those of the sample,
/// and fx and fy are 0.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SliceLaw(pub(super) physics::SliceLaw);

#[pymethods]
impl SliceLaw {
    /// Coefficients of the mean square of the interpolated amplitude, float32 of shape (4, 4).
    #[getter]
    fn mean_square<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        PyArray1::from_slice(py, self.0.mean_square.as_flattened()).reshape([4, 4])
    }

    /// Coefficients of the covariance with the next slice, float32 of shape (6, 6).
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        PyArray1::from_slice(py, self.0.covariance.as_flattened()).reshape([6, 6])
    }

    fn __repr__(&self) -> String {
        let [x, y] = self.0.turns;
        format!("<SliceLaw: turns=[{x}, {y}]>")
    }
}

methods! {
    impl SliceLaw as this: this.0;

    unmade "SpeckleStack.slice_law";

    /// Turns of phase per sample along x and y, from the frame of the next slice to that of this
    /// one, float64 of shape (2,).
    field turns -> Vector<2>;
}
