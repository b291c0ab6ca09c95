//! The random phasors of the pupil lattice, addressed by seed and position.

use core::f32::consts::FRAC_PI_2;

use num_complex::Complex;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

use crate::Phasors;

/// Phasors on a torus of `size` × `size` lattice points.
///
/// The phasor at (kx, ky) is made of word kx of the `ChaCha8` stream ky, so that any part of the
/// lattice can be generated alone, in any order and by any thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Lattice {
    pub(crate) seed: u64,
    pub(crate) size: usize,
    pub(crate) phasors: Phasors,
}

/// What the key of the generator holds beside the seed; a new value would be a new family.
const KEY: &[u8; 24] = b"tem00 speckle phasors v1";

/// Streams from here on hold the magnitudes, those below the phases.
const MAGNITUDES: u64 = 1 << 32;

/// Words drawn at a time.
const CHUNK: usize = 256;

impl Lattice {
    /// Fills `row` with the phasors at (kx, ky), (kx + 1, ky), …, all modulo the size.
    pub(crate) fn fill_row(&self, [kx, ky]: [i64; 2], row: &mut [Complex<f32>]) {
        let (start, ky) = (self.wrap(kx), self.wrap(ky));
        let (head, tail) = row.split_at_mut(row.len().min(self.size - start));
        self.fill_run(start, ky, head);
        self.fill_run(0, ky, tail);
    }

    fn fill_run(&self, start: usize, ky: usize, run: &mut [Complex<f32>]) {
        if run.is_empty() {
            return;
        }
        self.for_each_word(ky as u64, start, run, |value, word| {
            *value = unit_phasor(word);
        });
        if self.phasors == Phasors::Gaussian {
            self.for_each_word(MAGNITUDES + ky as u64, start, run, |value, word| {
                *value *= rayleigh_magnitude(word);
            });
        }
    }

    fn for_each_word(
        &self,
        stream: u64,
        start: usize,
        run: &mut [Complex<f32>],
        each: impl Fn(&mut Complex<f32>, u32),
    ) {
        let mut generator = self.generator(stream, start);
        let mut bytes = [0; 4 * CHUNK];
        for part in run.chunks_mut(CHUNK) {
            let bytes = &mut bytes[..4 * part.len()];
            generator.fill_bytes(bytes);
            let (words, _) = bytes.as_chunks();
            for (value, word) in part.iter_mut().zip(words) {
                each(value, u32::from_le_bytes(*word));
            }
        }
    }

    fn generator(&self, stream: u64, word: usize) -> ChaCha8Rng {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        key[8..].copy_from_slice(KEY);
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(stream);
        generator.set_word_pos(word as u128);
        generator
    }

    fn wrap(&self, k: i64) -> usize {
        wrap_to(k, self.size)
    }
}

/// Returns `k mod size` in [0, size).
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "sizes are at most 2¹⁵ and the result lies in [0, size)"
)]
pub(crate) fn wrap_to(k: i64, size: usize) -> usize {
    k.rem_euclid(size as i64) as usize
}

/// Returns `exp(2πi · word / 2³²)`.
///
/// Only `f32` additions and multiplications, which every platform rounds alike; the library sine
/// and cosine are not. The error is below 1.2e−7.
#[inline]
#[expect(
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    reason = "the remainder is a signed 30-bit number, rounded to the 24 bits of f32 on purpose"
)]
pub(crate) fn unit_phasor(word: u32) -> Complex<f32> {
    const TURN: f32 = FRAC_PI_2 / (1 << 30) as f32;
    // The nearest quarter turn and the angle from it, in [−π/4, π/4).
    let quarter = word.wrapping_add(1 << 29) >> 30;
    let angle = TURN * word.wrapping_sub(quarter << 30) as i32 as f32;
    let (sin, cos) = sin_cos_octant(angle);
    let odd = quarter & 1 == 1;
    let (re, im) = if odd { (sin, cos) } else { (cos, sin) };
    // The real part is negative in the quarters 1 and 2, the imaginary part in 2 and 3.
    let negate = |x: f32, quarter: u32| f32::from_bits(x.to_bits() ^ (quarter & 2) << 30);
    Complex::new(negate(re, quarter + 1), negate(im, quarter))
}

