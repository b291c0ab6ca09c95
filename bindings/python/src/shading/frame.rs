use pyo3::prelude::*;
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_shading::{self as physics, DVec2, DVec3, Motion};

use super::{any, vectors};
use crate::{
    arrays::{Array, Column, Numbers, Values, Vectors, evaluate, map_complex, map_inner},
    beam::named,
    decorrelation::RigidMotion,
};

/// The speckle of a body in a frame, made by ``Speckle.frame``.
///
/// Points and normals are given as they are now, and broadcast together. Where the camera does not see a point the
/// factor is 1; where the law has no value, as at a surface seen edge-on, the speckle is new. Neither points nor
/// normals that are NaN give NaN.
#[pyclass(frozen, module = "tem00.shading")]
#[derive(Clone, Debug)]
pub(crate) struct SpeckleFrame {
    pub(super) frame: physics::SpeckleFrame,
    pub(super) motion: Motion,
}

#[pymethods]
impl SpeckleFrame {
    /// Return the factors, with mean 1, that multiply the radiance which surfaces send from the laser to the camera.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (..., 3)
    ///     Points, in metres. Neighbours in the image, one after the other, are looked up fastest.
    /// normals : array_like, shape (..., 3)
    ///     Unit normals, to either side.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Factors, in the common shape.
    fn factor<'py>(
        &self,
        py: Python<'py>,
        points: Vectors<'py>,
        normals: Vectors<'py>,
    ) -> PyResult<Values<'py>> {
        let [factors] = ask(py, [&points, &normals], [&[]], |points, normals, [out]| {
            self.frame.factors(points, normals, out);
        })?;
        Ok(factors)
    }

    /// Return the factors at points that camera samples see at image points: out of focus those lie beside the ones where
    /// the centre of the lens sees the points.
    ///
    /// Parameters
    /// ----------
    /// pixels : array_like, shape (..., 2)
    ///     Image points of the samples, in pixels with y down.
    /// points, normals : array_like, shape (..., 3)
    ///     As for ``factor``.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Factors, in the common shape.
    fn factor_at<'py>(
        &self,
        py: Python<'py>,
        pixels: Vectors<'py>,
        points: Vectors<'py>,
        normals: Vectors<'py>,
    ) -> PyResult<Values<'py>> {
        let [x, y] = Column::components(("pixels", &pixels), &[2], f64::INFINITY)?;
        let [a, b, c, d, e, f] = hits([&points, &normals])?;
        let columns = [x, y, a, b, c, d, e, f];
        map_inner(py, columns, &[], |[x, y, a, b, c, d, e, f]| {
            let (point, normal) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
            [self.frame.factor_at(DVec2::new(x, y), point, normal)]
        })
    }

    /// Return the factors in light of one wave number of the laser's line each, for a renderer that draws one for each of
    /// its samples; ``factor`` is their mean over the line.
    ///
    /// Parameters
    /// ----------
    /// points, normals : array_like, shape (..., 3)
    ///     As for ``factor``.
    /// wave : array_like, shape (...)
    ///     Quantiles of the wave numbers in the line, from 0 to 1.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Factors, in the common shape.
    fn factor_in_wave<'py>(
        &self,
        py: Python<'py>,
        points: Vectors<'py>,
        normals: Vectors<'py>,
        wave: Numbers<'py>,
    ) -> PyResult<Values<'py>> {
        let [a, b, c, d, e, f] = hits([&points, &normals])?;
        let columns = [a, b, c, d, e, f, Column::new(("wave", &wave), 1.0)?];
        map_inner(py, columns, &[], |[a, b, c, d, e, f, wave]| {
            let (point, normal) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
            [self.frame.factor_in_wave(point, normal, wave)]
        })
    }

    /// Return the means of the factors over the pixels about the images of points, for a host with one sample per pixel.
    ///
    /// Parameters
    /// ----------
    /// points, normals : array_like, shape (..., 3)
    ///     As for ``factor``.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Means, in the common shape; 1 where the camera does not see the point.
    fn average<'py>(
        &self,
        py: Python<'py>,
        points: Vectors<'py>,
        normals: Vectors<'py>,
    ) -> PyResult<Values<'py>> {
        map_inner(py, hits([&points, &normals])?, &[], |[a, b, c, d, e, f]| {
            [self.frame.average(DVec3::new(a, b, c), DVec3::new(d, e, f))]
        })
    }

    /// Return the complex amplitudes of the first pattern, of mean square 1, for a host that adds fields.
    ///
    /// Parameters
    /// ----------
    /// points, normals : array_like, shape (..., 3)
    ///     As for ``factor``.
    ///
    /// Returns
    /// -------
    /// complex or ndarray of complex
    ///     Amplitudes, in the common shape; 0 where the camera does not see the point.
    fn amplitude<'py>(
        &self,
        py: Python<'py>,
        points: Vectors<'py>,
        normals: Vectors<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map_complex(py, hits([&points, &normals])?, |[a, b, c, d, e, f]| {
            let amplitude = self
                .frame
                .amplitude(DVec3::new(a, b, c), DVec3::new(d, e, f));
            amplitude.unwrap_or_default()
        })
    }

    /// Return what has become of the speckle at points since the reference state.
    ///
    /// Parameters
    /// ----------
    /// points, normals : array_like, shape (..., 3)
    ///     As for ``factor``.
    ///
    /// Returns
    /// -------
    /// SpeckleShift
    ///     The shifts, in the common shape.
    fn shift<'py>(
        &self,
        py: Python<'py>,
        points: Vectors<'py>,
        normals: Vectors<'py>,
    ) -> PyResult<Array<'py>> {
        let inner: [&[usize]; 5] = [&[2], &[], &[2], &[], &[]];
        let shifts = ask(py, [&points, &normals], inner, |points, normals, out| {
            let [displacement, pupil, across, axial, correlation] = out;
            let mut shifts = vec![None; pupil.len()];
            self.frame.shifts(points, normals, &mut shifts);
            for (i, shift) in shifts.into_iter().enumerate() {
                let shift = shift.unwrap_or(physics::SpeckleShift {
                    pupil: f64::INFINITY,
                    ..physics::SpeckleShift::default()
                });
                displacement[2 * i..][..2].copy_from_slice(&shift.displacement.to_array());
                across[2 * i..][..2].copy_from_slice(&shift.across.to_array());
                (pupil[i], axial[i]) = (shift.pupil, shift.axial);
                correlation[i] = pupil_overlap_correlation(shift.pupil);
            }
        })?;
        named(py, "SpeckleShift", shifts)
    }
}

