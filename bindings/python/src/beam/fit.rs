//! Beams fitted to measured data.

use pyo3::{exceptions::PyRuntimeError, prelude::*};

use super::{
    arguments::{list, map},
    located::LocatedBeam,
};
use crate::{
    arrays::{Components, Numbers, wavelength_of_light},
    error::{OrRaise, refused},
};

pyo3::create_exception!(
    tem00.beam,
    FitError,
    PyRuntimeError,
    "Measured data that are valid each, but do not determine a beam together."
);

/// A fitted value and its standard error, in the same unit: `tem00._estimate.Estimate` in Python, a number.
pub(crate) struct Estimate(tem00_optics::Estimate);

impl From<tem00_optics::Estimate> for Estimate {
    fn from(estimate: tem00_optics::Estimate) -> Self {
        Self(estimate)
    }
}

impl<'py> IntoPyObject<'py> for Estimate {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        estimate_class(py)?.call1((self.0.value, self.0.standard_error))
    }
}

/// The class of fitted values.
pub(super) fn estimate_class(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    py.import("tem00._estimate")?.getattr("Estimate")
}

/// A Gaussian beam fitted to its radius measured at several positions: its caustic.
///
/// The model is ``w(z) = √(w₀² + δ² (z − z₀)²)``, and ``M² = π w₀ δ / λ``. The radii count with errors
/// proportional to the radius; ``with_errors`` takes other assumptions. M² is not confined to 1 and
/// above: noise may bring it below.
///
/// Parameters
/// ----------
/// wavelength : float
///     Wavelength in metres.
/// positions : array_like, shape (n,)
///     Positions along the beam, in metres; at least 4.
/// radii : array_like, shape (n,)
///     Second-moment radii there, half of D4σ, in metres.
///
/// Raises
/// ------
/// FitError
///     If the data do not determine a beam.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CausticFit(tem00_optics::CausticFit);

#[pymethods]
impl CausticFit {
    #[new]
    fn new(wavelength: f64, positions: Components<'_>, radii: Components<'_>) -> PyResult<Self> {
        Self::with_errors(wavelength, positions, radii, Errors::Relative)
    }

    /// Return the fit with errors of the radii as stated.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in metres.
    /// positions : array_like, shape (n,)
    ///     Positions along the beam, in metres; at least 4.
    /// radii : array_like, shape (n,)
    ///     Second-moment radii there, half of D4σ, in metres.
    /// errors : {"relative", "equal"} or array_like, shape (n,)
    ///     ``"relative"``: proportional to the radius; ``"equal"``: the same for all. The size of both
    ///     follows from the scatter of the data. Numbers: the known standard deviations, in metres.
    ///
    /// Raises
    /// ------
    /// FitError
    ///     If the data do not determine a beam.
    #[staticmethod]
    fn with_errors(
        wavelength: f64,
        positions: Components<'_>,
        radii: Components<'_>,
        errors: Errors<'_>,
    ) -> PyResult<Self> {
        let wavelength = wavelength_of_light("wavelength", wavelength)?;
        let (positions, radii) = (list("positions", &positions)?, list("radii", &radii)?);
        let known = errors.known(radii.len())?;
        let errors = match (&errors, known) {
            (_, Some(deviations)) => tem00_optics::RadiusErrors::Known(deviations),
            (Errors::Equal, None) => tem00_optics::RadiusErrors::Equal,
            _ => tem00_optics::RadiusErrors::Relative,
        };
        tem00_optics::CausticFit::with_errors(wavelength, positions, radii, errors)
            .map(Self)
            .map_err(|error| raised(error, "radii"))
    }

    /// Return the fitted beam, seen from the position 0.
    ///
    /// Returns
    /// -------
    /// LocatedBeam
    ///     Refused where noise has brought M² below 1 or the fit is not paraxial.
    fn beam(&self) -> PyResult<LocatedBeam> {
        Ok(LocatedBeam(self.0.beam().or_raise()?))
    }

    fn __repr__(&self) -> String {
        let [waist, position, m_squared] = [
            self.0.waist_radius(),
            self.0.waist_position(),
            self.0.m_squared(),
        ]
        .map(|estimate| format!("{:?} ± {:?}", estimate.value, estimate.standard_error));
        format!("<CausticFit: waist radius {waist} m, waist position {position} m, M² {m_squared}>")
    }
}

methods! {
    impl CausticFit as this: this.0;

    /// Waist radius w₀, in metres.
    get waist_radius -> Estimate;

    /// Position z₀ of the waist, in metres, on the axis of the measured positions.
    get waist_position -> Estimate;

    /// Far-field divergence half-angle δ, in radians.
    get divergence -> Estimate;

    /// Rayleigh range ``w₀ / δ``, in metres.
    get rayleigh_range -> Estimate;

    /// Beam parameter product ``w₀ δ``, in m·rad.
    get beam_parameter_product -> Estimate;

    /// Beam quality factor M².
    get m_squared -> Estimate;

    /// Standard deviation of the data from the fit: relative to the radius, in metres for ``"equal"``
    /// errors, in units of the known deviations for known ones.
    get residual_deviation -> f64;

    /// Return the fitted beam radius (1/e²) in metres.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Position, in metres.
    map radius_at(z);
}

