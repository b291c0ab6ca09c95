mod displacements;
mod draws;
mod lattice;
mod spread;

use core::iter::once;

use tem00_numerics::{seed::scattered, vectorised};
use tem00_tracer::{RenderOptions, Sampling};

pub use self::displacements::mean_over_sample_displacements;
use self::lattice::Lattice;
pub(crate) use self::{
    draws::{DrawKey, Draws},
    spread::even,
};

/// Sets of points that fill the unit square evenly, anew for every pixel and every use.
///
/// The N points of a pixel form a lattice on the torus, which for any N has one point in each of N
/// columns and of N rows:
///
/// ```text
/// (i + a, g i + b) mod N        g: generator, of those that keep the points far apart
/// ```
///
/// The offsets a and b are random, so each point is uniform over the square and every estimate
/// unbiased; the generator is drawn for each pixel, so that no direction of an edge is unfavourable
/// throughout an image. Positions in the pixel have whole offsets and lie anywhere in the cell
/// where column and row cross, which suits edges; positions in two neighbouring columns, or rows,
/// mirror each other, so that light that varies linearly over the pixel is integrated exactly. All
/// other points come from the lattice folded in the middle, which makes every smooth function
/// periodic; the points of different uses are in random orders.
///
/// # References
///
/// - N. M. Korobov, *The Approximate Computation of Multiple Integrals*, 1959. Lattices.
/// - F. J. Hickernell, *Obtaining O(N^(−2+ε)) Convergence for Lattice Quadrature Rules*, 2002.
///   Folding.
#[derive(Clone, Debug)]
pub(crate) struct Sequence {
    /// The number of samples of a pixel.
    count: u32,
    lattices: Vec<Lattice>,
}

/// The random numbers of one camera sample: the same for any number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stream {
    /// The key of the pixel.
    pub key: u64,
    /// Index into the possible sample counts.
    pub level: u8,
    /// The number of the sample.
    pub index: u32,
}

/// The use of a pair of random numbers. Different uses have independent numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// The position in the pixel.
    Pixel,
    /// The position in the pupil.
    Lens,
    /// The direction in which a path continues from its vertex of this number.
    Scattering(u32),
    /// The decision whether a path continues from its vertex of this number.
    Survival(u32),
    /// The position on a light: number of the vertex, number of the light.
    Light(u32, u32),
    /// The wave number within the line of a laser.
    Wave,
    /// The direction towards a laser: number of the vertex, number of the laser.
    Laser(u32, u32),
    /// The point that a laser lights, to which the vertex of this number is connected.
    LitPoint(u32),
}

/// The maximum number of times that the minimum number of samples of a pixel is doubled.
const DOUBLINGS: u32 = 6;

/// Returns the possible sample counts of a pixel. If there are several, the first is the sample
/// count of the pilot.
pub(crate) fn sample_counts(options: &RenderOptions) -> Vec<u32> {
    let count = options.samples_per_pixel;
    let counts = |pilot, min: u32| {
        let doubled = (0..=DOUBLINGS).map(|times| min.saturating_mul(1 << times));
        once(pilot).chain(doubled).collect()
    };
    match options.sampling {
        Sampling::Adaptive if count >= 4 => counts((count / 4).clamp(2, 8), count / 2),
        Sampling::Even | Sampling::Adaptive => vec![count],
        Sampling::TargetError(_) => counts(16, count),
    }
}

impl Use {
    const fn code(self) -> u64 {
        const fn pack(kind: u64, vertex: u32, light: u32) -> u64 {
            kind << 61 | (vertex as u64) << 29 | light as u64
        }
        match self {
            Self::Pixel => pack(0, 0, 0),
            Self::Lens => pack(1, 0, 0),
            Self::Scattering(vertex) => pack(2, vertex, 0),
            Self::Survival(vertex) => pack(3, vertex, 0),
            Self::Light(vertex, light) => pack(4, vertex, light),
            Self::Wave => pack(6, 0, 0),
            Self::Laser(vertex, laser) => pack(5, vertex, laser),
            Self::LitPoint(vertex) => pack(7, vertex, 0),
        }
    }
}

impl Sequence {
    /// Prepares the points for pixels of `count` samples, at least one.
    pub(crate) fn new(count: u32) -> Self {
        Self {
            count,
            lattices: Lattice::good(count),
        }
    }

    /// Writes the positions in the pixel, in (0, 1)², of the samples from `first` on.
    pub(crate) fn positions(&self, first: Stream, positions: &mut [[f64; 2]]) {
        let seed = seed(first, Use::Pixel);
        let lattice = self.lattice(first);
        let columns = words(seed).map(|offset| (u64::from(offset) * u64::from(self.count)) >> 32);
        let corner = columns.map(|columns| lattice.column().wrapping_mul(columns));
        let seeds = [scattered(seed), scattered(!seed)];
        vectorised(
            #[inline(always)]
            || {
                for (position, index) in positions.iter_mut().zip(first.index..) {
                    let [column, row] = lattice.point(index);
                    *position = [
                        self.place(column.wrapping_add(corner[0]), seeds[0]),
                        self.place(row.wrapping_add(corner[1]), seeds[1]),
                    ];
                }
            },
        );
    }

