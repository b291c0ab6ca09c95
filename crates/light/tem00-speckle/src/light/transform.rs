//! Intensities in the frequency domain.

use num_complex::Complex;
use tem00_numerics::{Fft2, Grid, cast::to_signed};

/// Plans the transform of a pattern, or of part of one.
pub(super) fn plan([width, height]: [usize; 2]) -> Fft2 {
    Fft2::new(width, height).unwrap_or_else(|_| unreachable!("a pattern has samples"))
}

/// The frequency at `index` in a spectrum of `size` points, in periods per pattern.
pub(super) fn frequency(index: usize, size: usize) -> f64 {
    let (index, size) = (to_signed(index), to_signed(size));
    (if 2 * index > size {
        index - size
    } else {
        index
    }) as f64
}

/// A real grid as a complex one.
pub(super) fn to_complex(values: &Grid<f32>) -> Grid<Complex<f32>> {
    values.map(|&value| Complex::new(value, 0.0))
}

/// exp(2πi turns)
pub(super) fn wave(turns: f64) -> Complex<f64> {
    Complex::cis(core::f64::consts::TAU * (turns - turns.round()))
}
