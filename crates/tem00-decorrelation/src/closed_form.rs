//! The law of speckle motion as source text for kernels.
//!
//! A kernel on a GPU cannot call this crate: it evaluates the law itself.
//!
//! # Examples
//!
//! Put the functions before a shader of your own, which defines the table of the slices:
//!
//! ```
//! use tem00_decorrelation::closed_form::WGSL;
//!
//! let kernel = "
//!     @group(0) @binding(0) var<uniform> imaging: Tem00Imaging;
//!     @group(0) @binding(1) var<storage> overlaps: array<vec2<f32>>;
//!     fn tem00_slice_overlaps(slice: u32) -> vec2<f32> { return overlaps[slice]; }
//!     // … let moved = tem00_speckle_motion(imaging, to_pupil, normal, motion, rotation, light);
//! ";
//! let module = format!("{WGSL}\n{kernel}");
//! assert!(module.contains("fn tem00_speckle_motion("));
//! ```

/// Motion, change and slice coordinate of speckle in WGSL: functions and structs without bindings.
///
/// Its first comment says how to call them, which function the host defines, and how exact they are.
pub const WGSL: &str = include_str!("../shaders/tem00_decorrelation.wgsl");
