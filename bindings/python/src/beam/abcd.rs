//! Ray matrices of one transverse axis.

use pyo3::prelude::*;
use tem00_optics as physics;

use super::{
    arguments::{OrRaiseAs, components, map_inner},
    complex_parameter::ComplexBeamParameter,
    located::LocatedBeam,
};
use crate::{
    arrays::{Array, Vectors},
    error::{OrRaise, refused},
};

/// A thick lens in air.
///
/// A curvature 1/R is positive where the centre of the sphere lies beyond the surface, along +z, and
/// 0 for a flat surface. A biconvex lens has a positive front and a negative back curvature.
///
/// Parameters
/// ----------
/// index : float
///     Refractive index of the glass, from 0.001 to 1000.
/// front_curvature, back_curvature : float
///     Curvatures of the surfaces that the light enters and leaves by, in 1/m, within ±1e30.
/// thickness : float
///     Distance of the surfaces on the axis, in metres, from 0 to 1e30.
///
/// Notes
/// -----
/// The values are checked where a matrix is made.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ThickLens(physics::ThickLens);

#[pymethods]
impl ThickLens {
    #[new]
    fn new(index: f64, front_curvature: f64, back_curvature: f64, thickness: f64) -> Self {
        Self(physics::ThickLens {
            index,
            front_curvature,
            back_curvature,
            thickness,
        })
    }

    fn __repr__(&self) -> String {
        let (index, front, back, thickness) = self.__getnewargs__();
        format!(
            "ThickLens(index={index:?}, front_curvature={front:?}, back_curvature={back:?}, \
             thickness={thickness:?})"
        )
    }

    fn __getnewargs__(&self) -> (f64, f64, f64, f64) {
        let lens = &self.0;
        let [front, back] = [lens.front_curvature, lens.back_curvature];
        (lens.index, front, back, lens.thickness)
    }
}

methods! {
    impl ThickLens as this: this.0;

    /// Refractive index of the glass.
    field index -> f64;

    /// Curvature of the surface that the light enters, in 1/m.
    field front_curvature -> f64;

    /// Curvature of the surface that the light leaves by, in 1/m.
    field back_curvature -> f64;

    /// Distance of the surfaces on the axis, in metres.
    field thickness -> f64;
}

/// The ray matrix of a paraxial optical system, from an input plane to an output plane.
///
/// ::
///
///     x'  = A x + B s        x: height above the axis, in metres
///     s'  = C x + D s        s: slope dx/dz
///     det = A D − B C = n_in / n_out
///
/// The static methods are the elements, ``then`` joins them in the order of travel.
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
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AbcdMatrix(pub(super) physics::AbcdMatrix);

#[pymethods]
impl AbcdMatrix {
    #[new]
    fn new(a: f64, b: f64, c: f64, d: f64) -> PyResult<Self> {
        for (name, entry) in [("a", a), ("b", b), ("c", c), ("d", d)] {
            if !entry.is_finite() {
                let message = format!("{name} must be finite, got {entry}");
                return Err(refused(name, message));
            }
        }
        Ok(Self(physics::AbcdMatrix::new(a, b, c, d).or_raise()?))
    }

    /// Return the system that does nothing.
    #[staticmethod]
    fn identity() -> Self {
        Self(physics::AbcdMatrix::identity())
    }

    /// Return a thick lens in air, from the vertex of its front to the vertex of its back.
    ///
    /// Parameters
    /// ----------
    /// lens : ThickLens
    #[staticmethod]
    fn thick_lens(lens: &ThickLens) -> PyResult<Self> {
        let front = lens.0.front_curvature;
        let surface = if front.abs() <= 1e30 {
            "back_curvature"
        } else {
            "front_curvature"
        };
        let matrix = physics::AbcdMatrix::thick_lens(&lens.0);
        Ok(Self(matrix.or_raise_as(&[("curvature", surface)])?))
    }

    /// Return the matrices of a tilted mirror: in the plane of incidence, and across it.
    ///
    /// Parameters
    /// ----------
    /// curvature : float
    ///     1/R, in 1/m, positive for a concave mirror.
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

    /// Return a flat interface.
    ///
    /// Parameters
    /// ----------
    /// index_before, index_after : float
    ///     Refractive indices, from 0.001 to 1000.
    #[staticmethod]
    fn flat_interface(index_before: f64, index_after: f64) -> PyResult<Self> {
        Self::curved_interface(index_before, index_after, 0.0)
    }

