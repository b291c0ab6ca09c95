//! Beams seen from a reference plane.

use pyo3::prelude::*;
use tem00_beam as physics;

use super::{
    arguments::{coordinate, map},
    complex_parameter::ComplexBeamParameter,
    cross_section::CrossSection,
    gaussian::GaussianBeam,
};
use crate::{
    arrays::wavelength_of_light,
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// A Gaussian beam and where its waist lies, seen from a reference plane.
///
/// The beam travels along +z, z = 0 is the reference plane, and the waist lies at
/// ``z = waist_distance``: positive where it is still to come, negative where it has been passed or
/// is virtual.
///
/// Parameters
/// ----------
/// beam : GaussianBeam
/// waist_distance : float
///     Signed distance from the reference plane to the waist, in metres, within ±1e30.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LocatedBeam(pub(super) physics::LocatedBeam);

#[pymethods]
impl LocatedBeam {
    #[new]
    fn new(beam: &GaussianBeam, waist_distance: f64) -> PyResult<Self> {
        Ok(Self(
            physics::LocatedBeam::new(beam.0, waist_distance).or_raise()?,
        ))
    }

    /// Return the distribution of the irradiance over a plane across the beam.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Signed distance from the reference plane, in metres.
    fn cross_section_at(&self, z: f64) -> PyResult<CrossSection> {
        let z = coordinate("z", z)?;
        CrossSection::of([self.0.radius_at(z); 2])
    }

    /// Return the beam behind a thin lens in the reference plane.
    ///
    /// Parameters
    /// ----------
    /// focal_length : float
    ///     Focal length in metres, positive for a focusing lens.
    ///
    /// Returns
    /// -------
    /// LocatedBeam
    ///     The beam seen from the lens.
    fn through_lens(&self, focal_length: f64) -> PyResult<Self> {
        Ok(Self(
            tem00_optics::through_lens(&self.0, focal_length).or_raise()?,
        ))
    }

    pub(super) fn __repr__(&self) -> String {
        let (beam, distance) = (self.beam().__repr__(), self.0.waist_distance());
        format!("LocatedBeam(beam={beam}, waist_distance={distance:?})")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.beam(), self.0.waist_distance()))
    }
}

methods! {
    impl LocatedBeam as this: this.0;

    /// The beam.
    get beam -> GaussianBeam = GaussianBeam(*this.0.beam());

    /// Signed distance from the reference plane to the waist, in metres.
    get waist_distance -> f64;

    /// Complex beam parameter in the reference plane.
    get complex_parameter -> ComplexBeamParameter = ComplexBeamParameter(tem00_optics::ComplexBeamParameter::of(&this.0));

    /// Return the beam radius (1/e²) in metres.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Signed distance from the reference plane, in metres.
    map radius_at(z);

    /// Return the wavefront curvature 1/R in 1/m, positive where the beam diverges.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Signed distance from the reference plane, in metres.
    map curvature_at(z);
}

// Here, as it makes a beam of this file from a parameter: that file does without this one.
#[expect(clippy::wrong_self_convention, reason = "Python objects are borrowed")]
#[pymethods]
impl ComplexBeamParameter {
    /// Return the beam of this parameter, seen from the plane of the parameter.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in the medium the beam travels in, in metres.
    /// m_squared : float
    ///     Beam quality factor, at least 1.
    fn to_located_beam(&self, wavelength: f64, m_squared: f64) -> PyResult<LocatedBeam> {
        let wavelength = wavelength_of_light("wavelength", wavelength)?;
        let beam = self.0.to_located_beam(wavelength, m_squared);
        Ok(LocatedBeam(beam.or_raise()?))
    }
}
