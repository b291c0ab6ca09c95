//! Functions of circular pupils from arithmetic and square roots alone.
//!
//! No branch that a select cannot replace, no table look-up and no library, so that a loop over
//! them fills the vector units; no fused multiplication, so that their bits are the same on every
//! platform. Single calls and batches share them, and so agree to the last bit.
//!
//! The polynomials interpolate at Chebyshev nodes over the interval in question, mapped to [−1, 1].

use core::f64::consts::PI;

/// Returns the overlap of two discs, `shift` diameters apart: chat(s), within 5e−16. From s = 1 on
/// it is 0.
///
/// ```text
/// chat(1 − ε) = ε √ε S(ε)
/// ```
///
/// S is analytic up to ε = 2, so that 17 coefficients reach rounding on [0, 1].
#[inline(always)]
pub(crate) fn disc_overlap(shift: f64) -> f64 {
    let epsilon = (1.0 - shift.abs()).max(0.0);
    let series = polynomial(&OVERLAP, 2.0 * epsilon - 1.0);
    // Rounding may end a unit above 1.
    (epsilon * epsilon.sqrt() * series).min(1.0)
}

/// Returns `sin²(π x) / (π x)²`, within 1e−15; 0 beyond |x| = 2⁵⁰, where it is below 1e−31.
///
/// With the nearest integer k, sin²(π x) is sin²(π r) for r = x − k.
#[inline(always)]
pub(crate) fn sinc_squared(x: f64) -> f64 {
    // Numbers near 1.5 · 2⁵² are 1 apart, so the sum rounds.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LARGEST: f64 = 1_125_899_906_842_624.0;
    let x = x.abs().min(LARGEST);
    let r = x - ((x + ROUND) - ROUND);
    let fraction = if x < 0.5 { 1.0 } else { r / x };
    let amplitude = fraction * polynomial(&SINC, r * r);
    amplitude * amplitude
}

/// Returns how far apart on a circular path two discs have the given overlap, in half-turns:
/// the x in [0, 1] with 1 − x − sin(π x)/π = `overlap`, within 1e−15.
///
/// With φ = π (1 − x) this is Kepler's equation φ − sin φ = π c. Its solution is c^⅓ times an
/// analytic function of c^⅔ up to φ = 2π, so that 23 coefficients reach rounding up to φ = π.
#[inline(always)]
pub(crate) fn circular_path_distance(overlap: f64) -> f64 {
    let root = cube_root(overlap);
    let half_turns = root * polynomial(&KEPLER, 2.0 * root * root - 1.0);
    (1.0 - half_turns).max(0.0)
}

/// Returns the overlap of two discs on a circular path, x half-turns apart in [0, 1], within 1e−15.
///
/// ```text
/// 1 − x − sin(π x)/π
/// ```
#[inline(always)]
fn circular_path_overlap(x: f64) -> f64 {
    let rest = 1.0 - x;
    let r = x.min(rest);
    rest - r * polynomial(&SINC, r * r)
}

/// Returns how many slices from the first a blend of slices has the given overlap with it, on a
/// circular path with `half_period` slices to the first uncorrelated one.
///
/// Between the slices i and i + 1, with the overlaps a and b with the first, and ρ with each other,
///
/// ```text
/// g = [(1 − f) a + f b] / √(1 − 2 f (1 − f) (1 − ρ))
/// ```
///
/// is a quadratic equation A f² + 2 B f + C = 0. It falls from a to b, so that f is the smaller root.
#[inline(always)]
pub(crate) fn blended_slice(overlap: f64, half_period: f64) -> f64 {
    let per_half_period = 1.0 / half_period;
    // A slice may be taken for the end of the way to it, or for its beginning.
    let before = floor(half_period * circular_path_distance(overlap)).min(half_period - 1.0);
    let a = circular_path_overlap(before * per_half_period);
    let b = circular_path_overlap((before + 1.0) * per_half_period);
    let k = 1.0 - circular_path_overlap(per_half_period);
    let g = overlap.max(b).min(a);
    let step = b - a;
    let half_slope = a * step + k * g * g;
    // The discriminant has the factor g².
    let inner = step * step + 2.0 * k * a * b - k * (2.0 - k) * g * g;
    let root = g * inner.max(0.0).sqrt();
    // Both are zero where nothing has fallen.
    let fraction = (a - g) * (a + g) / (root - half_slope + f64::MIN_POSITIVE);
    (before + fraction.min(1.0)).max(0.0)
}