    /// Return a curved interface.
    ///
    /// Parameters
    /// ----------
    /// index_before, index_after : float
    ///     Refractive indices, from 0.001 to 1000.
    /// curvature : float
    ///     1/R, in 1/m, positive where the centre of the sphere lies beyond the interface.
    #[staticmethod]
    fn curved_interface(index_before: f64, index_after: f64, curvature: f64) -> PyResult<Self> {
        let matrix = physics::AbcdMatrix::curved_interface(index_before, index_after, curvature);
        let side = if (1e-3..=1e3).contains(&index_before) {
            "index_after"
        } else {
            "index_before"
        };
        Ok(Self(matrix.or_raise_as(&[("index", side)])?))
    }

    /// Return the system of this one followed by ``next``.
    ///
    /// Parameters
    /// ----------
    /// next : AbcdMatrix
    ///
    /// Returns
    /// -------
    /// AbcdMatrix
    ///     The matrix product ``next · self``.
    fn then(&self, next: &Self) -> Self {
        Self(self.0.then(next.0))
    }

    /// Return the beam parameter that reproduces itself from the input to the output plane.
    ///
    /// Returns
    /// -------
    /// ComplexBeamParameter
    ///     Of the round trip of a resonator, that of its eigenmode.
    fn eigenmode(&self) -> PyResult<ComplexBeamParameter> {
        Ok(ComplexBeamParameter(self.0.eigenmode().or_raise()?))
    }

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
    fn transform_ray<'py>(&self, py: Python<'py>, ray: Vectors<'py>) -> PyResult<Array<'py>> {
        let columns = components::<2>(("ray", &ray))?;
        map_inner(py, columns, &[2], |ray| self.0.transform_ray(ray))
    }

    /// Return the complex beam parameter in the output plane for that in the input plane.
    ///
    /// Parameters
    /// ----------
    /// parameter : ComplexBeamParameter
    fn transform_parameter(
        &self,
        parameter: &ComplexBeamParameter,
    ) -> PyResult<ComplexBeamParameter> {
        let parameter = self.0.transform_parameter(&parameter.0);
        Ok(ComplexBeamParameter(parameter.or_raise()?))
    }

    /// Return the beam behind the system, seen from the output plane.
    ///
    /// Parameters
    /// ----------
    /// beam : LocatedBeam
    ///     The beam in front, seen from the input plane.
    fn transform(&self, beam: &LocatedBeam) -> PyResult<LocatedBeam> {
        Ok(LocatedBeam(self.0.transform(&beam.0).or_raise()?))
    }

    fn __repr__(&self) -> String {
        let matrix = &self.0;
        let [a, b, c, d] = [matrix.a(), matrix.b(), matrix.c(), matrix.d()];
        format!("AbcdMatrix(a={a:?}, b={b:?}, c={c:?}, d={d:?})")
    }
}

methods! {
    impl AbcdMatrix as this: this.0;

    /// Return a path in one homogeneous medium.
    ///
    /// Parameters
    /// ----------
    /// length : float
    ///     Signed length, in metres, within ±1e30.
    make free_space(length);

    /// Return a thin lens.
    ///
    /// Parameters
    /// ----------
    /// focal_length : float
    ///     Signed focal length, in metres, positive for a focusing lens.
    make thin_lens(focal_length);

    /// Return a mirror at normal incidence.
    ///
    /// Parameters
    /// ----------
    /// curvature : float
    ///     1/R, in 1/m, positive for a concave, focusing mirror.
    make curved_mirror(curvature);

    /// Return a path inside a medium whose index falls off as ``n₀ (1 − g² r² / 2)``.
    ///
    /// Parameters
    /// ----------
    /// gradient : float
    ///     g, in 1/m, from 0 to 1e30.
    /// length : float
    ///     Signed length, in metres, within ±1e30.
    make grin(gradient, length);

    /// Return a rod of such a medium with flat faces, in air.
    ///
    /// Parameters
    /// ----------
    /// index : float
    ///     Refractive index n₀ on the axis, from 0.001 to 1000.
    /// gradient : float
    ///     g, in 1/m, from 0 to 1e30.
    /// length : float
    ///     Length, in metres, within ±1e30.
    make grin_rod(index, gradient, length);

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
}
