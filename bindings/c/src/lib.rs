//! C interface of tem00: laser beams as lights, speckle, and how it moves and decorrelates.
//!
//! The header `include/tem00.h` is made from this crate and says all that a user needs; its test
//! keeps the two alike. `include/tem00.hpp` wraps it for C++17.
//!
//! # Conventions
//!
//! - SI units, radians, double precision; `_f32` where a function has a twin in single precision.
//! - Every function that can fail returns a [`Status`] and writes its results through pointers,
//!   only when it succeeds.
//! - What owns memory is a handle behind a pointer, made by `create` and freed by `destroy`; it
//!   never changes, so that threads may share it. Everything else is a plain struct.
//! - No panic crosses the boundary: one guard around each function makes it [`Status::Panic`].
//!   Pointers become references in `pointers.rs` alone.
//!
//! # Scope and non-goals
//!
//! What a renderer calls per ray, per pixel or per frame. The physics face of the libraries,
//! resonators, fits, sums of patterns and the rest, is for Rust and Python.

#[macro_use]
mod pointers;
#[cfg(test)]
#[macro_use]
mod testing;

mod numbers;
mod threads;

// The order of the header.
mod status;

mod light;

mod shading;

mod stack;

mod bandwidth;

mod imaging;

pub use bandwidth::*;
pub use imaging::*;
pub use light::*;
pub use shading::*;
pub use stack::*;
pub use status::{Status, tem00_last_error, tem00_last_error_parameter};

/// Returns the version of the library, as "0.1.0"; that of the header is `TEM00_VERSION`.
#[unsafe(no_mangle)]
pub extern "C" fn tem00_version() -> *const core::ffi::c_char {
    const VERSION: &core::ffi::CStr = match core::ffi::CStr::from_bytes_with_nul(
        concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes(),
    ) {
        Ok(version) => version,
        Err(_) => c"",
    };
    VERSION.as_ptr()
}
