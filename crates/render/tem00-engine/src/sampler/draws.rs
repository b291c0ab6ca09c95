use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// The random numbers of a group of light paths.
///
/// The four numbers with which each path starts are spread evenly over the group: Sobol's sequence
/// with random digits added to all its points, which makes every one of them uniform. Groups start
/// independently of each other. All later numbers are independent.
///
/// # References
///
/// - I. M. Sobol', *On the Distribution of Points in a Cube and the Approximate Evaluation of
///   Integrals*, 1967.
/// - S. Joe and F. Y. Kuo, *Constructing Sobol Sequences with Better Two-Dimensional Projections*,
///   2008.
#[derive(Clone, Debug)]
pub(crate) struct Draws {
    generator: ChaCha8Rng,
    /// The next start, in units of 2⁻⁶⁴.
    start: [u64; 4],
    /// The number of starts drawn.
    started: u32,
}

/// Key of a sequence of random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DrawKey {
    pub seed: u64,
    pub frame: u32,
    pub laser: usize,
    pub group: u64,
}

impl Draws {
    pub(crate) fn new(key: DrawKey) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&key.seed.to_le_bytes());
        bytes[8..12].copy_from_slice(&key.frame.to_le_bytes());
        bytes[16..24].copy_from_slice(&(key.laser as u64).to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(bytes);
        generator.set_stream(key.group);
        let start = core::array::from_fn(|_| generator.next_u64());
        Self {
            generator,
            start,
            started: 0,
        }
    }

    /// Returns the four numbers in [0, 1) with which the next path starts.
    pub(crate) fn start(&mut self) -> [f64; 4] {
        let point = self.start.map(unit);
        self.started = self.started.wrapping_add(1);
        // In the order of Gray's code, neighbours of the sequence differ by one direction number.
        let bit = (self.started.trailing_zeros() as usize).min(BITS - 1);
        for (start, directions) in self.start.iter_mut().zip(&DIRECTIONS) {
            *start ^= directions[bit];
        }
        point
    }

    /// Returns a number in [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        unit(self.generator.next_u64())
    }

    /// Returns two numbers in [0, 1).
    pub(crate) fn uniform_2d(&mut self) -> [f64; 2] {
        [self.uniform(), self.uniform()]
    }
}

/// Returns the leading 53 bits as a number in [0, 1).
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * (0.5 * f64::EPSILON)
}

/// The sequence repeats after 2 to this power.
const BITS: usize = 32;

/// The direction numbers of four axes, in units of 2⁻⁶⁴, by the table of Joe and Kuo.
const DIRECTIONS: [[u64; BITS]; 4] = [
    directions(0, 0, [1, 1, 1]),
    directions(1, 0, [1, 1, 1]),
    directions(2, 1, [1, 3, 1]),
    directions(3, 1, [1, 3, 1]),
];

/// Returns the direction numbers of the primitive polynomial of a `degree` whose inner coefficients
/// are the bits of `inner`, from the `first` odd numbers; the numbers of van der Corput for degree
/// 0.
const fn directions(degree: usize, inner: u64, first: [u64; 3]) -> [u64; BITS] {
    let mut numbers = [0; BITS];
    let mut k = 0;
    while k < BITS {
        numbers[k] = if degree == 0 {
            1 << (63 - k)
        } else if k < degree {
            first[k] << (63 - k)
        } else {
            let mut number = numbers[k - degree] ^ (numbers[k - degree] >> degree);
            let mut back = 1;
            while back < degree {
                if inner >> (degree - 1 - back) & 1 == 1 {
                    number ^= numbers[k - back];
                }
                back += 1;
            }
            number
        };
        k += 1;
    }
    numbers
}