/// Rounds a number from 0 to 2⁵⁰ down, or a whole number to the one before.
#[inline(always)]
fn floor(x: f64) -> f64 {
    // Numbers near 1.5 · 2⁵² are 1 apart, so the sum rounds.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    (((x - 0.5) + ROUND) - ROUND).max(0.0)
}

/// Returns x^⅓ for x in [0, 1], within 1e−15 relative for normal numbers and 3e−103 below.
///
/// The exponent and the leading digits give z ≈ x^(−⅓) to 4 %. Each step multiplies z by the
/// series of (1 − e)^(−⅓) in e = 1 − x z³, which is 0.1 and 4e−6 at most.
#[inline(always)]
fn cube_root(x: f64) -> f64 {
    // A third of three times the biased exponent of 1 and more, less a shift that evens the error.
    const ONE: u64 = 1_430_187_263;
    // ⌈2³³/3⌉ divides 32-bit numbers by 3.
    const THIRD: u64 = 0xAAAA_AAAB;
    let x = x.max(f64::MIN_POSITIVE);
    let third = ((x.to_bits() >> 32) * THIRD) >> 33;
    let mut z = f64::from_bits((ONE - third) << 32);
    let e = 1.0 - x * (z * z * z);
    let third_to_fifth_order = 2.0 / 9.0 + e * (14.0 / 81.0 + e * (35.0 / 243.0));
    z += z * (e * (1.0 / 3.0 + e * third_to_fifth_order));
    let e = 1.0 - x * (z * z * z);
    z += z * (e * (1.0 / 3.0 + e * (2.0 / 9.0)));
    x * (z * z)
}

/// Returns Σ `coefficients[n]` tⁿ for an odd number of coefficients, the even and the odd powers
/// each by Horner's rule: two short chains take half the time of a long one.
#[inline(always)]
fn polynomial<const N: usize>(coefficients: &[f64; N], t: f64) -> f64 {
    let square = t * t;
    let (mut even, mut odd) = (coefficients[N - 1], 0.0);
    let mut n = N - 1;
    while n >= 2 {
        n -= 2;
        even = even * square + coefficients[n];
        odd = odd * square + coefficients[n + 1];
    }
    even + odd * t
}

/// S(ε) in powers of t = 2ε − 1.
const OVERLAP: [f64; 17] = [
    1.105_921_281_930_450_7,
    -0.099_488_320_428_322_92,
    -0.005_589_066_336_874_472,
    -0.000_698_837_433_255_083_5,
    -0.000_116_234_740_921_306_47,
    -2.254_626_001_799_234e-05,
    -4.820_198_945_530_587e-06,
    -1.102_357_402_993_782_1e-06,
    -2.649_035_577_725_918_6e-07,
    -6.611_049_323_646_947e-08,
    -1.700_463_954_646_908_3e-08,
    -4.502_832_586_668_821e-09,
    -1.211_443_225_592_539_8e-09,
    -3.088_671_588_772_760_3e-10,
    -8.545_132_612_999_535e-11,
    -3.687_868_013_170_165e-11,
    -1.054_671_639_581_684_2e-11,
];

/// φ/(π c^⅓) in powers of t = 2 c^⅔ − 1.
const KEPLER: [f64; 23] = [
    0.906_651_038_713_021_3,
    0.071_553_376_407_526_15,
    0.015_320_417_386_842_434,
    0.004_322_112_893_558_52,
    0.001_388_521_352_583_112_6,
    0.000_481_064_212_328_832_5,
    0.000_175_094_246_092_681_3,
    6.598_106_162_412_21e-05,
    2.551_256_552_205_625_6e-05,
    1.006_294_127_080_499e-05,
    4.032_223_979_123_996e-06,
    1.635_863_066_251_488_5e-06,
    6.710_571_057_369_719e-07,
    2.796_912_601_891_82e-07,
    1.166_987_057_589_038_9e-07,
    4.570_689_026_214_56e-08,
    1.926_061_887_008_27e-08,
    1.185_552_738_025_891_3e-08,
    5.087_138_461_372_898e-09,
    -4.034_481_239_890_662_4e-10,
    -1.868_500_333_576_460_3e-10,
    9.516_858_847_252_586e-10,
    4.139_501_605_540_050_3e-10,
];

/// sin(π r)/(π r) in powers of r²: (−1)ⁿ π²ⁿ/(2n + 1)!, with a remainder of 8e−19 at r = ½.
const SINC: [f64; 11] = {
    let mut values = [1.0; 11];
    let mut n = 1;
    while n < 11 {
        values[n] = -values[n - 1] * PI * PI / ((2 * n) * (2 * n + 1)) as f64;
        n += 1;
    }
    values
};

