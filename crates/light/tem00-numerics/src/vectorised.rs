/// Runs a loop with the widest vector instructions of the processor, found at run time.
///
/// No operation is contracted or reordered, so the bits of the result do not depend on the vector
/// width. Functions that the loop calls are vectorised if they are inlined. Without the feature
/// `simd` the loop runs with the instructions that every processor of the target has.
///
/// # Examples
///
/// ```
/// let (x, mut y) = ([1.0_f32, 2.0, 3.0], [0.5_f32; 3]);
/// tem00_numerics::vectorised(|| {
///     for (y, x) in y.iter_mut().zip(&x) {
///         *y += 2.0 * x;
///     }
/// });
/// assert_eq!(y, [2.5, 4.5, 6.5]);
/// ```
#[cfg(feature = "simd")]
#[inline(always)]
pub fn vectorised(body: impl FnOnce()) {
    fearless_simd::dispatch!(fearless_simd::Level::new(), _ => body());
}

/// Runs a loop with the vector instructions that every processor of the target has. With the
/// feature `simd` it uses the widest instructions of the processor in use.
#[cfg(not(feature = "simd"))]
#[inline(always)]
pub fn vectorised(body: impl FnOnce()) {
    body();
}
