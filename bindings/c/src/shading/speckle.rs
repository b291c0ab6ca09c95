use core::ffi::c_char;
use std::ffi::CString;

use tem00_shading::{DMat3, DVec3, Motion, PreparedSpeckle};

use super::{Camera, Speckle, vectors, vectors_and_factors};
use crate::{
    light::Light,
    pointers::{borrow, columns},
    status::{Failure, Status, call},
    threads::on_threads,
};

/// Motion of a rigid body from the reference state to now: x' = R x + t. All 0 is no motion.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Rows of the rotation matrix R, right-handed and orthonormal within 1e-6; all 0 for no
    /// rotation.
    pub rotation: [[f64; 3]; 3],
    /// Translation t, in metres.
    pub translation: [f64; 3],
}

/// Motion of a body, the camera and the light from the reference state to now. Only differences
/// count: if all three move as one, nothing changes. All 0 is the reference state of body 0.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyMotion {
    /// Number of the body. Bodies that move apart have numbers of their own, and speckle of their
    /// own.
    pub body: usize,
    /// Pose of the body whose surface is looked at.
    pub surface: Pose,
    /// Pose of the camera.
    pub camera: Pose,
    /// Pose of the light.
    pub light: Pose,
}

/// Parameters of speckle.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SpeckleDescription {
    /// Seed of the patterns. Two lights want two seeds.
    pub seed: u64,
    /// Motions of the frames, beside the reference state; null if nothing moves.
    pub motions: *const BodyMotion,
    /// Number of motions.
    pub motion_count: usize,
    /// Points x, y, z in the reference state, in metres, one after the other, from which the
    /// largest shift of the speckle is found; null for where the light crosses the plane in focus.
    pub points: *const f64,
    /// Unit normals of the surface at these points; null if there are none.
    pub normals: *const f64,
    /// Number of points.
    pub point_count: usize,
    /// Bytes that the patterns may take.
    pub memory_limit: u64,
    /// Number of equal independent patterns that add up, from 1 on: contrast falls to 1/√looks.
    pub looks: usize,
    /// Degree of polarisation of the light that reaches the sensor, from 0 to 1: 1 behind a
    /// polariser.
    pub polarisation: f64,
    /// Number of threads that generate the patterns, at most 1024; 0 for all the cores of the
    /// machine. The patterns are the same, to the last bit, for any number.
    pub threads: u32,
}

/// Properties of speckle.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SpeckleInfo {
    /// Choices with their reasons, in UTF-8. The text belongs to the speckle.
    pub summary: *const c_char,
    /// Speckle size on the sensor, in pixels.
    pub speckle_size: f64,
    /// Bytes that the patterns take.
    pub memory_bytes: u64,
}

impl Pose {
    fn pose(&self, name: &str) -> Result<tem00_shading::Pose, Failure> {
        let turns = self.rotation.as_flattened().iter().any(|&x| x != 0.0);
        let rotation = if turns {
            // glam counts by columns.
            DMat3::from_cols_array_2d(&self.rotation).transpose()
        } else {
            DMat3::IDENTITY
        };
        let pose = tem00_shading::Pose::new(rotation, DVec3::from_array(self.translation));
        pose.map_err(|error| {
            let parameter = format!("{name}.{}", error.parameter());
            Failure::argument(&parameter, format!("{name}.{error}"))
        })
    }
}

impl BodyMotion {
    pub(super) fn motion(&self, name: &str) -> Result<Motion, Failure> {
        Ok(Motion {
            body: self.body,
            surface: self.surface.pose(&format!("{name}.surface"))?,
            camera: self.camera.pose(&format!("{name}.camera"))?,
            laser: self.light.pose(&format!("{name}.light"))?,
        })
    }
}

impl SpeckleDescription {
    /// # Safety
    ///
    /// The pointers are null or valid for as many motions, and for three times as many numbers as
    /// points.
    unsafe fn prepare(
        &self,
        Camera(camera): &Camera,
        light: &Light,
    ) -> Result<PreparedSpeckle, Failure> {
        let motions = [("motions", self.motions)];
        // SAFETY: by the contract of this function.
        let ([motions], []) = unsafe { columns(self.motion_count, motions, []) }?;
        let motions = motions.iter().enumerate();
        let motions = motions.map(|(i, motion)| motion.motion(&format!("motions[{i}]")));
        let points = [("points", self.points), ("normals", self.normals)];
        // SAFETY: by the contract of this function.
        let [points, normals] = unsafe { vectors(self.point_count, points) }?;
        let speckle = tem00_shading::Speckle::new(camera, light.laser()?, self.seed)
            .for_motions(motions.collect::<Result<Vec<_>, _>>()?)
            .at_points(points.iter().copied().zip(normals.iter().copied()))
            .within(self.memory_limit)
            .looks(self.looks)
            .polarisation(self.polarisation);
        let prepared = on_threads(self.threads, || speckle.prepare())?.map_err(Failure::from);
        prepared.map_err(|failure| match failure.parameter.as_str() {
            "patterns" => Failure::argument("looks", format!("looks: {}", failure.message)),
            _ => failure,
        })
    }
}

impl From<PreparedSpeckle> for Speckle {
    fn from(prepared: PreparedSpeckle) -> Self {
        let summary = CString::new(prepared.to_string()).unwrap_or_default();
        Self { prepared, summary }
    }
}

/// Generates the speckle of a light in the image of a camera, both as they stand in the reference
/// state: chooses sizes, slices and seeds for the motions and the memory. `tem00_speckle_describe`
/// says what it chose.
///
/// The light must be a spot or a line; its wavelength counts as that in vacuum. Speckle does not
/// need camera and light any more once it is created. On failure `*speckle` is null.
///
/// # Safety
///
/// The pointers are null or valid, those to points and normals for three numbers each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_create(
    camera: *const Camera,
    light: *const Light,
    description: *const SpeckleDescription,
    speckle: *mut *mut Speckle,
) -> Status {
    create!(camera: borrow, light: borrow, description: borrow =>
        speckle: description.prepare(camera, light).map(Speckle::from))
}

/// Tells what was chosen for speckle.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_describe(
    speckle: *const Speckle,
    info: *mut SpeckleInfo,
) -> Status {
    answer!(speckle: borrow => info: SpeckleInfo {
        summary: speckle.summary.as_ptr(),
        speckle_size: speckle.prepared.geometry().speckle_size_in_pixels(),
        memory_bytes: speckle.prepared.memory_bytes(),
    })
}

/// Computes the factors at `count` points that stood elsewhere in the reference state, for a
/// renderer that knows no bodies but has buffers of an image.
///
/// `previous`, `points` and `normals` hold x, y, z of one point after the other: where the points
/// were, where they are, and their unit normals. A point counts as carried along without a turn.
/// Points whose motion is the same, one after the other, are fastest. Those that are not finite
/// have the factor 1. `factors` must not overlap with what is read.
///
/// # Safety
///
/// The pointers are null or valid, for `3 * count` numbers and for `count` factors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_factors_since(
    speckle: *const Speckle,
    previous: *const f64,
    points: *const f64,
    normals: *const f64,
    count: usize,
    factors: *mut f64,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let Speckle { prepared, .. } = unsafe { borrow("speckle", speckle) }?;
        let read = [
            ("previous", previous),
            ("points", points),
            ("normals", normals),
        ];
        // SAFETY: by the contract of this function.
        let ([previous, points, normals], factors) =
            unsafe { vectors_and_factors(count, read, factors) }?;
        prepared.factors_since(previous, points, normals, factors);
        Ok(())
    })
}
