//! Circular beams.

use pyo3::prelude::*;
use tem00_beam::{self as physics, DVec3};
use tem00_optics::{ComplexBeamParameter, through_lens};

use super::{abcd::Parameter, cross_section::CrossSection, map::LIMIT};
use crate::{
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

class! {
    /// A circular Gaussian beam, or its partially coherent relative with M² > 1.
    ///
    /// The beam travels along +z and its waist lies at z = 0. The wavelength λ in the medium it
    /// travels in, the waist radius w₀ and the beam quality factor M² determine everything else::
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
    "tem00.beam" GaussianBeam(physics::GaussianBeam): Copy
}

#[pymethods]
impl GaussianBeam {
    fn __repr__(&self) -> String {
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
        let beam = beam.with_m_squared(m_squared);
        Ok(Self(beam.or_raise_renamed(&["waist_radius"], "m_squared")?))
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
    make from_waist(wavelength: f64, waist_radius: f64);

    /// Return the diffraction-limited beam (M² = 1) of a wavelength and a divergence.
    ///
    /// Where a data sheet gives the divergence and an M², ask for the divergence ``δ / M²`` and
    /// then for the M², which brings it back to ``δ``: ``with_m_squared`` keeps the waist.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in the medium the beam travels in, in metres.
    /// divergence : float
    ///     Far-field half-angle (1/e²), in radians, in (0, 0.5].
    make from_divergence(wavelength: f64, divergence: f64);

    /// Return this beam with another beam quality factor M² and the same waist radius.
    ///
    /// Parameters
    /// ----------
    /// m_squared : float
    ///     Beam quality factor, at least 1, and small enough for the waist to stay paraxial.
    try with_m_squared(m_squared: f64) -> GaussianBeam =
        this.0.with_m_squared(m_squared).or_raise_renamed(&["waist_radius"], "m_squared");

    /// Return the full length, in metres, over which the radius stays within ``growth`` times the
    /// waist.
    ///
    /// Parameters
    /// ----------
    /// growth : float or array_like
    ///     Factor by which the radius may grow, greater than 1.
    try_map depth_of_focus(growth);

    /// Return the distribution of the irradiance over a plane across the beam.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Signed distance from the waist, in metres.
    try cross_section_at(z: f64) -> CrossSection =
        CrossSection::at("z", z, |z| [this.0.radius_at(z); 2]);

    /// Return the energy-flow vector per watt of beam power, in 1/m².
    ///
    /// Its integral over any surface that cuts the whole beam is 1. A surface whose normal ``n``
    /// lies on the lit side receives the irradiance ``max(0, -F·n)``.
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
    over flux_per_watt(x, y, z) -> [3] =
        |[x, y, z]| this.0.flux_per_watt(DVec3::new(x, y, z)).to_array();

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

class! {
    /// A Gaussian beam and where its waist lies, seen from a reference plane.
    ///
    /// The beam travels along +z, z = 0 is the reference plane, and the waist lies at ``z =
    /// waist_distance``: positive where it is still to come, negative where it has been passed or
    /// is virtual.
    ///
    /// Parameters
    /// ----------
    /// beam : GaussianBeam
    /// waist_distance : float
    ///     Signed distance from the reference plane to the waist, in metres, within ±1e30.
    "tem00.beam" LocatedBeam(physics::LocatedBeam): Copy
}

methods! {
    impl LocatedBeam as this: this.0;

    make new(beam: physics::GaussianBeam, waist_distance: f64);

    /// Return the beam of a complex beam parameter, seen from the plane of the parameter.
    ///
    /// Parameters
    /// ----------
    /// parameter : complex
    ///     ``q = z + i z_R``, in metres: signed distance past the waist, and Rayleigh range.
    /// wavelength : float
    ///     Wavelength in the medium the beam travels in, in metres.
    /// m_squared : float
    ///     Beam quality factor, at least 1.
    make from_complex_parameter(parameter: ComplexBeamParameter, wavelength: f64, m_squared: f64) =
        parameter.to_located_beam(wavelength, m_squared);

    /// Return the distribution of the irradiance over a plane across the beam.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Signed distance from the reference plane, in metres.
    try cross_section_at(z: f64) -> CrossSection =
        CrossSection::at("z", z, |z| [this.0.radius_at(z); 2]);

    /// Return the beam behind a thin lens in the reference plane, seen from the lens.
    ///
    /// Parameters
    /// ----------
    /// focal_length : float
    ///     Focal length in metres, positive for a focusing lens.
    try through_lens(focal_length: f64) -> LocatedBeam = through_lens(&this.0, focal_length);

    /// The beam.
    get beam -> GaussianBeam = this.0.beam().to_owned();

    /// Signed distance from the reference plane to the waist, in metres.
    get waist_distance -> f64;

    /// Complex beam parameter ``q = z + i z_R`` in the reference plane, in metres.
    get complex_parameter -> Parameter = ComplexBeamParameter::of(&this.0);

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

    made_by new(beam, waist_distance);
}
