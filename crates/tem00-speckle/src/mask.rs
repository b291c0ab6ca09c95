//! The lattice points inside the pupil, and the exact sums over them.

use core::f64::consts::PI;

use crate::{Pupil, lattice::wrap_to};

/// The lattice points of a pupil about its centre.
///
/// Every pupil is mirror symmetric in both axes, so the rows ky ≥ 0 and their half-widths say it
/// all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Mask {
    rows: Vec<Row>,
    count: usize,
}

/// The points |kx| ≤ `outer` of a row, without |kx| ≤ `hole`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Row {
    pub(crate) outer: usize,
    pub(crate) hole: Option<usize>,
}

impl Row {
    fn count(self) -> usize {
        2 * self.outer + 1 - self.hole.map_or(0, |hole| 2 * hole + 1)
    }
}

impl Mask {
    pub(crate) fn new(pupil: Pupil, diameter: usize) -> Self {
        let half_height = match pupil {
            Pupil::Circle | Pupil::Annulus { .. } => diameter / 2,
            Pupil::Rectangle { height } => floor_index(0.5 * height * to_f64(diameter)),
        };
        let row = |ky| match pupil {
            Pupil::Circle => Row {
                outer: disc_half_width(diameter, ky),
                hole: None,
            },
            Pupil::Annulus { inner } => Row {
                outer: disc_half_width(diameter, ky),
                hole: hole_half_width(inner * to_f64(diameter), ky),
            },
            Pupil::Rectangle { .. } => Row {
                outer: diameter / 2,
                hole: None,
            },
        };
        let rows: Vec<Row> = (0..=half_height).map(row).collect();
        let mirrored: usize = rows.iter().skip(1).map(|row| row.count()).sum();
        let count = rows[0].count() + 2 * mirrored;
        Self { rows, count }
    }

    /// The number of lattice points N.
    pub(crate) const fn count(&self) -> usize {
        self.count
    }

    /// The largest |kx| and |ky| inside.
    pub(crate) fn half_extent(&self) -> [usize; 2] {
        let width = self.rows.iter().map(|row| row.outer).max();
        [width.unwrap_or(0), self.rows.len() - 1]
    }

    pub(crate) fn row(&self, ky: usize) -> Row {
        self.rows[ky]
    }

    /// Σ over the mask of `exp(−2πi k·lag/size)`, divided by N; real by symmetry.
    pub(crate) fn correlation(&self, [x, y]: [f64; 2], size: usize) -> f64 {
        let period = to_f64(size);
        let x = nearest(x, period) * PI / period;
        let y = nearest(y, period) * 2.0 * PI / period;
        let sum: f64 = self
            .signed_rows()
            .map(|(ky, row)| {
                let hole = row.hole.map_or(0.0, |hole| dirichlet(hole, x));
                (f64::from(ky) * y).cos() * (dirichlet(row.outer, x) - hole)
            })
            .sum();
        sum / to_f64(self.count)
    }

    /// The number of points shared with the mask shifted on a torus of `size` points.
    pub(crate) fn overlap_count(&self, [shift_x, shift_y]: [i64; 2], size: usize) -> usize {
        let shift_x = signed(wrap_to(shift_x, size), size);
        let shared = |(ky, row): (i32, Row)| {
            let other = signed(wrap_to(i64::from(ky) - shift_y, size), size);
            let other = usize::try_from(other.unsigned_abs()).unwrap_or(usize::MAX);
            self.rows
                .get(other)
                .map_or(0, |other| shared_points(row, *other, shift_x, size))
        };
        self.signed_rows().map(shared).sum()
    }

    fn signed_rows(&self) -> impl Iterator<Item = (i32, Row)> + '_ {
        let upper = self.rows.iter().copied();
        let lower = self.rows.iter().copied().skip(1);
        (0..).zip(upper).chain((1..).map(|ky: i32| -ky).zip(lower))
    }
}

/// The largest kx with kx² + ky² ≤ (diameter / 2)², in integers.
fn disc_half_width(diameter: usize, ky: usize) -> usize {
    (diameter * diameter - 4 * ky * ky).isqrt() / 2
}

/// The largest kx with kx² + ky² < (diameter / 2)², if there is one.
fn hole_half_width(diameter: f64, ky: usize) -> Option<usize> {
    let inside = |kx: usize| to_f64(kx * kx + ky * ky) < 0.25 * diameter * diameter;
    inside(0).then(|| {
        let room = 0.25 * diameter * diameter - to_f64(ky * ky);
        let guess = floor_index(room.sqrt());
        // The square root is rounded; the strict inequality decides.
        (guess.saturating_sub(1)..=guess + 1)
            .rev()
            .find(|&kx| inside(kx))
            .unwrap_or(0)
    })
}

/// Points shared by two rows of which the second is shifted by `shift` on the torus.
fn shared_points(a: Row, b: Row, shift: i64, size: usize) -> usize {
    let arcs = |a: Option<usize>, b: Option<usize>| match (a, b) {
        (Some(a), Some(b)) => shared_arc(a, b, shift, size),
        _ => 0,
    };
    // |A∖a ∩ B∖b| = |AB| − |Ab| − |aB| + |ab|; the subtractions never pass below zero in this order.
    let (outer_a, outer_b) = (Some(a.outer), Some(b.outer));
    arcs(outer_a, outer_b) + arcs(a.hole, b.hole) - arcs(outer_a, b.hole) - arcs(a.hole, outer_b)
}

