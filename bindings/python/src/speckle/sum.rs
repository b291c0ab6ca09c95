use pyo3::prelude::*;
use tem00_speckle::{self as physics, SpeckleError};

use super::{field::PupilField, images::check_room, pattern::SpecklePattern};
use crate::{
    arrays::{Array, Components, Values, Whole, array},
    error::{IntoPython, OrRaise, refused},
};

/// Independent speckle patterns whose intensities add, each with its fraction of the light.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct IncoherentSum(physics::IncoherentSum);

#[pymethods]
impl IncoherentSum {
    /// The largest number of patterns in a sum.
    #[classattr]
    const MAX_PATTERNS: usize = physics::IncoherentSum::MAX_PATTERNS;

    /// Return the sum of patterns of equal mean.
    ///
    /// Parameters
    /// ----------
    /// count : int
    ///     Number of patterns, 1 to `MAX_PATTERNS`.
    #[staticmethod]
    fn equal(count: Whole<'_>) -> PyResult<Self> {
        let sum = physics::IncoherentSum::equal(count.unsigned("count")?);
        Ok(Self(sum.or_raise()?))
    }

    /// Return the sum of patterns of given mean intensities.
    ///
    /// Parameters
    /// ----------
    /// weights : `array_like`, shape (n,)
    ///     Mean intensities in any unit, 0 or more.
    #[staticmethod]
    fn weighted(weights: Components<'_>) -> PyResult<Self> {
        let sum = physics::IncoherentSum::weighted(weights.finite("weights")?);
        Ok(Self(sum.or_raise()?))
    }

    /// Return this sum with every pattern split as `other` is: light that both laws divide.
    fn split_by(&self, other: &Self) -> PyResult<Self> {
        Ok(Self(self.0.split_by(&other.0).or_raise()?))
    }

    /// Weights of the patterns, which sum to 1, float64 of shape (n,).
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let weights = self.0.weights().to_vec();
        Ok(array(py, &[weights.len()], weights)?.into_any())
    }

    /// Return one field for each pattern: `field` itself, then the same with seeds made from its own.
    ///
    /// Parameters
    /// ----------
    /// field : `PupilField`
    ///     Field of random phasors.
    fn fields(&self, field: &PupilField) -> PyResult<Vec<PupilField>> {
        let fields = self.0.fields(&field.0).or_raise()?;
        Ok(fields.into_iter().map(PupilField).collect())
    }

    /// Return the sum of what `part` makes of each of the fields, by their weights.
    ///
    /// Parameters
    /// ----------
    /// field : `PupilField`
    ///     Field of random phasors.
    /// part : callable, optional
    ///     Function of a field that returns a `SpecklePattern`; `PupilField.pattern` by default.
    #[pyo3(signature = (field, part = None))]
    fn pattern<'py>(
        &self,
        py: Python<'py>,
        field: &PupilField,
        part: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<SpecklePattern> {
        check_room(field.0.size(), 2 * 4)?;
        let sum = match part {
            None => py
                .detach(|| self.0.pattern(&field.0, physics::PupilField::pattern))
                .or_raise()?,
            Some(part) => {
                let sum = self.0.try_pattern(&field.0, of_one_size(part));
                sum.map_err(|Raised(error)| error)?
            }
        };
        Ok(SpecklePattern(sum))
    }

    /// Return the sum of the intensities that `part` gives for the patterns 0, 1, ..., in their
    /// weights.
    ///
    /// Parameters
    /// ----------
    /// part : callable
    ///     Function of the number of a pattern that returns intensities: a float or an array.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Sum in the shape of the intensities.
    fn intensity<'py>(&self, py: Python<'py>, part: &Bound<'py, PyAny>) -> PyResult<Values<'py>> {
        let mut sum = 0.0_f64.into_pyobject(py)?.into_any();
        for (index, weight) in self.0.weights().iter().enumerate() {
            sum = sum.add(part.call1((index,))?.mul(weight)?)?;
        }
        Ok(sum)
    }

    fn __repr__(&self) -> String {
        let (count, contrast) = (self.0.weights().len(), self.0.contrast());
        format!("<IncoherentSum: {count} patterns, contrast={contrast}>")
    }
}

methods! {
    impl IncoherentSum as this: this.0;

    /// Return partially polarised light.
    ///
    /// Parameters
    /// ----------
    /// degree : float
    ///     Degree of polarisation of the light that reaches the sensor, 0 to 1.
    make partially_polarised(degree);

    /// Contrast of the sum of fully developed patterns.
    get contrast -> f64;
}

/// An exception on its way through a sum.
struct Raised(PyErr);

impl From<SpeckleError> for Raised {
    fn from(error: SpeckleError) -> Self {
        Self(error.into_python())
    }
}

impl From<PyErr> for Raised {
    fn from(error: PyErr) -> Self {
        Self(error)
    }
}

/// Calls a Python function whose patterns must all have the size of the first.
fn of_one_size(
    part: &Bound<'_, PyAny>,
) -> impl FnMut(&physics::PupilField) -> Result<physics::SpecklePattern, Raised> {
    let mut size = None;
    move |field| {
        let pattern = part.call1((PupilField(field.clone()),))?;
        let pattern = pattern.cast::<SpecklePattern>().map_err(PyErr::from)?.get();
        let (own, first) = (pattern.0.size(), *size.get_or_insert(pattern.0.size()));
        if own != first {
            let message = format!("part must return patterns of one size, {first:?}, got {own:?}");
            return Err(Raised(refused("part", message)));
        }
        Ok(pattern.0.clone())
    }
}
