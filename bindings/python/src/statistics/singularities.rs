use pyo3::prelude::*;
use tem00_statistics as physics;

use super::images::boundary_of;
use crate::{arrays::ComplexImage, error::OrRaise};

/// A phase singularity of a complex field: a point of intensity zero around which the phase turns.
#[pyclass(frozen, eq, hash, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Singularity(physics::Singularity);

#[pymethods]
impl Singularity {
    fn __repr__(&self) -> String {
        let physics::Singularity { x, y, charge } = self.0;
        format!("<Singularity: x={x}, y={y}, charge={charge}>")
    }
}

methods! {
    impl Singularity as this: this.0;

    unmade "phase_singularities";

    /// Column of the cell: the singularity lies between this sample and the next.
    field x -> usize;

    /// Row of the cell.
    field y -> usize;

    /// +1 where the phase grows on the way from the x to the y axis, −1 where it falls.
    field charge -> i8;
}

/// Find the phase singularities of a sampled field, cell by cell, in the order of its rows.
///
/// Parameters
/// ----------
/// field : complex array_like, shape (rows, columns)
///     The field, in single precision.
/// boundary : {"periodic", "finite"}
///     Whether the field repeats, or nothing is known beyond its edges.
#[pyfunction]
pub(super) fn phase_singularities(
    py: Python<'_>,
    field: ComplexImage<'_>,
    boundary: &str,
) -> PyResult<Vec<Singularity>> {
    let (field, boundary) = (field.grid("field")?, boundary_of(boundary)?);
    let found = py.detach(|| physics::phase_singularities(&field, boundary));
    let found = found.or_raise_renamed(&["samples"], "field")?;
    Ok(found.into_iter().map(Singularity).collect())
}

/// An estimate of the number of phase singularities per area.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VortexDensity(physics::VortexDensity);

#[pymethods]
impl VortexDensity {
    /// Count the singularities of a field.
    ///
    /// Parameters
    /// ----------
    /// field : complex array_like, shape (rows, columns)
    ///     The field, in single precision.
    /// boundary : {"periodic", "finite"}
    ///     Whether the field repeats, or nothing is known beyond its edges.
    #[staticmethod]
    fn from_field(py: Python<'_>, field: ComplexImage<'_>, boundary: &str) -> PyResult<Self> {
        let (field, boundary) = (field.grid("field")?, boundary_of(boundary)?);
        let density = py.detach(|| physics::VortexDensity::from_field(&field, boundary));
        Ok(Self(density.or_raise_renamed(&["samples"], "field")?))
    }

    fn __repr__(&self) -> String {
        let (count, value) = (self.0.count(), self.0.value());
        let error = self.0.standard_error();
        format!("<VortexDensity: count={count}, value={value:?}, standard_error={error:?}>")
    }
}

methods! {
    impl VortexDensity as this: this.0;

    unmade "from_field";

    /// Number of singularities.
    get count -> usize;

    /// Number of singularities per squared sample.
    get value -> f64;

    /// Standard error of the density, per squared sample.
    get standard_error -> f64;

    /// Speckle size that makes this density, in samples; ``None`` without singularities.
    get speckle_size -> Option<f64>;
}
