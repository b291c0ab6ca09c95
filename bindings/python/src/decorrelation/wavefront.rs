use pyo3::prelude::*;
use tem00_decorrelation as physics;

use super::vectors::{Array3, array3, mat3, rows, shown, shown33, vec3};
use crate::{
    arrays::{Components, Matrix, Table, Vector},
    error::{OrRaise, refused},
    pickling::{Recipe, by_constructor},
};

/// The light that reaches a surface point: where it comes from and how its wavefront is curved.
///
/// Curvatures 1/R are in 1/m, positive where the wave diverges.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wavefront(pub(super) physics::Wavefront);

#[pymethods]
impl Wavefront {
    /// Return a plane wave from the direction to its source, of shape (3,) and any length.
    #[staticmethod]
    fn plane(direction_to_source: Components<'_>) -> PyResult<Self> {
        let direction = vec3("direction_to_source", &direction_to_source)?;
        Ok(Self(physics::Wavefront::plane(direction).or_raise()?))
    }

    /// Return a spherical wave.
    ///
    /// Parameters
    /// ----------
    /// direction_to_source : array_like, shape (3,)
    ///     Direction to the source, of any length.
    /// curvature : float
    ///     Curvature in 1/m.
    #[staticmethod]
    fn spherical(direction_to_source: Components<'_>, curvature: f64) -> PyResult<Self> {
        let direction = vec3("direction_to_source", &direction_to_source)?;
        let wave = physics::Wavefront::spherical(direction, curvature);
        Ok(Self(wave.or_raise()?))
    }

    /// Return an astigmatic wave, such as the fan of a laser line.
    ///
    /// Parameters
    /// ----------
    /// direction_to_source : array_like, shape (3,)
    ///     Direction to the source, of any length.
    /// axis : array_like, shape (3,)
    ///     Principal axis of any length; only its part across the direction counts.
    /// curvature_along, curvature_across : float
    ///     Curvatures along and across that axis, in 1/m.
    #[staticmethod]
    fn astigmatic(
        direction_to_source: Components<'_>,
        axis: Components<'_>,
        curvature_along: f64,
        curvature_across: f64,
    ) -> PyResult<Self> {
        let direction = vec3("direction_to_source", &direction_to_source)?;
        let axis = vec3("axis", &axis)?;
        check_finite("curvature_along", curvature_along)?;
        check_finite("curvature_across", curvature_across)?;
        let wave =
            physics::Wavefront::astigmatic(direction, axis, curvature_along, curvature_across);
        Ok(Self(wave.or_raise()?))
    }

    /// Return the wave of a curvature tensor, as it comes from the second derivatives of a phase.
    ///
    /// Parameters
    /// ----------
    /// direction_to_source : array_like, shape (3,)
    ///     Direction to the source, of any length.
    /// curvature : array_like, shape (3, 3)
    ///     Symmetric curvature tensor in 1/m; only its part across the direction counts.
    #[staticmethod]
    fn from_tensor(direction_to_source: Components<'_>, curvature: Table<'_>) -> PyResult<Self> {
        let direction = vec3("direction_to_source", &direction_to_source)?;
        let wave = physics::Wavefront::from_tensor(direction, mat3("curvature", &curvature)?);
        Ok(Self(wave.or_raise()?))
    }

    /// Return the wave whose direction turns along a surface as a renderer's ray differentials say.
    ///
    /// Parameters
    /// ----------
    /// direction_to_source : array_like, shape (3,)
    ///     Direction to the source, of any length.
    /// dp : array_like, shape (2, 3)
    ///     Differentials of the surface point by two parameters, in metres.
    /// dl : array_like, shape (2, 3)
    ///     Differentials of the unit vector to the source by the same parameters.
    #[staticmethod]
    fn from_differentials(
        direction_to_source: Components<'_>,
        dp: Table<'_>,
        dl: Table<'_>,
    ) -> PyResult<Self> {
        let direction = vec3("direction_to_source", &direction_to_source)?;
        let (dp, dl) = (rows("dp", &dp)?, rows("dl", &dl)?);
        let wave = physics::Wavefront::from_differentials(direction, dp, dl);
        Ok(Self(wave.or_raise()?))
    }

    /// Return the unit vector to the source from beside the point that the wave is described for.
    ///
    /// Parameters
    /// ----------
    /// offset : array_like, shape (3,)
    ///     Distance from the point, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (3,) or None
    ///     ``None`` in a focus, where there is no direction.
    fn direction_from<'py>(
        &self,
        py: Python<'py>,
        offset: Components<'py>,
    ) -> PyResult<Option<Array3<'py>>> {
        let direction = self.0.direction_from(vec3("offset", &offset)?);
        Ok(direction.map(|direction| array3(py, direction)))
    }

    pub(super) fn __repr__(&self) -> String {
        let direction = shown(self.0.direction_to_source());
        format!(
            "Wavefront.from_tensor({direction}, {})",
            shown33(self.0.curvature())
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let direction = Vec::from(self.0.direction_to_source().to_array());
        let rows = self.0.curvature().transpose().to_cols_array_2d();
        let rows = rows.map(Vec::from).to_vec();
        by_constructor::<Self>(py, "from_tensor", (direction, rows))
    }
}

methods! {
    impl Wavefront as this: this.0;

    unmade "plane, spherical, astigmatic, from_tensor or from_differentials";

    /// Unit vector from the surface to the source, of shape (3,).
    get direction_to_source -> Vector<3>;

    /// Symmetric curvature tensor in 1/m, of shape (3, 3).
    get curvature -> Matrix;
}

fn check_finite(name: &'static str, value: f64) -> PyResult<()> {
    if value.is_finite() {
        return Ok(());
    }
    Err(refused(
        name,
        format!("{name} must be finite, got {value} 1/m"),
    ))
}
