//! Ray matrices of one transverse axis.

use pyo3::{
    prelude::*,
    types::{PyComplex, PyComplexMethods},
};
use tem00_beam::LocatedBeam as Beam;
use tem00_optics::{self as physics, ComplexBeamParameter};

use super::{gaussian::LocatedBeam, map::LIMIT};
use crate::{
    arguments::{Take, extracted},
    error::{OrRaise, refused},
};

/// The complex beam parameter ``q = z + i z_R``: in Python a complex number.
pub(super) struct Parameter(ComplexBeamParameter);

impl From<ComplexBeamParameter> for Parameter {
    fn from(parameter: ComplexBeamParameter) -> Self {
        Self(parameter)
    }
}

impl<'py> IntoPyObject<'py> for Parameter {
    type Target = PyComplex;
    type Output = Bound<'py, PyComplex>;
    type Error = core::convert::Infallible;

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        let q = self.0.to_complex();
        Ok(PyComplex::from_doubles(py, q.re, q.im))
    }
}

impl<'py> Take<'py> for ComplexBeamParameter {
    fn take(given: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        let q: Bound<'_, PyComplex> = extracted(given, name)?;
        Self::new(q.real(), q.imag()).or_raise_renamed(&["waist_distance", "rayleigh_range"], name)
    }
}

class! {
    /// The ray matrix of a paraxial optical system, from an input plane to an output plane.
    ///
    /// ::
    ///
    ///     x'  = A x + B s        x: height above the axis, in metres
    ///     s'  = C x + D s        s: slope dx/dz
    ///     det = A D − B C = n_in / n_out
    ///
    /// The static methods are the elements, ``then`` joins them in the order of travel. Curvatures
    /// 1/R are in 1/m, refractive indices from 0.001 to 1000, lengths signed, in metres, within
    /// ±1e30.
    ///
    /// Parameters
    /// ----------
    /// a, b, c, d : float
    ///     Entries of the matrix; ``b`` is in metres and ``c`` in 1/m.
    ///
    /// Examples
    /// --------
    /// >>> from tem00.beam import AbcdMatrix
    /// >>> expander = (
    /// ...     AbcdMatrix.thin_lens(50e-3)
    /// ...     .then(AbcdMatrix.free_space(250e-3))
    /// ...     .then(AbcdMatrix.thin_lens(200e-3))
    /// ... )
    /// >>> round(expander.a, 12)
    /// -4.0
    "tem00.beam" AbcdMatrix(physics::AbcdMatrix): Copy
}

