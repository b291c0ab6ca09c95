#[cfg(test)]
mod independent;
mod lattice;
mod sobol;

#[cfg(test)]
pub(crate) use self::independent::Sampler;
use self::{
    lattice::Lattice,
    sobol::{scrambled, sobol_second},
};

/// Sets of points that fill the unit square evenly, anew for every pixel and every use.
///
/// The N points of a round of samples are those of a lattice on the torus, which for any N has one
/// point in each of N columns and of N rows:
///
/// ```text
/// (i + a, g i + b) mod N        g: generator, of those that keep the points far apart
/// ```
///
/// The offsets a and b are random, so each point is uniform over the square and every estimate
/// unbiased; the generator is drawn for each pixel, so that no direction of an edge is a bad one
/// throughout an image. Positions in the pixel have whole offsets and lie anywhere in the cell
/// where column and row cross, which suits edges. All other points are those of the lattice folded in the
/// middle, which makes every smooth function a periodic one; those of different uses are in random orders.
///
/// Each further round shifts the lattice by a point of Sobol's sequence in its unit cell, and has orders of its
/// own: with the same ones, what depends on several uses at once would see the same samples again.
///
/// # References
///
/// - N. M. Korobov, *The Approximate Computation of Multiple Integrals*, 1959. Lattices.
/// - F. J. Hickernell, *Obtaining O(N^(−2+ε)) Convergence for Lattice Quadrature Rules*, 2002. Folding.
/// - I. M. Sobol', *On the Distribution of Points in a Cube and the Approximate Evaluation of
///   Integrals*, 1967.
/// - A. B. Owen, *Randomly Permuted (t, m, s)-Nets and (t, s)-Sequences*, 1995.
/// - B. Burley, *Practical Hash-based Owen Scrambling*, 2020.
#[derive(Clone, Debug)]
pub(crate) struct Sequence {
    /// The number of samples of a round.
    count: u32,
    lattices: Vec<Lattice>,
}

/// The random numbers of one camera sample: the same for any number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stream {
    /// The key of the pixel.
    pub key: u64,
    /// The number of the round of samples.
    pub round: u32,
    /// The number of the sample in its round.
    pub index: u32,
}

/// The use of a pair of random numbers. Different uses have independent numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// The position in the pixel.
    Pixel,
    /// The position in the pupil.
    Lens,
    /// The direction in which a path goes on from its vertex of this number.
    Scattering(u32),
    /// The decision if a path goes on from its vertex of this number.
    Survival(u32),
    /// The position on a light: number of the vertex, number of the light.
    Light(u32, u32),
    /// The wave number within the line of a laser.
    Wave,
    /// The direction towards a laser: number of the vertex, number of the laser.
    Laser(u32, u32),
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
        }
    }
}

impl Sequence {
    /// Prepares the points for rounds of `count` samples, at least one.
    pub(crate) fn new(count: u32) -> Self {
        Self {
            count,
            lattices: Lattice::good(count),
        }
    }

    /// Returns the position in the pixel, in (0, 1)².
    pub(crate) fn position(&self, stream: Stream) -> [f64; 2] {
        let count = u64::from(self.count);
        let seed = seed(stream, Use::Pixel);
        let lattice = self.lattice(stream);
        let point = lattice.point(stream.index);
        let offsets = self.shifted(seed, stream);
        let within = scrambled_point(stream.round, mixed(mixed(seed) ^ u64::from(stream.index)));
        [0, 1].map(|axis| {
            let columns = (u64::from(offsets[axis]) * count) >> 32;
            let cell = point[axis].wrapping_add(lattice.column().wrapping_mul(columns));
            fraction(word(cell >> 32).wrapping_add(within[axis] / self.count))
        })
    }

