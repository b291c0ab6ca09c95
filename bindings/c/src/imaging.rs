//! Cameras as optics, and the laws of the speckle that they see.

// The order of the header.
mod camera;

mod laws;

pub use camera::*;
pub use laws::*;

use tem00_decorrelation::ImagingGeometry;

use crate::pointers;

/// A camera focused on a surface: a lens, its pupils and the sensor behind it. It never changes:
/// any number of threads may ask it at once.
#[derive(Debug)]
pub struct Imaging(ImagingGeometry);

/// Frees a camera; null is allowed. No thread may be using it, and it must not be used again.
///
/// # Safety
///
/// `imaging` is null, or came from one of the functions that create cameras and was not destroyed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_imaging_destroy(imaging: *mut Imaging) {
    // SAFETY: by the contract of this function.
    unsafe { pointers::destroy(imaging) };
}

#[cfg(test)]
mod tests;
