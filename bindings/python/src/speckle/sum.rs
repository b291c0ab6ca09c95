use pyo3::{
    prelude::*,
    types::{PyTuple, PyType},
};
use tem00_speckle::{self as physics, SpeckleError};

use super::{field::PupilField, images::check_room, pattern::SpecklePattern};
use crate::{
    arrays::{Array, Components, Values, Whole, array},
    error::{IntoPython, OrRaise, refused},
};

/// A narrow Gaussian spectrum on a surface that spreads the optical path.
///
/// Parameters
/// ----------
/// wavelength : float
///     Central wavelength in metres.
/// linewidth : float
///     Full width at half maximum of the power per wavelength, in metres.
/// `path_spread` : float
///     Standard deviation of the optical path over the light that meets in a point, in metres: twice
///     that of the height, for a rough surface lit and seen along its normal.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bandwidth(physics::Bandwidth);

#[pymethods]
impl Bandwidth {
    #[new]
    const fn new(wavelength: f64, linewidth: f64, path_spread: f64) -> Self {
        Self(physics::Bandwidth {
            wavelength,
            linewidth,
            path_spread,
        })
    }

    fn __repr__(&self) -> String {
        let Self(band) = self;
        format!(
            "Bandwidth(wavelength={:e}, linewidth={:e}, path_spread={:e})",
            band.wavelength, band.linewidth, band.path_spread
        )
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let Self(band) = slf.get();
        let arguments = (band.wavelength, band.linewidth, band.path_spread);
        Ok((slf.get_type(), arguments.into_pyobject(slf.py())?))
    }
}

methods! {
    impl Bandwidth as this: this.0;

    /// Central wavelength in metres.
    field wavelength -> f64;

    /// Full width at half maximum in metres.
    field linewidth -> f64;

    /// Standard deviation of the optical path in metres.
    field path_spread -> f64;
}

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

    /// Return light of a Gaussian spectrum.
    ///
    /// Parameters
    /// ----------
    /// bandwidth : `Bandwidth`
    ///     Spectrum of the light and path spread of the surface.
    #[staticmethod]
    fn polychromatic(bandwidth: &Bandwidth) -> PyResult<Self> {
        let sum = physics::IncoherentSum::polychromatic(bandwidth.0);
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
