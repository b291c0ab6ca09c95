//! The fields of placed lights as rows of four, as a GPU buffer wants them.

use numpy::{
    Element, PyArray1, PyArray2, PyArrayDescr, PyArrayDescrMethods, PyArrayMethods, dtype,
};
use pyo3::prelude::*;

use crate::{arrays::Numbers, error::refused};

/// Largest deviation of the axes of a light from orthonormal: the rounding of single precision.
const ORTHONORMAL: f64 = 1e-6;

/// Rows that a user gave, checked.
pub(super) struct Rows<const N: usize>(pub(super) [[f64; 4]; N]);

impl<const N: usize> Rows<N> {
    /// Takes finite rows that place a light, its power and its cut-off.
    pub(super) fn placed(numbers: &Numbers<'_>) -> PyResult<Self> {
        if numbers.shape() != [N, 4] {
            let shape = numbers.shape();
            return Err(wrong(&format!(
                "must have the shape [{N}, 4], got {shape:?}"
            )));
        }
        let mut rows = [[0.0; 4]; N];
        rows.as_flattened_mut().copy_from_slice(numbers.values()?);
        let rows = Self(rows);
        rows.check_frame()?;
        rows.within(0, 3, "power", 0.0..=1e100)?;
        rows.within(1, 3, "cutoff", 1e-30..=1e30)?;
        Ok(rows)
    }

    /// Checks that a place holds a wavelength.
    pub(super) fn check_wavelength(&self, row: usize, place: usize) -> PyResult<()> {
        self.within(row, place, "wavelength", 1e-30..=1e30)
    }

    /// Checks that a row is the squared radius of a beam.
    pub(super) fn check_axis(&self, row: usize) -> PyResult<()> {
        self.within(row, 0, "w0_sq", 1e-60..=1e60)?;
        self.within(row, 1, "theta_sq", 1e-120..=0.2501)?;
        self.within(row, 2, "z0", -2e30..=2e30)
    }

    /// Checks the profile of a laser line and its fan.
    pub(super) fn check_fan(&self) -> PyResult<()> {
        self.within(2, 3, "apex_offset", 1e-30..=1e30)?;
        self.within(3, 3, "source_radius", 1e-60..=1e30)?;
        self.within(5, 0, "flat", 0.0..=1e30)?;
        self.within(5, 1, "sigma", 0.0..=1e30)?;
        self.code(5, 2, "variable", 3)?;
        self.within(5, 3, "mass", 1e-3..=1.0)?;
        self.within(6, 0, "half_slope", 1e-30..=1e30)?;
        self.code(6, 1, "focus_on_plane", 1)?;
        self.check_wavelength(6, 2)
    }

    /// Checks that a place holds a whole number from 0 to `largest`.
    fn code(&self, row: usize, place: usize, field: &str, largest: u8) -> PyResult<()> {
        let value = self.0[row][place];
        let is_code = |code: u8| value.total_cmp(&f64::from(code)).is_eq();
        if (0..=largest).any(is_code) {
            return Ok(());
        }
        Err(wrong(&format!(
            "must hold {field} as a whole number from 0 to {largest} in row {row}, got {value:e}"
        )))
    }

    fn check_frame(&self) -> PyResult<()> {
        for (place, axis) in ["x", "y", "z"].into_iter().enumerate() {
            self.within(0, place, &format!("origin.{axis}"), -1e30..=1e30)?;
        }
        let axes = [1, 2, 3].map(|row| [0, 1, 2].map(|place| self.0[row][place]));
        for (i, a) in axes.iter().enumerate() {
            for (j, b) in axes.iter().enumerate() {
                let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                let expected = if i == j { 1.0 } else { 0.0 };
                let allowed = expected - ORTHONORMAL..=expected + ORTHONORMAL;
                if !allowed.contains(&dot) {
                    return Err(wrong(&format!("must hold orthonormal axes, got {axes:?}")));
                }
            }
        }
        Ok(())
    }

    fn within(
        &self,
        row: usize,
        place: usize,
        field: &str,
        allowed: std::ops::RangeInclusive<f64>,
    ) -> PyResult<()> {
        let value = self.0[row][place];
        if allowed.contains(&value) {
            return Ok(());
        }
        let (low, high) = (allowed.start(), allowed.end());
        Err(wrong(&format!(
            "must hold {field} from {low:e} to {high:e} in row {row}, got {value:e}"
        )))
    }
}

fn wrong(what: &str) -> PyErr {
    refused("rows", format!("rows {what}"))
}

/// The precision of rows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Precision {
    Single,
    Double,
}

impl<'py> FromPyObject<'_, 'py> for Precision {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let py = object.py();
        let given = PyArrayDescr::new(py, object.to_owned())?;
        if given.is_equiv_to(&dtype::<f64>(py)) {
            Ok(Self::Double)
        } else if given.is_equiv_to(&dtype::<f32>(py)) {
            Ok(Self::Single)
        } else {
            let message = format!("dtype must be float64 or float32, got {given}");
            Err(refused("dtype", message))
        }
    }
}

/// Returns rows as a fresh array, shape (rows, `K`).
pub(super) fn array_of<'py, T: Element, const K: usize>(
    py: Python<'py>,
    rows: &[[T; K]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    PyArray1::from_slice(py, rows.as_flattened()).reshape([rows.len(), K])
}