/// A Gaussian beam fitted to the power that passes a knife edge moved across it.
///
/// The model is ``P(x) = P₀/2 · erfc(±√2 (x − x₀) / w)``; ``with_background`` adds a constant.
///
/// Parameters
/// ----------
/// positions : array_like, shape (n,)
///     Positions of the edge, in metres; at least 4.
/// powers : array_like, shape (n,)
///     Power that passes there, in any unit.
///
/// Raises
/// ------
/// FitError
///     If the data do not determine a beam.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KnifeEdgeFit(tem00_optics::KnifeEdgeFit);

#[pymethods]
impl KnifeEdgeFit {
    #[new]
    fn new(positions: Components<'_>, powers: Components<'_>) -> PyResult<Self> {
        let (positions, powers) = (list("positions", &positions)?, list("powers", &powers)?);
        let fit = tem00_optics::KnifeEdgeFit::new(positions, powers);
        fit.map(Self).map_err(|error| raised(error, "powers"))
    }

    /// Return the fit with a constant background.
    ///
    /// Parameters
    /// ----------
    /// positions : array_like, shape (n,)
    ///     Positions of the edge, in metres; at least 5.
    /// powers : array_like, shape (n,)
    ///     Power that passes there, in any unit.
    ///
    /// Raises
    /// ------
    /// FitError
    ///     If the data do not determine a beam.
    #[staticmethod]
    fn with_background(positions: Components<'_>, powers: Components<'_>) -> PyResult<Self> {
        let (positions, powers) = (list("positions", &positions)?, list("powers", &powers)?);
        let fit = tem00_optics::KnifeEdgeFit::with_background(positions, powers);
        fit.map(Self).map_err(|error| raised(error, "powers"))
    }

    fn __repr__(&self) -> String {
        let [radius, centre, power] = [self.0.radius(), self.0.centre(), self.0.power()]
            .map(|estimate| format!("{:?} ± {:?}", estimate.value, estimate.standard_error));
        format!("<KnifeEdgeFit: radius {radius} m, centre {centre} m, power {power}>")
    }
}

methods! {
    impl KnifeEdgeFit as this: this.0;

    /// Radius (1/e²) of the beam along the movement of the edge, in metres.
    get radius -> Estimate;

    /// Position of the centre of the beam, in metres.
    get centre -> Estimate;

    /// Power of the whole beam, in the unit of the measured powers.
    get power -> Estimate;

    /// Background, in the unit of the measured powers; None if none was fitted.
    get background -> Option<Estimate> = this.0.background().map(Into::into);

    /// Standard deviation of the data from the fit, in the unit of the measured powers.
    get residual_deviation -> f64;

    /// Return the fitted power, in the unit of the measured powers.
    ///
    /// Parameters
    /// ----------
    /// position : float or array_like
    ///     Position of the edge, in metres.
    map power_at(position);
}

/// Assumption on the errors of measured radii.
enum Errors<'py> {
    Relative,
    Equal,
    Known(Numbers<'py>),
}

impl<'py> FromPyObject<'_, 'py> for Errors<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match object.extract::<String>() {
            Err(_) => Ok(Self::Known(object.extract()?)),
            Ok(name) if name == "relative" => Ok(Self::Relative),
            Ok(name) if name == "equal" => Ok(Self::Equal),
            Ok(name) => {
                let message =
                    format!("errors must be 'relative', 'equal' or numbers, got '{name}'");
                Err(refused("errors", message))
            }
        }
    }
}

impl Errors<'_> {
    /// The known deviations, one for each radius, if they are known.
    fn known(&self, radii: usize) -> PyResult<Option<&[f64]>> {
        let Self::Known(numbers) = self else {
            return Ok(None);
        };
        let deviations = list("errors", numbers)?;
        if deviations.len() == radii {
            return Ok(Some(deviations));
        }
        let got = deviations.len();
        let message = format!("errors must be one for each radius, got {got} for {radii} radii");
        Err(refused("errors", message))
    }
}

/// The exception for data that cannot be fitted; `values` is the name of what was measured.
fn raised(error: tem00_optics::FitError, values: &str) -> PyErr {
    let name = match &error {
        tem00_optics::FitError::Argument(argument) => argument.parameter(),
        tem00_optics::FitError::TooFewPoints { .. } | tem00_optics::FitError::EqualPositions => {
            "positions"
        }
        tem00_optics::FitError::LengthsDiffer { .. } => values,
        _ => return FitError::new_err(error.to_string()),
    };
    refused(name, error.to_string())
}
