//! Fourier transform along one axis, from the few leading samples of a long line.

use core::f64::consts::PI;
use std::sync::Arc;

use num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// The transform of `aperture` samples at the start of a line of `length`.
///
/// With `length = parts · D` the frequencies `k = parts · j + s` of each remainder s are a
/// transform of length D:
///
/// ```text
/// X(parts · j + s) = Σ y_s(n) exp(−2πi n j / D)       0 ≤ n < D
/// y_s(n) = x(n) exp(−2πi n s / length) + x(n + D) exp(−2πi (n + D) s / length)
/// ```
///
/// so that no zero is ever transformed. D is the smallest divisor of `length` that is at least 8/9
/// of the aperture; the samples beyond D are folded back. A disc of the even diameter Q/2 needs the
/// folding, as it spans Q/2 + 1 lattice points.
#[derive(Clone)]
pub(super) struct Axis {
    aperture: usize,
    parts: usize,
    short: Arc<dyn Fft<f32>>,
    /// exp(−2πi n s / length) for s = 1, 2, …, one line of `aperture` values for each.
    twiddles: Vec<Complex<f32>>,
}

impl Axis {
    /// The caller has checked that `0 < aperture ≤ length`.
    pub(super) fn new(length: usize, aperture: usize, planner: &mut FftPlanner<f32>) -> Self {
        let short = short_length(length, aperture);
        let parts = length / short;
        let twiddles = (1..parts)
            .flat_map(|s| (0..aperture).map(move |n| root_of_unity(n * s % length, length)))
            .collect();
        Self {
            aperture,
            parts,
            short: planner.plan_fft_forward(short),
            twiddles,
        }
    }

    pub(super) fn length(&self) -> usize {
        self.parts * self.short.len()
    }

    pub(super) const fn aperture(&self) -> usize {
        self.aperture
    }

    /// The number of remainders s, the parts into which [`transform`](Self::transform) splits the
    /// frequencies.
    pub(super) const fn parts(&self) -> usize {
        self.parts
    }

    pub(super) fn scratch_length(&self) -> usize {
        let short = &self.short;
        let outside = short.get_outofplace_scratch_len();
        short.get_inplace_scratch_len().max(outside)
    }

    /// Transforms the line `input`; `X(parts · j + s)` is written to `output[s · D + j]`. The
    /// contents of `input` are destroyed.
    #[inline(always)]
    pub(super) fn transform(
        &self,
        input: &mut [Complex<f32>],
        output: &mut [Complex<f32>],
        scratch: &mut [Complex<f32>],
    ) {
        let short = self.short.len();
        let (head, folded) = input.split_at_mut(short.min(input.len()));
        let (first, others) = output.split_at_mut(short);
        let turned = self.twiddles.chunks_exact(self.aperture);
        for (part, twiddles) in others.chunks_exact_mut(short).zip(turned) {
            turn(head, folded, twiddles, part);
        }
        self.short.process_with_scratch(others, scratch);
        for (sum, value) in head.iter_mut().zip(folded) {
            *sum += *value;
        }
        if head.len() == short {
            self.short
                .process_outofplace_with_scratch(head, first, scratch);
        } else {
            let (used, zeros) = first.split_at_mut(head.len());
            used.copy_from_slice(head);
            zeros.fill(Complex::new(0.0, 0.0));
            self.short.process_with_scratch(first, scratch);
        }
    }
}

/// Writes `y_s` into `part`: the values times their twiddles, with values beyond the part folded
/// back.
#[inline(always)]
fn turn(
    head: &[Complex<f32>],
    folded: &[Complex<f32>],
    twiddles: &[Complex<f32>],
    part: &mut [Complex<f32>],
) {
    let (used, zeros) = part.split_at_mut(head.len());
    zeros.fill(Complex::new(0.0, 0.0));
    let (head_twiddles, folded_twiddles) = twiddles.split_at(head.len());
    for ((to, value), twiddle) in used.iter_mut().zip(head).zip(head_twiddles) {
        *to = value * twiddle;
    }
    for ((sum, value), twiddle) in used.iter_mut().zip(folded).zip(folded_twiddles) {
        *sum += value * twiddle;
    }
}

/// The smallest divisor of `length` that is at least 8/9 of `aperture`.
fn short_length(length: usize, aperture: usize) -> usize {
    let min = aperture - aperture / 9;
    (1..=length / min)
        .rev()
        .find(|parts| length.is_multiple_of(*parts))
        .map_or(length, |parts| length / parts)
}

/// exp(−2πi n / length), rounded once.
#[expect(
    clippy::cast_possible_truncation,
    reason = "lengths are below 2⁵³ and the transform runs in f32"
)]
fn root_of_unity(n: usize, length: usize) -> Complex<f32> {
    let (sin, cos) = (-2.0 * PI * n as f64 / length as f64).sin_cos();
    Complex::new(cos as f32, sin as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_transforms_are_the_smallest_that_hold_the_aperture() {
        for (length, aperture, short) in [
            (1_024, 513, 512),
            (1_024, 512, 512),
            (1_024, 577, 1_024),
            (1_024, 256, 256),
            (1_000, 240, 250),
            (97, 40, 97),
            (97, 97, 97),
            (15, 1, 1),
            (2, 2, 2),
        ] {
            assert_eq!(
                short_length(length, aperture),
                short,
                "{aperture} in {length}"
            );
        }
    }

    #[test]
    fn what_is_folded_fits_once() {
        for length in 1..200 {
            for aperture in 1..=length {
                let short = short_length(length, aperture);
                assert!(length.is_multiple_of(short), "{short} divides {length}");
                assert!(aperture <= 2 * short, "{aperture} folds once into {short}");
            }
        }
    }
}
