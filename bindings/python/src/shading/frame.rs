use pyo3::prelude::*;
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_shading::{self as physics, DVec2, DVec3, Motion};

use super::{LIMIT, vectors};
use crate::{
    arrays::{Array, Numbers, Values, Vectors, evaluate, map_complex, map_inner},
    beam::named,
    decorrelation::RigidMotion,
};

/// The speckle of a body in a frame, made by ``Speckle.frame``.
///
/// Points and normals are given as they are now, and broadcast together. Where the camera does not
/// see a point the factor is 1; where the law has no value, as at a surface seen edge-on, the
/// speckle is new. Neither points nor normals that are NaN give NaN.
#[pyclass(frozen, module = "tem00.shading")]
#[derive(Clone, Debug)]
pub(crate) struct SpeckleFrame {
    pub(super) frame: physics::SpeckleFrame,
    pub(super) motion: Motion,
}

immutable!(SpeckleFrame);

methods! {
    impl SpeckleFrame as this: this.frame;

    unmade "Speckle.frame";

    /// Return the factors in light of one wave number of the laser's line each, for a renderer that
    /// draws one for each of its samples; ``factor`` is their mean over the line.
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
    call factor_in_wave(py;
        points: Vectors<'py>, normals: Vectors<'py>, wave: Numbers<'py>
    ) -> Values<'py> = {
        let [wave] = columns!(1.0; wave);
        let [a, b, c, d, e, f] = columns!(LIMIT; points: 3, normals: 3);
        let columns = [a, b, c, d, e, f, wave];
        map_inner(py, columns, &[], |[a, b, c, d, e, f, wave]| {
            let (point, normal) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
            [this.frame.factor_in_wave(point, normal, wave)]
        })
    };

    /// Return the factors, with mean 1, that multiply the radiance which surfaces send from the
    /// laser to the camera.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (..., 3)
    ///     Points, in metres. Neighbours in the image, one after the other, are looked up fastest;
    ///     a call for one point takes ten times as long as a point in an array.
    /// normals : array_like, shape (..., 3)
    ///     Normals of any length, to either side.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Factors, in the common shape.
    call factor(py; points: Vectors<'py>, normals: Vectors<'py>) -> Values<'py> = {
        let hits = columns!(LIMIT; points: 3, normals: 3);
        let [factors] = evaluate(py, hits, [&[]], |[a, b, c, d, e, f], [out]| {
            this.frame
                .factors(&vectors([a, b, c]), &vectors([d, e, f]), out);
        })?;
        Ok(factors)
    };

    /// Return the complex amplitudes of the first pattern, of mean square 1, for a host that adds
    /// fields.
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
    call amplitude(py; points: Vectors<'py>, normals: Vectors<'py>) -> Bound<'py, PyAny> = {
        let hits = columns!(LIMIT; points: 3, normals: 3);
        map_complex(py, hits, |[x, y, z, normal @ ..]| {
            let amplitude = this.frame.amplitude(DVec3::new(x, y, z), normal.into());
            amplitude.unwrap_or_default()
        })
    };

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
    call shift(py; points: Vectors<'py>, normals: Vectors<'py>) -> Array<'py> = {
        let inner: [&[usize]; 5] = [&[2], &[], &[2], &[], &[]];
        let hits = columns!(LIMIT; points: 3, normals: 3);
        let shifts = evaluate(py, hits, inner, |[a, b, c, d, e, f], out| {
            let [displacement, pupil, across, axial, correlation] = out;
            let mut shifts = vec![None; pupil.len()];
            let (points, normals) = (vectors([a, b, c]), vectors([d, e, f]));
            this.frame.shifts(&points, &normals, &mut shifts);
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
    };

    /// Return the factors at points that camera samples see at image points: out of focus those lie
    /// beside the ones where the centre of the lens sees the points.
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
    over factor_at(pixels: 2, points: 3, normals: 3) -> [] = |[x, y, a, b, c, normal @ ..]| {
        let (pixel, point) = (DVec2::new(x, y), DVec3::new(a, b, c));
        [this.frame.factor_at(pixel, point, normal.into())]
    };

    /// Return the means of the factors over the pixels about the images of points, for a host with
    /// one sample per pixel.
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
    over average(points: 3, normals: 3) -> [] =
        |[x, y, z, normal @ ..]| [this.frame.average(DVec3::new(x, y, z), normal.into())];

    /// Side of the reference state on which the speckle is: 1.0, or -1.0 where the pupil has moved
    /// over it the other way than in the frame in which it moves farthest.
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