    /// Returns a position in the column that begins at `start`, in units of 2⁻⁶⁴ of the torus:
    /// positions in two neighbouring columns mirror each other.
    #[inline(always)]
    fn place(&self, start: u64, seed: u64) -> f64 {
        let start = word(start >> 32);
        // The start is rounded down.
        let column = ((u64::from(start) + 1) * u64::from(self.count)) >> 32;
        let within = word(scattered(seed ^ (column >> 1)));
        let mirrored = if column & 1 == 0 { within } else { !within };
        fraction(start.wrapping_add(quotient(mirrored, self.count)))
    }

    /// Returns two numbers in (0, 1).
    ///
    /// The pairs of one use fill the square evenly over the samples of a pixel.
    pub(crate) fn pair(&self, stream: Stream, purpose: Use) -> [f64; 2] {
        let points = self.points(stream, purpose);
        points.pair(permuted(stream.index, self.count, points.order))
    }

    /// Writes the [pairs](Self::pair) of the samples from `first` on.
    pub(crate) fn pairs(&self, first: Stream, purpose: Use, pairs: &mut [[f64; 2]]) {
        let points = self.points(first, purpose);
        let pairs = pairs.iter_mut().zip(first.index..);
        if self.count.is_power_of_two() {
            vectorised(
                #[inline(always)]
                || {
                    for (pair, index) in pairs {
                        let place = permuted_bits(index.into(), points.order, self.count - 1);
                        *pair = points.pair(word(place));
                    }
                },
            );
        } else {
            for (pair, index) in pairs {
                *pair = points.pair(permuted(index, self.count, points.order));
            }
        }
    }

    fn points(&self, stream: Stream, purpose: Use) -> Points<'_> {
        let seed = seed(stream, purpose);
        Points {
            lattice: self.lattice(stream),
            offsets: words(seed),
            order: scattered(seed),
        }
    }

    /// Returns one number in (0, 1): the first of the pair.
    pub(crate) fn uniform(&self, stream: Stream, purpose: Use) -> f64 {
        let [first, _] = self.pair(stream, purpose);
        first
    }

    /// Returns the lattice of a pixel.
    fn lattice(&self, stream: Stream) -> &Lattice {
        let choice = (stream.key >> 32) * self.lattices.len() as u64;
        &self.lattices[word(choice >> 32) as usize]
    }
}

/// The pairs of the samples of a round for a use.
struct Points<'a> {
    lattice: &'a Lattice,
    /// The offsets, in units of 2⁻³² of the torus.
    offsets: [u32; 2],
    /// The seed of the order in which the samples take the points of the lattice.
    order: u64,
}

impl Points<'_> {
    #[inline(always)]
    fn pair(&self, point: u32) -> [f64; 2] {
        let point = self.lattice.point(point);
        [0, 1].map(|axis| {
            fraction(folded(
                word(point[axis] >> 32).wrapping_add(self.offsets[axis]),
            ))
        })
    }
}

/// Returns the two numbers in (0, 1) of a key.
pub(crate) fn point_in_square(key: u64) -> [f64; 2] {
    words(scattered(key)).map(fraction)
}

/// Combines the seed of a render with three numbers, such as the numbers of a frame and of a
/// pixel's column and row.
pub(crate) fn pixel_key(seed: u64, [first, second, third]: [u64; 3]) -> u64 {
    let key = scattered(scattered(seed) ^ first);
    scattered(scattered(key ^ second.rotate_left(16)) ^ third.rotate_left(48))
}

/// Returns a random number of a pixel for a use.
const fn seed(stream: Stream, purpose: Use) -> u64 {
    scattered(stream.key ^ purpose.code())
}

/// Returns the lower half of a number.
#[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
#[inline(always)]
const fn word(number: u64) -> u32 {
    number as u32
}

#[inline(always)]
const fn words(number: u64) -> [u32; 2] {
    [word(number), word(number >> 32)]
}

/// Folds the interval in the middle: x becomes 1 − |2x − 1|.
#[inline(always)]
const fn folded(bits: u32) -> u32 {
    let below_half = if bits >> 31 == 0 { bits } else { !bits };
    below_half << 1 | 1
}

/// Returns the image of `index` under a random permutation of the numbers below `count`.
///
/// Each step permutes the numbers below a power of two; numbers that leave the range are permuted
/// again.
fn permuted(index: u32, count: u32, seed: u64) -> u32 {
    let mask = word(u64::from(count).next_power_of_two() - 1);
    let mut number = u64::from(index);
    loop {
        number = permuted_bits(number, seed, mask);
        if number < u64::from(count) {
            return word(number);
        }
    }
}

/// Permutes the numbers up to `mask`, one less than a power of two.
#[inline(always)]
fn permuted_bits(mut number: u64, seed: u64, mask: u32) -> u64 {
    let half = mask.count_ones().div_ceil(2);
    for factor in [seed, seed.rotate_left(21), seed.rotate_left(42)] {
        number = (number ^ (factor >> 32)).wrapping_mul(factor | 1) & u64::from(mask);
        number ^= number >> half;
    }
    number
}

/// Returns the whole part of a quotient, by a division that vectorises: it is exact, as no quotient
/// of such numbers is less than 2⁻³³ of itself below a whole number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the whole part is meant"
)]
#[inline(always)]
fn quotient(number: u32, by: u32) -> u32 {
    (f64::from(number) / f64::from(by)) as u32
}

/// Returns the middle of one of 2³² equal intervals of (0, 1).
#[inline(always)]
fn fraction(bits: u32) -> f64 {
    (f64::from(bits) + 0.5) / (1_u64 << 32) as f64
}

#[cfg(test)]
mod tests;
