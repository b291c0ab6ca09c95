//! Taps of a look-up on the torus, and the interpolated amplitude.

use num_complex::Complex;
use tem00_numerics::Grid;

/// The period of a stack along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Period {
    cells: usize,
    length: f64,
    reciprocal: f64,
}

/// Adding and subtracting this number rounds to an integer.
const ROUNDING: f64 = 1.5 * (1_u64 << 52) as f64;

/// Coordinates below this one are reduced by multiplication.
const NEAR: f64 = (1_u64 << 50) as f64;

impl Period {
    pub(crate) fn new(cells: usize) -> Self {
        let length = cells as f64;
        Self {
            cells,
            length,
            reciprocal: 1.0 / length,
        }
    }

    /// Splits coordinates into the cell, below the period, and the fraction in [0, 1] of the
    /// distance to the next cell.
    ///
    /// No step rounds a value that an `f64` can hold: the number of periods and its product are
    /// integers below 2⁵³, and the difference is a multiple of the last bit of x and smaller than
    /// x. The period is therefore exact. Only a coordinate within rounding below zero gives the end
    /// of the last cell. A coordinate that is not finite gives the last cell and the fraction NaN.
    #[inline(always)]
    pub(crate) fn split<const L: usize>(&self, x: &[f64; L]) -> ([usize; L], [f64; L]) {
        let mut x = *x;
        // A fold without a branch for each coordinate.
        let near = x.iter().fold(true, |near, x| near & (x.abs() < NEAR));
        if !near {
            x = x.map(|x| self.brought_near(x));
        }
        let last = self.length - 1.0;
        let (mut cells, mut fractions) = ([0; L], [0.0; L]);
        for (x, (cell, fraction)) in x.iter().zip(cells.iter_mut().zip(&mut fractions)) {
            let rest = x - round(x * self.reciprocal) * self.length;
            let position = rest + if rest < 0.0 { self.length } else { 0.0 };
            let nearest = round(position);
            let floor = nearest - if nearest > position { 1.0 } else { 0.0 };
            let floor = if floor < last { floor } else { last };
            *cell = low_bits(floor);
            *fraction = position - floor;
        }
        (cells, fractions)
    }

    #[cold]
    fn brought_near(&self, x: f64) -> f64 {
        x % self.length
    }

    /// Returns an index below two periods, on the torus.
    #[inline(always)]
    pub(crate) const fn wrap(&self, index: usize) -> usize {
        if index < self.cells {
            index
        } else {
            index - self.cells
        }
    }
}

/// Rounds to the nearest integer, without the function call that basic processors need.
#[inline(always)]
fn round(x: f64) -> f64 {
    x + ROUNDING - ROUNDING
}

/// Converts an integral number below 2³², from the last bits of its sum with a large number.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
fn low_bits(x: f64) -> usize {
    (x + ROUNDING).to_bits() as u32 as usize
}

/// The taps around L coordinates along one axis of a periodic grid.
///
/// The points of a batch lie side by side, so that one vector instruction serves several.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taps<const L: usize> {
    /// The first of the four cells, one after the other on the torus.
    first: [usize; L],
    weights: [[f32; L]; 4],
    /// The fractions from which the weights follow.
    pub(crate) fractions: [f32; L],
    /// The coordinates of the taps, within one period.
    pub(crate) positions: [f64; L],
}

