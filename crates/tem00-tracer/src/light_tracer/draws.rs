use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// The random numbers of a group of light paths.
///
/// The four numbers with which each path starts are spread evenly over the group: points of the
/// lattice sequence of Roberts, from a random first point, which makes every one of them uniform.
/// Groups start independently of each other. All later numbers are independent.
///
/// # References
///
/// - M. Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018.
#[derive(Clone, Debug)]
pub(super) struct Draws {
    generator: ChaCha8Rng,
    /// The next start, in units of 2⁻⁶⁴.
    start: [u64; 4],
}

/// What the random numbers belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DrawKey {
    pub seed: u64,
    pub frame: u32,
    pub laser: usize,
    pub group: u64,
}

/// The steps of the sequence, g⁻¹ to g⁻⁴ in units of 2⁻⁶⁴, where g = 1.1673… solves g⁵ = g + 1.
const STEPS: [u64; 4] = [
    0xdb4f_0b91_75ae_2165,
    0xbbe0_5633_03a4_615f,
    0xa0f2_ec75_a1fe_1576,
    0x89e1_8285_7d9e_d689,
];

impl Draws {
    pub(super) fn new(key: DrawKey) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&key.seed.to_le_bytes());
        bytes[8..12].copy_from_slice(&key.frame.to_le_bytes());
        bytes[16..24].copy_from_slice(&(key.laser as u64).to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(bytes);
        generator.set_stream(key.group);
        let start = core::array::from_fn(|_| generator.next_u64());
        Self { generator, start }
    }

    /// Returns the four numbers in [0, 1) with which the next path starts.
    pub(super) fn start(&mut self) -> [f64; 4] {
        let point = self.start.map(unit);
        for (start, step) in self.start.iter_mut().zip(STEPS) {
            *start = start.wrapping_add(step);
        }
        point
    }

    /// Returns a number in [0, 1).
    pub(super) fn uniform(&mut self) -> f64 {
        unit(self.generator.next_u64())
    }

    /// Returns two numbers in [0, 1).
    pub(super) fn uniform_2d(&mut self) -> [f64; 2] {
        [self.uniform(), self.uniform()]
    }
}

/// Returns the leading 53 bits as a number in [0, 1).
#[expect(
    clippy::cast_precision_loss,
    reason = "53 bits are exactly representable"
)]
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * (0.5 * f64::EPSILON)
}
