//! Values on the pupil lattice: random phasors addressed by seed and position, or samples.

use core::f32::consts::FRAC_PI_2;
use std::sync::Arc;

use num_complex::Complex;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use tem00_numerics::{Grid, cast::to_signed, vectorised};

use crate::Phasors;

/// A field on the points of a torus, with `period` points along each axis.
///
/// On a torus of P points the point k has the value of the source at the representative of k in
/// [−P/2, P/2), counted from the origin, so that the surroundings of the origin are the same for
/// every P.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lattice {
    pub(crate) source: Source,
    pub(crate) period: [i64; 2],
    /// The point of the source at which the pupil rests.
    pub(crate) origin: [i64; 2],
}

/// Source of the values at the lattice points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Source {
    Seeded(Seeded),
    /// Samples about the origin, which is the point (⌊w/2⌋, ⌊h/2⌋); zero beyond them.
    Measured(Arc<Grid<Complex<f32>>>),
}

/// Random phasors.
///
/// The phasor at (kx, ky) is computed from word kx of the `ChaCha8` stream ky, both modulo 2³², so
/// that any part of the lattice can be generated alone, in any order and by any thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Seeded {
    pub(crate) seed: u64,
    pub(crate) phasors: Phasors,
}

/// The part of the generator's key other than the seed; a new value would give a new family of
/// phasors.
const KEY: &[u8; 24] = b"tem00 speckle phasors v1";

/// The first stream with magnitudes; the streams below hold the phases.
const MAGNITUDES: u64 = 1 << 32;

/// Words drawn at a time.
const CHUNK: usize = 64;

impl Lattice {
    /// The number of points along an axis after which random phasors repeat.
    pub(crate) const SIDE: i64 = 1 << 32;

    /// A lattice that does not close before its phasors do.
    pub(crate) const fn endless(source: Source) -> Self {
        Self {
            source,
            period: [Self::SIDE; 2],
            origin: [0; 2],
        }
    }

    /// Returns the lattice displaced by a number of points.
    pub(crate) const fn displaced(mut self, [x, y]: [i64; 2]) -> Self {
        let [x0, y0] = self.origin;
        // A displacement by 2³² points is the identity.
        self.origin = [
            nearest(x0.wrapping_add(x), Self::SIDE),
            nearest(y0.wrapping_add(y), Self::SIDE),
        ];
        self
    }

    /// Fills `row` with the values at (kx, ky), (kx + 1, ky), …
    pub(crate) fn fill_row(&self, [kx, ky]: [i64; 2], row: &mut [Complex<f32>]) {
        let [kx, ky] = self.nearest([kx, ky]);
        let end = (self.period[0] + 1) / 2;
        let (mut start, mut rest) = (kx, row);
        while !rest.is_empty() {
            let length = usize::try_from(end - start).unwrap_or(usize::MAX);
            let (run, tail) = rest.split_at_mut(length.min(rest.len()));
            let point = [start + self.origin[0], ky + self.origin[1]];
            match &self.source {
                Source::Seeded(seeded) => seeded.fill_run(point, run),
                Source::Measured(samples) => copy_run(samples, point, run),
            }
            start = end - self.period[0];
            rest = tail;
        }
    }

    /// Returns the representative of `k` nearest to the origin.
    pub(crate) fn nearest(&self, [kx, ky]: [i64; 2]) -> [i64; 2] {
        [nearest(kx, self.period[0]), nearest(ky, self.period[1])]
    }
}

/// The representative of k modulo `period` in [−period/2, period/2).
const fn nearest(k: i64, period: i64) -> i64 {
    let k = k.rem_euclid(period);
    if k < period - k { k } else { k - period }
}

/// Copies the samples at (kx, ky), (kx + 1, ky), …, with zeros beyond the samples.
fn copy_run(samples: &Grid<Complex<f32>>, [kx, ky]: [i64; 2], run: &mut [Complex<f32>]) {
    let [width, height] = [samples.width(), samples.height()].map(to_signed);
    run.fill(Complex::new(0.0, 0.0));
    let (x, y) = (kx + width / 2, ky + height / 2);
    if !(0..height).contains(&y) {
        return;
    }
    let row = samples.row(to_index(y));
    // The part of the run that meets the row.
    let (first, last) = (x.max(0), (x + to_signed(run.len())).min(width));
    if first < last {
        run[to_index(first - x)..to_index(last - x)]
            .copy_from_slice(&row[to_index(first)..to_index(last)]);
    }
}

