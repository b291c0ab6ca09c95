use tem00_numerics::seed::scattered;

/// Random numbers of one pixel or of one group of light paths: `SplitMix64` from its own starting
/// point.
pub(super) struct Random(u64);

impl Random {
    /// Starts the numbers of a seed and three indices, such as the numbers of a frame, a column and
    /// a row.
    pub(super) fn new(seed: u64, indices: [u64; 3]) -> Self {
        let mixed = |state, index| scattered(state ^ scattered(index));
        Self(indices.into_iter().fold(scattered(!seed), mixed))
    }

    /// Returns a number in [0, 1).
    pub(super) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        (scattered(self.0) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns two numbers in [0, 1).
    pub(super) fn pair(&mut self) -> [f64; 2] {
        [self.number(), self.number()]
    }
}
