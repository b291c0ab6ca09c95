//! Lattice points inside the pupil, and exact sums over them.

use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::{
    Grid,
    cast::to_c64,
    cast::{to_i64, to_signed, to_usize},
};

use crate::Pupil;

/// The lattice points of a pupil about a point of the lattice, and their transmission.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mask {
    /// The first column and row of the box around the points.
    corner: [i64; 2],
    /// The number of columns and rows of the box.
    extent: [usize; 2],
    rows: Vec<Row>,
    /// Transmission over the box, unless it is 1 at all points of the pupil.
    weights: Option<Grid<Complex<f32>>>,
    sums: Sums,
}

/// The columns of a row of the box that belong to the pupil: an outer span minus the hole in
/// its middle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Row {
    pub(crate) outer: Span,
    pub(crate) hole: Span,
}

/// The columns from `start` up to, but excluding, `end`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// The points that transmit, and the sums of |t|² and |t|⁴ over them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sums {
    count: usize,
    square: f64,
    fourth: f64,
}

impl Span {
    pub(crate) const fn range(self) -> core::ops::Range<usize> {
        self.start..self.end
    }

    const fn count(self) -> usize {
        self.end - self.start
    }
}

impl Row {
    fn new(inside: impl Iterator<Item = bool> + Clone) -> Self {
        let mut columns = inside.clone().zip(0..).filter(|(inside, _)| *inside);
        let Some((_, start)) = columns.next() else {
            return Self::default();
        };
        let end = columns.last().map_or(start, |(_, last)| last) + 1;
        let within = inside.zip(0..).skip(start).take(end - start);
        let mut hole = within
            .filter(|(inside, _)| !inside)
            .map(|(_, column)| column);
        let hole = hole.next().map_or_else(Span::default, |first| Span {
            start: first,
            end: hole.last().unwrap_or(first) + 1,
        });
        Self {
            outer: Span { start, end },
            hole,
        }
    }

    fn columns(self) -> impl Iterator<Item = usize> {
        let hole = self.hole.range();
        self.outer.range().filter(move |x| !hole.contains(x))
    }
}

impl Mask {
    /// The points k of a pupil with a diameter of `diameter` points along each axis and its centre
    /// at `fraction`.
    pub(crate) fn new(pupil: &Pupil, diameter: [f64; 2], fraction: [f64; 2]) -> Self {
        let extent = Self::extent_of(pupil, diameter);
        let reach = pupil.reach();
        let along = |axis: usize| {
            let first = fraction[axis] - 0.5 * reach[axis] * diameter[axis] * Pupil::RIM;
            to_i64(first.ceil())
        };
        let corner = [along(0), along(1)];
        let position = |axis: usize| -> Vec<f64> {
            (0..extent[axis])
                .map(|i| ((corner[axis] + to_signed(i)) as f64 - fraction[axis]) / diameter[axis])
                .collect()
        };
        let (x, y) = (position(0), position(1));
        let row = |&y: &f64| Row::new(x.iter().map(move |&x| pupil.contains([x, y])));
        let mut mask = Self {
            corner,
            extent,
            rows: y.iter().map(row).collect(),
            weights: pupil.is_weighted().then(|| {
                Grid::from_fn(extent[0], extent[1], |i, j| {
                    pupil.transmission([x[i], y[j]])
                })
            }),
            sums: Sums::default(),
        };
        mask.sums = mask.sum_up();
        mask
    }

    /// The largest box that the points need for any position of the centre.
    pub(crate) fn extent_of(pupil: &Pupil, diameter: [f64; 2]) -> [usize; 2] {
        let reach = pupil.reach();
        [0, 1].map(|axis| to_usize(reach[axis] * diameter[axis] * Pupil::RIM) + 1)
    }

    fn sum_up(&self) -> Sums {
        let mut sums = Sums::default();
        for y in 0..self.rows.len() {
            for (_, power) in self.powers(y) {
                sums.count += usize::from(power > 0.0);
                sums.square += power;
                sums.fourth += power * power;
            }
        }
        sums
    }

    /// The number of lattice points that transmit, N.
    pub(crate) const fn count(&self) -> usize {
        self.sums.count
    }

    /// Σ |t|².
    pub(crate) const fn power(&self) -> f64 {
        self.sums.square
    }

    /// The number of equal points with the same fluctuations, (Σ |t|²)² / Σ |t|⁴.
    pub(crate) fn effective_count(&self) -> f64 {
        if self.sums.fourth > 0.0 {
            self.sums.square * self.sums.square / self.sums.fourth
        } else {
            0.0
        }
    }

    pub(crate) const fn corner(&self) -> [i64; 2] {
        self.corner
    }

    pub(crate) const fn extent(&self) -> [usize; 2] {
        self.extent
    }

    pub(crate) fn row(&self, y: usize) -> Row {
        self.rows[y]
    }

