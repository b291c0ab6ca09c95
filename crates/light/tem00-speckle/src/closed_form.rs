//! Phasors, the parts of a Fourier transform and look-ups as source text, for kernels on a graphics
//! card.
//!
//! A kernel cannot call this crate. It receives the
//! [`coefficients`](crate::SpeckleStack::coefficients) of a stack and the rows of its
//! [`SliceLaw`](crate::SliceLaw) and looks up intensities with these functions, or it generates the
//! phasors from the seed itself. `tem00-gpu` does both on a `wgpu` device.
//!
//! # Examples
//!
//! Put the functions before your own shader, which defines where the stack is stored:
//!
//! ```
//! use tem00_speckle::closed_form::WGSL;
//!
//! let kernel = "
//!     @group(0) @binding(0) var<storage, read> coefficients: array<vec2<f32>>;
//!     @group(0) @binding(1) var<storage, read> laws: array<array<vec4<f32>, 14>>;
//!     const stack = Tem00Stack(vec2<u32>(512u, 512u), 64u, 0u);
//!
//!     fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> {
//!         return coefficients[(slice * stack.size.y + cell.y) * stack.size.x + cell.x];
//!     }
//!     fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> {
//!         return laws[slice][row];
//!     }
//!     // … radiance *= tem00_stack_intensity(stack, x, y, u);
//! ";
//! let module = format!("{WGSL}\n{kernel}");
//! assert!(module.contains("fn tem00_stack_intensity("));
//! ```

/// Phasors, the parts of a Fourier transform and look-ups in WGSL: functions and structs without
/// bindings.
///
/// Its first comment names the two functions that the host writes.
pub const WGSL: &str = include_str!("../shaders/tem00_speckle.wgsl");
