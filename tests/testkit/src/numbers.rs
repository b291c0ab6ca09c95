/// Random numbers of a test: Steele's `SplitMix64`, the same on every platform.
#[derive(Clone, Debug)]
pub struct Numbers(u64);

impl Numbers {
    /// Starts the sequence of a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub const fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number in [0, 1), one of 2⁵³.
    pub const fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Numbers in [0, 1).
    pub fn units<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.unit())
    }

    /// A number in [start, end).
    pub const fn between(&mut self, start: f64, end: f64) -> f64 {
        start + (end - start) * self.unit()
    }

    /// A standard normal number.
    pub fn normal(&mut self) -> f64 {
        let [a, b] = self.units();
        (-2.0 * (1.0 - a).ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kolmogorov_smirnov;

    #[test]
    fn bits_are_those_of_the_published_generator() {
        let mut numbers = Numbers::new(1_234_567);
        let first = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973];
        assert_eq!([numbers.bits(), numbers.bits()], first, "the first two");
    }

    #[test]
    fn numbers_have_their_distributions() {
        let mut numbers = Numbers::new(3);
        let mut uniform: Vec<f64> = (0..2000).map(|_| numbers.between(-1.0, 3.0)).collect();
        let mut normal: Vec<f64> = (0..2000).map(|_| numbers.normal()).collect();
        let line = |x: f64| (x + 1.0) / 4.0;
        let error = |x: f64| 0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2);
        let p = [
            kolmogorov_smirnov(&mut uniform, line),
            kolmogorov_smirnov(&mut normal, error),
        ];
        assert!(p[0] > 1e-3 && p[1] > 1e-3, "{p:?}");
        let other = kolmogorov_smirnov(&mut uniform, error);
        assert!(other < 1e-9, "another distribution: {other}");
    }
}
