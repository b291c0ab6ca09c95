//! Elliptic beams with simple astigmatism.

use pyo3::prelude::*;
use tem00_beam::{self as physics, DVec3, LocatedBeam as Beam};

use super::{abcd::AbcdMatrix, cross_section::CrossSection, gaussian::LocatedBeam, map::LIMIT};
use crate::{
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

class! {
    /// An elliptic Gaussian beam with simple astigmatism.
    ///
    /// Two principal axes at right angles, each with its own waist, place of the waist and M². The
    /// beam travels along +z from the reference plane z = 0, the aperture.
    ///
    /// Parameters
    /// ----------
    /// x, y : LocatedBeam
    ///     The beams along x and along y, of one wavelength.
    "tem00.beam" AstigmaticBeam(physics::AstigmaticBeam): Copy
}

#[pymethods]
impl AstigmaticBeam {
    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let (x, y) = slf.get().axes();
        let [x, y] = [x, y].map(|axis| Bound::new(slf.py(), axis).and_then(|axis| axis.repr()));
        let rotation = slf.get().0.rotation();
        Ok(format!(
            "AstigmaticBeam({}, {}).with_rotation({rotation:?})",
            x?, y?
        ))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let (x, y) = self.axes();
        by_constructor::<Self>(py, "_restored", (x, y, self.rotation()))
    }
}

methods! {
    impl AstigmaticBeam as this: this.0;

    /// Return the beam behind a system whose matrices act along the principal axes of the beam.
    ///
    /// Parameters
    /// ----------
    /// systems : (AbcdMatrix, AbcdMatrix)
    ///     The matrices of the first and the second axis.
    ///
    /// Returns
    /// -------
    /// AstigmaticBeam
    ///     The beam seen from the output plane.
    call through_axes(_py; systems: [PyRef<'py, AbcdMatrix>; 2]) -> Self = {
        let beam = tem00_optics::through_axes(&this.0, systems.map(|system| system.0));
        Ok(Self(beam.or_raise_renamed(&["determinant"], "systems")?))
    };

    make new(x: Beam, y: Beam) =
        physics::AstigmaticBeam::new(x, y).or_raise_renamed(&["wavelength"], "y");

    /// Constructor that pickle calls.
    make _restored(x: Beam, y: Beam, rotation: f64) =
        physics::AstigmaticBeam::new(x, y).and_then(|beam| beam.with_rotation(rotation));

    /// Return the diffraction-limited beam of two divergences, with both waists at z = 0.
    ///
    /// Data sheets of laser diodes give the full width at half maximum θ: ``δ = θ / √(2 ln 2)``.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in metres.
    /// divergences : (float, float)
    ///     Far-field half-angles (1/e²) along x and y, in radians, in (0, 0.5].
    make from_divergences(wavelength: f64, divergences: [f64; 2]) =
        physics::AstigmaticBeam::from_divergences(wavelength, divergences)
            .or_raise_renamed(&["divergence"], "divergences");

    /// Return this beam with its waists at other distances from the reference plane.
    ///
    /// Parameters
    /// ----------
    /// waist_distances : (float, float)
    ///     Signed distances along the first and the second axis, in metres.
    try with_waist_distances(waist_distances: [f64; 2]) -> AstigmaticBeam =
        this.0.with_waist_distances(waist_distances)
            .or_raise_renamed(&["waist_distance"], "waist_distances");

    /// Return this beam with its first principal axis at another angle.
    ///
    /// Parameters
    /// ----------
    /// rotation : float
    ///     Angle in radians, from x towards y.
    try with_rotation(rotation: f64) -> AstigmaticBeam = this.0.with_rotation(rotation);

    /// Return the distribution of the irradiance over a plane, along the principal axes.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Distance from the reference plane, in metres.
    try cross_section_at(z: f64) -> CrossSection =
        CrossSection::at("z", z, |z| this.0.radii_at(z));

    /// Return the beam radii (1/e²) along the principal axes, in metres, in the last axis.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    over radii_at(z) -> [2] = |[z]| this.0.radii_at(z);

    /// Return the wavefront curvatures along the principal axes, in 1/m, in the last axis; positive
    /// where diverging.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    over curvatures_at(z) -> [2] = |[z]| this.0.curvatures_at(z);

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

    /// The beams along the first and the second principal axis.
    get axes -> (LocatedBeam, LocatedBeam) = {
        let [x, y] = this.0.axes().map(LocatedBeam);
        (x, y)
    };

    /// Angle from x to the first principal axis, in radians.
    get rotation -> f64;

    /// Wavelength, in metres.
    get wavelength -> f64;

    /// Distances, in metres and ascending, at which the beam is circular; None where there are
    /// fewer.
    get circular_planes -> (Option<f64>, Option<f64>);

    /// Return the Gouy phase, in radians: the mean of those of the two axes.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    map gouy_phase_at(z);

    /// Return the ratio of the smaller to the larger beam radius.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    map ellipticity_at(z);

    /// Return the irradiance on the axis per watt of beam power, in 1/m².
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    map peak_irradiance_per_watt(z);

    /// Return the irradiance per watt of beam power, in 1/m², on planes square to the axis.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates in the frame of the beam, in metres; they broadcast together.
    map irradiance_per_watt(x, y, z) = this.0.irradiance_per_watt(DVec3::new(x, y, z));
}
