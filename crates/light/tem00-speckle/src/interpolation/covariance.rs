//! Mean squares after interpolation, as polynomials of the fractions.
//!
//! Interpolation multiplies the wave `exp(−2πi k x / Q)` of a pupil point k by a response `g(k; f)`
//! near 1 (see [`response`]). Mean squares are sums of products of two responses over the pupil,
//! one axis times the other. Along each axis the real part of such a product is even about f = ½
//! and the imaginary part odd, so that both are polynomials of `p = f (1 − f)`, the odd part after
//! division by `p (1 − 2f)`. For one slice this is exact, with degree 3 in p. For two slices with
//! different pupil positions, the products also turn with f. The polynomials then have errors of at
//! most 1e−6, and of 2e−5 in the odd parts, which cancel for a symmetric pupil.

use num_complex::Complex;
use tem00_numerics::{
    Grid,
    cast::to_c64,
    cast::{to_f32, to_signed},
};

use crate::{
    PupilField,
    interpolation::spline::{Variance, lag_products, response},
    pupil::mask::{Row, Span},
};

/// Number of powers of p in the part that is even about the middle.
pub(crate) const EVEN: usize = 4;
/// Number of powers of p in the odd part.
const ODD: usize = 2;
/// Number of shapes along one axis: 1, p, p², p³ and o, o p with o = p (1 − 2f).
pub(crate) const SHAPES: usize = EVEN + ODD;

/// Coefficients of the products of even shapes, `[ny][nx]`.
pub(crate) type Even = [[f32; EVEN]; EVEN];

/// Σ c[ny][nx] py^ny px^nx, with p = f (1 − f) along each axis.
#[inline(always)]
pub(crate) fn even_at<const L: usize>(table: &Even, x: &[f32; L], y: &[f32; L]) -> [f32; L] {
    let mut sums = [0.0; L];
    for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
        let (px, py) = (x * (1.0 - x), y * (1.0 - y));
        let along = |[a, b, c, d]: [f32; EVEN]| ((d * px + c) * px + b) * px + a;
        let [a, b, c, d] = [
            along(table[0]),
            along(table[1]),
            along(table[2]),
            along(table[3]),
        ];
        *sum = ((d * py + c) * py + b) * py + a;
    }
    sums
}

/// The covariance of the interpolated amplitudes of two slices at one point, in the common frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Covariance {
    pub(crate) even: Even,
    /// The terms with an odd shape, unless they are below the resolution of `f32` amplitudes.
    odd: Option<[[f32; SHAPES]; SHAPES]>,
}

impl Covariance {
    /// The covariances at L fractions.
    #[inline(always)]
    pub(crate) fn at<const L: usize>(&self, x: &[f32; L], y: &[f32; L]) -> [f32; L] {
        let mut sums = even_at(&self.even, x, y);
        if let Some(odd) = &self.odd {
            for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
                *sum += odd_at(odd, *x, *y);
            }
        }
        sums
    }

    /// The coefficients of the products of all shapes, `[ny][nx]`.
    pub(crate) fn table(&self) -> [[f32; SHAPES]; SHAPES] {
        let mut table = self.odd.unwrap_or([[0.0; SHAPES]; SHAPES]);
        for (row, even) in table.iter_mut().zip(&self.even) {
            row[..EVEN].copy_from_slice(even);
        }
        table
    }

    fn new(table: [[f64; SHAPES]; SHAPES]) -> Self {
        // The largest value of each shape: p ≤ ¼, o ≤ √3/18.
        const LARGEST: [f64; SHAPES] = [1.0, 0.25, 0.0625, 0.015_625, 0.096_3, 0.024_1];
        const RESOLVED: f64 = 2e-6;
        let even = core::array::from_fn(|ny| core::array::from_fn(|nx| to_f32(table[ny][nx])));
        let mut odd = table;
        for row in odd.iter_mut().take(EVEN) {
            row[..EVEN].fill(0.0);
        }
        let bound: f64 = odd
            .iter()
            .zip(LARGEST)
            .map(|(row, y)| {
                y * row
                    .iter()
                    .zip(LARGEST)
                    .map(|(c, x)| c.abs() * x)
                    .sum::<f64>()
            })
            .sum();

        Self {
            even,
            odd: (bound > RESOLVED).then(|| odd.map(|row| row.map(to_f32))),
        }
    }
}

#[inline(always)]
fn odd_at(table: &[[f32; SHAPES]; SHAPES], x: f32, y: f32) -> f32 {
    let (x, y) = (shapes_at(x), shapes_at(y));
    let mut sum = 0.0;
    for ny in 0..SHAPES {
        for nx in if ny < EVEN { EVEN } else { 0 }..SHAPES {
            sum += table[ny][nx] * y[ny] * x[nx];
        }
    }
    sum
}