methods! {
    impl SpeckleFrame as this: this.frame;

    unmade "Speckle.frame";

    /// Side of the reference state on which the speckle is: 1.0, or -1.0 where the pupil has moved over it the other way
    /// than in the frame in which it moves farthest.
    get side -> f64;

    /// Poses of the surface, the camera and the laser.
    get poses -> (RigidMotion, RigidMotion, RigidMotion) = {
        let motion = &this.motion;
        let [a, b, c] = [motion.surface, motion.camera, motion.laser].map(RigidMotion);
        (a, b, c)
    };

    /// Number of the body.
    get body -> usize = this.motion.body;

    shown poses, body;
}

/// The components of points and of their normals.
fn hits<'a>([points, normals]: [&'a Vectors<'_>; 2]) -> PyResult<[Column<'a>; 6]> {
    let ([a, b, c], [d, e, f]) = (any("points", points)?, any("normals", normals)?);
    Ok([a, b, c, d, e, f])
}

/// Hands points and their normals to `f` block by block, with where to write: as [`evaluate`].
fn ask<'py, const M: usize>(
    py: Python<'py>,
    [points, normals]: [&Vectors<'py>; 2],
    inner: [&[usize]; M],
    mut f: impl FnMut(&[DVec3], &[DVec3], [&mut [f64]; M]) + Send,
) -> PyResult<[Values<'py>; M]> {
    evaluate(
        py,
        hits([points, normals])?,
        inner,
        |[a, b, c, d, e, g], out| {
            f(&vectors([a, b, c]), &vectors([d, e, g]), out);
        },
    )
}
