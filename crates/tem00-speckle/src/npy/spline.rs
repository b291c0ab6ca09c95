//! The amplitude at the samples and the coefficients of the spline, one from the other.

use num_complex::Complex;
use tem00_numerics::{
    Fft2, Fft2Scratch, Grid,
    cast::{to_f32, to_signed},
};

use crate::{Interpolation, interpolation::spline::prefilter};

/// The filter that turns samples of a band-limited field into the coefficients of its spline.
///
/// ```text
/// coefficients(k) = samples(k) · sinc⁻⁴(π kx / W) sinc⁻⁴(π ky / H)        in the Fourier domain
/// ```
#[derive(Debug)]
pub(super) struct SplineFilter {
    transform: Fft2,
    scratch: Fft2Scratch,
    /// The factor of the coefficients at each frequency, along either axis.
    factors: [Vec<f64>; 2],
}

impl SplineFilter {
    /// The filter for grids of that size, or `None` where the samples themselves are interpolated.
    pub(super) fn of([width, height]: [usize; 2], interpolation: Interpolation) -> Option<Self> {
        if interpolation != Interpolation::CubicSpline {
            return None;
        }
        let factors = [width, height].map(|size| {
            // Frequencies of either sign have the same factor.
            let frequency = |index: usize| to_signed(index.min(size - index));
            let factor = |index| prefilter(frequency(index), size, interpolation);
            (0..size).map(factor).collect()
        });
        Some(Self {
            transform: Fft2::new(width, height).ok()?,
            scratch: Fft2Scratch::default(),
            factors,
        })
    }

    pub(super) fn coefficients(&mut self, samples: &mut Grid<Complex<f32>>) {
        self.filter(samples, |factor| factor);
    }

    pub(super) fn samples(&mut self, coefficients: &mut Grid<Complex<f32>>) {
        self.filter(coefficients, f64::recip);
    }

    fn filter(&mut self, grid: &mut Grid<Complex<f32>>, power: impl Fn(f64) -> f64 + Sync) {
        let [x, y] = &self.factors;
        let count = grid.values().len() as f64;
        // The inverse transform is the conjugate of that of the conjugate, over the number of values.
        let factor = |i: usize, j: usize| to_f32(power(x[i] * y[j]) / count);
        let spectrum = self
            .transform
            .forward(grid, |i, j, value| value.conj() * factor(i, j));
        self.transform
            .forward_into(&spectrum, grid, &mut self.scratch, |_, _, value| {
                value.conj()
            });
    }
}
