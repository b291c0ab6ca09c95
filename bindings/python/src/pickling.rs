//! Representation and pickling of objects.

use std::hash::{DefaultHasher, Hash, Hasher};

use numpy::Complex32;
use pyo3::{
    PyTypeInfo,
    prelude::*,
    types::{IntoPyDict, PyTuple, PyType},
};

use crate::arrays::ImageArray;

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

/// Attributes of an object, arrays as lists.
pub(crate) fn plain<'py>(
    object: &Bound<'py, PyAny>,
    names: &[&str],
) -> PyResult<Bound<'py, PyTuple>> {
    let mut values = Vec::new();
    for name in names {
        let value = object.getattr(*name)?;
        values.push(match value.getattr_opt("tolist")? {
            Some(listed) => listed.call0()?,
            None => value,
        });
    }
    PyTuple::new(object.py(), values)
}

/// Writes attributes of an object: `a=1.0, b=[0.0, 1.0]`.
pub(crate) fn shown(object: &Bound<'_, PyAny>, names: &[&str]) -> PyResult<String> {
    let mut text = Vec::new();
    for (name, value) in names.iter().zip(plain(object, names)?) {
        text.push(format!("{name}={}", value.repr()?));
    }
    Ok(text.join(", "))
}

/// Writes the call that makes an object again, as [`by_constructor`] makes it, of its attributes.
pub(crate) fn call(object: &Bound<'_, PyAny>, name: &str, arguments: &[&str]) -> PyResult<String> {
    let class = object.get_type().name()?;
    let arguments = shown(object, arguments)?;
    Ok(match name {
        "new" => format!("{class}({arguments})"),
        _ => format!("{class}.{name}({arguments})"),
    })
}

/// Hashes what an object shows, which is equal for equal objects but for the sign of zeros.
pub(crate) fn hash(text: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    text.replace('-', "").hash(&mut hasher);
    hasher.finish()
}

/// An argument that makes an object again.
#[derive(IntoPyObject)]
pub(crate) enum Value {
    Number(f64),
    Count(usize),
    List(Vec<f64>),
    Image(ImageArray<Complex32>),
}

/// Writes arguments one after the other.
pub(crate) fn listed(py: Python<'_>, arguments: Vec<Value>) -> PyResult<String> {
    let mut text = Vec::new();
    for argument in arguments {
        text.push(argument.into_pyobject(py)?.repr()?.to_string());
    }
    Ok(text.join(", "))
}

/// The call of a static method, by keywords, that makes an object which does not keep its
/// arguments.
#[derive(Clone, Debug)]
pub(crate) struct Made {
    pub(crate) name: &'static str,
    pub(crate) keywords: Vec<(&'static str, f64)>,
}

impl Made {
    /// Writes the call.
    pub(crate) fn call(&self, class: &str) -> String {
        let all = self.keywords.iter();
        let all: Vec<_> = all
            .map(|(name, value)| format!("{name}={value:?}"))
            .collect();
        format!("{class}.{}({})", self.name, all.join(", "))
    }

    /// Returns how pickle makes an object of the class `T` again.
    pub(crate) fn recipe<'py, T: PyTypeInfo>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let keywords = self.keywords.clone().into_py_dict(py)?;
        let call = py.import("operator")?.getattr("methodcaller")?;
        Ok((
            call.call((self.name,), Some(&keywords))?,
            (T::type_object(py),),
        ))
    }
}
