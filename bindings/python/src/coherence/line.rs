use pyo3::prelude::*;
use tem00_coherence::{self as physics, LineShape};

use crate::{
    arrays::{Components, Whole, map},
    error::{OrRaise, refused},
};

/// The spectrum of a laser or of another narrow source: by default one Gaussian peak.
///
/// Parameters
/// ----------
/// wavelength : float
///     Central wavelength in metres.
/// linewidth : float
///     Full width at half maximum in metres, at most a tenth of the wavelength; 0 for light of one wavelength.
#[pyclass(frozen, eq, module = "tem00.coherence")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpectralLine(pub(crate) physics::SpectralLine);

#[pymethods]
impl SpectralLine {
    #[new]
    #[pyo3(signature = (wavelength, linewidth=0.0))]
    fn new(wavelength: f64, linewidth: f64) -> PyResult<Self> {
        Self::shaped(wavelength, linewidth, LineShape::Gaussian)
    }

    fn __repr__(&self) -> String {
        let (wavelength, length) = (self.0.wavelength(), self.0.coherence_length());
        format!("<SpectralLine: wavelength={wavelength:?}, coherence_length={length:?}>")
    }

    /// Return a Lorentzian line: long wings, as of a single mode of a diode.
    #[staticmethod]
    fn lorentzian(wavelength: f64, linewidth: f64) -> PyResult<Self> {
        Self::shaped(wavelength, linewidth, LineShape::Lorentzian)
    }

    /// Return a rectangular line, as of a wavelength that is swept during the exposure.
    #[staticmethod]
    fn rectangular(wavelength: f64, linewidth: f64) -> PyResult<Self> {
        Self::shaped(wavelength, linewidth, LineShape::Rectangular)
    }

    /// Return so many equal peaks without a width, the first and the last ``span`` apart, in metres.
    #[staticmethod]
    fn comb(wavelength: f64, span: f64, count: Whole<'_>) -> PyResult<Self> {
        let line = physics::SpectralLine::comb(wavelength, span, count.unsigned("count")?);
        Ok(Self(line.or_raise_renamed(&["peaks"], "count")?))
    }

    /// Return peaks without a width.
    ///
    /// Parameters
    /// ----------
    /// wavelengths : array_like, shape (n,)
    ///     Wavelengths in metres.
    /// powers : array_like, shape (n,)
    ///     The power of each, in any unit.
    #[staticmethod]
    fn from_peaks(wavelengths: Components<'_>, powers: Components<'_>) -> PyResult<Self> {
        let (wavelengths, powers) = (wavelengths.finite("wavelengths")?, powers.finite("powers")?);
        if wavelengths.len() != powers.len() {
            let message = format!(
                "powers must be as many as wavelengths, {}, got {}",
                wavelengths.len(),
                powers.len()
            );
            return Err(refused("powers", message));
        }
        let peaks: Vec<_> = wavelengths
            .iter()
            .zip(powers)
            .map(|(&w, &p)| [w, p])
            .collect();
        let line = physics::SpectralLine::from_peaks(&peaks);
        let line = line.or_raise_renamed(&["power"], "powers");
        Ok(Self(line?))
    }
}

impl SpectralLine {
    fn shaped(wavelength: f64, linewidth: f64, shape: LineShape) -> PyResult<Self> {
        let line = physics::SpectralLine::new(wavelength, linewidth, shape);
        Ok(Self(line.or_raise()?))
    }
}

methods! {
    impl SpectralLine as this: this.0;

    /// Wavelength of the mean wave number, in metres.
    get wavelength -> f64;

    /// Coherence length in metres; infinite for peaks without a width.
    get coherence_length -> f64;

    /// Return the squared degree of coherence.
    ///
    /// Parameters
    /// ----------
    /// path : float or array_like
    ///     Path difference in metres.
    map squared_coherence(path);

    /// Standard deviation, in rad/m, of a Gaussian line that is as wide between the quantiles where that has half its
    /// maximum.
    get effective_spread -> f64;

    /// Return the difference between a wave number drawn from the line and the mean one, in rad/m.
    ///
    /// Parameters
    /// ----------
    /// uniform : float or array_like
    ///     Random numbers from 0 to 1.
    map draw(uniform);
}
