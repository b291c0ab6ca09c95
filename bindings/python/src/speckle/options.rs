use pyo3::{
    prelude::*,
    types::{PyTuple, PyType},
};
use tem00_speckle as physics;

use super::arguments::{INTERPOLATIONS, choice, name_of};
use crate::arrays::Whole;

/// Options of a stack.
///
/// Parameters
/// ----------
/// interpolation : {"cubic_spline", "bilinear", "nearest"}
///     How look-ups interpolate in the plane.
/// memory_limit : int
///     Bytes that the slices may take; 2**64 - 1 by default.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StackOptions(pub(super) physics::StackOptions);

#[pymethods]
impl StackOptions {
    #[new]
    #[pyo3(signature = (interpolation = "cubic_spline", memory_limit = None))]
    fn new(interpolation: &str, memory_limit: Option<Whole<'_>>) -> PyResult<Self> {
        let memory_limit = memory_limit.map(|limit| limit.unsigned("memory_limit"));
        Ok(Self(physics::StackOptions {
            interpolation: choice("interpolation", &INTERPOLATIONS, interpolation)?,
            memory_limit: memory_limit.transpose()?.unwrap_or(u64::MAX),
        }))
    }

    fn __repr__(&self) -> String {
        format!(
            "StackOptions(interpolation='{}', memory_limit={})",
            self.interpolation(),
            self.0.memory_limit
        )
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let options = slf.get();
        let arguments = (options.interpolation(), options.0.memory_limit);
        Ok((slf.get_type(), arguments.into_pyobject(slf.py())?))
    }
}

methods! {
    impl StackOptions as this: this.0;

    /// Interpolation of look-ups in the plane.
    get interpolation -> &'static str = name_of(&INTERPOLATIONS, this.0.interpolation);

    /// Bytes that the slices may take.
    field memory_limit -> u64;
}
