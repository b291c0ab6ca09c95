use pyo3::{
    prelude::*,
    types::{PyTuple, PyType},
};
use tem00_speckle as physics;

use crate::arrays::Whole;

/// Options of a stack.
///
/// Parameters
/// ----------
/// memory_limit : int
///     Bytes that the slices may take; 2**64 - 1 by default.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StackOptions(pub(super) physics::StackOptions);

#[pymethods]
impl StackOptions {
    #[new]
    #[pyo3(signature = (memory_limit = None))]
    fn new(memory_limit: Option<Whole<'_>>) -> PyResult<Self> {
        let memory_limit = memory_limit.map(|limit| limit.unsigned("memory_limit"));
        Ok(Self(physics::StackOptions {
            memory_limit: memory_limit.transpose()?.unwrap_or(u64::MAX),
        }))
    }

    fn __repr__(&self) -> String {
        format!("StackOptions(memory_limit={})", self.0.memory_limit)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let options = slf.get();
        let arguments = (options.0.memory_limit,);
        Ok((slf.get_type(), arguments.into_pyobject(slf.py())?))
    }
}

methods! {
    impl StackOptions as this: this.0;

    /// Bytes that the slices may take.
    field memory_limit -> u64;
}