impl<const L: usize> Taps<L> {
    /// The taps around `x`.
    #[inline(always)]
    pub(crate) fn around(x: &[f64; L], period: &Period) -> Self {
        let (cells, f) = period.split(x);
        let fractions = to_single(&f);
        let mut weights = [[0.0; L]; 4];
        let mut first = cells;
        for i in 0..L {
            let [a, b, c, d] = cubic_weights(fractions[i]);
            weights[0][i] = a;
            weights[1][i] = b;
            weights[2][i] = c;
            weights[3][i] = d;
            first[i] = period.wrap(cells[i] + period.cells - 1);
        }
        Self {
            first,
            weights,
            fractions,
            positions: positions(&cells, &f),
        }
    }
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
fn to_single<const L: usize>(x: &[f64; L]) -> [f32; L] {
    let mut single = [0.0; L];
    for (single, x) in single.iter_mut().zip(x) {
        *single = *x as f32;
    }
    single
}

#[inline(always)]
fn positions<const L: usize>(cells: &[usize; L], fractions: &[f64; L]) -> [f64; L] {
    let mut positions = [0.0; L];
    for (position, (cell, f)) in positions.iter_mut().zip(cells.iter().zip(fractions)) {
        *position = *cell as f64 + f;
    }
    positions
}

/// The four taps of the cubic B-spline at the fraction `f` between the second and the third.
#[inline(always)]
pub(crate) fn cubic_weights(f: f32) -> [f32; 4] {
    let g = 1.0 - f;
    let sixth = 1.0 / 6.0;
    let (ff, gg) = (f * f, g * g);
    [
        sixth * g * gg,
        2.0 / 3.0 - 0.5 * ff * (2.0 - f),
        2.0 / 3.0 - 0.5 * gg * (2.0 - g),
        sixth * f * ff,
    ]
}

/// The interpolated amplitudes, real and imaginary parts.
#[inline(always)]
pub(crate) fn amplitudes<const L: usize>(
    coefficients: &Grid<Complex<f32>>,
    x: &Taps<L>,
    y: &Taps<L>,
) -> [[f32; L]; 2] {
    let (width, height) = (coefficients.width(), coefficients.height());
    let mut halves = [[0.0; 4]; L];
    for (i, halves) in halves.iter_mut().enumerate() {
        let (column, row) = (x.first[i], y.first[i]);
        let mut sums = Sums::default();
        if column + 4 <= width && row + 4 <= height {
            let from = row * width + column;
            let window = &coefficients.values()[from..from + 3 * width + 4];
            for (t, weights) in y.weights.iter().enumerate() {
                if let Some(taps) = window[t * width..].first_chunk() {
                    sums.add(taps, weights[i]);
                }
            }
        } else {
            sums = across_a_seam(coefficients, [column, row], y, i);
        }
        *halves = sums.weighted(x, i);
    }
    let mut parts = [[0.0; L]; 2];
    for (i, half) in halves.iter().enumerate() {
        parts[0][i] = half[0] + half[2];
        parts[1][i] = half[1] + half[3];
    }
    parts
}

/// The sums over the rows if the taps lie on both sides of the seam of the torus.
#[cold]
#[inline(never)]
fn across_a_seam<const L: usize>(
    coefficients: &Grid<Complex<f32>>,
    [column, row]: [usize; 2],
    y: &Taps<L>,
    i: usize,
) -> Sums {
    let mut sums = Sums::default();
    for (t, weights) in y.weights.iter().enumerate() {
        let values = coefficients.row((row + t) % coefficients.height());
        let taps: [_; 4] = core::array::from_fn(|x| values[(column + x) % values.len()]);
        sums.add(&taps, weights[i]);
    }
    sums
}

/// Σ over the rows of the four columns: real and imaginary parts of two columns side by side, as
/// vector instructions need them.
#[derive(Clone, Copy, Default)]
struct Sums([[f32; 4]; 2]);

impl Sums {
    #[inline(always)]
    fn add(&mut self, taps: &[Complex<f32>; 4], weight: f32) {
        let [a, b, c, d] = taps;
        let pairs = [[a.re, a.im, b.re, b.im], [c.re, c.im, d.re, d.im]];
        for (sums, values) in self.0.iter_mut().zip(pairs) {
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += value * weight;
            }
        }
    }

    /// Σ over every other column.
    #[inline(always)]
    fn weighted<const L: usize>(&self, x: &Taps<L>, i: usize) -> [f32; 4] {
        let mut total = [0.0; 4];
        for (t, sums) in self.0.iter().enumerate() {
            let (a, b) = (x.weights[2 * t][i], x.weights[2 * t + 1][i]);
            let weights = [a, a, b, b];
            for (total, (sum, weight)) in total.iter_mut().zip(sums.iter().zip(weights)) {
                *total += sum * weight;
            }
        }
        total
    }
}

#[cfg(test)]
mod tests;
