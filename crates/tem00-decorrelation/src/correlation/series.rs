use tem00_numerics::{circular_path_overlap, circular_path_overlap_inverse};

/// Returns how many slices from the first a blend of slices has the given overlap with it, on a
/// circular path with `half_period` slices to the first uncorrelated one.
///
/// Between the slices i and i + 1, with the overlaps a and b with the first, and ρ with each other,
///
/// ```text
/// g = [(1 − f) a + f b] / √(1 − 2 f (1 − f) (1 − ρ))
/// ```
///
/// is a quadratic equation A f² + 2 B f + C = 0. It falls from a to b, so that f is the smaller root.
#[inline(always)]
pub(crate) fn blended_slice(overlap: f64, half_period: f64) -> f64 {
    let per_half_period = 1.0 / half_period;
    // A slice may be taken for the end of the way to it, or for its beginning.
    let before = floor(half_period * circular_path_overlap_inverse(overlap)).min(half_period - 1.0);
    let a = circular_path_overlap(before * per_half_period);
    let b = circular_path_overlap((before + 1.0) * per_half_period);
    let k = 1.0 - circular_path_overlap(per_half_period);
    let g = overlap.max(b).min(a);
    let step = b - a;
    let half_slope = a * step + k * g * g;
    // The discriminant has the factor g².
    let inner = step * step + 2.0 * k * a * b - k * (2.0 - k) * g * g;
    let root = g * inner.max(0.0).sqrt();
    // Both are zero where nothing has fallen.
    let fraction = (a - g) * (a + g) / (root - half_slope + f64::MIN_POSITIVE);
    (before + fraction.min(1.0)).max(0.0)
}

/// Rounds a number from 0 to 2⁵⁰ down, or a whole number to the one before.
#[inline(always)]
fn floor(x: f64) -> f64 {
    // Numbers near 1.5 · 2⁵² are 1 apart, so the sum rounds.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    (((x - 0.5) + ROUND) - ROUND).max(0.0)
}
