//! Ray matrices that mix the two transverse axes.

use numpy::{PyArray1, PyArray4, PyArrayMethods};
use pyo3::prelude::*;
use tem00_beam::DVec2;
use tem00_beam::optics as physics;

use super::{
    abcd::AbcdMatrix,
    arguments::{OrRaiseAs, map_inner, matrices},
    matrices::{matrix_of, rows_of},
};
use crate::{
    arrays::{Array, Vectors},
    error::OrRaise,
};

/// The ray matrix of a paraxial system that may act differently in x and y, and mix them.
///
/// A ray enters at the position ``x = (x, y)``, in metres, with the slope ``s = (s_x, s_y)`` and leaves
/// with ``x' = A x + B s`` and ``s' = C x + D s``. Slopes are not multiplied by a refractive index.
///
/// Parameters
/// ----------
/// blocks : array_like, shape (2, 2, 2, 2)
///     The blocks ``[[A, B], [C, D]]``, each 2 × 2; ``B`` is in metres, ``C`` in 1/m. Together they
///     must be symplectic up to the ratio of the refractive indices.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AstigmaticSystem(pub(super) physics::AstigmaticSystem);

#[pymethods]
impl AstigmaticSystem {
    #[new]
    fn new(blocks: [[[[f64; 2]; 2]; 2]; 2]) -> PyResult<Self> {
        let blocks = blocks.map(|row| row.map(matrix_of));
        let system = physics::AstigmaticSystem::new(blocks);
        Ok(Self(system.or_raise_as(&[("matrix", "blocks")])?))
    }

    /// Return the system that acts as one of two matrices in each of its principal axes.
    ///
    /// Parameters
    /// ----------
    /// axes : (AbcdMatrix, AbcdMatrix)
    ///     The matrices, of one determinant.
    /// rotation : float
    ///     Angle of the first principal axis, in radians, from x towards y.
    #[staticmethod]
    fn from_axes(axes: [PyRef<'_, AbcdMatrix>; 2], rotation: f64) -> PyResult<Self> {
        let axes = axes.map(|axis| axis.0);
        Ok(Self(
            physics::AstigmaticSystem::from_axes(axes, rotation)
                .or_raise_renamed(&["determinant"], "axes")?,
        ))
    }

    /// Return the system of this one followed by ``next``.
    ///
    /// Parameters
    /// ----------
    /// next : AstigmaticSystem
    fn then(&self, next: &Self) -> Self {
        Self(self.0.then(next.0))
    }

    /// Return the rays behind the system.
    ///
    /// Parameters
    /// ----------
    /// ray : array_like, shape (..., 2, 2)
    ///     Position ``(x, y)``, in metres, in the first row, and slope in the second.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 2, 2)
    ///     Position and slope of each ray behind.
    fn transform_ray<'py>(&self, py: Python<'py>, ray: Vectors<'py>) -> PyResult<Array<'py>> {
        let columns = matrices(("ray", &ray))?;
        map_inner(py, columns, &[2, 2], |[x, y, s_x, s_y]| {
            let ray = [DVec2::new(x, y), DVec2::new(s_x, s_y)];
            let [position, slope] = self.0.transform_ray(ray);
            [position.x, position.y, slope.x, slope.y]
        })
    }

    /// The blocks ``[[A, B], [C, D]]`` of the matrix, shape (2, 2, 2, 2).
    #[getter]
    fn blocks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        let blocks = self.0.blocks().map(|row| row.map(rows_of));
        let entries = blocks.as_flattened().as_flattened().as_flattened();
        PyArray1::from_slice(py, entries).reshape([2, 2, 2, 2])
    }

    fn __repr__(&self) -> String {
        let blocks = self.0.blocks().map(|row| row.map(rows_of));
        format!("AstigmaticSystem(blocks={blocks:?})")
    }
}

methods! {
    impl AstigmaticSystem as this: this.0;

    /// Return a straight path.
    ///
    /// Parameters
    /// ----------
    /// length : float
    ///     Signed length, in metres, within ±1e30.
    make free_space(length);

    /// Return a thin lens.
    ///
    /// Parameters
    /// ----------
    /// focal_length : float
    ///     Signed focal length, in metres, positive where it focuses.
    make thin_lens(focal_length);

    /// Return a thin cylinder lens.
    ///
    /// Parameters
    /// ----------
    /// focal_length : float
    ///     Signed focal length, in metres, positive where it focuses.
    /// rotation : float
    ///     Angle, in radians, from x towards y, of the direction along which the lens bends rays.
    make cylinder_lens(focal_length, rotation);

    /// Return a system that turns positions and slopes, as an image rotator of mirrors does.
    ///
    /// Parameters
    /// ----------
    /// rotation : float
    ///     Angle, in radians, from x towards y.
    make image_rotation(rotation);

    /// Ratio of the refractive index before the system to that behind it.
    get index_ratio -> f64;
}
