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
/// # Errors
///
/// As [`evaluate`].
pub(crate) fn fill<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    arguments: [Named<'_, 'py>; N],
    f: impl FnOnce([&[f64]; N], &mut [Vec<f64>; M]) + Send,
) -> PyResult<[Bound<'py, PyAny>; M]> {
    let columns = arguments.map(|(name, values)| Column {
        name,
        values: values.as_array(),
        limit: f64::MAX,
    });
    evaluate(py, columns, [&[]; M], f)
}

/// The values of one argument, or of one component of an argument that holds vectors.
pub(crate) struct Column<'a> {
    /// The name of the argument.
    pub(crate) name: &'static str,
    /// The values, in the shape that broadcasts with the others.
    pub(crate) values: ArrayViewD<'a, f64>,
    /// The largest magnitude that is allowed.
    pub(crate) limit: f64,
}

/// As [`fill`], for columns of any origin and for results that hold a vector or a matrix in each
/// place: `inner` is the shape of each, empty for a number.
///
/// A column that already has the common shape and lies in memory row by row is not copied. `f`
/// fills vectors component by component, all first components before all second ones. Python
/// nevertheless sees the components in the last axes, without a copy.
///
/// # Errors
///
/// Refuses values beyond their limit or not finite, shapes that do not fit together, and what memory
/// does not hold.
pub(crate) fn evaluate<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    columns: [Column<'_>; N],
    inner: [&[usize]; M],
    f: impl FnOnce([&[f64]; N], &mut [Vec<f64>; M]) + Send,
) -> PyResult<[Bound<'py, PyAny>; M]> {
    let shape = common_shape(&columns)?;
    let filled = py.detach(|| -> Result<[Vec<f64>; M], Refusal> {
        let mut slices = [const { Cow::Owned(Vec::new()) }; N];
        for (slice, column) in slices.iter_mut().zip(&columns) {
            *slice = column.broadcast(&shape)?;
            column.check(slice)?;
        }
        let mut out = zeros(slices[0].len(), inner)?;
        f(slices.each_ref().map(|values| &**values), &mut out);
        Ok(out)
    })?;
    let mut arrays = Vec::with_capacity(M);
    for (values, inner) in filled.into_iter().zip(inner) {
        arrays.push(into_python(py, &shape, inner, values)?);
    }
    arrays
        .try_into()
        .map_err(|_| PyRuntimeError::new_err("an array is missing"))
}

/// Why arguments were refused, said once the interpreter is at hand again.
enum Refusal {
    TooLarge {
        name: &'static str,
        value: f64,
        limit: f64,
    },
    Memory {
        bytes: usize,
    },
}

impl From<Refusal> for PyErr {
    fn from(refusal: Refusal) -> Self {
        match refusal {
            Refusal::TooLarge { name, value, limit } if limit < f64::MAX => refused(
                name,
                format!("{name} must be finite and within ±{limit:e} everywhere, got {value:e}"),
            ),
            Refusal::TooLarge { name, value, .. } => refused(
                name,
                format!("{name} is {value}, but must be finite everywhere"),
            ),
            Refusal::Memory { bytes } => {
                PyMemoryError::new_err(format!("the machine refused {bytes} bytes for an array"))
            }
        }
    }
}

impl Column<'_> {
    /// The values in the shape of all, borrowed where they already lie that way.
    fn broadcast(&self, shape: &[usize]) -> Result<Cow<'_, [f64]>, Refusal> {
        let Some(wide) = self.values.broadcast(IxDyn(shape)) else {
            return Ok(Cow::Borrowed(&[]));
        };
        if let Some(slice) = wide.to_slice() {
            return Ok(Cow::Borrowed(slice));
        }
        let mut copy = reserved(wide.len())?;
        copy.extend(wide.iter());
        Ok(Cow::Owned(copy))
    }

    /// Whether a value is within the limit; one of `f64::MAX` allows all that is finite.
    fn allows(&self, value: f64) -> bool {
        value.abs() <= self.limit
    }

    fn check(&self, values: &[f64]) -> Result<(), Refusal> {
        match values.iter().find(|value| !self.allows(**value)) {
            None => Ok(()),
            Some(&value) => Err(Refusal::TooLarge {
                name: self.name,
                value,
                limit: self.limit,
            }),
        }
    }
}

/// The shape that all arguments broadcast to, by NumPy's rule.
fn common_shape(columns: &[Column<'_>]) -> PyResult<Vec<usize>> {
    let mut common: Vec<usize> = Vec::new();
    for Column { name, values, .. } in columns {
        let shape = values.shape();
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

/// Room for `length` results of each inner shape.
fn zeros<const M: usize>(length: usize, inner: [&[usize]; M]) -> Result<[Vec<f64>; M], Refusal> {
    let mut out = [const { Vec::new() }; M];
    for (values, inner) in out.iter_mut().zip(inner) {
        let count = length.saturating_mul(inner.iter().product());
        *values = reserved(count)?;
        values.resize(count, 0.0);
    }
    Ok(out)
}

/// An empty list with room for `count` numbers.
fn reserved(count: usize) -> Result<Vec<f64>, Refusal> {
    let mut values = Vec::new();
    let bytes = count.saturating_mul(size_of::<f64>());
    values
        .try_reserve_exact(count)
        .map_err(|_| Refusal::Memory { bytes })?;
    Ok(values)
}

/// A float for the shape of a number, else an array that owns the values, with the inner shape in
/// its last axes.
fn into_python<'py>(
    py: Python<'py>,
    shape: &[usize],
    inner: &[usize],
    values: Vec<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    if let ([], [], [value]) = (shape, inner, values.as_slice()) {
        return Ok(PyFloat::new(py, *value).into_any());
    }
    let in_memory = [inner, shape].concat();
    let axes: Vec<usize> = (inner.len()..in_memory.len())
        .chain(0..inner.len())
        .collect();
    let array = PyArray1::from_vec(py, values).reshape(in_memory)?;
    Ok(array.permute(Some(axes))?.into_any())
}
