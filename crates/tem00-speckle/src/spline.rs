//! Interpolation of a band-limited random field, and the variance it leaves.

use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::{Grid, wrap_coordinate};

use crate::{
    Interpolation,
    field::PupilField,
    lattice::to_i64,
    mask::{Mask, from_i64, to_f64},
    transmission::to_c64,
};

/// The four taps of the cubic B-spline that reach the fraction `f` between the second and the third.
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

/// What the pupil point k is multiplied with: the reciprocal of the spline's Fourier transform,
/// `sinc⁻⁴(π k / Q)`. The other interpolations go through the samples themselves.
pub(crate) fn prefilter(k: i64, size: usize, interpolation: Interpolation) -> f64 {
    match interpolation {
        Interpolation::CubicSpline => {
            tem00_numerics::sinc(PI * from_i64(k) / to_f64(size)).powi(-4)
        }
        Interpolation::Bilinear | Interpolation::Nearest => 1.0,
    }
}

/// The lattice points along one axis of the mask's box.
fn points(mask: &Mask, axis: usize) -> impl Iterator<Item = i64> {
    let corner = mask.corner()[axis];
    (0..mask.extent()[axis]).map(move |index| corner + to_i64(index))
}

/// The prefilter over the bounding box of the pupil, for each axis.
#[expect(
    clippy::cast_possible_truncation,
    reason = "amplitudes are stored as f32"
)]
pub(crate) fn prefilters(field: &PupilField, interpolation: Interpolation) -> [Vec<f32>; 2] {
    [0, 1].map(|axis| {
        points(&field.mask, axis)
            .map(|k| prefilter(k, field.size()[axis], interpolation) as f32)
            .collect()
    })
}

/// The mean square of the interpolated field, in closed form.
///
/// ```text
/// v(fx, fy) = Σ R(lx, ly) a(lx; fx) a(ly; fy)      a(l; f) = Σ w(t; f) w(t + l; f)
/// R(lx, ly) = Σ p cos(2π kx lx/Q) cos(2π ky ly/Q) b(kx)² b(ky)² / Σ p
/// ```
///
/// R is the autocorrelation of the coefficients at the lags that four taps can reach, the mean over
/// both signs of each lag, with the prefilter b and the power p of the pupil points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variance {
    /// `table[ly][lx]`, with lags of both signs gathered in one entry.
    pub(crate) table: [[f32; 4]; 4],
}

impl Variance {
    /// The expected variance over random phasors.
    pub(crate) fn expected(field: &PupilField, interpolation: Interpolation) -> Self {
        Self::new(field, interpolation, |y| field.mask.powers(y))
    }

    /// The variance of what the pupil sees of a field from outside, given over the mask's box.
    pub(crate) fn of(
        seen: &Grid<Complex<f32>>,
        field: &PupilField,
        interpolation: Interpolation,
    ) -> Self {
        Self::new(field, interpolation, |y| {
            let square = |z: &Complex<f32>| to_c64(*z).norm_sqr();
            seen.row(y).iter().map(square).enumerate()
        })
    }

    fn new<P: Iterator<Item = (usize, f64)>>(
        field: &PupilField,
        interpolation: Interpolation,
        powers: impl Fn(usize) -> P,
    ) -> Self {
        let columns = weighted_cosines(field, 0, interpolation);
        let rows = weighted_cosines(field, 1, interpolation);
        let mut total = 0.0;
        let mut table = [[0.0_f64; 4]; 4];
        for (y, row_weights) in rows.iter().enumerate() {
            let mut sums = [0.0; 4];
            for (x, power) in powers(y) {
                total += power;
                for (sum, term) in sums.iter_mut().zip(columns[x]) {
                    *sum += power * term;
                }
            }
            for (lags, row_weight) in table.iter_mut().zip(row_weights) {
                for (entry, sum) in lags.iter_mut().zip(sums) {
                    *entry += row_weight * sum;
                }
            }
        }
        Self::normalised(table, total)
    }

    #[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
    fn normalised(table: [[f64; 4]; 4], total: f64) -> Self {
        let multiplicity = |lag: usize| if lag == 0 { 1.0 } else { 2.0 };
        let entry = |ly: usize, lx: usize| {
            if total > 0.0 {
                (table[ly][lx] * multiplicity(lx) * multiplicity(ly) / total) as f32
            } else {
                // Without light any variance will do; this one is 1 at every fraction.
                if ly + lx == 0 {
                    1.0
                } else {
                    multiplicity(lx) as f32 * multiplicity(ly) as f32
                }
            }
        };
        Self {
            table: core::array::from_fn(|ly| core::array::from_fn(|lx| entry(ly, lx))),
        }
    }