#[inline(always)]
fn shapes_at(f: f32) -> [f32; SHAPES] {
    let p = f * (1.0 - f);
    let o = p * (1.0 - 2.0 * f);
    [1.0, p, p * p, p * p * p, o, o * p]
}

/// The responses of the lattice points of the pupil's box along each axis, from which the
/// covariance of any two slices follows.
pub(crate) struct Responses([Vec<[Complex<f64>; SHAPES]>; 2]);

impl Responses {
    pub(crate) fn new(field: &PupilField) -> Self {
        let fractions = fractions();
        Self([0, 1].map(|axis| {
            let (corner, size) = (field.mask.corner()[axis], field.size()[axis]);
            (0..field.mask.extent()[axis])
                .map(|index| {
                    let k = corner + to_signed(index);
                    fractions.map(|f| response(k, f, size))
                })
                .collect()
        }))
    }

    /// The covariance of two slices of phasors whose pupils are `shift` lattice points apart.
    pub(crate) fn of_phasors(&self, field: &PupilField, shift: [i64; 2]) -> Covariance {
        let mask = &field.mask;
        let shapes = self.shapes(shift);
        let running = running_sums(&shapes[0]);
        let table = sum_rows(&shapes[1], shift[1], |y, other| {
            match (mask.weights(y), mask.weights(other)) {
                (Some(a), Some(b)) => weighted(a, b, shift[0], &shapes[0]),
                _ => counted(mask.row(y), mask.row(other), shift[0], &running),
            }
        });
        Covariance::new(table.map(|row| row.map(|entry| entry / mask.power())))
    }

    /// The covariance of two slices whose pupils contain the fields `here` and, displaced by
    /// `shift`, `next`.
    pub(crate) fn of_light(
        &self,
        here: &Grid<Complex<f32>>,
        next: &Grid<Complex<f32>>,
        shift: [i64; 2],
    ) -> Covariance {
        let shapes = self.shapes(shift);
        Covariance::new(sum_rows(&shapes[1], shift[1], |y, other| {
            weighted(here.row(y), next.row(other), shift[0], &shapes[0])
        }))
    }

    /// For each axis and each point k: the coefficients of `g(k; f) g*(k − shift; f)`.
    fn shapes(&self, shift: [i64; 2]) -> [Vec<[f64; SHAPES]>; 2] {
        let fit = Fit::new();
        [0, 1].map(|axis| {
            let responses = &self.0[axis];
            let shapes = responses.iter().enumerate().map(|(index, here)| {
                let other = moved(index, shift[axis]).and_then(|other| responses.get(other));
                other.map_or([0.0; SHAPES], |there| fit.product(here, there))
            });
            shapes.collect()
        })
    }
}

/// The index of the same lattice point in a box displaced by `shift`.
fn moved(index: usize, shift: i64) -> Option<usize> {
    usize::try_from(to_signed(index).saturating_sub(shift)).ok()
}

/// Σ over the rows that both pupils share, of the sums along each row.
fn sum_rows(
    shapes: &[[f64; SHAPES]],
    shift: i64,
    along: impl Fn(usize, usize) -> [Complex<f64>; SHAPES],
) -> [[f64; SHAPES]; SHAPES] {
    let mut table = [[0.0; SHAPES]; SHAPES];
    for (y, shape) in shapes.iter().enumerate() {
        let Some(other) = moved(y, shift).filter(|&other| other < shapes.len()) else {
            continue;
        };
        let sums = along(y, other);
        for (ny, (row, factor)) in table.iter_mut().zip(shape).enumerate() {
            for (nx, (entry, sum)) in row.iter_mut().zip(sums).enumerate() {
                // Odd shapes are imaginary.
                let real = match (ny < EVEN, nx < EVEN) {
                    (true, true) => sum.re,
                    (false, false) => -sum.re,
                    _ => -sum.im,
                };
                *entry += factor * real;
            }
        }
    }
    table
}

/// Σ over the columns of a b* · shape.
fn weighted(
    a: &[Complex<f32>],
    b: &[Complex<f32>],
    shift: i64,
    shapes: &[[f64; SHAPES]],
) -> [Complex<f64>; SHAPES] {
    let mut sums = [Complex::new(0.0, 0.0); SHAPES];
    for (x, (a, shape)) in a.iter().zip(shapes).enumerate() {
        let Some(b) = moved(x, shift).and_then(|other| b.get(other)) else {
            continue;
        };
        let product = to_c64(*a) * to_c64(*b).conj();
        for (sum, coefficient) in sums.iter_mut().zip(shape) {
            *sum += product * coefficient;
        }
    }
    sums
}

/// The sums of all shapes before each column, and after the last.
fn running_sums(shapes: &[[f64; SHAPES]]) -> Vec<[f64; SHAPES]> {
    let mut sums = vec![[0.0; SHAPES]];
    let mut sum = [0.0; SHAPES];
    for shape in shapes {
        for (sum, coefficient) in sum.iter_mut().zip(shape) {
            *sum += coefficient;
        }
        sums.push(sum);
    }
    sums
}

