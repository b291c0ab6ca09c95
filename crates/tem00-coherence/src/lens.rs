//! Integrals over the lens that two displaced pupils share.

use num_complex::Complex;
use tem00_numerics::quadrature::for_each_node;

/// Returns `(1/π) ∫ exp(iφ)` over the lens that two unit discs share whose centres are 2 `shift` apart along the
/// first axis, with the phase φ(along, across), which changes by at most some `ranges` from the centre to the edge
/// along and across.
pub(crate) fn mean_over_lens(
    shift: f64,
    ranges: [f64; 2],
    phase: impl Fn(f64, f64) -> f64,
) -> Complex<f64> {
    let shift = shift.abs();
    let half = 1.0 - shift;
    if half <= 0.0 {
        return Complex::ZERO;
    }
    let longest = ranges.map(|range| 4.0 / range.max(4.0));
    let mut sum = Complex::ZERO;
    // The lens ends like a root: along = half (1 − t²).
    for_each_node([0.0, 1.0], longest[0], |t, weight| {
        let along = half * (1.0 - t * t);
        let chord = ((1.0 - along - shift) * (1.0 + along + shift)).sqrt();
        for_each_node([-chord, chord], longest[1], |across, by| {
            let pair = [along, -along].map(|along| Complex::cis(phase(along, across)));
            sum += (pair[0] + pair[1]) * (by * weight * 2.0 * half * t);
        });
    });
    sum / core::f64::consts::PI
}
