/// About the maximum number of generators that are tried.
const MAX_TRIED: u32 = 1024;

/// Smallest squared distance between points of an acceptable lattice, relative to the best lattice.
const GOOD: f64 = 0.9;

/// A lattice of N points on a torus, with one point in each of N columns and of N rows: (i, g i) /
/// N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lattice {
    /// The step from a point to the next one: (1, g) / N, rounded up to 2⁻⁶⁴ of the torus.
    step: [u64; 2],
    /// The square of the shortest distance between two points, in columns.
    square_distance: i128,
}

impl Lattice {
    /// Returns lattices of `count` points, one in each column and in each row, whose points are far
    /// apart.
    pub(super) fn good(count: u32) -> Vec<Self> {
        let step = count.div_ceil(MAX_TRIED) as usize;
        let units = (1..=count)
            .step_by(step)
            .filter(|&g| common_divisor(g, count) == 1);
        let lattices: Vec<_> = units.map(|g| Self::new(g, count)).collect();
        let best = lattices.iter().map(|lattice| lattice.square_distance).max();
        let min = GOOD * best.unwrap_or_default() as f64;
        let lattices = lattices.into_iter();
        lattices
            .filter(|lattice| lattice.square_distance as f64 >= min)
            .collect()
    }

    fn new(generator: u32, count: u32) -> Self {
        let shortest = shortest_vector(generator, count);
        Self {
            step: [1, generator].map(|columns| step(columns, count)),
            square_distance: dot(shortest, shortest),
        }
    }

    /// Returns the width of a column, in 2⁻⁶⁴ of the torus.
    pub(super) const fn column(&self) -> u64 {
        self.step[0]
    }

    /// Returns the position of a point, in 2⁻⁶⁴ of the torus.
    #[inline(always)]
    pub(super) fn point(&self, index: u32) -> [u64; 2] {
        self.step.map(|step| step.wrapping_mul(index.into()))
    }

    /// Returns the column and the row of a point, of `count`.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "columns are less than their count"
    )]
    pub(super) fn column_and_row(&self, index: u32, count: u32) -> [u32; 2] {
        let whole = |place: u64| (u128::from(place) * u128::from(count)) >> 64;
        self.point(index).map(|place| whole(place) as u32)
    }
}

/// Returns the width of `columns` out of `count` columns, rounded up to 2⁻⁶⁴ of the torus; the
/// whole torus is 0.
#[expect(
    clippy::cast_possible_truncation,
    reason = "whole turns of the torus are dropped"
)]
fn step(columns: u32, count: u32) -> u64 {
    (u128::from(columns) << 64).div_ceil(count.into()) as u64
}

/// Finds a shortest vector of the lattice, in columns, by the algorithm of Lagrange and Gauss.
fn shortest_vector(generator: u32, count: u32) -> [i128; 2] {
    let (mut short, mut long) = ([1, generator.into()], [0, count.into()]);
    loop {
        if dot(short, short) > dot(long, long) {
            (short, long) = (long, short);
        }
        let square = dot(short, short);
        let times = (2 * dot(short, long) + square).div_euclid(2 * square);
        if times == 0 {
            return short;
        }
        long = [0, 1].map(|axis| long[axis] - times * short[axis]);
    }
}

const fn dot([a, b]: [i128; 2], [c, d]: [i128; 2]) -> i128 {
    a * c + b * d
}

const fn common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_a_search_over_all_points() {
        for count in [2, 7, 16, 64, 89, 121, 200] {
            for lattice in Lattice::good(count) {
                let square = |index| {
                    let near = |x: u32| u64::from(x.min(count - x));
                    let [x, y] = lattice.column_and_row(index, count).map(near);
                    i128::from(x * x + y * y)
                };
                let found = (1..count).map(square).min();
                assert_eq!(found, Some(lattice.square_distance), "{lattice:?}");
            }
        }
        // 89 is a number of Fibonacci, and its square lattice has the sides (8, 5) and (−5, 8).
        let lattices = Lattice::good(89);
        assert!(
            lattices
                .iter()
                .any(|lattice| lattice.column_and_row(1, 89) == [1, 34])
        );
    }
}
