//! The closed forms of irradiance and next event, as source text for kernels and for C.
//!
//! A kernel on a GPU and a just-in-time compiled renderer cannot call this crate. They copy a
//! prepared [`SpotLight`](crate::SpotLight) or [`LineLight`](crate::LineLight) in `f32` and
//! evaluate it themselves: the structs have the same layout on both sides.
//!
//! # Examples
//!
//! Put the functions before your own shader:
//!
//! ```
//! use tem00_beam::closed_form::WGSL;
//!
//! let kernel = "
//!     @group(0) @binding(0) var<uniform> light: Tem00SpotLight;
//!     // … let event = tem00_spot_next_event(light, p);
//! ";
//! let module = format!("{WGSL}\n{kernel}");
//! assert!(module.contains("fn tem00_spot_next_event("));
//! ```

/// Irradiance and next event of all lights in WGSL: functions and structs without bindings.
///
/// Its first comment lists their arguments and results.
pub const WGSL: &str = include_str!("../shaders/tem00_beam.wgsl");

/// Irradiance and next event of all lights in C99, for `float` and for `double`.
///
/// It is the text of the header `tem00_beam.h`. The header includes itself by this name, so save it
/// under this name.
pub const C_HEADER: &str = include_str!("../include/tem00_beam.h");
