//! Elliptic beams with simple astigmatism.

use pyo3::prelude::*;
use tem00_beam as physics;
use tem00_beam::DVec3;

use super::{
    abcd::AbcdMatrix,
    arguments::{OrRaiseAs, coordinate, coordinates, map, map_inner, map_vector},
    cross_section::CrossSection,
    located::LocatedBeam,
};
use crate::{
    arrays::{Array, Numbers, wavelength_of_light},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// An elliptic Gaussian beam with simple astigmatism.
///
/// Two principal axes at right angles, each with its own waist, place of the waist and M². The beam
/// travels along +z from the reference plane z = 0, the aperture.
///
/// Parameters
/// ----------
/// x, y : LocatedBeam
///     The beams along x and along y, of one wavelength.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AstigmaticBeam(pub(super) physics::AstigmaticBeam);

#[pymethods]
impl AstigmaticBeam {
    #[new]
    fn new(x: &LocatedBeam, y: &LocatedBeam) -> PyResult<Self> {
        let beam = physics::AstigmaticBeam::new(x.0, y.0);
        Ok(Self(beam.or_raise_as(&[("wavelength", "y")])?))
    }

    /// Return the circular beam that is ``beam`` in both axes.
    ///
    /// Parameters
    /// ----------
    /// beam : LocatedBeam
    #[staticmethod]
    fn stigmatic(beam: &LocatedBeam) -> Self {
        Self(physics::AstigmaticBeam::stigmatic(beam.0))
    }

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
    #[staticmethod]
    fn from_divergences(wavelength: f64, divergences: [f64; 2]) -> PyResult<Self> {
        let wavelength = wavelength_of_light("wavelength", wavelength)?;
        let beam = physics::AstigmaticBeam::from_divergences(wavelength, divergences);
        Ok(Self(beam.or_raise_as(&[("divergence", "divergences")])?))
    }

    /// Return this beam with its waists at other distances from the reference plane.
    ///
    /// Parameters
    /// ----------
    /// waist_distances : (float, float)
    ///     Signed distances along the first and the second axis, in metres.
    fn with_waist_distances(&self, waist_distances: [f64; 2]) -> PyResult<Self> {
        let beam = self.0.with_waist_distances(waist_distances);
        Ok(Self(
            beam.or_raise_as(&[("waist_distance", "waist_distances")])?,
        ))
    }

    /// Return this beam with its first principal axis at another angle.
    ///
    /// Parameters
    /// ----------
    /// rotation : float
    ///     Angle in radians, from x towards y.
    fn with_rotation(&self, rotation: f64) -> PyResult<Self> {
        Ok(Self(self.0.with_rotation(rotation).or_raise()?))
    }

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
    fn through_axes(&self, systems: [PyRef<'_, AbcdMatrix>; 2]) -> PyResult<Self> {
        let beam = tem00_optics::through_axes(&self.0, systems.map(|system| system.0));
        Ok(Self(beam.or_raise_as(&[("determinant", "systems")])?))
    }

    /// Return the beam radii (1/e²) along the principal axes, in metres.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 2)
    ///     Radii in metres, with the axes last.
    fn radii_at<'py>(&self, py: Python<'py>, z: Numbers<'py>) -> PyResult<Array<'py>> {
        map_vector(py, [("z", &z)], |[z]| self.0.radii_at(z))
    }

    /// Return the distribution of the irradiance over a plane, along the principal axes.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Distance from the reference plane, in metres.
    fn cross_section_at(&self, z: f64) -> PyResult<CrossSection> {
        let z = coordinate("z", z)?;
        CrossSection::of(self.0.radii_at(z))
    }

    /// Return the wavefront curvatures along the principal axes, in 1/m, positive where diverging.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 2)
    ///     Curvatures in 1/m, with the axes last.
    fn curvatures_at<'py>(&self, py: Python<'py>, z: Numbers<'py>) -> PyResult<Array<'py>> {
        map_vector(py, [("z", &z)], |[z]| self.0.curvatures_at(z))
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

    fn __repr__(&self) -> String {
        let (x, y) = self.axes();
        let (x, y, rotation) = (x.__repr__(), y.__repr__(), self.0.rotation());
        format!("AstigmaticBeam(x={x}, y={y}).with_rotation({rotation:?})")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let (x, y) = self.axes();
        by_constructor::<Self>(py, "_restored", (x, y, self.rotation()))
    }

    /// Constructor that pickle calls.
    #[staticmethod]
    fn _restored(x: &LocatedBeam, y: &LocatedBeam, rotation: f64) -> PyResult<Self> {
        Self::new(x, y)?.with_rotation(rotation)
    }
}

methods! {
    impl AstigmaticBeam as this: this.0;

    /// The beams along the first and the second principal axis.
    get axes -> (LocatedBeam, LocatedBeam) = this.0.axes().map(LocatedBeam).into();

    /// Angle from x to the first principal axis, in radians.
    get rotation -> f64;

    /// Wavelength, in metres.
    get wavelength -> f64;

    /// Distances, in metres and ascending, at which the beam is circular; None where there are fewer.
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
