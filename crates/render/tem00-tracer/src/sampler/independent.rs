use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// Independent random numbers, for tests.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    generator: ChaCha8Rng,
}

impl Sampler {
    /// Starts the stream `stream` of the seed `seed`.
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self { generator }
    }

    /// Returns a number in [0, 1) with 53 random bits.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 * (0.5 * f64::EPSILON)
    }

    /// Returns two numbers in [0, 1).
    pub(crate) fn uniform_2d(&mut self) -> [f64; 2] {
        [self.uniform(), self.uniform()]
    }
}