methods! {
    impl AbcdMatrix as this: this.0;

    make new(a: f64, b: f64, c: f64, d: f64) = {
        for (name, entry) in [("a", a), ("b", b), ("c", c), ("d", d)] {
            if !entry.is_finite() {
                return Err(refused(name, format!("{name} must be finite, got {entry}")));
            }
        }
        physics::AbcdMatrix::new(a, b, c, d).or_raise()
    };

    /// Return the system that does nothing.
    make identity() = PyResult::Ok(physics::AbcdMatrix::identity());

    /// Return a path in one homogeneous medium.
    make free_space(length: f64);

    /// Return a thin lens of a focal length, positive for a focusing lens.
    make thin_lens(focal_length: f64);

    /// Return a thick lens in air, from the vertex of its front to the vertex of its back.
    ///
    /// Parameters
    /// ----------
    /// index : float
    ///     Refractive index of the glass.
    /// front_curvature, back_curvature : float
    ///     Curvatures of the surfaces that the light enters and leaves by, positive where the
    ///     centre of the sphere lies beyond the surface. A biconvex lens has a positive front and a
    ///     negative back curvature.
    /// thickness : float
    ///     Distance of the surfaces on the axis, 0 or more.
    make thick_lens(index: f64, front_curvature: f64, back_curvature: f64, thickness: f64) = {
        let bad = [(front_curvature, "front_curvature"), (back_curvature, "back_curvature")]
            .into_iter()
            .find(|(curvature, _)| curvature.is_nan() || curvature.abs() > 1e30);
        let lens = physics::ThickLens { index, front_curvature, back_curvature, thickness };
        let matrix = physics::AbcdMatrix::thick_lens(&lens);
        matrix.or_raise_renamed(&["curvature"], bad.map_or("back_curvature", |(_, name)| name))
    };

    /// Return a mirror at normal incidence, of a positive curvature for a concave, focusing mirror.
    make curved_mirror(curvature: f64);

    /// Return a flat interface.
    make flat_interface(index_before: f64, index_after: f64) =
        interface(index_before, index_after, 0.0);

    /// Return a curved interface, of a positive curvature where the centre of the sphere lies
    /// beyond it.
    make curved_interface(index_before: f64, index_after: f64, curvature: f64) =
        interface(index_before, index_after, curvature);

    /// Return a path inside a medium whose index falls off as ``n₀ (1 − g² r² / 2)``.
    ///
    /// Parameters
    /// ----------
    /// gradient : float
    ///     g, in 1/m, from 0 to 1e30.
    /// length : float
    ///     Length of the path.
    make grin(gradient: f64, length: f64);

    /// Return a rod of such a medium with flat faces, in air.
    ///
    /// Parameters
    /// ----------
    /// index : float
    ///     Refractive index n₀ on the axis.
    /// gradient : float
    ///     g, in 1/m, from 0 to 1e30.
    /// length : float
    ///     Length of the rod.
    make grin_rod(index: f64, gradient: f64, length: f64);

    /// Return the system of this one followed by ``next``: the matrix product ``next · self``.
    fn then(next: physics::AbcdMatrix) -> AbcdMatrix = this.0.then(next);

    /// Return the complex beam parameter that reproduces itself from the input to the output plane.
    ///
    /// Of the round trip of a resonator it is that of the eigenmode.
    try eigenmode() -> Parameter = this.0.eigenmode();

    /// Return the complex beam parameter in the output plane for that in the input plane, in
    /// metres.
    try transform_parameter(parameter: ComplexBeamParameter) -> Parameter =
        this.0.transform_parameter(&parameter);

    /// Return the beam behind the system, seen from the output plane.
    ///
    /// Parameters
    /// ----------
    /// beam : LocatedBeam
    ///     The beam in front, seen from the input plane.
    try transform(beam: Beam) -> LocatedBeam = this.0.transform(&beam);

    /// Entry A: the height behind the system per height in front.
    get a -> f64;

    /// Entry B, in metres; 0 where the output plane is an image of the input plane.
    get b -> f64;

    /// Entry C, in 1/m; negative for a focusing system.
    get c -> f64;

    /// Entry D: the slope behind the system per slope in front.
    get d -> f64;

    /// Determinant, the refractive index in front over that behind.
    get determinant -> f64;

    /// Focal length on the side of the output, in metres; None for an afocal system.
    get focal_length -> Option<f64>;

    /// Distance from the output plane to the back focal point, in metres; None if afocal.
    get back_focal_distance -> Option<f64>;

    /// Distance from the output plane to the back principal plane, in metres; None if afocal.
    get back_principal_plane -> Option<f64>;

    /// Distance from the input plane to the front principal plane, in metres; None if afocal.
    get front_principal_plane -> Option<f64>;

    /// Half the trace of the matrix.
    get half_trace -> f64;

    /// True if rays stay near the axis however often they travel through the system.
    get is_stable -> bool;

    /// Return the rays behind the system.
    ///
    /// Parameters
    /// ----------
    /// ray : array_like, shape (..., 2)
    ///     Height above the axis, in metres, and slope of each ray in front.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 2)
    ///     Height and slope of each ray behind.
    over transform_ray(ray: 2) -> [2] = |ray| this.0.transform_ray(ray);

    made_by new(a, b, c, d);
}

#[pymethods]
impl AbcdMatrix {
    /// Return the matrices of a tilted mirror: in the plane of incidence, and across it.
    ///
    /// Parameters
    /// ----------
    /// curvature : float
    ///     Positive for a concave mirror.
    /// angle_of_incidence : float
    ///     Angle in radians, in (-π/2, π/2).
    ///
    /// Returns
    /// -------
    /// (AbcdMatrix, AbcdMatrix)
    ///     The tangential and the sagittal matrix.
    #[staticmethod]
    fn tilted_mirror(curvature: f64, angle_of_incidence: f64) -> PyResult<(Self, Self)> {
        let planes = physics::AbcdMatrix::tilted_mirror(curvature, angle_of_incidence);
        Ok(planes.or_raise()?.map(Self).into())
    }
}

/// Returns an interface; refuses the refractive index by its name.
fn interface(before: f64, after: f64, curvature: f64) -> PyResult<physics::AbcdMatrix> {
    let side = match (1e-3..=1e3).contains(&before) {
        true => "index_after",
        false => "index_before",
    };
    let matrix = physics::AbcdMatrix::curved_interface(before, after, curvature);
    matrix.or_raise_renamed(&["index"], side)
}
