//! Loops over many points, compiled for the vector units of the processor they run on.

/// Runs a loop with the widest vector instructions of the processor.
///
/// No step of it is contracted or reordered, so its bits do not depend on their width.
#[cfg(feature = "simd")]
#[inline(always)]
pub(super) fn vectorised(body: impl FnOnce()) {
    fearless_simd::dispatch!(fearless_simd::Level::new(), _ => body());
}

/// Runs a loop with the vector instructions that every processor of the target has.
#[cfg(not(feature = "simd"))]
#[inline(always)]
pub(super) fn vectorised(body: impl FnOnce()) {
    body();
}

/// Panics unless all slices of a batch are of equal length.
pub(super) fn check_lengths<const N: usize>(points: [usize; 3], out: [usize; N]) {
    let [x, y, z] = points;
    assert!(
        points.iter().chain(&out).all(|&len| len == x),
        "x, y, z and out must be of equal length, got {x}, {y}, {z} and {out:?}",
    );
}
