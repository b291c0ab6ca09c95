use numpy::{Element, PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::{exceptions::PyMemoryError, prelude::*, types::PyFloat};
use tem00_decorrelation::{DMat3, DVec2, DVec3};
use tem00_numerics::available_memory;

/// Arrays below this many bytes are made without asking how much memory is left.
const SMALL: usize = 1 << 24;

/// Returns the number of elements of an array.
///
/// # Errors
///
/// Returns a `MemoryError` where no address counts that many.
pub(super) fn element_count(shape: &[usize]) -> PyResult<usize> {
    if shape.contains(&0) {
        return Ok(0);
    }
    shape
        .iter()
        .try_fold(1_usize, |count, &side| count.checked_mul(side))
        .ok_or_else(|| PyMemoryError::new_err(format!("no memory holds the shape {shape:?}")))
}

/// Refuses to copy an array of this shape if memory does not hold it.
///
/// # Errors
///
/// Returns a `MemoryError` then.
pub(super) fn check_copy(shape: &[usize], bytes_each: usize) -> PyResult<()> {
    let bytes = element_count(shape)?.saturating_mul(bytes_each);
    if is_too_much(bytes) {
        let message = format!("memory does not hold the {bytes} bytes of a copy of the argument");
        return Err(PyMemoryError::new_err(message));
    }
    Ok(())
}

fn is_too_much(bytes: usize) -> bool {
    bytes > SMALL && available_memory().is_some_and(|available| bytes as u64 > available)
}

/// Returns an array of zeros of each of these shapes.
///
/// # Errors
///
/// Returns a `MemoryError` where memory does not hold them.
pub(super) fn zeros_of<T: Copy + Default, const M: usize>(
    shapes: [&[usize]; M],
) -> PyResult<[Vec<T>; M]> {
    let mut counts = [0; M];
    for (count, shape) in counts.iter_mut().zip(shapes) {
        *count = element_count(shape)?;
    }
    let all = counts
        .iter()
        .fold(0, |sum: usize, &count| sum.saturating_add(count));
    let bytes = all.saturating_mul(size_of::<T>());
    let refusal = || {
        PyMemoryError::new_err(format!(
            "memory does not hold the {bytes} bytes of the result"
        ))
    };
    if is_too_much(bytes) {
        return Err(refusal());
    }
    let mut out = [const { Vec::new() }; M];
    for (values, count) in out.iter_mut().zip(counts) {
        values.try_reserve_exact(count).map_err(|_| refusal())?;
        values.resize(count, T::default());
    }
    Ok(out)
}

/// Moves values, row by row, into an array of this shape.
fn array<'py, T: Element>(
    py: Python<'py>,
    shape: &[usize],
    values: Vec<T>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    PyArray1::from_vec(py, values).reshape(shape.to_vec())
}

/// A float where all arguments are numbers, else an array of their common shape.
pub(crate) type Values<'py> = Bound<'py, PyAny>;

/// An array, with vectors or matrices in its last axes.
pub(crate) type Array<'py> = Bound<'py, PyAny>;

/// Numbers by their shape: in Python an array of float64. A vector has the shape (K,), a list (n,)
/// and a matrix, by its rows, (3, 3).
#[derive(Clone, Debug)]
pub(crate) struct Floats(Vec<usize>, Vec<f64>);

impl<const K: usize> From<[f64; K]> for Floats {
    fn from(components: [f64; K]) -> Self {
        Vec::from(components).into()
    }
}

impl From<Vec<f64>> for Floats {
    fn from(values: Vec<f64>) -> Self {
        Self(vec![values.len()], values)
    }
}

impl From<DVec2> for Floats {
    fn from(vector: DVec2) -> Self {
        vector.to_array().into()
    }
}

impl From<DVec3> for Floats {
    fn from(vector: DVec3) -> Self {
        vector.to_array().into()
    }
}

impl From<DMat3> for Floats {
    fn from(matrix: DMat3) -> Self {
        Self(vec![3, 3], matrix.transpose().to_cols_array().into())
    }
}

impl<'py> IntoPyObject<'py> for Floats {
    type Target = PyArrayDyn<f64>;
    type Output = Bound<'py, PyArrayDyn<f64>>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        array(py, &self.0, self.1)
    }
}

/// A float for the shape of a number, else an array.
pub(super) fn array_or_float<'py, T: Element + Copy + Into<f64>>(
    py: Python<'py>,
    shape: &[usize],
    values: Vec<T>,
) -> PyResult<Bound<'py, PyAny>> {
    match (shape, values.as_slice()) {
        ([], [value]) => Ok(PyFloat::new(py, (*value).into()).into_any()),
        _ => Ok(array(py, shape, values)?.into_any()),
    }
}

/// Defines a result without methods: in Python a named tuple of this name in `tem00._results`.
macro_rules! named_tuple {
    ($name:ident($inner:ty) as $this:ident: $fields:expr) => {
        pub(crate) struct $name($inner);

        impl From<$inner> for $name {
            fn from(inner: $inner) -> Self {
                Self(inner)
            }
        }

        impl<'py> pyo3::IntoPyObject<'py> for $name {
            type Target = pyo3::PyAny;
            type Output = pyo3::Bound<'py, pyo3::PyAny>;
            type Error = pyo3::PyErr;

            fn into_pyobject(self, py: pyo3::Python<'py>) -> pyo3::PyResult<Self::Output> {
                let $this = self.0;
                let class = $crate::arrays::named_class(py, stringify!($name))?;
                pyo3::types::PyAnyMethods::call1(&class, $fields)
            }
        }
    };
}

pub(crate) use named_tuple;

/// The class of a result without methods.
pub(crate) fn named_class<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("tem00._results")?.getattr(name)
}

/// Adds classes of results without methods to the module that they belong to.
pub(crate) fn add_named(module: &Bound<'_, PyModule>, names: &[&str]) -> PyResult<()> {
    for name in names {
        module.add(*name, named_class(module.py(), name)?)?;
    }
    Ok(())
}