    #[inline]
    pub(crate) fn at<const N: usize>(&self, x: &Axis<N>, y: &Axis<N>) -> f32 {
        let (x, y) = (autocorrelation(&x.weights), autocorrelation(&y.weights));
        let along = |row: &[f32; 4]| -> f32 { row.iter().zip(&x).map(|(r, a)| r * a).sum() };
        self.table
            .iter()
            .zip(&y)
            .map(|(row, a)| along(row) * a)
            .sum()
    }
}

/// `cos(2π k l / Q) b(k)²` for l = 0 to 3, for each lattice point k along an axis.
fn weighted_cosines(
    field: &PupilField,
    axis: usize,
    interpolation: Interpolation,
) -> Vec<[f64; 4]> {
    let size = field.size()[axis];
    let weighted = |k: i64| {
        let angle = 2.0 * PI * from_i64(k) / to_f64(size);
        let filter = prefilter(k, size, interpolation).powi(2);
        [0.0, 1.0, 2.0, 3.0].map(|lag: f64| (lag * angle).cos() * filter)
    };
    points(&field.mask, axis).map(weighted).collect()
}

/// Σ w(t) w(t + l) for each lag l.
#[inline]
fn autocorrelation<const N: usize>(w: &[f32; N]) -> [f32; N] {
    core::array::from_fn(|lag| w[lag..].iter().zip(w).map(|(a, b)| a * b).sum())
}

/// The taps around a coordinate along one axis of a periodic grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis<const N: usize> {
    cells: [usize; N],
    weights: [f32; N],
    /// The coordinate that the taps stand for, in one period.
    pub(crate) place: f64,
}

/// Interpolation along one axis.
pub(crate) trait Along: Copy {
    /// The taps around `x` on a grid with the period `size`.
    fn along(x: f64, size: usize) -> Self;
}

impl Along for Axis<4> {
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
    fn along(x: f64, size: usize) -> Self {
        let (cell, f) = wrap_coordinate(x, size);
        Self {
            cells: [
                wrap(cell + size - 1, size),
                cell,
                wrap(cell + 1, size),
                wrap(cell + 2, size),
            ],
            weights: weights(f as f32),
            place: to_f64(cell) + f,
        }
    }
}

impl Along for Axis<2> {
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
    fn along(x: f64, size: usize) -> Self {
        let (cell, f) = wrap_coordinate(x, size);
        Self {
            cells: [cell, wrap(cell + 1, size)],
            weights: [1.0 - f as f32, f as f32],
            place: to_f64(cell) + f,
        }
    }
}

impl Along for Axis<1> {
    #[inline]
    fn along(x: f64, size: usize) -> Self {
        let (cell, f) = wrap_coordinate(x, size);
        // No branch: which of two samples is nearer, no processor can foresee.
        let nearest = wrap(cell + usize::from(f >= 0.5), size);
        Self {
            cells: [nearest],
            weights: [1.0],
            place: to_f64(nearest),
        }
    }
}

/// An index below two periods, on the torus.
const fn wrap(index: usize, size: usize) -> usize {
    if index < size { index } else { index - size }
}

/// The interpolated amplitude.
#[inline]
pub(crate) fn amplitude<const N: usize>(
    coefficients: &Grid<Complex<f32>>,
    x: &Axis<N>,
    y: &Axis<N>,
) -> Complex<f32> {
    let mut columns = [Complex::new(0.0, 0.0); N];
    for (&row, weight) in y.cells.iter().zip(y.weights) {
        let values = gather(coefficients.row(row), &x.cells);
        for (column, value) in columns.iter_mut().zip(values) {
            *column += value * weight;
        }
    }
    columns
        .iter()
        .zip(x.weights)
        .map(|(c, weight)| c * weight)
        .sum()
}

/// The values of a row; in one piece unless the taps straddle its ends.
#[inline]
fn gather<const N: usize>(row: &[Complex<f32>], cells: &[usize; N]) -> [Complex<f32>; N] {
    match row[cells[0]..].first_chunk() {
        Some(values) => *values,
        None => cells.map(|cell| row[cell]),
    }
}

#[cfg(test)]
mod tests;