impl Seeded {
    /// Fills a run of phasors.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positions are meant modulo 2³²"
    )]
    fn fill_run(self, [kx, ky]: [i64; 2], run: &mut [Complex<f32>]) {
        if run.is_empty() {
            return;
        }
        let (word, stream) = (kx as u32, u64::from(ky as u32));
        // After word 2³² − 1 the generator continues with word 2³², not with word 0.
        let length = usize::try_from(Lattice::SIDE - i64::from(word)).unwrap_or(usize::MAX);
        let (run, beyond) = run.split_at_mut(length.min(run.len()));
        self.fill_run([0, ky], beyond);
        self.for_each_word(stream, word, run, |value, word| {
            *value = unit_phasor(word);
        });
        if self.phasors == Phasors::Gaussian {
            self.for_each_word(MAGNITUDES + stream, word, run, |value, word| {
                *value *= rayleigh_magnitude(word);
            });
        }
    }

    fn for_each_word(
        self,
        stream: u64,
        start: u32,
        run: &mut [Complex<f32>],
        each: impl Fn(&mut Complex<f32>, u32),
    ) {
        let mut generator = self.generator(stream, start);
        let mut bytes = [0; 4 * CHUNK];
        for part in run.chunks_mut(CHUNK) {
            let bytes = &mut bytes[..4 * part.len()];
            generator.fill_bytes(bytes);
            let (words, _) = bytes.as_chunks();
            vectorised(
                #[inline(always)]
                || {
                    for (value, word) in part.iter_mut().zip(words) {
                        each(value, u32::from_le_bytes(*word));
                    }
                },
            );
        }
    }

    fn generator(self, stream: u64, word: u32) -> ChaCha8Rng {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        key[8..].copy_from_slice(KEY);
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(stream);
        generator.set_word_pos(u128::from(word));
        generator
    }
}

/// Converts an index, which the caller guarantees not to be negative.
fn to_index(n: i64) -> usize {
    usize::try_from(n).unwrap_or(0)
}

/// Returns `exp(2πi · word / 2³²)`.
///
/// It uses only `f32` additions and multiplications, which every platform rounds alike, unlike the
/// library sine and cosine. The error is below 1.2e−7.
#[inline(always)]
#[expect(
    clippy::cast_possible_wrap,
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

