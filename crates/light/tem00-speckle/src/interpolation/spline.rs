//! Interpolation of a band-limited random field, and the variance of the result.

use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::{
    Grid,
    cast::to_c64,
    cast::{to_f32, to_signed},
};

use crate::pupil::{PupilField, mask::Mask};

/// Factor on the pupil point k: the reciprocal of the spline's Fourier transform,
/// `sinc⁻⁴(π k / Q)`.
fn prefilter(k: i64, size: usize) -> f64 {
    tem00_numerics::sinc(PI * k as f64 / size as f64).powi(-4)
}

/// The lattice points along one axis of the mask's box.
fn points(mask: &Mask, axis: usize) -> impl Iterator<Item = i64> {
    let corner = mask.corner()[axis];
    (0..mask.extent()[axis]).map(move |index| corner + to_signed(index))
}

/// The prefilter over the bounding box of the pupil, for each axis.
pub(crate) fn prefilters(field: &PupilField) -> [Vec<f32>; 2] {
    [0, 1].map(|axis| {
        points(&field.mask, axis)
            .map(|k| to_f32(prefilter(k, field.size()[axis])))
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
/// R is the autocorrelation of the coefficients at the lags within four taps, averaged over both
/// signs of each lag, with the prefilter b and the power p of the pupil points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variance {
    /// `table[ly][lx]`, with lags of both signs gathered in one entry.
    pub(crate) table: [[f32; 4]; 4],
}

impl Variance {
    /// The expected variance over random phasors.
    pub(crate) fn expected(field: &PupilField) -> Self {
        Self::new(field, |y| field.mask.powers(y))
    }

    /// The variance of the external field in the pupil, given over the mask's box.
    pub(crate) fn of_light(seen: &Grid<Complex<f32>>, field: &PupilField) -> Self {
        Self::new(field, |y| {
            let square = |z: &Complex<f32>| to_c64(*z).norm_sqr();
            seen.row(y).iter().map(square).enumerate()
        })
    }

    fn new<P: Iterator<Item = (usize, f64)>>(
        field: &PupilField,
        powers: impl Fn(usize) -> P,
    ) -> Self {
        let columns = weighted_cosines(field, 0);
        let rows = weighted_cosines(field, 1);
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

    fn normalised(table: [[f64; 4]; 4], total: f64) -> Self {
        let multiplicity = |lag: usize| if lag == 0 { 1.0 } else { 2.0 };
        let entry = |ly: usize, lx: usize| {
            if total > 0.0 {
                to_f32(table[ly][lx] * multiplicity(lx) * multiplicity(ly) / total)
            } else {
                // Without light the variance is arbitrary; this one is 1 at every fraction.
                if ly + lx == 0 {
                    1.0
                } else {
                    to_f32(multiplicity(lx) * multiplicity(ly))
                }
            }
        };
        Self {
            table: core::array::from_fn(|ly| core::array::from_fn(|lx| entry(ly, lx))),
        }
    }
}

/// `cos(2π k l / Q) b(k)²` for l = 0 to 3, for each lattice point k along an axis.
fn weighted_cosines(field: &PupilField, axis: usize) -> Vec<[f64; 4]> {
    let size = field.size()[axis];
    let weighted = |k: i64| {
        let angle = 2.0 * PI * k as f64 / size as f64;
        let filter = prefilter(k, size).powi(2);
        [0.0, 1.0, 2.0, 3.0].map(|lag: f64| (lag * angle).cos() * filter)
    };
    points(&field.mask, axis).map(weighted).collect()
}

/// The weights of the taps −1, 0, 1 and 2 at the fraction `f` of the way from 0 to 1.
fn weights(f: f64) -> [f64; 4] {
    [-1.0, 0.0, 1.0, 2.0].map(|tap: f64| kernel((tap - f).abs()))
}

/// The cubic B-spline at the distance x from its middle.
fn kernel(x: f64) -> f64 {
    let tail = (2.0 - x).max(0.0).powi(3);
    let head = (1.0 - x).max(0.0).powi(3);
    (tail - 4.0 * head) / 6.0
}

/// Σ w(t) w(t + l) for the lags l = 0 to 3.
pub(crate) fn lag_products(f: f64) -> [f64; 4] {
    let w = weights(f);
    core::array::from_fn(|lag| w[lag..].iter().zip(&w).map(|(a, b)| a * b).sum())
}

/// Response of the interpolation at the fraction `f` to the wave of the pupil point k, divided by
/// the wave.
///
/// ```text
/// g(k; f) = b(k) Σ w(t) exp(−2πi k (t − f) / Q)
/// ```
pub(crate) fn response(k: i64, f: f64, size: usize) -> Complex<f64> {
    let angle = 2.0 * PI * k as f64 / size as f64;
    let taps = weights(f).into_iter().zip([-1.0, 0.0, 1.0, 2.0]);
    let sum: Complex<f64> = taps
        .map(|(weight, tap)| Complex::from_polar(weight, -angle * (tap - f)))
        .sum();
    sum * prefilter(k, size)
}
