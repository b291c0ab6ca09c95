//! Cubic B-spline interpolation of a band-limited random field, and the variance it leaves.

use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::{Grid, wrap_coordinate};

use crate::{
    field::PupilField,
    lattice::to_i64,
    mask::{Mask, from_i64, to_f64},
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

/// The reciprocal of the kernel's Fourier transform, `sinc⁻⁴(π k / Q)`.
fn prefilter(k: i64, size: usize) -> f64 {
    tem00_numerics::sinc(PI * from_i64(k) / to_f64(size)).powi(-4)
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
pub(crate) fn prefilters(field: &PupilField) -> [Vec<f32>; 2] {
    [0, 1].map(|axis| {
        points(&field.mask, axis)
            .map(|k| prefilter(k, field.size()[axis]) as f32)
            .collect()
    })
}

/// The mean square of the interpolated field, in closed form.
///
/// ```text
/// v(fx, fy) = Σ R(lx, ly) a(lx; fx) a(ly; fy)      a(l; f) = Σ w(t; f) w(t + l; f)
/// R(lx, ly) = Σ |t|² cos(2π kx lx/Q) cos(2π ky ly/Q) sinc⁻⁸(π kx/Q) sinc⁻⁸(π ky/Q) / Σ |t|²
/// ```
///
/// R is the autocorrelation of the spline coefficients at the lags that four taps can reach, the mean
/// over both signs of each lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variance {
    /// `table[ly][lx]`, with lags of both signs gathered in one entry.
    table: [[f32; 4]; 4],
}

impl Variance {
    #[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
    pub(crate) fn new(mask: &Mask, size: [usize; 2]) -> Self {
        let columns = weighted_cosines(mask, 0, size[0]);
        let rows = weighted_cosines(mask, 1, size[1]);
        let mut table = [[0.0_f64; 4]; 4];
        for (y, row_weights) in rows.iter().enumerate() {
            let mut sums = [0.0; 4];
            for (x, power) in mask.powers(y) {
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
        let multiplicity = |lag: usize| if lag == 0 { 1.0 } else { 2.0 };
        let entry = |ly: usize, lx: usize| {
            (table[ly][lx] * multiplicity(lx) * multiplicity(ly) / mask.power()) as f32
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

/// `cos(2π k l / Q) sinc⁻⁸(π k / Q)` for l = 0 to 3, for each lattice point k along an axis.
fn weighted_cosines(mask: &Mask, axis: usize, size: usize) -> Vec<[f64; 4]> {
    let weighted = |k: i64| {
        let angle = 2.0 * PI * from_i64(k) / to_f64(size);
        let filter = prefilter(k, size).powi(2);
        [0.0, 1.0, 2.0, 3.0].map(|lag: f64| (lag * angle).cos() * filter)
    };
    points(mask, axis).map(weighted).collect()
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
    /// The point, reduced to one period.
    pub(crate) point: [f64; 2],
}

impl Taps {
    #[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
    pub(crate) fn new(x: f64, y: f64, size: [usize; 2], variance: &Variance) -> Self {
        let (column, fx) = wrap_coordinate(x, size[0]);
        let (row, fy) = wrap_coordinate(y, size[1]);
        let (x, y) = (weights(fx as f32), weights(fy as f32));
        Self {
            columns: neighbours(column, size[0]),
            rows: neighbours(row, size[1]),
            x,
            y,
            variance: variance.at(&x, &y),
            point: [to_f64(column) + fx, to_f64(row) + fy],
        }
    }

    #[inline]
    pub(crate) fn amplitude(&self, coefficients: &Grid<Complex<f32>>) -> Complex<f32> {
        let mut columns = [Complex::new(0.0, 0.0); 4];
        for (&row, weight) in self.rows.iter().zip(self.y) {
            let values = self.gather(coefficients.row(row));
            for (column, value) in columns.iter_mut().zip(values) {
                *column += value * weight;
            }
        }
        columns
            .iter()
            .zip(self.x)
            .map(|(c, weight)| c * weight)
            .sum()
    }

    /// The four values of a row; in one piece unless the taps straddle its ends.
    #[inline]
    fn gather(&self, row: &[Complex<f32>]) -> [Complex<f32>; 4] {
        match row[self.columns[0]..].first_chunk() {
            Some(values) => *values,
            None => self.columns.map(|column| row[column]),
        }
    }
}

/// One sample before `cell` and two after it, on the torus.
fn neighbours(cell: usize, size: usize) -> [usize; 4] {
    let wrap = |index: usize| if index < size { index } else { index - size };
    [wrap(cell + size - 1), cell, wrap(cell + 1), wrap(cell + 2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cubic B-spline by its definition (Unser 1999, eq. 5).
    fn kernel(x: f64) -> f64 {
        let x = x.abs();
        if x < 1.0 {
            2.0 / 3.0 - x * x + 0.5 * x * x * x
        } else {
            (2.0 - x.min(2.0)).powi(3) / 6.0
        }
    }

    /// What interpolation at the fraction `f` makes of the wave `exp(−2πi k x / Q)`, over the wave.
    fn gain(k: f64, f: f64, size: usize) -> Complex<f64> {
        let angle = 2.0 * PI * k / to_f64(size);
        let filter = (0.5 * angle / (0.5 * angle).sin()).powi(4);
        let filter = if filter.is_nan() { 1.0 } else { filter };
        [-1.0, 0.0, 1.0, 2.0]
            .iter()
            .map(|t| Complex::from_polar(filter * kernel(t - f), -angle * (t - f)))
            .sum()
    }

    fn points(mask: &Mask) -> Vec<([f64; 2], f64)> {
        let [x0, y0] = mask.corner();
        (0..mask.extent()[1])
            .flat_map(|y| mask.powers(y).map(move |(x, power)| (x, y, power)))
            .map(|(x, y, power)| {
                let k = [from_i64(x0 + to_i64(x)), from_i64(y0 + to_i64(y))];
                (k, power)
            })
            .collect()
    }

    fn mask(size: [usize; 2], speckle_size: f64, pupil: crate::Pupil) -> Mask {
        let field = PupilField::from_speckle_size(size, speckle_size, 0).unwrap();
        field.with_pupil(pupil).unwrap().mask
    }

    /// The mean over the mask of `term(gain at f)`.
    fn mean(
        mask: &Mask,
        size: [usize; 2],
        f: [f64; 2],
        term: impl Fn([f64; 2], Complex<f64>) -> f64,
    ) -> f64 {
        let sum: f64 = points(mask)
            .iter()
            .map(|&([x, y], power)| {
                power * term([x, y], gain(x, f[0], size[0]) * gain(y, f[1], size[1]))
            })
            .sum();
        sum / mask.power()
    }

    const FRACTIONS: [[f64; 2]; 5] = [
        [0.0, 0.0],
        [0.5, 0.0],
        [0.0, 0.25],
        [0.5, 0.5],
        [0.875, 0.125],
    ];

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "exact fractions")]
    fn weights_are_the_kernel_at_the_four_samples() {
        for f in [0.0, 0.125, 0.25, 0.5, 0.75, 0.999_023_437_5] {
            let weights = weights(f as f32);
            for (t, weight) in [-1.0, 0.0, 1.0, 2.0].iter().zip(weights) {
                let error = f64::from(weight) - kernel(t - f);
                assert!(error.abs() < 1e-7, "tap {t} at {f}: {error:e}");
            }
        }
    }

    #[test]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "exact fractions and small integers"
    )]
    fn the_closed_variance_is_the_mean_square_gain() {
        let slanted = Grid::from_fn(9, 9, |x, y| (40 + x + x * y) as f32 / 112.0);
        let slanted = crate::Transmission::new(&slanted).unwrap();
        for (size, speckle_size) in [
            ([20, 20], 2.0),
            ([33, 33], 2.0625),
            ([64, 64], 5.3),
            ([36, 26], 2.5),
        ] {
            for pupil in [
                crate::Pupil::Circle,
                crate::Pupil::Annulus { inner: 0.4 },
                crate::Pupil::Rectangle { height: 0.8 },
                crate::Pupil::Gaussian { radius: 0.6 },
                crate::Pupil::Sampled(slanted.clone()),
            ] {
                let mask = mask(size, speckle_size, pupil.clone());
                let variance = Variance::new(&mask, size);
                for [fx, fy] in FRACTIONS {
                    let expected = mean(&mask, size, [fx, fy], |_, g| g.norm_sqr());
                    let got = variance.at(&weights(fx as f32), &weights(fy as f32));
                    let error = f64::from(got) - expected;
                    // Sums of 16 terms of at most 4 in f32.
                    assert!(
                        error.abs() < 1e-6,
                        "{pupil:?}, {size:?}, ({fx}, {fy}): {error:e}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_error_of_the_spline_is_as_documented() {
        for (size, rms_limit, covariance_limit) in [(64, 4.5e-3, 3.2e-3), (128, 2.1e-4, 1.2e-4)] {
            let mask = mask([size; 2], to_f64(size) / 32.0, crate::Pupil::Circle);
            let size = [size; 2];
            let (mut rms, mut deviation) = (0.0_f64, 0.0_f64);
            for here in FRACTIONS {
                let square = mean(&mask, size, here, |_, g| (g - 1.0).norm_sqr());
                rms = rms.max(square.sqrt());
                let normal = mean(&mask, size, here, |_, g| g.norm_sqr());
                let cells = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [2.0, 0.0], [0.0, 2.0]];
                for (there, cell) in FRACTIONS.iter().flat_map(|f| cells.map(|c| (f, c))) {
                    let lag = [there[0] - here[0] + cell[0], there[1] - here[1] + cell[1]];
                    let covariance = mean(&mask, size, here, |[x, y], g| {
                        let angle = 2.0 * PI * (x * lag[0] + y * lag[1]) / to_f64(size[0]);
                        let other = gain(x, there[0], size[0]) * gain(y, there[1], size[1]);
                        (g * other.conj() * Complex::from_polar(1.0, angle)).re
                    });
                    let other = mean(&mask, size, *there, |_, g| g.norm_sqr());
                    let gamma = covariance * covariance / (normal * other);
                    let exact = mask.correlation(lag, size).norm_sqr();
                    deviation = deviation.max((gamma - exact).abs());
                }
            }
            assert!(
                rms < rms_limit && rms > 0.5 * rms_limit,
                "rms error {rms:e}"
            );
            assert!(deviation < covariance_limit, "deviation {deviation:e}");
        }
    }
}
