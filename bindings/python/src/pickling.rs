use pyo3::{
    PyTypeInfo,
    prelude::*,
    types::{PyTuple, PyType},
};

/// Result of `__reduce__`: something to call, and its arguments.
pub(crate) type Recipe<'py> = (Bound<'py, PyAny>, (Bound<'py, PyType>,));

/// Returns how pickle makes an object of the class `T` again: by calling its static method `name`,
/// or the class itself for the name `new`, with these arguments.
pub(crate) fn by_constructor<'py, T: PyTypeInfo>(
    py: Python<'py>,
    name: &str,
    arguments: impl IntoPyObject<
        'py,
        Target = PyTuple,
        Output = Bound<'py, PyTuple>,
        Error: Into<PyErr>,
    >,
) -> PyResult<Recipe<'py>> {
    let name = if name == "new" { "__call__" } else { name };
    let mut all = vec![name.into_pyobject(py)?.into_any()];
    all.extend(arguments.into_pyobject(py).map_err(Into::into)?.iter());
    // Unlike a static method of an extension, this can be pickled.
    let call = py.import("operator")?.getattr("methodcaller")?;
    Ok((call.call1(PyTuple::new(py, all)?)?, (T::type_object(py),)))
}

/// Writes the call of a static method of a class, or of the class itself for the name `new`.
pub(crate) fn call(class: &str, name: &str, arguments: &[String]) -> String {
    let arguments = arguments.join(", ");
    match name {
        "new" => format!("{class}({arguments})"),
        _ => format!("{class}.{name}({arguments})"),
    }
}
