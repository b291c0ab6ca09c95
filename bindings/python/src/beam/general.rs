//! Beams with general astigmatism.

use numpy::{Complex64, PyArray2};
use pyo3::{
    prelude::*,
    types::{PyComplex, PyComplexMethods},
};
use tem00_beam as physics;
use tem00_beam::DVec3;

use super::{
    arguments::{OrRaiseAs, coordinate, coordinates, map, map_inner, map_vector},
    astigmatic::AstigmaticBeam,
    astigmatic_system::AstigmaticSystem,
    cross_section::CrossSection,
    matrices::{Rows, matrix_of, rows_of},
    rows::array_of,
};
use crate::{
    arrays::{Array, Matrix, Numbers, Vector, wavelength_of_light},
    error::OrRaise,
};

/// The second moments of the phase space of a beam at one plane.
///
/// Covariances of the position ``(x, y)``, in metres, and the slope ``(s_x, s_y)`` of the rays. A radius
/// to 1/e² is twice a standard deviation: ``⟨x²⟩ = w²/4``.
///
/// Parameters
/// ----------
/// position : array_like, shape (2, 2)
///     ``⟨x xᵀ⟩``, in m²; symmetric.
/// mixed : array_like, shape (2, 2)
///     ``⟨x sᵀ⟩``, in metres, with the component of the position as row.
/// slope : array_like, shape (2, 2)
///     ``⟨s sᵀ⟩``; symmetric.
///
/// Notes
/// -----
/// The values are checked where a beam is made.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SecondMoments(physics::SecondMoments);

#[pymethods]
impl SecondMoments {
    #[new]
    fn new(position: Rows, mixed: Rows, slope: Rows) -> Self {
        Self(physics::SecondMoments {
            position: matrix_of(position),
            mixed: matrix_of(mixed),
            slope: matrix_of(slope),
        })
    }

    fn __repr__(&self) -> String {
        let (position, mixed, slope) = self.__getnewargs__();
        format!("SecondMoments(position={position:?}, mixed={mixed:?}, slope={slope:?})")
    }

    fn __getnewargs__(&self) -> (Rows, Rows, Rows) {
        let moments = &self.0;
        [moments.position, moments.mixed, moments.slope]
            .map(rows_of)
            .into()
    }
}

methods! {
    impl SecondMoments as this: this.0;

    /// Covariance of the position, in m², shape (2, 2).
    field position -> Matrix<2>;

    /// Covariance of position (rows) and slope (columns), in metres, shape (2, 2).
    field mixed -> Matrix<2>;

    /// Covariance of the slope, shape (2, 2).
    field slope -> Matrix<2>;
}

/// A Gaussian beam with general astigmatism: the ellipse of its irradiance may turn on its way, and it
/// may be twisted and partially coherent.
///
/// The beam travels along +z from the reference plane z = 0. Its phase space is a normal density of
/// position and slope. Made by ``from_astigmatic``, ``from_moments`` or ``from_complex_curvature``.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GeneralAstigmaticBeam(pub(super) physics::GeneralAstigmaticBeam);

#[pymethods]
impl GeneralAstigmaticBeam {
    /// Return a beam with simple astigmatism as one with general astigmatism.
    ///
    /// Parameters
    /// ----------
    /// beam : AstigmaticBeam
    #[staticmethod]
    fn from_astigmatic(beam: &AstigmaticBeam) -> Self {
        Self(beam.0.into())
    }

    /// Return the beam of second moments at z = 0.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in metres.
    /// moments : SecondMoments
    ///     Moments that light of this wavelength can have: M² is at least 1 in both modes.
    #[staticmethod]
    fn from_moments(wavelength: f64, moments: &SecondMoments) -> PyResult<Self> {
        let wavelength = wavelength_of_light("wavelength", wavelength)?;
        let beam = physics::GeneralAstigmaticBeam::from_moments(wavelength, &moments.0);
        Ok(Self(beam.or_raise()?))
    }

    /// Return the coherent beam of a complex curvature ``1/R − i λ/(π w²)``, as tensors, at z = 0.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Wavelength in metres.
    /// curvature : array_like of complex, shape (2, 2)
    ///     Complex curvature, in 1/m; symmetric, with a negative definite imaginary part.
    #[staticmethod]
    fn from_complex_curvature(wavelength: f64, curvature: [[Complex; 2]; 2]) -> PyResult<Self> {
        let wavelength = wavelength_of_light("wavelength", wavelength)?;
        let tensor = curvature.map(|row| row.map(|Complex(entry)| entry));
        let beam = physics::GeneralAstigmaticBeam::from_complex_curvature(wavelength, tensor);
        Ok(Self(beam.or_raise()?))
    }