#[cfg(test)]
mod tests {
    use tem00_numerics as reference;

    use super::*;

    /// The fractional parts of the multiples of the golden ratio: an even spread over (0, 1).
    fn spread() -> impl Iterator<Item = f64> {
        (1..100_000).map(|i| (f64::from(i) * 0.618_033_988_749).fract())
    }

    #[test]
    fn overlap_is_the_closed_form() {
        for s in spread() {
            let (got, expected) = (disc_overlap(s), reference::disc_overlap(s));
            // Two roundings of 2e−16 near 1 on either side. From s = 0.99 on the reference is a
            // series with a remainder of 9e−12 relative, 6e−15 absolute.
            assert!((got - expected).abs() < 8e-16 || s > 0.99, "s = {s}: {got}");
            assert!(
                (got / expected - 1.0).abs() < 2e-11 || s < 0.99,
                "s = {s}: {got}"
            );
        }
    }

    #[test]
    fn overlap_ends_at_one_and_zero() {
        let none = 1.0 - disc_overlap(0.0);
        assert!(none == 0.0, "{none:e} too little");
        for s in [1.0, -1.0, 1.5, f64::MAX, f64::INFINITY] {
            assert!(disc_overlap(s) == 0.0, "s = {s}");
        }
        // (8√2/3π) ε^(3/2) (1 − 3ε/20) at the last number before 1.
        let epsilon = f64::EPSILON / 2.0;
        let leading = 8.0 * 2.0_f64.sqrt() / (3.0 * PI) * epsilon.powf(1.5);
        let relative = disc_overlap(1.0 - epsilon) / leading - 1.0;
        assert!(relative.abs() < 1e-14, "{relative:e}");
    }

    #[test]
    fn squared_sinc_is_that_of_the_library() {
        for x in spread().map(|x| 5.0 * x) {
            let expected = reference::sinc(PI * x).powi(2);
            // The reference rounds π x ≤ 16 by 2e−15, which turns sinc by 2e−15/(π x).
            let error = (sinc_squared(x) - expected).abs();
            assert!(error < 2e-15, "x = {x}: {error:e}");
        }
        assert!(1.0 - sinc_squared(0.0) == 0.0, "at zero");
        for x in [1.0, -7.0, 1e15, f64::MAX, f64::INFINITY] {
            assert!(sinc_squared(x) == 0.0, "x = {x}");
        }
        // Around powers of two, where a sum with a large number rounds the most.
        for x in (48..1_023).map(|exponent| 2.0_f64.powi(exponent)) {
            for x in [x.next_down(), x, x.next_up()] {
                assert!((0.0..2e-30).contains(&sinc_squared(x)), "x = {x:e}");
            }
        }
    }

    #[test]
    fn distance_on_the_path_has_the_overlap_asked_for() {
        for overlap in spread() {
            let x = circular_path_distance(overlap);
            // 1 − x − sin(π x)/π as a function of y = 1 − x, which does not cancel.
            let back = (1.0 - x) - (PI * (1.0 - x)).sin() / PI;
            // The slope is 2 at most: 2 · 1e−15, and rounding of the check.
            assert!(
                (back - overlap).abs() < 2e-15,
                "c = {overlap}: {:e}",
                back - overlap
            );
        }
    }

    #[test]
    fn distance_on_the_path_ends_at_zero_and_one() {
        for overlap in [1.0, 1.5, f64::INFINITY] {
            assert!(circular_path_distance(overlap) == 0.0, "c = {overlap}");
        }
        for overlap in [0.0, -0.0, -1e-17, 5e-324] {
            let short = 1.0 - circular_path_distance(overlap);
            assert!(short == 0.0, "c = {overlap}: {short:e} too short");
        }
        // φ³/6 = π c, up to φ²/60.
        let small = 1e-12_f64;
        let expected = (6.0 * PI * small).cbrt() / PI;
        let got = 1.0 - circular_path_distance(small);
        assert!((got / expected - 1.0).abs() < 1e-8, "{got}, {expected}");
    }

    #[test]
    fn cube_roots_are_those_of_the_library() {
        for exponent in -300..0 {
            for mantissa in [1.0, 1.7, 2.3, 4.4, 6.1, 9.9] {
                let x = mantissa * 10.0_f64.powi(exponent);
                let relative = cube_root(x) / x.cbrt() - 1.0;
                assert!(relative.abs() < 1e-15, "{x:e}: {relative:e}");
            }
        }
    }
}