/// Taylor series on [−π/4, π/4]: the first terms left out are 2e−9 (sine) and 2.5e−8 (cosine).
#[inline]
fn sin_cos_octant(a: f32) -> (f32, f32) {
    let a2 = a * a;
    let sin = 1.0 / 5_040.0 - a2 * (1.0 / 362_880.0);
    let sin = 1.0 / 120.0 - a2 * sin;
    let sin = 1.0 / 6.0 - a2 * sin;
    let cos = 1.0 / 720.0 - a2 * (1.0 / 40_320.0);
    let cos = 1.0 / 24.0 - a2 * cos;
    let cos = 0.5 - a2 * cos;
    (a - a * a2 * sin, 1.0 - a2 * cos)
}

/// Returns `√(−ln((word + ½) / 2³²))`, whose square is exponential with mean 1.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    reason = "magnitudes are stored as f32"
)]
fn rayleigh_magnitude(word: u32) -> f32 {
    let uniform = (f64::from(word) + 0.5) / 4_294_967_296.0;
    (-ln(uniform)).sqrt() as f32
}

/// The natural logarithm of a normal `x`, from operations that every platform rounds alike.
#[inline]
fn ln(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    const SQRT_HALF_BITS: u64 = 0x3fe6_a09e_667f_3bcd;
    // x = m · 2ⁿ with m in [√½, √2).
    let shifted = x.to_bits().wrapping_sub(SQRT_HALF_BITS);
    #[expect(clippy::cast_possible_wrap, reason = "the sign of the exponent")]
    let exponent = (shifted as i64 >> 52) as i32;
    let m = f64::from_bits((shifted & MANTISSA).wrapping_add(SQRT_HALF_BITS));
    // ln m = 2 artanh(s) with |s| ≤ 0.172: the first term left out is 2 s¹⁵ / 15 = 4e−13.
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let series = [
        1.0 / 13.0,
        1.0 / 11.0,
        1.0 / 9.0,
        1.0 / 7.0,
        0.2,
        1.0 / 3.0,
        1.0,
    ]
    .iter()
    .fold(0.0, |sum, term| sum * s2 + term);
    2.0 * s * series + f64::from(exponent) * core::f64::consts::LN_2
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::*;

    /// Word `word` of `ChaCha` with 8 rounds, after the definition of Bernstein (2008) with a
    /// 64-bit counter and a 64-bit stream.
    fn chacha8_word(seed: u64, stream: u64, word: u64) -> u32 {
        let mut key = seed.to_le_bytes().to_vec();
        key.extend_from_slice(b"tem00 speckle phasors v1");
        let halves = |x: u64| x.to_le_bytes();
        let mut bytes = b"expand 32-byte k".to_vec();
        bytes.extend_from_slice(&key);
        bytes.extend_from_slice(&halves(word / 16));
        bytes.extend_from_slice(&halves(stream));
        let input: Vec<u32> = bytes
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes(b.try_into().unwrap()))
            .collect();
        let mut x = input.clone();
        let mut quarter = |a: usize, b: usize, c: usize, d: usize| {
            for (sum, other, mixed, turn) in
                [(a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)]
            {
                x[sum] = x[sum].wrapping_add(x[other]);
                x[mixed] = (x[mixed] ^ x[sum]).rotate_left(turn);
            }
        };
        for _ in 0..4 {
            for i in 0..4 {
                quarter(i, 4 + i, 8 + i, 12 + i);
            }
            for i in 0..4 {
                quarter(i, 4 + (i + 1) % 4, 8 + (i + 2) % 4, 12 + (i + 3) % 4);
            }
        }
        let word = usize::try_from(word % 16).unwrap();
        x[word].wrapping_add(input[word])
    }

    fn lattice(seed: u64) -> Lattice {
        Lattice {
            seed,
            size: 1_000,
            phasors: Phasors::Unit,
        }
    }

    fn row(lattice: Lattice, start: [i64; 2], length: usize) -> Vec<Complex<f32>> {
        let mut row = vec![Complex::new(0.0, 0.0); length];
        lattice.fill_row(start, &mut row);
        row
    }

    #[test]
    fn phasors_are_the_words_of_chacha8() {
        for (kx, ky) in [(0, 0), (1, 0), (15, 3), (16, 3), (777, 999)] {
            let expected = unit_phasor(chacha8_word(42, ky, kx));
            let k = [i64::try_from(kx).unwrap(), i64::try_from(ky).unwrap()];
            assert_eq!(row(lattice(42), k, 1)[0], expected, "at ({kx}, {ky})");
        }
    }

    #[test]
    fn magnitudes_are_the_words_of_streams_of_their_own() {
        let gaussian = Lattice {
            phasors: Phasors::Gaussian,
            ..lattice(42)
        };
        let magnitude = rayleigh_magnitude(chacha8_word(42, (1 << 32) + 5, 9));
        let expected = unit_phasor(chacha8_word(42, 5, 9)) * magnitude;
        assert_eq!(row(gaussian, [9, 5], 1)[0], expected);
    }

    /// Recorded once. Stable on every platform: `ChaCha8` is integer arithmetic, and the phasor is
    /// made of `f32` operations that IEEE 754 rounds alike everywhere.
    #[test]
    fn a_seed_means_the_same_bits_for_ever() {
        let bits: Vec<_> = row(lattice(2_016), [3, 7], 3)
            .iter()
            .map(|p| (p.re.to_bits(), p.im.to_bits()))
            .collect();
        assert_eq!(
            bits,
            [
                (0x3f78_c3c1, 0x3e71_bb57),
                (0xbe9f_1b60, 0xbf73_534d),
                (0x3f7c_3cf7, 0xbe2e_e6f1)
            ]
        );
    }

    #[test]
    fn the_lattice_is_a_torus() {
        let lattice = lattice(1);
        let across = row(lattice, [990, -1], 20);
        assert_eq!(across[..10], row(lattice, [-10, 999], 10));
        assert_eq!(across[10..], row(lattice, [1_000, 1_999], 10));
    }

    #[test]
    fn a_row_is_the_same_in_parts() {
        let lattice = lattice(9);
        let whole = row(lattice, [0, 4], 1_000);
        for (start, length) in [(0, 1), (255, 2), (256, 300), (17, 983)] {
            let part = row(lattice, [i64::try_from(start).unwrap(), 4], length);
            assert_eq!(part, whole[start..start + length], "from {start}");
        }
    }

    #[test]
    fn the_polynomial_is_the_exponential() {
        // A multiplicative walk through the words, and the borders of all octants.
        let walk = (0..20_000_u32).map(|i| i.wrapping_mul(2_654_435_769));
        let borders = (0..8_u32).flat_map(|i| [i << 29, (i << 29).wrapping_sub(1)]);
        for word in walk.chain(borders) {
            let (sin, cos) = (2.0 * PI * f64::from(word) / 4_294_967_296.0).sin_cos();
            let phasor = unit_phasor(word);
            let error = (f64::from(phasor.re) - cos).hypot(f64::from(phasor.im) - sin);
            // Half a unit in the last place of each part, of the angle (π/4 · 2⁻²⁴) and of the
            // last product: below 2 · 2⁻²⁴.
            assert!(error < 1.2e-7, "error {error:e} at {word:#x}");
        }
    }

    #[test]
    fn the_series_is_the_logarithm() {
        for i in 0..10_000_u32 {
            let x = (f64::from(i) + 0.5) / 10_000.0;
            // 4e−13 of the series and the rounding of |ln x| ≤ 10.
            assert!((ln(x) - x.ln()).abs() < 1e-12, "at {x}");
        }
        // −ln 2⁻³³ for the smallest word, and a positive value for the largest.
        let largest = f64::from(rayleigh_magnitude(0)).powi(2);
        assert!(
            (largest - 33.0 * core::f64::consts::LN_2).abs() < 1e-5,
            "{largest}"
        );
        assert!(rayleigh_magnitude(u32::MAX) > 0.0, "a magnitude of zero");
    }
}
