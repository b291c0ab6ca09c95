//! Random numbers: a stream of `ChaCha` for each purpose.

use core::f64::consts::TAU;

use num_complex::Complex;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

const KEY: &[u8; 24] = b"tem00 wave scatterers v1";

/// Purpose of a stream of random numbers. Streams are independent.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Purpose {
    Positions,
    Amplitudes,
    Heights,
}

/// Uniform and Gaussian numbers from a seed.
pub(crate) struct Random {
    generator: ChaCha8Rng,
}

impl Random {
    pub(crate) fn new(seed: u64, purpose: Purpose) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..].copy_from_slice(KEY);
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(purpose as u64);
        Self { generator }
    }

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    pub(crate) fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        let value = (self.generator.next_u64() >> 11) as f64;
        value * STEP
    }

    /// A phasor of magnitude 1 and uniform phase.
    pub(crate) fn unit_phasor(&mut self) -> Complex<f64> {
        let (sin, cos) = (TAU * self.uniform()).sin_cos();
        Complex::new(cos, sin)
    }

    /// A circular complex Gaussian number with `⟨|g|²⟩ = 1` (Box and Muller 1958).
    pub(crate) fn complex_gaussian(&mut self) -> Complex<f64> {
        // 1 − u lies in (0, 1].
        let magnitude = (-(1.0 - self.uniform()).ln()).sqrt();
        magnitude * self.unit_phasor()
    }

    /// A real Gaussian number with variance 1.
    pub(crate) fn gaussian(&mut self) -> f64 {
        core::f64::consts::SQRT_2 * self.complex_gaussian().re
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaussian_numbers_have_their_moments() {
        let mut random = Random::new(1, Purpose::Heights);
        const COUNT: u32 = 200_000;
        let (mut second, mut fourth, mut pseudo) = (0.0, 0.0, Complex::new(0.0, 0.0));
        for _ in 0..COUNT {
            let g = random.complex_gaussian();
            second += g.norm_sqr() / f64::from(COUNT);
            fourth += g.norm_sqr().powi(2) / f64::from(COUNT);
            pseudo += g * g / f64::from(COUNT);
        }
        // The standard deviations of the means are √(1, 20, 1)/√n = 0.0022, 0.010, 0.0022; four
        // standard deviations are exceeded with probability 6e−5.
        assert!((second - 1.0).abs() < 0.009, "⟨|g|²⟩ = {second}");
        assert!((fourth - 2.0).abs() < 0.040, "⟨|g|⁴⟩ = {fourth}");
        assert!(pseudo.norm() < 0.011, "⟨g²⟩ = {pseudo}");
    }

    #[test]
    fn purposes_have_streams_of_their_own() {
        let first = |purpose| Random::new(7, purpose).uniform().to_bits();
        let values = [Purpose::Positions, Purpose::Amplitudes, Purpose::Heights].map(first);
        assert!(
            values[0] != values[1] && values[1] != values[2] && values[0] != values[2],
            "{values:?}"
        );
    }
}
