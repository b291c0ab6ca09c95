//! Arrays in and out: numbers of any shape, broadcast together as NumPy does it.

use std::borrow::Cow;

use numpy::{
    AllowTypeChange, PyArray1, PyArrayLikeDyn, PyArrayMethods,
    ndarray::{ArrayViewD, IxDyn},
};
use pyo3::{
    exceptions::{PyMemoryError, PyRuntimeError},
    prelude::*,
    types::PyFloat,
};

use crate::error::refused;

/// A number, or an array of numbers of any shape, as an argument of a function.
pub(crate) type Numbers<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// An argument and its name.
pub(crate) type Named<'a, 'py> = (&'static str, &'a Numbers<'py>);

/// Applies `f` to `N` arguments broadcast together, without the interpreter's lock: a float for
/// numbers, an array of the common shape for arrays.
///
/// # Errors
///
/// Refuses arguments that are not finite, and shapes that do not fit together.
pub(crate) fn map<'py, const N: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl Fn([f64; N]) -> f64 + Send + Sync,
) -> PyResult<Bound<'py, PyAny>> {
    let [values] = map_many(py, arguments, |x| [f(x)])?;
    Ok(values)
}

/// As [`map`], for functions with `M` values.
pub(crate) fn map_many<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl Fn([f64; N]) -> [f64; M] + Send + Sync,
) -> PyResult<[Bound<'py, PyAny>; M]> {
    fill(py, arguments, |columns, out| {
        for i in 0..columns[0].len() {
            let values = f(columns.map(|column| column[i]));
            for (out, value) in out.iter_mut().zip(values) {
                out[i] = value;
            }
        }
    })
}

/// Hands `N` arguments, broadcast together, to `f` as slices of equal length, and returns the `M`
/// slices that it fills, in the common shape; floats for numbers. Without the interpreter's lock.
///
/// An array that already has the common shape and lies in memory row by row is not copied.
///
/// # Errors
///
/// Refuses arguments that are not finite, shapes that do not fit together, and what memory does not
/// hold.
pub(crate) fn fill<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl FnOnce([&[f64]; N], &mut [Vec<f64>; M]) + Send,
) -> PyResult<[Bound<'py, PyAny>; M]> {
    let names = arguments.map(|(name, _)| name);
    let views = arguments.map(|(_, argument)| argument.as_array());
    let shape = common_shape(&names, &views)?;
    let filled = py.detach(|| -> Result<[Vec<f64>; M], Refusal> {
        let columns = views.each_ref().map(|view| broadcast(view, &shape));
        check_finite(&names, &columns)?;
        let mut out = zeros(columns[0].len())?;
        f(columns.each_ref().map(|column| &**column), &mut out);
        Ok(out)
    });
    let mut arrays = Vec::with_capacity(M);
    for values in filled? {
        arrays.push(into_python(py, &shape, values)?);
    }
    arrays
        .try_into()
        .map_err(|_| PyRuntimeError::new_err("an array is missing"))
}

/// Why arguments were refused, said once the interpreter is at hand again.
enum Refusal {
    NotFinite { name: &'static str, value: f64 },
    Memory { bytes: usize },
}

impl From<Refusal> for PyErr {
    fn from(refusal: Refusal) -> Self {
        match refusal {
            Refusal::NotFinite { name, value } => refused(
                name,
                format!("{name} is {value}, but must be finite everywhere"),
            ),
            Refusal::Memory { bytes } => {
                PyMemoryError::new_err(format!("the machine refused {bytes} bytes for the result"))
            }
        }
    }
}

/// The shape that all arguments broadcast to, by NumPy's rule.
fn common_shape<const N: usize>(
    names: &[&'static str; N],
    views: &[ArrayViewD<'_, f64>; N],
) -> PyResult<Vec<usize>> {
    let mut common: Vec<usize> = Vec::new();
    for (name, view) in names.iter().zip(views) {
        let shape = view.shape();
        let longer = shape.len().saturating_sub(common.len());
        common.splice(0..0, std::iter::repeat_n(1, longer));
        let skipped = common.len() - shape.len();
        for (side, &own) in common[skipped..].iter_mut().zip(shape) {
            if *side == 1 {
                *side = own;
            } else if own != 1 && own != *side {
                let message = format!(
                    "{name} has the shape {shape:?}, which does not broadcast with the arguments \
                     before it"
                );
                return Err(refused(name, message));
            }
        }
    }
    Ok(common)
}

/// The values in the shape of all, borrowed where they already lie that way.
fn broadcast<'a>(view: &'a ArrayViewD<'a, f64>, shape: &[usize]) -> Cow<'a, [f64]> {
    match view.broadcast(IxDyn(shape)) {
        Some(wide) => match wide.to_slice() {
            Some(slice) => Cow::Borrowed(slice),
            None => Cow::Owned(wide.iter().copied().collect()),
        },
        None => Cow::Borrowed(&[]),
    }
}

fn check_finite<const N: usize>(
    names: &[&'static str; N],
    columns: &[Cow<'_, [f64]>; N],
) -> Result<(), Refusal> {
    for (&name, column) in names.iter().zip(columns) {
        if let Some(&value) = column.iter().find(|value| !value.is_finite()) {
            return Err(Refusal::NotFinite { name, value });
        }
    }
    Ok(())
}

fn zeros<const M: usize>(length: usize) -> Result<[Vec<f64>; M], Refusal> {
    let mut out = [const { Vec::new() }; M];
    for values in &mut out {
        let bytes = length.saturating_mul(size_of::<f64>());
        values
            .try_reserve_exact(length)
            .map_err(|_| Refusal::Memory { bytes })?;
        values.resize(length, 0.0);
    }
    Ok(out)
}

/// A float for the shape of a number, else an array that owns the values.
fn into_python<'py>(
    py: Python<'py>,
    shape: &[usize],
    values: Vec<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    match (shape, values.as_slice()) {
        ([], [value]) => Ok(PyFloat::new(py, *value).into_any()),
        _ => Ok(PyArray1::from_vec(py, values)
            .reshape(shape.to_vec())?
            .into_any()),
    }
}