    /// Return the beam seen from a reference plane further along.
    ///
    /// Parameters
    /// ----------
    /// distance : float
    ///     Signed distance, in metres, within ±1e30.
    fn propagated(&self, distance: f64) -> PyResult<Self> {
        let beam = self.0.propagated(coordinate("distance", distance)?);
        Ok(Self(beam.or_raise_as(&[("radius", "distance")])?))
    }

    /// Return the beam behind a system, with its reference plane at the exit of the system.
    ///
    /// Parameters
    /// ----------
    /// system : AstigmaticSystem
    fn through(&self, system: &AstigmaticSystem) -> PyResult<Self> {
        Ok(Self(self.0.through(&system.0).or_raise()?))
    }

    /// Return the second moments at a plane.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Distance from the reference plane, in metres.
    fn moments_at(&self, z: f64) -> PyResult<SecondMoments> {
        let z = coordinate("z", z)?;
        Ok(SecondMoments(self.0.moments_at(z)))
    }

    /// Return the beam radii (1/e²) along the principal axes, the larger one first, in metres.
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

    /// Return the distribution of the irradiance over a plane, the larger principal axis first.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Distance from the reference plane, in metres.
    fn cross_section_at(&self, z: f64) -> PyResult<CrossSection> {
        let z = coordinate("z", z)?;
        Ok(CrossSection(self.0.cross_section_at(z)))
    }

    /// Return the tensor, in 1/m, that takes a position to the mean slope of the rays there.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 2, 2)
    ///     Curvature of the wavefront of a coherent beam, in 1/m.
    fn curvature_tensor_at<'py>(&self, py: Python<'py>, z: Numbers<'py>) -> PyResult<Array<'py>> {
        map_inner(py, coordinates([("z", &z)])?, &[2, 2], |[z]| {
            self.0.curvature_tensor_at(z).transpose().to_cols_array()
        })
    }

    /// Return the complex curvature ``1/R − i λ/(π w²)``, as tensors, in 1/m.
    ///
    /// Parameters
    /// ----------
    /// z : float
    ///     Distance from the reference plane, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray of complex128, shape (2, 2)
    fn complex_curvature_at<'py>(
        &self,
        py: Python<'py>,
        z: f64,
    ) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        let z = coordinate("z", z)?;
        array_of(py, &self.0.complex_curvature_at(z))
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
        let [smaller, larger] = self.0.beam_quality();
        let (wavelength, radii) = (self.0.wavelength(), self.0.radii_at(0.0));
        format!(
            "<GeneralAstigmaticBeam: wavelength {wavelength:?}, radii {radii:?} at z = 0, beam \
             quality {smaller:?} and {larger:?}>"
        )
    }
}

methods! {
    impl GeneralAstigmaticBeam as this: this.0;

    unmade "from_astigmatic, from_moments or from_complex_curvature";

    /// Covariance of the positions of all rays of one slope, in m², shape (2, 2).
    get position_spread -> Matrix<2>;

    /// Matrix, in metres, shape (2, 2), that takes a slope to the mean position of its rays at z = 0.
    get position_per_slope -> Matrix<2>;

    /// Wavelength in the medium the beam travels in, in metres.
    get wavelength -> f64;

    /// Far-field divergence half-angles, in radians, shape (2,), the larger one first.
    get divergences -> Vector<2>;

    /// M² of the two modes of the beam, shape (2,), the smaller one first.
    get beam_quality -> Vector<2>;

    /// Twist ``⟨x s_y⟩ − ⟨y s_x⟩`` of the beam, in metres.
    get twist -> f64;

    /// Return the angle from x to the major axis of the irradiance, in radians.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the reference plane, in metres.
    map orientation_at(z);

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

/// A number that Python can make complex.
struct Complex(Complex64);

impl<'py> FromPyObject<'_, 'py> for Complex {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let complex = object.py().get_type::<PyComplex>().call1((object,))?;
        let complex = complex.cast_into::<PyComplex>()?;
        Ok(Self(Complex64::new(complex.real(), complex.imag())))
    }
}
