use pyo3::{prelude::*, types::PyComplex};
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_shading::{self as physics, DVec2, DVec3, Motion};

use super::arguments::{any, vectors};
use crate::{
    arrays::{Column, Numbers, Values, Vectors, evaluate},
    beam::records::record,
    decorrelation::RigidMotion,
};

record! {
    "tem00.shading",
    /// What has become of the speckle at points since the reference state.
    ///
    /// Where the law has no value, or the camera does not see the point, the speckle is new: ``pupil`` is infinite and
    /// all else 0.
    SpeckleShift {
        /// Displacement of the speckle in the image, in pixels with y down, shape (..., 2).
        displacement: Array,
        /// Displacement of the pupil over the speckle, in its diameters, shape (...).
        pupil: Values,
        /// The part of it across the line of sight, to the right and up, in pupil diameters, shape (..., 2).
        across: Array,
        /// Displacement along the axis, in axial decorrelation lengths, shape (...): positive towards the camera.
        axial: Values,
        /// Correlation of intensity that is left where the speckle has gone, in [0, 1], shape (...).
        correlation: Values,
    }
}

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
        let ([a, b, c], [d, e, f]) = (any("points", &points)?, any("normals", &normals)?);
        let columns = [x, y, a, b, c, d, e, f];
        let [factors] = evaluate(py, columns, [&[]], |[x, y, a, b, c, d, e, f], [out]| {
            let (points, normals) = (vectors([a, b, c]), vectors([d, e, f]));
            for (i, out) in out.iter_mut().enumerate() {
                let pixel = DVec2::new(x[i], y[i]);
                *out = self.frame.factor_at(pixel, points[i], normals[i]);
            }
        })?;
        Ok(factors)
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
        let ([a, b, c], [d, e, f]) = (any("points", &points)?, any("normals", &normals)?);
        let columns = [a, b, c, d, e, f, Column::new(("wave", &wave), 1.0)?];
        let [factors] = evaluate(py, columns, [&[]], |[a, b, c, d, e, f, wave], [out]| {
            let (points, normals) = (vectors([a, b, c]), vectors([d, e, f]));
            for (i, out) in out.iter_mut().enumerate() {
                *out = self.frame.factor_in_wave(points[i], normals[i], wave[i]);
            }
        })?;
        Ok(factors)
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
        let [averages] = ask(py, [&points, &normals], [&[]], |points, normals, [out]| {
            for (i, out) in out.iter_mut().enumerate() {
                *out = self.frame.average(points[i], normals[i]);
            }
        })?;
        Ok(averages)
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
        let [re, im] = ask(
            py,
            [&points, &normals],
            [&[]; 2],
            |points, normals, [re, im]| {
                for i in 0..re.len() {
                    let amplitude = self
                        .frame
                        .amplitude(points[i], normals[i])
                        .unwrap_or_default();
                    (re[i], im[i]) = (amplitude.re, amplitude.im);
                }
            },
        )?;
        re.add(im.mul(PyComplex::from_doubles(py, 0.0, 1.0))?)
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
    ) -> PyResult<SpeckleShift> {
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
        let [displacement, pupil, across, axial, correlation] = shifts.map(Bound::unbind);
        Ok(SpeckleShift {
            displacement,
            pupil,
            across,
            axial,
            correlation,
        })
    }

    fn __repr__(&self) -> String {
        let motion = &self.motion;
        let [surface, camera, laser] =
            [motion.surface, motion.camera, motion.laser].map(|pose| RigidMotion(pose).__repr__());
        let body = motion.body;
        format!("<SpeckleFrame: surface={surface}, camera={camera}, laser={laser}, body={body}>")
    }
}

methods! {
    impl SpeckleFrame as this: this.frame;

    unmade "Speckle.frame";

    /// Side of the reference state on which the speckle is: 1.0, or -1.0 where the pupil has moved over it the other way
    /// than in the frame in which it moves farthest.
    get side -> f64;
}

/// Hands points and their normals to `f` block by block, with where to write: as [`evaluate`].
fn ask<'py, const M: usize>(
    py: Python<'py>,
    [points, normals]: [&Vectors<'py>; 2],
    inner: [&[usize]; M],
    mut f: impl FnMut(&[DVec3], &[DVec3], [&mut [f64]; M]) + Send,
) -> PyResult<[Values<'py>; M]> {
    let ([a, b, c], [d, e, g]) = (any("points", points)?, any("normals", normals)?);
    evaluate(py, [a, b, c, d, e, g], inner, |[a, b, c, d, e, g], out| {
        f(&vectors([a, b, c]), &vectors([d, e, g]), out);
    })
}
