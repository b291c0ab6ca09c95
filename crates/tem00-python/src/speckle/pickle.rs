//! Objects that are pickled as the call that makes them again.

use pyo3::{
    PyTypeInfo,
    prelude::*,
    types::{PyTuple, PyType},
};

/// What `__reduce__` returns: a function, and the class to call it with.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyType>,));

/// Says how to call a static method of the class of `T` again.
///
/// # Errors
///
/// As importing from the standard library.
pub(crate) fn reduce<'py, T: PyTypeInfo>(
    py: Python<'py>,
    constructor: &str,
    arguments: impl IntoPyObject<
        'py,
        Output = Bound<'py, PyTuple>,
        Target = PyTuple,
        Error: Into<PyErr>,
    >,
) -> PyResult<Reduced<'py>> {
    let arguments = arguments.into_pyobject(py).map_err(Into::into)?;
    let named = PyTuple::new(py, [constructor])?;
    let call = py
        .import("operator")?
        .getattr("methodcaller")?
        .call1(named.add(arguments)?.cast_into::<PyTuple>()?)?;
    Ok((call, (T::type_object(py),)))
}
