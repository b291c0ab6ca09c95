#[cfg(test)]
mod independent;
mod strata;

#[cfg(test)]
pub(crate) use self::independent::Sampler;
pub(crate) use self::strata::Strata;

/// The maximum number of points that a pixel's samples share before they start afresh.
const MAX_POINTS: u32 = 1 << 12;

/// A set of points that fills the unit square evenly, scrambled anew for every pixel and every use.
///
/// The points are the first two dimensions of Sobol's sequence: of the first 2ᵏ, each rectangle of
/// area 2⁻ᵏ with sides that are halves of halves holds exactly one. Owen's scrambling keeps that and
/// makes each point uniform over the square, so that every estimate is unbiased; the points of
/// different uses are in independent orders.
///
/// # References
///
/// - I. M. Sobol', *On the Distribution of Points in a Cube and the Approximate Evaluation of
///   Integrals*, 1967.
/// - A. B. Owen, *Randomly Permuted (t, m, s)-Nets and (t, s)-Sequences*, 1995.
/// - B. Burley, *Practical Hash-based Owen Scrambling*, 2020.
#[derive(Clone, Debug)]
pub(crate) struct Sequence {
    /// The coordinates with their bits in reverse, as the scrambling takes them.
    points: Vec<[u32; 2]>,
}

/// The random numbers of one camera sample: the same for any number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stream {
    key: u64,
    /// The number of the sample among those that share the points.
    index: u32,
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
    /// Prepares the points for pixels of `samples` samples.
    pub(crate) fn new(samples: u32) -> Self {
        let count = samples.clamp(1, MAX_POINTS).next_power_of_two();
        let points = (0..count).map(|index| [index, sobol_second(index).reverse_bits()]);
        Self {
            points: points.collect(),
        }
    }

    /// Returns the random numbers of sample `index` of the pixel that has the key `pixel`.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "there are at most 2¹² points"
    )]
    pub(crate) fn stream(&self, pixel: u64, index: u32) -> Stream {
        let count = self.points.len() as u32;
        Stream {
            key: mixed(pixel ^ mixed(u64::from(index / count))),
            index: index % count,
        }
    }

    /// Returns two numbers in (0, 1).
    ///
    /// Those of one use fill the square evenly over the samples of a pixel.
    pub(crate) fn pair(&self, stream: Stream, purpose: Use) -> [f64; 2] {
        let [order, first, second] = seeds(stream, purpose);
        let [x, y] = self.points[self.shuffled(stream.index, order)];
        [
            fraction(scrambled(x, first).reverse_bits()),
            fraction(scrambled(y, second).reverse_bits()),
        ]
    }

    /// Returns one number in (0, 1): the first of the pair.
    pub(crate) fn uniform(&self, stream: Stream, purpose: Use) -> f64 {
        let [order, first, _] = seeds(stream, purpose);
        let [x, _] = self.points[self.shuffled(stream.index, order)];
        fraction(scrambled(x, first).reverse_bits())
    }

    /// Puts the points into another order, in which each half of the points still fills the square.
    fn shuffled(&self, index: u32, seed: u32) -> usize {
        let mask = self.points.len() - 1;
        scrambled(index.reverse_bits(), seed).reverse_bits() as usize & mask
    }
}

/// Returns two numbers in (0, 1) that are independent from sample to sample.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the words of the number are taken one by one"
)]
pub(crate) fn independent_pair(stream: Stream, purpose: Use) -> [f64; 2] {
    let bits = mixed(mixed(stream.key ^ purpose.code()) ^ u64::from(stream.index));
    [fraction(bits as u32), fraction((bits >> 32) as u32)]
}

/// Returns the two numbers in (0, 1) of a key.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the words are taken one by one"
)]
pub(crate) fn point_in_square(key: u64) -> [f64; 2] {
    let bits = mixed(key);
    [fraction(bits as u32), fraction((bits >> 32) as u32)]
}

/// Combines the seed of a render with the numbers of a frame, a pixel and a round of samples.
pub(crate) fn pixel_key(seed: u64, [frame, pixel, round]: [u64; 3]) -> u64 {
    let key = mixed(mixed(seed) ^ frame);
    mixed(mixed(key ^ pixel.rotate_left(16)) ^ round.rotate_left(48))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the words of the numbers are taken one by one"
)]
fn seeds(stream: Stream, purpose: Use) -> [u32; 3] {
    let one = mixed(stream.key ^ purpose.code());
    let two = mixed(one);
    [one as u32, (one >> 32) as u32, two as u32]
}

/// Returns the middle of one of 2³² equal intervals of (0, 1).
fn fraction(bits: u32) -> f64 {
    (f64::from(bits) + 0.5) / (1_u64 << 32) as f64
}

/// Returns the second coordinate of a point of Sobol's sequence, in units of 2⁻³².
///
/// The columns of its generator matrix are those of Pascal's triangle modulo 2.
fn sobol_second(index: u32) -> u32 {
    let mut column = 1_u32 << 31;
    let mut value = 0;
    for bit in 0..u32::BITS {
        if index >> bit & 1 == 1 {
            value ^= column;
        }
        column ^= column >> 1;
    }
    value
}

/// Scrambles a number by Owen's method, its bits in reverse: each bit is flipped, or not, by chance
/// that depends on the bits below it.
///
/// The hash is that of S. Laine and T. Karras, *Stratified Sampling for Stochastic Transparency*,
/// 2011, with the constants of Burley 2020.
const fn scrambled(reversed: u32, seed: u32) -> u32 {
    let mut x = reversed.wrapping_add(seed);
    x ^= x.wrapping_mul(0x6c50_b47c);
    x ^= x.wrapping_mul(0xb82f_1e52);
    x ^= x.wrapping_mul(0xc7af_e638);
    x ^ x.wrapping_mul(0x8d22_f6e6)
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