/// Σ of the shapes over the columns that two rows share, of which the second is shifted.
fn counted(a: Row, b: Row, shift: i64, running: &[[f64; SHAPES]]) -> [Complex<f64>; SHAPES] {
    let mut sums = [Complex::new(0.0, 0.0); SHAPES];
    let mut add = |a: Span, b: Span, sign: f64| {
        let along = |n: usize| usize::try_from(to_signed(n).saturating_add(shift)).unwrap_or(0);
        let (start, end) = (a.start.max(along(b.start)), a.end.min(along(b.end)));
        if start < end {
            for (n, sum) in sums.iter_mut().enumerate() {
                *sum += sign * (running[end][n] - running[start][n]);
            }
        }
    };
    add(a.outer, b.outer, 1.0);
    add(a.outer, b.hole, -1.0);
    add(a.hole, b.outer, -1.0);
    add(a.hole, b.hole, 1.0);
    sums
}

/// The polynomials of p through given values.
struct Fit {
    even: [[f64; EVEN]; EVEN],
    odd: [[f64; ODD]; ODD],
}

impl Fit {
    fn new() -> Self {
        let mut odd = basis(nodes::<ODD>());
        let middle = &fractions()[EVEN..];
        for (polynomial, f) in odd.iter_mut().zip(middle) {
            let scale = f * (1.0 - f) * (1.0 - 2.0 * f);
            *polynomial = polynomial.map(|c| c / scale);
        }
        Self {
            even: basis(nodes::<EVEN>()),
            odd,
        }
    }

    /// The coefficients of the product of one response and the conjugate of another.
    fn product(
        &self,
        here: &[Complex<f64>; SHAPES],
        there: &[Complex<f64>; SHAPES],
    ) -> [f64; SHAPES] {
        let products: [_; SHAPES] = core::array::from_fn(|n| here[n] * there[n].conj());
        let mut shape = [0.0; SHAPES];
        for (polynomial, product) in self.even.iter().zip(products) {
            for (entry, c) in shape.iter_mut().zip(polynomial) {
                *entry += c * product.re;
            }
        }
        for (polynomial, product) in self.odd.iter().zip(&products[EVEN..]) {
            for (entry, c) in shape[EVEN..].iter_mut().zip(polynomial) {
                *entry += c * product.im;
            }
        }
        shape
    }
}

/// Chebyshev's points of [0, ¼], where p lies.
fn nodes<const N: usize>() -> [f64; N] {
    let step = core::f64::consts::PI / (2.0 * N as f64);
    core::array::from_fn(|n| 0.125 * (1.0 - (step * (2 * n + 1) as f64).cos()))
}

/// The fractions below ½ at the nodes of the even part, then at the nodes of the odd part.
fn fractions() -> [f64; SHAPES] {
    let fraction = |p: f64| 0.5 - (0.25 - p).sqrt();
    let (even, odd) = (nodes::<EVEN>(), nodes::<ODD>());
    core::array::from_fn(|n| fraction(if n < EVEN { even[n] } else { odd[n - EVEN] }))
}

/// The coefficients of the polynomials that are 1 at one node and 0 at all others.
fn basis<const N: usize>(nodes: [f64; N]) -> [[f64; N]; N] {
    core::array::from_fn(|own| {
        let mut polynomial = [0.0; N];
        polynomial[0] = 1.0;
        for (other, node) in nodes.iter().enumerate() {
            if other == own {
                continue;
            }
            // Times (p − node) / (own − node).
            let scale = 1.0 / (nodes[own] - node);
            for power in (0..N).rev() {
                let below = if power > 0 {
                    polynomial[power - 1]
                } else {
                    0.0
                };
                polynomial[power] = scale * (below - node * polynomial[power]);
            }
        }
        polynomial
    })
}

/// The mean square of one slice as a polynomial, instead of the sum over lags.
pub(crate) fn mean_square(variance: &Variance) -> Even {
    let (basis, fractions) = (basis(nodes::<EVEN>()), fractions());
    // For each lag, the polynomial of Σ w(t) w(t + lag).
    let mut lags = [[0.0; EVEN]; 4];
    for (polynomial, f) in basis.iter().zip(fractions) {
        for (lag, product) in lags.iter_mut().zip(lag_products(f)) {
            for (entry, c) in lag.iter_mut().zip(polynomial) {
                *entry += c * product;
            }
        }
    }
    let mut table = [[0.0_f64; EVEN]; EVEN];
    for (row, ly) in variance.table.iter().zip(&lags) {
        for (entry, lx) in row.iter().zip(&lags) {
            for (out, cy) in table.iter_mut().zip(ly) {
                for (out, cx) in out.iter_mut().zip(lx) {
                    *out += f64::from(*entry) * cy * cx;
                }
            }
        }
    }
    table.map(|row| row.map(to_f32))
}

#[cfg(test)]
pub(super) mod tests;
