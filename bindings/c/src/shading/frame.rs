use tem00_decorrelation::pupil_overlap_correlation;
use tem00_shading::DVec2;

use super::{Speckle, SpeckleFrame, read_vector, speckle::BodyMotion, vectors_and_factors};
use crate::{
    pointers::{borrow, read},
    status::{Status, call},
};

/// Displacement and correlation of the speckle at a point since the reference state.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpeckleShift {
    /// Displacement of the speckle in the image, in pixels with y down.
    pub displacement: [f64; 2],
    /// Displacement of the pupil over the speckle, in pupil diameters. A motion along the axis
    /// counts by the displacement that leaves the same correlation. Infinite where the speckle is
    /// new.
    pub pupil_shift: f64,
    /// Correlation of intensity with the speckle in the reference state, in [0, 1], where it is
    /// looked up at the displacement.
    pub correlation: f64,
}

impl From<Option<tem00_shading::SpeckleShift>> for SpeckleShift {
    fn from(shift: Option<tem00_shading::SpeckleShift>) -> Self {
        let (displacement, pupil_shift) = match shift {
            Some(shift) => (shift.displacement.to_array(), shift.pupil),
            None => ([0.0; 2], f64::INFINITY),
        };
        Self {
            displacement,
            pupil_shift,
            correlation: pupil_overlap_correlation(pupil_shift),
        }
    }
}

/// Finds the speckle of a body in a frame: once per body and frame.
///
/// A motion that shifts the speckle farther than those that it was prepared for is refused. On
/// failure `*frame` is null.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_frame_create(
    speckle: *const Speckle,
    motion: *const BodyMotion,
    frame: *mut *mut SpeckleFrame,
) -> Status {
    create!(speckle: borrow, motion: borrow =>
        frame: Ok(SpeckleFrame(speckle.prepared.frame(&motion.motion("motion")?)?)))
}

/// Computes the factor, with mean 1, by which speckle multiplies the radiance that a point of a
/// surface sends from the light to the camera.
///
/// `point` and the unit vector `normal` hold x, y, z, both as they are now. The factor is 1 where
/// the camera does not see the point, NaN included; where the law has no value, as edge-on, the
/// speckle is new.
///
/// # Safety
///
/// The pointers are null or valid, `point` and `normal` for three numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_frame_factor(
    frame: *const SpeckleFrame,
    point: *const f64,
    normal: *const f64,
    factor: *mut f64,
) -> Status {
    answer!(frame: borrow, point: read_vector, normal: read_vector =>
        factor: frame.0.factor(point, normal))
}

/// Computes the factor at a point that a camera sample sees at an image point: out of focus it lies
/// beside the one where the centre of the lens sees it.
///
/// `pixel` holds x and y in pixels, y down; `point` and `normal` are as for
/// `tem00_speckle_frame_factor`.
///
/// # Safety
///
/// The pointers are null or valid, `pixel` for two numbers, `point` and `normal` for three.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_frame_factor_at(
    frame: *const SpeckleFrame,
    pixel: *const f64,
    point: *const f64,
    normal: *const f64,
    factor: *mut f64,
) -> Status {
    answer!(frame: borrow, pixel: read, point: read_vector, normal: read_vector =>
        factor: frame.0.factor_at(DVec2::from_array(pixel), point, normal))
}

/// Computes the factors at `count` points: the bits of `tem00_speckle_frame_factor`. Neighbours in
/// the image, one after the other, are fastest.
///
/// `points` and `normals` hold x, y, z of one point after the other; `factors` must not overlap
/// with them.
///
/// # Safety
///
/// The pointers are null or valid, for `3 * count` numbers and for `count` factors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_frame_factors(
    frame: *const SpeckleFrame,
    points: *const f64,
    normals: *const f64,
    count: usize,
    factors: *mut f64,
) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let SpeckleFrame(frame) = unsafe { borrow("frame", frame) }?;
        let read = [("points", points), ("normals", normals)];
        // SAFETY: by the contract of this function.
        let ([points, normals], factors) = unsafe { vectors_and_factors(count, read, factors) }?;
        frame.factors(points, normals, factors);
        Ok(())
    })
}

/// Computes the mean factor over the pixel about the image of a point, for a renderer with one
/// sample per pixel: 1 where the camera does not see it.
///
/// # Safety
///
/// The pointers are null or valid, `point` and `normal` for three numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_frame_average(
    frame: *const SpeckleFrame,
    point: *const f64,
    normal: *const f64,
    average: *mut f64,
) -> Status {
    answer!(frame: borrow, point: read_vector, normal: read_vector =>
        average: frame.0.average(point, normal))
}

/// Tells what has become of the speckle at a point since the reference state; it is new where the
/// law has no value or the camera does not see the point.
///
/// # Safety
///
/// The pointers are null or valid, `point` and `normal` for three numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_frame_shift(
    frame: *const SpeckleFrame,
    point: *const f64,
    normal: *const f64,
    shift: *mut SpeckleShift,
) -> Status {
    answer!(frame: borrow, point: read_vector, normal: read_vector =>
        shift: frame.0.shift(point, normal).into())
}
