use pyo3::prelude::*;
use tem00_beam as physics;

use crate::{
    arrays::{Numbers, map},
    error::OrRaise,
};

/// Gaussian beams, laser lines, and the lights that a renderer places.
#[pymodule(submodule)]
pub(crate) mod beam {
    #[pymodule_export]
    use super::GaussianBeam;
}

/// A round Gaussian beam; z = 0 is its waist.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GaussianBeam(physics::GaussianBeam);

#[pymethods]
impl GaussianBeam {
    /// Return the beam of a wavelength and a waist radius (1/e²), both in metres.
    #[staticmethod]
    fn from_waist(wavelength: f64, waist_radius: f64) -> PyResult<Self> {
        let beam = physics::GaussianBeam::from_waist(wavelength, waist_radius).or_raise()?;
        Ok(Self(beam))
    }

    /// Return the beam radius (1/e²) in metres at the distance z from the waist, in metres.
    fn radius_at<'py>(&self, py: Python<'py>, z: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("z", &z)], |[z]| self.0.radius_at(z))
    }
}
