use pyo3::prelude::*;
use tem00_coherence::Relief;
use tem00_shading::{self as physics, Motion, Pose};

use super::{LIMIT, camera::Camera, frame::SpeckleFrame, laser::Laser, vectors};
use crate::{
    arrays::{Values, Vectors, Whole, columns, evaluate},
    decorrelation::RigidMotion,
    error::{OrRaise, refused},
};

/// The speckle of a laser in the image of a camera, prepared for the frames in which something
/// moves.
///
/// It chooses sizes, slices and seeds and generates the patterns; ``print`` says what it chose. Two
/// lasers want two seeds.
///
/// Parameters
/// ----------
/// camera : Camera
///     The camera in the reference state.
/// laser : Laser
///     The laser in the reference state.
/// seed : int
///     Seed of the patterns, 0 to 2**64 - 1.
/// poses, camera_poses, laser_poses : sequence of Pose, optional
///     Poses of a body, of the camera and of the laser in each frame; what has none stands still in
///     all. With several bodies that move, those of one after those of another.
/// at_points : (array_like, array_like), shape (..., 3) each, optional
///     Points of surfaces in the reference state, and their unit normals: there the largest shift
///     of the speckle is looked for. Without them it is where the light of the laser crosses the
///     plane in focus. A laser with a linewidth or an extent needs them.
/// memory : int, optional
///     Bytes that the patterns may take; 256 MiB if left out. With poses there are 32, 16, 8
///     or 4 slices per pupil diameter, the most that fit: look-ups between them exceed the
///     correlation law by up to 0.04, 0.08, 0.14 or 0.23.
/// looks : int, optional
///     Number of equal independent patterns that add up, which lowers the contrast to 1/√looks; 1
///     if left out.
/// polarisation : float, optional
///     Degree of polarisation of the light at the sensor, from 0 to 1: 1 behind a polariser.
/// rms_height, correlation_length : float, optional
///     Root mean square height of the relief that is finer than a resolution cell, and the distance
///     at which the correlation of the heights falls to 1/e, in metres: they count in light that
///     has a linewidth.
#[pyclass(frozen, module = "tem00.shading")]
#[derive(Clone, Debug)]
pub(crate) struct Speckle(physics::PreparedSpeckle);

immutable!(Speckle);

#[pymethods]
impl Speckle {
    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Speckle: {}>", self.0)
    }
}

