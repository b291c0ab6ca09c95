//! The law of speckle motion as source text for kernels.
//!
//! A kernel on a GPU cannot call this crate and evaluates the law itself. For whole frames, with
//! the rows of camera, laser and motion, `tem00_factor` of the crate `tem00-shading` calls these
//! functions.

/// Motion and correlation of speckle between two states in WGSL: functions and structs without
/// bindings.
///
/// Its first comment states how to call the functions and how exact they are.
///
/// # Examples
///
/// Put the functions before your own shader:
///
/// ```
/// use tem00_decorrelation::closed_form::WGSL;
///
/// let kernel = "
///     fn contrast_left(pupil_shift: f32) -> f32 {
///         return sqrt(tem00_correlation(pupil_shift, 0.0));
///     }
/// ";
/// let module = format!("{WGSL}\n{kernel}");
/// assert!(module.contains("fn tem00_correlation("));
/// ```
pub const WGSL: &str = include_str!("../shaders/tem00_decorrelation.wgsl");
