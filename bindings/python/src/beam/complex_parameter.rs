//! The complex beam parameter.

use pyo3::{prelude::*, types::PyComplex};

use super::arguments::{OrRaiseAs, try_map};
use crate::arrays::{Numbers, Values};

/// The complex beam parameter ``q = z + i z_R`` of a Gaussian beam in one plane.
///
/// It knows neither wavelength nor M²; together with the effective wavelength ``M² λ`` it also says
/// how wide the beam is.
///
/// Parameters
/// ----------
/// distance_from_waist : float
///     Signed distance past the waist, in metres, within ±1e30; negative where the beam converges.
/// rayleigh_range : float
///     Rayleigh range, in metres, from 1e-100 to 1e100.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ComplexBeamParameter(pub(super) tem00_optics::ComplexBeamParameter);

#[expect(clippy::wrong_self_convention, reason = "Python objects are borrowed")]
#[pymethods]
impl ComplexBeamParameter {
    #[new]
    fn new(distance_from_waist: f64, rayleigh_range: f64) -> PyResult<Self> {
        let parameter =
            tem00_optics::ComplexBeamParameter::new(distance_from_waist, rayleigh_range);
        let names = [("waist_distance", "distance_from_waist")];
        Ok(Self(parameter.or_raise_as(&names)?))
    }

    /// Return the parameter of a beam from what is seen of it in one plane.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Beam radius (1/e²), in metres.
    /// curvature : float
    ///     Wavefront curvature 1/R, in 1/m, positive where the beam diverges.
    /// effective_wavelength : float
    ///     ``M² λ``, in metres.
    #[staticmethod]
    fn from_radius_and_curvature(
        radius: f64,
        curvature: f64,
        effective_wavelength: f64,
    ) -> PyResult<Self> {
        let parameter = tem00_optics::ComplexBeamParameter::from_radius_and_curvature(
            radius,
            curvature,
            effective_wavelength,
        );
        let names = [("wavelength", "effective_wavelength")];
        Ok(Self(parameter.or_raise_as(&names)?))
    }

    /// Return the beam radius (1/e²), in metres.
    ///
    /// Parameters
    /// ----------
    /// effective_wavelength : float or array_like
    ///     ``M² λ``, in metres.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Radius in metres, in the shape of ``effective_wavelength``.
    fn radius<'py>(
        &self,
        py: Python<'py>,
        effective_wavelength: Numbers<'py>,
    ) -> PyResult<Values<'py>> {
        let argument = ("effective_wavelength", &effective_wavelength);
        try_map(py, argument, |wavelength| self.0.radius(wavelength))
    }

    /// Return the parameter as a complex number, in metres.
    fn to_complex<'py>(&self, py: Python<'py>) -> Bound<'py, PyComplex> {
        let q = self.0.to_complex();
        PyComplex::from_doubles(py, q.re, q.im)
    }

    /// Return the parameter as a complex number, in metres.
    fn __complex__<'py>(&self, py: Python<'py>) -> Bound<'py, PyComplex> {
        let q = self.0.to_complex();
        PyComplex::from_doubles(py, q.re, q.im)
    }
}

methods! {
    impl ComplexBeamParameter as this: this.0;

    /// Signed distance past the waist, in metres.
    get distance_from_waist -> f64;

    /// Rayleigh range, in metres.
    get rayleigh_range -> f64;

    /// Wavefront curvature 1/R, in 1/m, positive where the beam diverges.
    get curvature -> f64;

    /// Gouy phase, in radians.
    get gouy_phase -> f64;

    made_by new(distance_from_waist, rayleigh_range);
}
