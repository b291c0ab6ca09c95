//! Cubic B-spline interpolation of a band-limited random field, and the variance it leaves.

use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::{Grid, wrap_coordinate};

use crate::{
    field::PupilField,
    mask::{Mask, to_f64},
};

/// The four taps that reach the fraction `f` between the second and the third sample.
pub(crate) fn weights(f: f32) -> [f32; 4] {
    let g = 1.0 - f;
    let (f3, g3) = (f * f * f, g * g * g);
    let sixth = 1.0 / 6.0;
    [
        sixth * g3,
        sixth * (4.0 - 3.0 * f * f * (2.0 - f)),
        sixth * (4.0 - 3.0 * g * g * (2.0 - g)),
        sixth * f3,
    ]
}

/// The reciprocal of the kernel's Fourier transform, `sinc⁻⁴(π k / Q)`, for k = 0, 1, …, `half`.
fn prefilter(half: usize, size: usize) -> Vec<f64> {
    (0..=half)
        .map(|k| tem00_numerics::sinc(PI * to_f64(k) / to_f64(size)).powi(-4))
        .collect()
}

/// The prefilter over the bounding box of the pupil, for each axis.
#[expect(
    clippy::cast_possible_truncation,
    reason = "amplitudes are stored as f32"
)]
pub(crate) fn prefilters(field: &PupilField) -> [Vec<f32>; 2] {
    field.mask().half_extent().map(|half| {
        let filter = prefilter(half, field.size());
        (0..=2 * half)
            .map(|index| filter[index.abs_diff(half)] as f32)
            .collect()
    })
}

/// The mean square of the interpolated field, in closed form.
///
/// ```text
/// v(fx, fy) = Σ R(lx, ly) a(lx; fx) a(ly; fy)      a(l; f) = Σ w(t; f) w(t + l; f)
/// R(lx, ly) = 1/N Σ cos(2π kx lx/Q) cos(2π ky ly/Q) sinc⁻⁸(π kx/Q) sinc⁻⁸(π ky/Q)
/// ```
///
/// R is the autocorrelation of the spline coefficients at the lags that four taps can reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variance {
    /// `table[ly][lx]`, with lags of both signs gathered in one entry.
    table: [[f32; 4]; 4],
}

impl Variance {
    #[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
    pub(crate) fn new(mask: &Mask, size: usize) -> Self {
        let [half_width, half_height] = mask.half_extent();
        let columns = prefix_sums(half_width, size);
        let rows = weighted_cosines(half_height, size);
        let mut table = [[0.0_f64; 4]; 4];
        for (ky, row_weights) in rows.iter().enumerate() {
            let row = mask.row(ky);
            let both_signs = if ky == 0 { 1.0 } else { 2.0 };
            for (lags, row_weight) in table.iter_mut().zip(row_weights) {
                for (lx, sum) in lags.iter_mut().enumerate() {
                    let hole = row.hole.map_or(0.0, |hole| columns[hole][lx]);
                    *sum += both_signs * row_weight * (columns[row.outer][lx] - hole);
                }
            }
        }
        let count = to_f64(mask.count());
        let multiplicity = |lag: usize| if lag == 0 { 1.0 } else { 2.0 };
        let entry = |ly: usize, lx: usize| {
            (table[ly][lx] * multiplicity(lx) * multiplicity(ly) / count) as f32
        };
        Self {
            table: core::array::from_fn(|ly| core::array::from_fn(|lx| entry(ly, lx))),
        }
    }

    fn at(&self, x: &[f32; 4], y: &[f32; 4]) -> f32 {
        let (x, y) = (autocorrelation(x), autocorrelation(y));
        let along = |row: &[f32; 4]| -> f32 { row.iter().zip(&x).map(|(r, a)| r * a).sum() };
        self.table
            .iter()
            .zip(&y)
            .map(|(row, a)| along(row) * a)
            .sum()
    }
}

/// `cos(2π k l / Q) sinc⁻⁸(π k / Q)` for k = 0, 1, …, `half` and l = 0 to 3.
fn weighted_cosines(half: usize, size: usize) -> Vec<[f64; 4]> {
    let weighted = |(k, filter): (usize, f64)| {
        let angle = 2.0 * PI * to_f64(k) / to_f64(size);
        [0.0, 1.0, 2.0, 3.0].map(|lag: f64| (lag * angle).cos() * filter * filter)
    };
    prefilter(half, size)
        .into_iter()
        .enumerate()
        .map(weighted)
        .collect()
}

/// The sums of [`weighted_cosines`] over −n ≤ k ≤ n, for n = 0, 1, …, `half`.
fn prefix_sums(half: usize, size: usize) -> Vec<[f64; 4]> {
    let mut sum = [0.0; 4];
    let running = |(k, terms): (usize, [f64; 4])| {
        let both_signs = if k == 0 { 1.0 } else { 2.0 };
        for (sum, term) in sum.iter_mut().zip(terms) {
            *sum += both_signs * term;
        }
        sum
    };
    weighted_cosines(half, size)
        .into_iter()
        .enumerate()
        .map(running)
        .collect()
}

fn autocorrelation(w: &[f32; 4]) -> [f32; 4] {
    [
        w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3],
        w[0] * w[1] + w[1] * w[2] + w[2] * w[3],
        w[0] * w[2] + w[1] * w[3],
        w[0] * w[3],
    ]
}

/// The sixteen taps around a point of a periodic grid, and the variance they leave.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taps {
    columns: [usize; 4],
    rows: [usize; 4],
    x: [f32; 4],
    y: [f32; 4],
    pub(crate) variance: f32,
}

impl Taps {
    #[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
    pub(crate) fn new(x: f64, y: f64, size: usize, variance: &Variance) -> Self {
        let (column, fx) = wrap_coordinate(x, size);
        let (row, fy) = wrap_coordinate(y, size);
        let (x, y) = (weights(fx as f32), weights(fy as f32));
        Self {
            columns: neighbours(column, size),
            rows: neighbours(row, size),
            x,
            y,
            variance: variance.at(&x, &y),
        }
    }

    pub(crate) fn amplitude(&self, coefficients: &Grid<Complex<f32>>) -> Complex<f32> {
        let along = |row: usize| -> Complex<f32> {
            let values = coefficients.row(row);
            let columns = self.columns.iter().zip(&self.x);
            columns
                .map(|(&column, weight)| values[column] * weight)
                .sum()
        };
        self.rows
            .iter()
            .zip(&self.y)
            .map(|(&row, weight)| along(row) * weight)
            .sum()
    }
}

/// One sample before `cell` and two after it, on the torus.
fn neighbours(cell: usize, size: usize) -> [usize; 4] {
    let wrap = |index: usize| if index < size { index } else { index - size };
    [wrap(cell + size - 1), cell, wrap(cell + 1), wrap(cell + 2)]
}