    /// Returns two numbers in (0, 1).
    ///
    /// Those of one use fill the square evenly over the samples of a pixel.
    pub(crate) fn pair(&self, stream: Stream, purpose: Use) -> [f64; 2] {
        let seed = seed(stream, purpose);
        let order = mixed(seed ^ u64::from(stream.round));
        let point = self
            .lattice(stream)
            .point(permuted(stream.index, self.count, order));
        let offsets = self.shifted(seed, stream);
        [0, 1].map(|axis| fraction(folded(word(point[axis] >> 32).wrapping_add(offsets[axis]))))
    }

    /// Returns one number in (0, 1): the first of the pair.
    pub(crate) fn uniform(&self, stream: Stream, purpose: Use) -> f64 {
        let [first, _] = self.pair(stream, purpose);
        first
    }

    /// Returns the offsets of a round, in 2⁻³² of the torus.
    fn shifted(&self, offsets: u64, stream: Stream) -> [u32; 2] {
        let (offsets, shift) = (words(offsets), self.lattice(stream).shift(stream.round));
        [0, 1].map(|axis| offsets[axis].wrapping_add(shift[axis]))
    }

    /// Returns the lattice of a pixel.
    fn lattice(&self, stream: Stream) -> &Lattice {
        let choice = (stream.key >> 32) * self.lattices.len() as u64;
        &self.lattices[word(choice >> 32) as usize]
    }
}

/// Returns the two numbers in (0, 1) of a key.
pub(crate) fn point_in_square(key: u64) -> [f64; 2] {
    words(mixed(key)).map(fraction)
}

/// Combines the seed of a render with three numbers, as those of a frame and of a pixel's column and row.
pub(crate) fn pixel_key(seed: u64, [first, second, third]: [u64; 3]) -> u64 {
    let key = mixed(mixed(seed) ^ first);
    mixed(mixed(key ^ second.rotate_left(16)) ^ third.rotate_left(48))
}

/// Returns a random number of a pixel for a use.
const fn seed(stream: Stream, purpose: Use) -> u64 {
    mixed(stream.key ^ purpose.code())
}

/// Returns the lower half of a number.
#[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
const fn word(number: u64) -> u32 {
    number as u32
}

const fn words(number: u64) -> [u32; 2] {
    [word(number), word(number >> 32)]
}

/// Folds the interval in the middle: x becomes 1 − |2x − 1|.
const fn folded(bits: u32) -> u32 {
    let below_half = if bits >> 31 == 0 { bits } else { !bits };
    below_half << 1 | 1
}

/// Returns where a random permutation of the numbers below `count` takes `index`.
///
/// Each step permutes the numbers below a power of two; those that leave the range go round again.
fn permuted(index: u32, count: u32, seed: u64) -> u32 {
    let mask = u64::from(count).next_power_of_two() - 1;
    let half = mask.count_ones().div_ceil(2);
    let mut number = u64::from(index);
    loop {
        for factor in [seed, seed.rotate_left(21), seed.rotate_left(42)] {
            number = (number ^ (factor >> 32)).wrapping_mul(factor | 1) & mask;
            number ^= number >> half;
        }
        if number < u64::from(count) {
            return word(number);
        }
    }
}

/// Returns a point of Sobol's sequence in the plane, scrambled by Owen's method, in units of 2⁻³².
const fn scrambled_point(index: u32, seed: u64) -> [u32; 2] {
    let [first, second] = words(seed);
    [
        scrambled(index, first).reverse_bits(),
        scrambled(sobol_second(index).reverse_bits(), second).reverse_bits(),
    ]
}

/// Returns the middle of one of 2³² equal intervals of (0, 1).
fn fraction(bits: u32) -> f64 {
    (f64::from(bits) + 0.5) / (1_u64 << 32) as f64
}

/// Spreads neighbouring numbers over all: the generator `SplitMix64` of G. L. Steele, D. Lea and
/// C. H. Flood, *Fast Splittable Pseudorandom Number Generators*, 2014.
const fn mixed(number: u64) -> u64 {
    let mut bits = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests;
