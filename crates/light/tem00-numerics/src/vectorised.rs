/// Runs a loop with the widest vector instructions of the processor, found at run time.
///
/// No step of it is contracted or reordered, so its bits do not depend on their width. What the
/// loop calls takes part if it is inlined. Without the feature `simd` the loop runs with the
/// instructions that every processor of the target has.
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
/// feature `simd` these are the widest of the processor at hand.
#[cfg(not(feature = "simd"))]
#[inline(always)]
pub fn vectorised(body: impl FnOnce()) {
    body();
}
