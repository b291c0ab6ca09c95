//! Beams fitted to measured data.

use pyo3::{exceptions::PyRuntimeError, prelude::*};
use tem00_optics::{self as physics, RadiusErrors};

use super::{gaussian::LocatedBeam, map::LIMIT};
use crate::{arguments::Take, arrays::named_class, error::refused};

pyo3::create_exception!(
    tem00.beam,
    FitError,
    PyRuntimeError,
    "Measured data that are valid each, but do not determine a beam together."
);

/// A fitted value and its standard error, in the same unit: `tem00._results.Estimate` in Python, a
/// number.
pub(crate) struct Estimate(physics::Estimate);

impl From<physics::Estimate> for Estimate {
    fn from(estimate: physics::Estimate) -> Self {
        Self(estimate)
    }
}

impl<'py> IntoPyObject<'py> for Estimate {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        named_class(py, "Estimate")?.call1((self.0.value, self.0.standard_error))
    }
}

class! {
    /// A Gaussian beam fitted to its radius measured at several positions: its caustic.
    ///
    /// The model is ``w(z) = √(w₀² + δ² (z − z₀)²)``, and ``M² = π w₀ δ / λ``. M² is not confined
    /// to 1 and above: noise may bring it below.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in metres.
    /// positions : array_like, shape (n,)
    ///     Positions along the beam, in metres; at least 4.
    /// radii : array_like, shape (n,)
    ///     Second-moment radii there, half of D4σ, in metres.
    /// errors : {"relative", "equal"} or array_like, shape (n,), optional
    ///     ``"relative"``, the default: proportional to the radius; ``"equal"``: the same for all.
    ///     The size of both follows from the scatter of the data. Numbers: the known standard
    ///     deviations, in metres.
    ///
    /// Raises
    /// ------
    /// FitError
    ///     If the data do not determine a beam.
    "tem00.beam" CausticFit(physics::CausticFit): Copy
}

methods! {
    impl CausticFit as this: this.0;

    #[new]
    #[pyo3(signature = (wavelength, positions, radii, errors = None))]
    build new(_py;
        wavelength: Bound<'py, PyAny>, positions: Bound<'py, PyAny>, radii: Bound<'py, PyAny>,
        errors: Option<Bound<'py, PyAny>>
    ) = {
        take!(wavelength: f64, positions: Vec<f64>, radii: Vec<f64>);
        let name = errors
            .as_ref()
            .and_then(|errors| errors.extract::<String>().ok());
        let known = match (errors, &name) {
            (Some(errors), None) => Some(deviations(&errors, radii.len())?),
            _ => None,
        };
        let errors = match (&known, name.as_deref()) {
            (Some(deviations), _) => RadiusErrors::Known(deviations),
            (None, None | Some("relative")) => RadiusErrors::Relative,
            (None, Some("equal")) => RadiusErrors::Equal,
            (None, Some(other)) => {
                let message =
                    format!("errors must be 'relative', 'equal' or numbers, got '{other}'");
                return Err(refused("errors", message));
            }
        };
        physics::CausticFit::with_errors(wavelength, &positions, &radii, errors)
            .map(Self)
            .map_err(|error| raised(error, "radii"))
    };

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

    /// Standard deviation of the data from the fit: relative to the radius, in metres for
    /// ``"equal"`` errors, in units of the known deviations for known ones.
    get residual_deviation -> f64;

    /// Return the fitted beam radius (1/e²) in metres.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Position, in metres.
    map radius_at(z);

    /// Return the fitted beam, seen from the position 0.
    ///
    /// Returns
    /// -------
    /// LocatedBeam
    ///     Refused where noise has brought M² below 1 or the fit is not paraxial.
    try beam() -> LocatedBeam = this.0.beam();

    shown waist_radius, waist_position, m_squared;
}

class! {
    /// A Gaussian beam fitted to the power that passes a knife edge moved across it.
    ///
    /// The model is ``P(x) = P₀/2 · erfc(±√2 (x − x₀) / w)``, and a constant background if asked
    /// for.
    ///
    /// Parameters
    /// ----------
    /// positions : array_like, shape (n,)
    ///     Positions of the edge, in metres; at least 4, and 5 with a background.
    /// powers : array_like, shape (n,)
    ///     Power that passes there, in any unit.
    /// with_background : bool, optional
    ///     Whether a background is fitted too.
    ///
    /// Raises
    /// ------
    /// FitError
    ///     If the data do not determine a beam.
    "tem00.beam" KnifeEdgeFit(physics::KnifeEdgeFit): Copy
}

methods! {
    impl KnifeEdgeFit as this: this.0;

    #[new]
    #[pyo3(signature = (positions, powers, with_background = false))]
    build new(_py;
        positions: Bound<'py, PyAny>, powers: Bound<'py, PyAny>, with_background: bool
    ) = {
        take!(positions: Vec<f64>, powers: Vec<f64>);
        let fit = match with_background {
            true => physics::KnifeEdgeFit::with_background(&positions, &powers),
            false => physics::KnifeEdgeFit::new(&positions, &powers),
        };
        fit.map(Self).map_err(|error| raised(error, "powers"))
    };

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

    shown radius, centre, power;
}

/// Known deviations, one for each radius.
fn deviations(errors: &Bound<'_, PyAny>, radii: usize) -> PyResult<Vec<f64>> {
    let deviations = Vec::take(errors, "errors")?;
    if deviations.len() == radii {
        return Ok(deviations);
    }
    let got = deviations.len();
    let message = format!("errors must be one for each radius, got {got} for {radii} radii");
    Err(refused("errors", message))
}

/// The exception for data that cannot be fitted; `values` is the name of what was measured.
fn raised(error: physics::FitError, values: &str) -> PyErr {
    let name = match &error {
        physics::FitError::Argument(argument) => argument.parameter(),
        physics::FitError::TooFewPoints { .. } | physics::FitError::EqualPositions => "positions",
        physics::FitError::LengthsDiffer { .. } => values,
        _ => return FitError::new_err(error.to_string()),
    };
    refused(name, error.to_string())
}
