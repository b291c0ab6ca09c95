use super::sobol::sobol_second;

/// About the maximum number of generators that are tried.
const MAX_TRIED: u32 = 1024;

/// How close the points of a lattice may be: the square of their distance by that of the best lattice.
const GOOD: f64 = 0.9;

/// A lattice of N points on a torus, with one point in each of N columns and of N rows: (i, g i) / N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lattice {
    /// The way from a point to the next one: (1, g) / N, rounded up to 2⁻⁶⁴ of the torus.
    step: [u64; 2],
    /// Two shortest vectors that span the lattice, in 2⁻⁶⁴ of the torus.
    basis: [[i128; 2]; 2],
    /// The square of the shortest distance between two points, in columns.
    square_distance: i128,
}

impl Lattice {
    /// Returns lattices of `count` points, one in each column and in each row, whose points are far apart.
    pub(super) fn good(count: u32) -> Vec<Self> {
        let step = count.div_ceil(MAX_TRIED) as usize;
        let units = (1..=count)
            .step_by(step)
            .filter(|&g| common_divisor(g, count) == 1);
        let lattices: Vec<_> = units.map(|g| Self::new(g, count)).collect();
        let best = lattices.iter().map(|lattice| lattice.square_distance).max();
        let least = GOOD * best.unwrap_or_default() as f64;
        let lattices = lattices.into_iter();
        lattices
            .filter(|lattice| lattice.square_distance as f64 >= least)
            .collect()
    }

    fn new(generator: u32, count: u32) -> Self {
        let basis = shortest_vectors(generator, count);
        let of_torus = |columns: i128| (columns << 64).div_euclid(count.into());
        Self {
            step: [1, generator].map(|columns| step(columns, count)),
            basis: basis.map(|vector| vector.map(of_torus)),
            square_distance: dot(basis[0], basis[0]),
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

    /// Returns the shift in a round, in 2⁻³² of the torus: Sobol's point of that number in the unit cell.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole turns of the torus are dropped"
    )]
    pub(super) fn shift(&self, round: u32) -> [u32; 2] {
        if round == 0 {
            return [0; 2];
        }
        let [short, long] = self.basis;
        let parts = [round.reverse_bits(), sobol_second(round)].map(i128::from);
        [0, 1].map(|axis| ((parts[0] * short[axis] + parts[1] * long[axis]) >> 64) as u32)
    }
}

/// Returns so many columns out of `count`, rounded up to 2⁻⁶⁴ of the torus; the whole torus is 0.
#[expect(
    clippy::cast_possible_truncation,
    reason = "whole turns of the torus are dropped"
)]
fn step(columns: u32, count: u32) -> u64 {
    (u128::from(columns) << 64).div_ceil(count.into()) as u64
}

/// Finds two shortest vectors that span the lattice, in columns, by the algorithm of Lagrange and Gauss.
fn shortest_vectors(generator: u32, count: u32) -> [[i128; 2]; 2] {
    let (mut short, mut long) = ([1, generator.into()], [0, count.into()]);
    loop {
        if dot(short, short) > dot(long, long) {
            (short, long) = (long, short);
        }
        let square = dot(short, short);
        let times = (2 * dot(short, long) + square).div_euclid(2 * square);
        if times == 0 {
            return [short, long];
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

    /// Returns the column and the row of a point.
    fn column_and_row(lattice: &Lattice, count: u32, index: u32) -> [u64; 2] {
        let whole = |place: u64| (u128::from(place) * u128::from(count)) >> 64;
        lattice
            .point(index)
            .map(|place| u64::try_from(whole(place)).unwrap())
    }

    #[test]
    fn distances_are_those_of_a_search_over_all_points() {
        for count in [2, 7, 16, 64, 89, 121, 200] {
            for lattice in Lattice::good(count) {
                let square = |index| {
                    let near = |x: u64| x.min(u64::from(count) - x);
                    let [x, y] = column_and_row(&lattice, count, index).map(near);
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
                .any(|lattice| column_and_row(lattice, 89, 1) == [1, 34])
        );
    }

    /// The smallest distance of a shift, in 2⁻³² of the torus, to a point of the lattice, in columns.
    fn distance_to_lattice(lattice: &Lattice, count: u32, shift: [u32; 2]) -> f64 {
        let unit = f64::from(count) / (1_u64 << 32) as f64;
        let distance = |index| {
            let point = lattice.point(index).map(|x| x >> 32);
            let [x, y] = [0, 1].map(|axis| {
                let apart = u64::from(shift[axis]).abs_diff(point[axis]);
                apart.min((1 << 32) - apart) as f64 * unit
            });
            x.hypot(y)
        };
        (0..count).map(distance).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn points_of_four_rounds_keep_apart() {
        for count in [1, 7, 16, 64, 121] {
            for lattice in Lattice::good(count) {
                let shortest = (lattice.square_distance as f64).sqrt();
                for (first, second) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                    let [a, b] = [first, second].map(|round| lattice.shift(round));
                    let between = [0, 1].map(|axis| b[axis].wrapping_sub(a[axis]));
                    let distance = distance_to_lattice(&lattice, count, between);
                    // Four times it is a vector of the lattice and not zero. Shifts are rounded to 2⁻³².
                    assert!(distance > 0.25 * shortest - 1e-6, "{lattice:?}: {distance}");
                }
            }
        }
    }
}
