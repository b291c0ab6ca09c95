//! Functions of circular pupils, computed from arithmetic and square roots, except for [`jinc`] and
//! [`sinc`].
//!
//! They have no branch that a select cannot replace, no table look-up and no library call, so that
//! a loop over them fills the vector units, and no fused multiplication, so that their bits are the
//! same on every platform. Single calls and batches share the functions and therefore agree to the
//! last bit.
//!
//! The polynomials interpolate at Chebyshev nodes over the interval in question, mapped to [−1, 1].

use core::f64::consts::PI;

/// Returns the normalised overlap of two discs of equal diameter, the function called *chat*,
/// within 5e−16.
///
/// `shift` is the distance of the centres in units of the diameter.
///
/// ```text
/// chat(ρ) = (2/π) (acos ρ − ρ √(1 − ρ²))    0 ≤ ρ ≤ 1
/// chat(ρ) = 0                               ρ ≥ 1
/// ```
///
/// It is the optical transfer function of a circular pupil, the amplitude correlation of two
/// speckle fields whose pupils are displaced by ρ diameters, and the shape of the power spectrum of
/// a speckle pattern. The function is even; the sign of `shift` does not matter. NaN counts as no
/// overlap.
///
/// # References
///
/// - J. W. Goodman, *Introduction to Fourier Optics*, 2005, §6.3.
#[inline(always)]
pub fn disc_overlap(shift: f64) -> f64 {
    // chat(1 − ε) = ε √ε S(ε), with S analytic up to ε = 2: 17 coefficients reach rounding on [0,
    // 1].
    let epsilon = (1.0 - shift.abs()).max(0.0);
    let series = polynomial(&OVERLAP, 2.0 * epsilon - 1.0);
    // Rounding may end a unit above 1.
    (epsilon * epsilon.sqrt() * series).min(1.0)
}

/// Returns the shift ρ in [0, 1], in units of the diameter, at which [`disc_overlap`] is `overlap`,
/// within 1e−15.
///
/// An overlap of 1 or more gives ρ = 0, and an overlap of 0 or less, or NaN, gives ρ = 1, so that
/// values with rounding noise at either end are mapped to the end.
#[inline(always)]
pub fn disc_overlap_inverse(overlap: f64) -> f64 {
    let r = 0.5 * circular_path_overlap_inverse(overlap);
    (PI * r * polynomial(&SINC, r * r)).min(1.0)
}

/// Returns the overlap of two discs on a circular path, `angle` half-turns apart, within 1e−15.
///
/// The path's diameter is the discs' diameter, so that discs half a turn apart just cease to
/// overlap:
///
/// ```text
/// chat(sin(π x / 2)) = 1 − x − sin(π x) / π        0 ≤ x ≤ 1
/// ```
///
/// The function is even and has the period 2, one full turn.
pub fn circular_path_overlap(angle: f64) -> f64 {
    let reduced = angle.rem_euclid(2.0);
    let x = reduced.min(2.0 - reduced);
    let rest = 1.0 - x;
    let r = x.min(rest);
    rest - r * polynomial(&SINC, r * r)
}

/// Returns the `angle` in [0, 1], in half-turns, at which [`circular_path_overlap`] is `overlap`,
/// within 1e−15.
///
/// With φ = π (1 − x) this is Kepler's equation φ − sin φ = π c. Values outside [0, 1] map to the
/// nearer end, as in [`disc_overlap_inverse`].
#[inline(always)]
pub fn circular_path_overlap_inverse(overlap: f64) -> f64 {
    // The solution is c^⅓ times an analytic function of c^⅔ up to φ = 2π, so that 23 coefficients
    // reach rounding up to φ = π. The cube root takes NaN for zero.
    let root = cube_root(overlap.clamp(0.0, 1.0));
    let half_turns = root * polynomial(&KEPLER, 2.0 * root * root - 1.0);
    (1.0 - half_turns).max(0.0)
}

/// Returns `jinc(x) = 2 J₁(x) / x`, which is 1 at x = 0.
///
/// It is the amplitude of the Airy pattern of a circular pupil; its first zero lies at x = 3.8317.
pub fn jinc(x: f64) -> f64 {
    if x.abs() < 1e-4 {
        // 1 − x²/8 + x⁴/192: the last term is below 1e−18.
        return 1.0 - x * x / 8.0;
    }
    2.0 * libm::j1(x) / x
}

/// Returns `sinc(x) = sin(x) / x`, which is 1 at x = 0 and 0 at infinity.
pub fn sinc(x: f64) -> f64 {
    if x.is_infinite() {
        return 0.0;
    }
    if x.abs() < 1e-4 {
        // 1 − x²/6 + x⁴/120: the last term is below 1e−18.
        return 1.0 - x * x / 6.0;
    }
    libm::sin(x) / x
}

/// Returns the square of [`sinc`] at πx, `sin²(π x) / (π x)²`, within 1e−15; 0 beyond |x| = 2⁵⁰,
/// where it is below 1e−31.
///
/// With the nearest integer k, sin²(π x) is sin²(π r) for r = x − k.
#[inline(always)]
pub fn sinc_pi_squared(x: f64) -> f64 {
    // Numbers near 1.5 · 2⁵² are 1 apart, so the sum rounds.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LARGEST: f64 = 1_125_899_906_842_624.0;
    let x = x.abs().min(LARGEST);
    let r = x - ((x + ROUND) - ROUND);
    let fraction = if x < 0.5 { 1.0 } else { r / x };
    let amplitude = fraction * polynomial(&SINC, r * r);
    amplitude * amplitude
}

/// Returns the x in [0, π] at which [`sinc`] is `value`, on the branch before the first zero.
///
/// A value of 1 or more gives x = 0, and a value of 0 or less gives x = π.
pub fn sinc_inverse(value: f64) -> f64 {
    if value >= 1.0 {
        return 0.0;
    }
    if value.is_nan() || value <= 0.0 {
        return PI;
    }
    // sin(x)/x falls monotonically on (0, π): bisection down to rounding.
    let (mut low, mut high) = (0.0, PI);
    while high - low > f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if sinc(middle) > value {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
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
mod tests;
