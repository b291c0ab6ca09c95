//! Circular beams.

use pyo3::prelude::*;
use tem00_beam as physics;
use tem00_beam::DVec3;

use super::{
    arguments::{OrRaiseAs, coordinate, coordinates, map, map_inner, try_map},
    cross_section::CrossSection,
};
use crate::{
    arrays::{Array, Numbers, Values},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// A circular Gaussian beam, or its partially coherent relative with M² > 1.
///
/// The beam travels along +z and its waist lies at z = 0. The wavelength λ in the medium it travels
/// in, the waist radius w₀ and the beam quality factor M² determine everything else::
///
///     z_R  = π w₀² / (M² λ)           Rayleigh range
///     w(z) = w₀ √(1 + (z / z_R)²)     beam radius, where the irradiance has fallen to 1/e²
///     δ    = M² λ / (π w₀)            divergence, half-angle
///
/// Paraxial: waists below ``2 M² λ / π``, where the divergence reaches 0.5 rad, are refused.
///
/// Examples
/// --------
/// >>> from tem00.beam import GaussianBeam
/// >>> beam = GaussianBeam.from_waist(wavelength=632.8e-9, waist_radius=100e-6)
/// >>> round(beam.rayleigh_range, 5)
/// 0.04965
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GaussianBeam(pub(super) physics::GaussianBeam);

#[pymethods]
impl GaussianBeam {
    /// Return this beam with another beam quality factor M² and the same waist radius.
    ///
    /// Parameters
    /// ----------
    /// m_squared : float
    ///     Beam quality factor, at least 1, and small enough for the waist to stay paraxial.
    fn with_m_squared(&self, m_squared: f64) -> PyResult<Self> {
        let beam = self.0.with_m_squared(m_squared);
        Ok(Self(beam.or_raise_as(&[("waist_radius", "m_squared")])?))
    }

    /// Return the full length over which the radius stays within ``growth`` times the waist.
    ///
    /// Parameters
    /// ----------
    /// growth : float or array_like
    ///     Factor by which the radius may grow, greater than 1.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Depth of focus in metres, in the shape of ``growth``.
    fn depth_of_focus<'py>(&self, py: Python<'py>, growth: Numbers<'py>) -> PyResult<Values<'py>> {
        try_map(py, ("growth", &growth), |g| self.0.depth_of_focus(g))
    }

    /// Return the distribution of the irradiance over a plane across the beam.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Signed distance from the waist, in metres.
    fn cross_section_at(&self, z: f64) -> PyResult<CrossSection> {
        let z = coordinate("z", z)?;
        CrossSection::of([self.0.radius_at(z); 2])
    }

    /// Return the energy-flow vector per watt of beam power, in 1/m².
    ///
    /// Its integral over any surface that cuts the whole beam is 1. A surface whose normal ``n`` lies
    /// on the lit side receives the irradiance ``max(0, -F·n)``.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates in the frame of the beam, in metres; they broadcast together.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 3)
    ///     Energy flow per watt, with its components in the last axis.
    fn flux_per_watt<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
    ) -> PyResult<Array<'py>> {
        let points = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        map_inner(py, points, &[3], |p| {
            self.0.flux_per_watt(DVec3::from(p)).to_array()
        })
    }

    pub(super) fn __repr__(&self) -> String {
        let (wavelength, waist_radius) = (self.0.wavelength(), self.0.waist_radius());
        let m_squared = match self.0.m_squared() {
            1.0 => String::new(),
            m_squared => format!(".with_m_squared({m_squared:?})"),
        };
        format!(
            "GaussianBeam.from_waist(wavelength={wavelength:?}, \
             waist_radius={waist_radius:?}){m_squared}"
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let beam = &self.0;
        let fields = (beam.wavelength(), beam.waist_radius(), beam.m_squared());
        by_constructor::<Self>(py, "_restored", fields)
    }

    /// Constructor that pickle calls, and Mitsuba's plugin, whose scenes have units of their own.
    #[staticmethod]
    fn _restored(wavelength: f64, waist_radius: f64, m_squared: f64) -> PyResult<Self> {
        let beam = physics::GaussianBeam::from_waist(wavelength, waist_radius).or_raise()?;
        Self(beam).with_m_squared(m_squared)
    }
}

methods! {
    impl GaussianBeam as this: this.0;

    unmade "from_waist or from_divergence";

    /// Return the diffraction-limited beam (M² = 1) of a wavelength and a waist radius.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in the medium the beam travels in, in metres.
    /// waist_radius : float
    ///     Radius of the waist (1/e²), in metres, at least ``2 λ / π``.
    make from_waist(wavelength: wavelength_of_light, waist_radius);

    /// Return the diffraction-limited beam (M² = 1) of a wavelength and a divergence.
    ///
    /// Where a data sheet gives the divergence and an M², ask for the divergence ``δ / M²`` and then
    /// for the M², which brings it back to ``δ``: ``with_m_squared`` keeps the waist.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in the medium the beam travels in, in metres.
    /// divergence : float
    ///     Far-field half-angle (1/e²), in radians, in (0, 0.5].
    make from_divergence(wavelength: wavelength_of_light, divergence);

    /// Wavelength in the medium the beam travels in, in metres.
    get wavelength -> f64;

    /// Radius of the waist (1/e²), in metres.
    get waist_radius -> f64;

    /// Beam quality factor M², 1 for a diffraction-limited beam.
    get m_squared -> f64;

    /// Rayleigh range ``π w₀² / (M² λ)``, in metres.
    get rayleigh_range -> f64;

    /// Far-field divergence half-angle ``M² λ / (π w₀)``, in radians.
    get divergence -> f64;

    /// Confocal parameter ``2 z_R``, in metres.
    get confocal_parameter -> f64;

    /// Beam parameter product ``w₀ δ``, in m·rad; 1e-6 m·rad are 1 mm·mrad.
    get beam_parameter_product -> f64;

    /// Return the beam radius (1/e²) in metres.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Signed distance from the waist, in metres.
    map radius_at(z);

    /// Return the full width at half maximum ``√(2 ln 2) w(z)`` in metres.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Signed distance from the waist, in metres.
    map fwhm_at(z);

    /// Return the D4σ width ``2 w(z)``, a diameter, in metres.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Signed distance from the waist, in metres.
    map d4_sigma_at(z);

    /// Return the wavefront curvature 1/R in 1/m, positive where the beam diverges.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Signed distance from the waist, in metres.
    map curvature_at(z);

    /// Return the Gouy phase ``atan(z / z_R)`` in radians.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Signed distance from the waist, in metres.
    map gouy_phase_at(z);

    /// Return the irradiance on the axis per watt of beam power, in 1/m².
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Signed distance from the waist, in metres.
    map peak_irradiance_per_watt(z);

    /// Return the irradiance per watt of beam power, in 1/m², on a plane across the beam.
    ///
    /// Parameters
    /// ----------
    /// r, z : float or array_like
    ///     Distance from the axis and signed distance from the waist, in metres; they broadcast
    ///     together.
    map irradiance_per_watt(r, z);

    /// Return the fraction of the power within a distance of the axis.
    ///
    /// Parameters
    /// ----------
    /// radius, z : float or array_like
    ///     Distance from the axis, 0 or more, and signed distance from the waist, in metres; they
    ///     broadcast together.
    map encircled_power(radius: not_negative, z);
}