/// Taylor series on [−π/4, π/4]: the first omitted terms are 2e−9 (sine) and 2.5e−8 (cosine).
#[inline(always)]
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
    // ln m = 2 artanh(s) with |s| ≤ 0.172: the first omitted term is 2 s¹⁵ / 15 = 4e−13.
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

    use tem00_testkit::assert_absolute;

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
        Lattice::endless(Source::Seeded(Seeded {
            seed,
            phasors: Phasors::Unit,
        }))
    }

    fn torus(seed: u64, period: [i64; 2]) -> Lattice {
        Lattice {
            period,
            ..lattice(seed)
        }
    }

    fn row(lattice: &Lattice, start: [i64; 2], length: usize) -> Vec<Complex<f32>> {
        let mut row = vec![Complex::new(0.0, 0.0); length];
        lattice.fill_row(start, &mut row);
        row
    }

    #[test]
    fn phasors_are_the_words_of_chacha8() {
        for [kx, ky] in [
            [0, 0],
            [1, 0],
            [15, 3],
            [16, 3],
            [777, 999],
            [-1, 2],
            [5, -1],
            [-1_000_000_007, 2_000_000_011],
        ] {
            let modulo = |k: i64| u64::try_from(k.rem_euclid(1 << 32)).unwrap();
            let expected = unit_phasor(chacha8_word(42, modulo(ky), modulo(kx)));
            assert_eq!(
                row(&lattice(42), [kx, ky], 1)[0],
                expected,
                "at ({kx}, {ky})"
            );
        }
    }

    #[test]
    fn magnitudes_are_the_words_of_streams_of_their_own() {
        let gaussian = Lattice::endless(Source::Seeded(Seeded {
            seed: 42,
            phasors: Phasors::Gaussian,
        }));
        for [kx, ky] in [[9_u32, 5_u32], [9, u32::MAX]] {
            let (word, stream) = (u64::from(kx), u64::from(ky));
            let magnitude = rayleigh_magnitude(chacha8_word(42, (1 << 32) + stream, word));
            let expected = unit_phasor(chacha8_word(42, stream, word)) * magnitude;
            assert_eq!(row(&gaussian, [kx.into(), ky.into()], 1)[0], expected);
        }
    }

    /// The values were recorded once and are the same on every platform: `ChaCha8` is integer
    /// arithmetic, and the phasor uses `f32` operations that IEEE 754 rounds alike everywhere.
    #[test]
    fn a_seed_means_the_same_bits_for_ever() {
        let bits: Vec<_> = row(&lattice(2_016), [3, 7], 3)
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
    fn a_lattice_repeats_after_its_period_and_not_before() {
        let closed = torus(1, [1_000, 70]);
        let across = row(&closed, [990, -1], 20);
        assert_eq!(across[..10], row(&closed, [-10, 69], 10));
        assert_eq!(across[10..], row(&closed, [1_000, 139], 10));
        let endless = lattice(1);
        for far in [1_000, 1 << 20, 1 << 31] {
            let (here, there) = (row(&endless, [-3, -3], 6), row(&endless, [far - 3, -3], 6));
            assert!(here.iter().zip(&there).all(|(a, b)| a != b), "{far}");
        }
        let round = [(1 << 32) - 3, -3 - (1 << 32)];
        assert_eq!(row(&endless, [-3, -3], 6), row(&endless, round, 6));
    }

    #[test]
    fn the_surroundings_of_the_origin_do_not_depend_on_the_period() {
        for period in [16, 17, 1 << 20] {
            let closed = row(&torus(3, [period; 2]), [-8, -8], 16);
            assert_eq!(closed, row(&lattice(3), [-8, -8], 16), "period {period}");
        }
    }

    #[test]
    fn a_displaced_lattice_has_the_phasors_of_another_place() {
        let here = |start: [i64; 2]| row(&lattice(7), start, 40);
        for origin in [[1_000, -3], [-1_000, 5], [1 << 31, 0], [(1 << 40) + 9, -1]] {
            for start in [[-20, 2], [-1_010, -2], [(1 << 31) - 9, 0]] {
                let there = here([0, 1].map(|axis| start[axis] + origin[axis]));
                let displaced = lattice(7).displaced(origin);
                assert_eq!(row(&displaced, start, 40), there, "{start:?} by {origin:?}");
            }
        }
        // A lattice that closes keeps the values around its origin.
        let closed = torus(7, [64, 16]).displaced([500, 0]);
        assert_eq!(row(&closed, [-20, 2], 40), here([480, 2]));
        assert_eq!(row(&closed, [44, 18], 40), here([480, 2]));
    }

    #[test]
    fn a_row_is_the_same_in_parts() {
        let lattice = torus(9, [701, 8]);
        let whole = row(&lattice, [-800, 4], 1_800);
        for (start, length) in [(0, 1), (255, 2), (256, 300), (17, 1_783), (799, 3)] {
            let part = row(&lattice, [to_signed(start) - 800, 4], length);
            assert_eq!(part, whole[start..start + length], "from {start}");
        }
    }

    #[test]
    fn samples_lie_about_the_origin_with_nothing_around_them() {
        let sample = |x: usize, y: usize| Complex::new(1.0 + x as f32, 1.0 + y as f32);
        for (width, height) in [(4, 3), (5, 4)] {
            let samples = Arc::new(Grid::from_fn(width, height, sample));
            let lattice = Lattice::endless(Source::Measured(samples));
            for ky in -5..6 {
                for start in [-6, -2, 1] {
                    for (k, value) in (start..).zip(row(&lattice, [start, ky], 7)) {
                        let inside = |k: i64, n: usize| {
                            usize::try_from(k + to_signed(n / 2))
                                .ok()
                                .filter(|&i| i < n)
                        };
                        let expected = match (inside(k, width), inside(ky, height)) {
                            (Some(x), Some(y)) => sample(x, y),
                            _ => Complex::new(0.0, 0.0),
                        };
                        assert_eq!(value, expected, "at ({k}, {ky}) of {width} × {height}");
                    }
                }
            }
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
            // The tolerance covers 4e−13 of the series and the rounding of |ln x| ≤ 10.
            assert!((ln(x) - x.ln()).abs() < 1e-12, "at {x}");
        }
        // −ln 2⁻³³ for the smallest word, and a positive value for the largest.
        let largest = f64::from(rayleigh_magnitude(0)).powi(2);
        assert_absolute(largest, 33.0 * core::f64::consts::LN_2, 1e-5);
        assert!(rayleigh_magnitude(u32::MAX) > 0.0, "a magnitude of zero");
    }
}