    /// The transmission along row `y` of the box, unless it is 1 at all points.
    pub(crate) fn weights(&self, y: usize) -> Option<&[Complex<f32>]> {
        self.weights.as_ref().map(|weights| weights.row(y))
    }

    /// The transmission over the box, unless it is 1 at all points of the pupil.
    pub(crate) const fn transmission(&self) -> Option<&Grid<Complex<f32>>> {
        self.weights.as_ref()
    }

    /// The columns of row `y` of the box that belong to the pupil, each with its |t|².
    pub(crate) fn powers(&self, y: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let weights = self.weights(y);
        let power = move |x: usize| weights.map_or(1.0, |w| to_c64(w[x]).norm_sqr());
        self.rows[y].columns().map(move |x| (x, power(x)))
    }

    /// Σ |t|² `exp(−2πi k·lag/size)` divided by Σ |t|².
    pub(crate) fn correlation(&self, lag: [f64; 2], size: [usize; 2]) -> Complex<f64> {
        let turns = |axis: usize| nearest(lag[axis], size[axis] as f64) / size[axis] as f64;
        let (x, y) = (PI * turns(0), -2.0 * PI * turns(1));
        let sum: Complex<f64> = match &self.weights {
            None => self.sum_rows(y, |_, row| {
                self.span_sum(row.outer, x) - self.span_sum(row.hole, x)
            }),
            Some(_) => {
                let wave = |i| Complex::cis(-2.0 * x * (self.corner[0] + to_signed(i)) as f64);
                let waves: Vec<_> = (0..self.extent[0]).map(wave).collect();
                self.sum_rows(y, |j, _| {
                    self.powers(j).map(|(i, power)| waves[i] * power).sum()
                })
            }
        };
        sum / self.power()
    }

    /// Σ over the rows of `sum(y, row)` `exp(i angle ky)`.
    fn sum_rows(&self, angle: f64, sum: impl Fn(usize, Row) -> Complex<f64>) -> Complex<f64> {
        let rows = self.rows.iter().enumerate();
        rows.map(|(y, row)| {
            let ky = (self.corner[1] + to_signed(y)) as f64;
            sum(y, *row) * Complex::cis(angle * ky)
        })
        .sum()
    }

    /// Σ over the span of exp(−2i kx theta).
    fn span_sum(&self, span: Span, theta: f64) -> Complex<f64> {
        // The first and the last point lie symmetrically about half their sum.
        let twice_middle = 2 * self.corner[0] + to_signed(span.start + span.end) - 1;
        Complex::cis(-theta * twice_middle as f64) * dirichlet(span.count(), theta)
    }

    /// Σ t(k) t*(k − shift), complex.
    pub(crate) fn overlap(&self, [dx, dy]: [i64; 2]) -> Complex<f64> {
        let mut sum = Complex::new(0.0, 0.0);
        for (y, row) in self.rows.iter().enumerate() {
            let other = usize::try_from(to_signed(y).saturating_sub(dy));
            let Some((other, there)) = other.ok().and_then(|o| Some((o, self.rows.get(o)?))) else {
                continue;
            };
            sum += match (self.weights(y), self.weights(other)) {
                (Some(a), Some(b)) => shared_weights(a, b, dx),
                _ => Complex::new(shared_points(*row, *there, dx) as f64, 0.0),
            };
        }
        sum
    }
}

/// Points shared by two rows of which the second is shifted by `shift`.
fn shared_points(a: Row, b: Row, shift: i64) -> usize {
    let shared = |a: Span, b: Span| {
        let start = to_signed(a.start).max(to_signed(b.start).saturating_add(shift));
        let end = to_signed(a.end).min(to_signed(b.end).saturating_add(shift));
        usize::try_from(end.saturating_sub(start)).unwrap_or(0)
    };
    // |A∖a ∩ B∖b| = |AB| − |Ab| − |aB| + |ab|; the subtractions never pass below zero in this
    // order.
    shared(a.outer, b.outer) + shared(a.hole, b.hole)
        - shared(a.outer, b.hole)
        - shared(a.hole, b.outer)
}

fn shared_weights(a: &[Complex<f32>], b: &[Complex<f32>], shift: i64) -> Complex<f64> {
    let at = |x: usize| usize::try_from(to_signed(x).saturating_sub(shift)).ok();
    let shared = a.iter().enumerate().filter_map(|(x, a)| {
        let b = b.get(at(x)?)?;
        Some(to_c64(*a) * to_c64(*b).conj())
    });
    shared.sum()
}

/// The sum of exp(2ikθ) over `count` points in unit steps, symmetric about k = 0.
fn dirichlet(count: usize, theta: f64) -> f64 {
    let points = count as f64;
    let sin = theta.sin();
    if sin.abs() < f64::MIN_POSITIVE {
        return points;
    }
    (points * theta).sin() / sin
}

/// The representative of x modulo `period` in [−period/2, period/2].
fn nearest(x: f64, period: f64) -> f64 {
    x - period * (x / period).round()
}

#[cfg(test)]
mod tests;