/// Points shared by [−a, a] and [shift − b, shift + b], all modulo `size`.
fn shared_arc(a: usize, b: usize, shift: i64, size: usize) -> usize {
    let (a, b, size) = (to_i64(a), to_i64(b), to_i64(size));
    let shared: i64 = [shift - size, shift, shift + size]
        .iter()
        .map(|s| (a.min(s + b) - (-a).max(s - b) + 1).max(0))
        .sum();
    usize::try_from(shared).unwrap_or(0)
}

/// Σ from −n to n of exp(2ikθ).
fn dirichlet(n: usize, theta: f64) -> f64 {
    let points = to_f64(2 * n + 1);
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

/// The representative of `k` in [0, size) nearest to zero.
pub(crate) fn signed(k: usize, size: usize) -> i64 {
    if 2 * k > size {
        to_i64(k) - to_i64(size)
    } else {
        to_i64(k)
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "lattice sizes and counts are far below 2⁵³"
)]
pub(crate) const fn to_f64(n: usize) -> f64 {
    n as f64
}

#[expect(
    clippy::cast_possible_wrap,
    reason = "lattice sizes and counts are far below 2⁶³"
)]
pub(crate) const fn to_i64(n: usize) -> i64 {
    n as i64
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a non-negative number of lattice points, rounded down on purpose"
)]
fn floor_index(x: f64) -> usize {
    x as usize
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn pupils() -> [Pupil; 4] {
        [
            Pupil::Circle,
            Pupil::Annulus { inner: 0.37 },
            Pupil::Annulus { inner: 0.5 },
            Pupil::Rectangle { height: 0.6 },
        ]
    }

    /// The definition of the pupils, point by point.
    fn inside(pupil: Pupil, diameter: usize, [x, y]: [i64; 2]) -> bool {
        #[expect(clippy::cast_precision_loss, reason = "small integers")]
        let (x, y) = (x as f64, y as f64);
        let c = to_f64(diameter);
        let r2 = 4.0 * (x * x + y * y);
        match pupil {
            Pupil::Circle => r2 <= c * c,
            Pupil::Annulus { inner } => r2 <= c * c && r2 >= (inner * c).powi(2),
            Pupil::Rectangle { height } => 2.0 * x.abs() <= c && 2.0 * y.abs() <= height * c,
        }
    }

    fn points(pupil: Pupil, diameter: usize) -> Vec<[i64; 2]> {
        let c = to_i64(diameter);
        (-c..=c)
            .flat_map(|y| (-c..=c).map(move |x| [x, y]))
            .filter(|&k| inside(pupil, diameter, k))
            .collect()
    }

    #[test]
    fn the_mask_holds_the_points_of_the_definition() {
        for pupil in pupils() {
            for diameter in [8, 9, 13, 32, 33] {
                let mask = Mask::new(pupil, diameter);
                let expected = points(pupil, diameter).len();
                assert_eq!(mask.count(), expected, "{pupil:?}, diameter {diameter}");
            }
        }
    }

    #[test]
    fn the_number_of_points_of_a_disc_is_that_of_the_gauss_circle_problem() {
        // Lattice points with |k| ≤ 4, 5, 10: OEIS A000328.
        for (diameter, count) in [(8, 49), (10, 81), (20, 317)] {
            assert_eq!(Mask::new(Pupil::Circle, diameter).count(), count);
        }
    }

    #[test]
    fn the_overlap_is_the_number_of_shared_points_on_the_torus() {
        for (diameter, size) in [(8, 16), (9, 19), (10, 20)] {
            let (c, q) = (to_i64(diameter), to_i64(size));
            for pupil in pupils() {
                let mask = Mask::new(pupil, diameter);
                let points = points(pupil, diameter);
                let on_torus = |[x, y]: [i64; 2]| [x.rem_euclid(q), y.rem_euclid(q)];
                for shift in [[0, 0], [1, 0], [-3, 5], [c, 0], [0, c], [q - 2, 3 * q + 4]] {
                    // Every pair of points that meet; rim points of C = Q/2 meet twice.
                    let shared = points
                        .iter()
                        .flat_map(|k| points.iter().map(move |l| (k, l)))
                        .filter(|(k, l)| {
                            on_torus(**k) == on_torus([l[0] + shift[0], l[1] + shift[1]])
                        })
                        .count();
                    let counted = mask.overlap_count(shift, size);
                    assert_eq!(counted, shared, "{pupil:?} at {shift:?}, Q = {size}");
                }
            }
        }
    }

    proptest! {
        #[test]
        fn the_correlation_is_the_sum_over_the_mask(
            x in -40.0_f64..40.0, y in -40.0_f64..40.0, index in 0_usize..4
        ) {
            let pupil = pupils()[index];
            let (diameter, size) = (11, 25);
            let points = points(pupil, diameter);
            #[expect(clippy::cast_precision_loss, reason = "small integers")]
            let term = |k: &[i64; 2]| {
                (2.0 * PI * (k[0] as f64 * x + k[1] as f64 * y) / to_f64(size)).cos()
            };
            let sum: f64 = points.iter().map(term).sum();
            let correlation = Mask::new(pupil, diameter).correlation([x, y], size);
            // Sums of up to 97 terms of rounding 2⁻⁵³ and of phases up to 18 · 2⁻⁵³.
            prop_assert!((correlation - sum / to_f64(points.len())).abs() < 1e-13);
        }
    }
}
