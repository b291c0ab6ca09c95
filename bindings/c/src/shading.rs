//! Speckle by one call per hit: of a light in the image of a camera, for the motions of bodies.

// The order of the header.
mod camera;

mod speckle;

mod frame;

pub use camera::*;
pub use frame::*;
pub use speckle::*;

use tem00_shading::{DVec3, PreparedSpeckle};

use crate::{
    pointers::{self, Named, columns, read, records},
    status::Failure,
};

/// A perspective camera with a thin lens, whose image the speckle is in. It never changes: any
/// number of threads may ask it at once.
#[derive(Debug)]
pub struct Camera(tem00_shading::Camera);

/// The speckle of a light in the image of a camera, prepared for the motions of some frames. It
/// never changes: any number of threads may ask it at once.
#[derive(Debug)]
pub struct Speckle {
    prepared: PreparedSpeckle,
    summary: std::ffi::CString,
}

/// The speckle of one body in one frame; it outlives the speckle that it came from. It never
/// changes: any number of threads may ask it at once.
#[derive(Debug)]
pub struct SpeckleFrame(tem00_shading::SpeckleFrame);

// What `vectors` relies on, beside the order of the fields, which is that of C.
const _: () = assert!(
    size_of::<DVec3>() == size_of::<[f64; 3]>() && align_of::<DVec3>() == align_of::<f64>(),
    "a vector is three numbers"
);

/// Reads a vector of any components.
///
/// # Safety
///
/// The pointer is null or valid for three numbers.
unsafe fn read_vector(name: &str, pointer: *const f64) -> Result<DVec3, Failure> {
    // SAFETY: by the contract of this function.
    unsafe { read(name, pointer) }.map(DVec3::from_array)
}

/// Borrows columns of `count` vectors, each x, y, z one after the other.
///
/// # Safety
///
/// Each pointer is null, or points to `3 * count` numbers that nobody writes to during `'a`.
unsafe fn vectors<'a, const N: usize>(
    count: usize,
    read: [Named<*const f64>; N],
) -> Result<[&'a [DVec3]; N], Failure> {
    let read = read.map(|(name, pointer)| (name, pointer.cast()));
    // SAFETY: by the contract of this function.
    let (read, []) = unsafe { columns(count, read, []) }?;
    Ok(read)
}

/// Borrows `count` vectors of each column, and room for as many factors, which overlaps with none
/// of them.
///
/// # Safety
///
/// As [`vectors`]; `factors` is null, or points to `count` numbers that nobody else touches during
/// `'a`.
unsafe fn vectors_and_factors<'a, const N: usize>(
    count: usize,
    read: [Named<*const f64>; N],
    factors: *mut f64,
) -> Result<([&'a [DVec3]; N], &'a mut [f64]), Failure> {
    // SAFETY: by the contract of this function.
    let vectors = unsafe { vectors(count, read) }?;
    let read: [_; N] = core::array::from_fn(|i| (read[i].0, vectors[i]));
    // SAFETY: by the contract of this function.
    let factors = unsafe { records(count, ("factors", factors), read) }?;
    Ok((vectors, factors))
}

/// Frees a camera; null is allowed. No thread may be using it, and it must not be used again.
///
/// # Safety
///
/// `camera` is null, or came from `tem00_camera_create` and was not destroyed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_camera_destroy(camera: *mut Camera) {
    // SAFETY: by the contract of this function.
    unsafe { pointers::destroy(camera) };
}

/// Frees speckle, whose frames live on; null is allowed. No thread may be using it, and it must not
/// be used again.
///
/// # Safety
///
/// `speckle` is null, or came from `tem00_speckle_create` and was not destroyed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_destroy(speckle: *mut Speckle) {
    // SAFETY: by the contract of this function.
    unsafe { pointers::destroy(speckle) };
}

/// Frees a frame; null is allowed. No thread may be using it, and it must not be used again.
///
/// # Safety
///
/// `frame` is null, or came from `tem00_speckle_frame_create` and was not destroyed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_speckle_frame_destroy(frame: *mut SpeckleFrame) {
    // SAFETY: by the contract of this function.
    unsafe { pointers::destroy(frame) };
}

#[cfg(test)]
mod tests;