methods! {
    impl Speckle as this: this.0;

    #[new]
    #[pyo3(signature = (
        camera, laser, seed, *, poses = None, camera_poses = None, laser_poses = None,
        at_points = None, memory = None, looks = None, polarisation = 1.0, rms_height = 0.0,
        correlation_length = 0.0,
    ))]
    build new(py;
        camera: &Camera, laser: &Laser, seed: Whole<'py>,
        poses: Option<Vec<PyRef<'py, RigidMotion>>>,
        camera_poses: Option<Vec<PyRef<'py, RigidMotion>>>,
        laser_poses: Option<Vec<PyRef<'py, RigidMotion>>>, at_points: Option<[Vectors<'py>; 2]>,
        memory: Option<Whole<'py>>, looks: Option<Whole<'py>>, polarisation: f64, rms_height: f64,
        correlation_length: f64
    ) = {
        let mut speckle = physics::Speckle::new(&camera.0, &laser.0, seed.unsigned("seed")?)
            .for_motions(motions([poses, camera_poses, laser_poses])?)
            .polarisation(polarisation)
            .relief(Relief {
                rms_height,
                correlation_length,
            });
        if let Some([points, normals]) = at_points {
            let at_points = [("at_points", &points, 3), ("at_points", &normals, 3)];
            let mut pairs = Vec::new();
            let [] = evaluate(
                py,
                columns(&at_points, LIMIT)?,
                [],
                |[a, b, c, d, e, f], []| {
                    pairs.extend(vectors([a, b, c]).into_iter().zip(vectors([d, e, f])));
                },
            )?;
            speckle = speckle.at_points(pairs);
        }
        if let Some(memory) = memory {
            speckle = speckle.within(memory.unsigned("memory")?);
        }
        if let Some(looks) = looks {
            speckle = speckle.looks(looks.unsigned("looks")?);
        }
        Ok(Self(
            py.detach(|| speckle.prepare())
                .or_raise_renamed(&["patterns"], "looks")?,
        ))
    };

    /// Return the speckle of a body in a frame: once per body and frame.
    ///
    /// Parameters
    /// ----------
    /// surface, camera, laser : Pose, optional
    ///     Where the body, the camera and the laser are now; what is left out has not moved.
    /// body : int, optional
    ///     Number of the body: bodies that move apart have numbers, and speckle, of their own; 0 if
    ///     left out.
    ///
    /// Returns
    /// -------
    /// SpeckleFrame
    ///     A motion that shifts the speckle farther than the poses do is refused.
    #[pyo3(signature = (surface = None, camera = None, laser = None, body = None))]
    call frame(_py;
        surface: Option<PyRef<'py, RigidMotion>>, camera: Option<PyRef<'py, RigidMotion>>,
        laser: Option<PyRef<'py, RigidMotion>>, body: Option<Whole<'py>>
    ) -> SpeckleFrame = {
        let body = body.map_or(Ok(0), |body| body.unsigned("body"))?;
        let [surface, camera, laser] =
            [surface, camera, laser].map(|pose| pose.map_or(Pose::IDENTITY, |pose| pose.0));
        let motion = Motion {
            body,
            surface,
            camera,
            laser,
        };
        let frame = this.0.frame(&motion).or_raise()?;
        Ok(SpeckleFrame { frame, motion })
    };

    /// Return the factors at points that stood elsewhere in the reference state, for a host that
    /// knows no bodies.
    ///
    /// A point counts as carried along without a turn; those that are not finite have the factor 1.
    /// Points whose motion is the same, one after the other, are looked up fastest.
    ///
    /// Parameters
    /// ----------
    /// previous, points : array_like, shape (..., 3)
    ///     Where the points were, and where they are, in metres.
    /// normals : array_like, shape (..., 3)
    ///     Unit normals, to either side.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Factors, in the common shape.
    call factors_since(py;
        previous: Vectors<'py>, points: Vectors<'py>, normals: Vectors<'py>
    ) -> Values<'py> = {
        let columns = columns!(LIMIT; previous: 3, points: 3, normals: 3);
        let [factors] = evaluate(py, columns, [&[]], |[a, b, c, d, e, f, g, h, i], [out]| {
            let [previous, points, normals] = [[a, b, c], [d, e, f], [g, h, i]].map(vectors);
            this.0.factors_since(&previous, &points, &normals, out);
        })?;
        Ok(factors)
    };

    /// Bytes that the patterns take.
    get memory_bytes -> u64;

    /// Speckle size in the image, in pixels.
    get speckle_size -> f64 = this.0.geometry().speckle_size_in_pixels();
}

/// Returns one motion for each frame.
fn motions(all: [Option<Vec<PyRef<'_, RigidMotion>>>; 3]) -> PyResult<Vec<Motion>> {
    let all = all.map(Option::unwrap_or_default);
    let frames = all.iter().map(Vec::len).max().unwrap_or(0);
    for (name, poses) in ["poses", "camera_poses", "laser_poses"].iter().zip(&all) {
        if !poses.is_empty() && poses.len() != frames {
            let found = poses.len();
            let message =
                format!("{name} must be none or one for each of {frames} frames, got {found}");
            return Err(refused(name, message));
        }
    }
    let motion = |frame: usize| {
        let [surface, camera, laser] = all
            .each_ref()
            .map(|poses| poses.get(frame).map_or(Pose::IDENTITY, |pose| pose.0));
        Motion {
            body: 0,
            surface,
            camera,
            laser,
        }
    };
    Ok((0..frames).map(motion).collect())
}
