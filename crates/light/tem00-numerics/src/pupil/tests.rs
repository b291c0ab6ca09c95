use core::f64::consts::{FRAC_2_PI, PI};
use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

/// The fractional parts of the multiples of the golden ratio: an even spread over (0, 1).
fn spread() -> impl Iterator<Item = f64> {
    (1..100_000).map(|i| (f64::from(i) * 0.618_033_988_749).fract())
}

#[test]
fn overlap_is_the_closed_form() {
    for s in spread().filter(|s| *s < 0.99) {
        let expected = FRAC_2_PI * (s.acos() - s * ((1.0 - s) * (1.0 + s)).sqrt());
        let got = disc_overlap(s);
        // Two roundings of 2e−16 near 1 on either side.
        assert!((got - expected).abs() < 8e-16, "s = {s}: {got}");
    }
}

#[test]
fn overlap_of_discs_that_hardly_meet_is_the_series() {
    for epsilon in spread().map(|x| 0.01 * x) {
        // chat(1 − ε), from integrating −chat′ = (4/π) √(2ε − ε²) term by term. At ε = 0.01 the
        // first term left out is 9e−12; rounding of 1 − ε turns it by 1.5 · 1e−16 / ε.
        let s = 1.0 - epsilon;
        let epsilon = 1.0 - s;
        let leading = 8.0 * 2.0_f64.sqrt() / (3.0 * PI) * epsilon * epsilon.sqrt();
        let expected =
            leading * (1.0 - epsilon * (3.0 / 20.0 + epsilon * (3.0 / 224.0 + epsilon / 384.0)));
        assert_relative(disc_overlap(s), expected, 2e-11);
    }
    // The last number before 1.
    let epsilon = f64::EPSILON / 2.0;
    let leading = 8.0 * 2.0_f64.sqrt() / (3.0 * PI) * epsilon.powf(1.5);
    assert_relative(disc_overlap(1.0 - epsilon), leading, 1e-14);
}

#[test]
fn overlap_ends_at_one_and_zero() {
    let none = 1.0 - disc_overlap(0.0);
    assert!(none == 0.0, "{none:e} too little");
    for s in [1.0, -1.0, 1.5, f64::MAX, f64::INFINITY, f64::NAN] {
        assert!(disc_overlap(s) == 0.0, "s = {s}");
    }
}

#[test]
fn squared_sinc_is_that_of_the_library() {
    for x in spread().map(|x| 5.0 * x) {
        let expected = sinc(PI * x).powi(2);
        // The reference rounds π x ≤ 16 by 2e−15, which turns sinc by 2e−15/(π x).
        let error = (sinc_pi_squared(x) - expected).abs();
        assert!(error < 2e-15, "x = {x}: {error:e}");
    }
    assert!(1.0 - sinc_pi_squared(0.0) == 0.0, "at zero");
    for x in [1.0, -7.0, 1e15, f64::MAX, f64::INFINITY] {
        assert!(sinc_pi_squared(x) == 0.0, "x = {x}");
    }
    // Around powers of two, where a sum with a large number rounds the most.
    for x in (48..1_023).map(|exponent| 2.0_f64.powi(exponent)) {
        for x in [x.next_down(), x, x.next_up()] {
            assert!((0.0..2e-30).contains(&sinc_pi_squared(x)), "x = {x:e}");
        }
    }
}

#[test]
fn pupil_functions_vanish_at_infinity() {
    for x in [f64::INFINITY, f64::NEG_INFINITY] {
        assert!(sinc(x).abs() < f64::MIN_POSITIVE, "sinc({x}) = {}", sinc(x));
        assert!(jinc(x).abs() < f64::MIN_POSITIVE, "jinc({x}) = {}", jinc(x));
    }
}

#[test]
fn airy_amplitude_vanishes_at_its_first_zero() {
    // The first zero of J₁ (Abramowitz & Stegun 1964, table 9.5).
    assert!(jinc(3.831_705_970_207_512).abs() < 1e-15, "not a zero");
    // Both sides of the switch to the series; the slope there is −x/4 = −2.5e−5.
    assert_absolute(jinc(0.999_999e-4), jinc(1.000_001e-4), 1e-14);
    assert_absolute(sinc(0.999_999e-4), sinc(1.000_001e-4), 1e-14);
}

#[test]
fn overlap_on_the_circle_is_that_of_discs_so_far_apart() {
    for x in spread() {
        let expected = disc_overlap((0.5 * PI * x).sin());
        for angle in [x, -x, 2.0 - x, 2.0 + x, 40.0 + x] {
            let got = circular_path_overlap(angle);
            // The sum 40 + x is rounded by 4e−15, and the slope is 2 at most.
            assert!((got - expected).abs() < 9e-15, "{angle}: {got}");
        }
    }
}

#[test]
fn overlaps_on_the_circle_have_their_known_squares() {
    // Of 1 − x − sin(π x)/π to 15 digits.
    for (parts, square) in [
        (4.0, 0.275_541_973_262_254),
        (8.0, 0.567_292_284_154_527),
        (16.0, 0.766_326_598_814_221),
    ] {
        let got = circular_path_overlap(1.0_f64 / parts).powi(2);
        assert!((got - square).abs() < 1e-15, "1/{parts}: {got}");
    }
}

#[test]
fn angle_on_the_circle_has_the_overlap_asked_for() {
    for overlap in spread() {
        let x = circular_path_overlap_inverse(overlap);
        // 1 − x − sin(π x)/π as a function of y = 1 − x, which does not cancel.
        let back = (1.0 - x) - (PI * (1.0 - x)).sin() / PI;
        // The slope is 2 at most: 2 · 1e−15, and rounding of the check.
        assert_absolute(back, overlap, 2e-15);
    }
}

#[test]
fn inverses_of_the_overlaps_end_at_zero_and_one() {
    for overlap in [1.0, 1.5, f64::INFINITY] {
        assert!(
            circular_path_overlap_inverse(overlap) == 0.0,
            "c = {overlap}"
        );
        assert!(disc_overlap_inverse(overlap) == 0.0, "c = {overlap}");
    }
    for overlap in [0.0, -0.0, -1e-17, 5e-324, f64::NAN] {
        let angle = 1.0 - circular_path_overlap_inverse(overlap);
        let shift = 1.0 - disc_overlap_inverse(overlap);
        assert!(
            angle == 0.0 && shift == 0.0,
            "c = {overlap}: {angle:e}, {shift:e} short"
        );
    }
    // φ³/6 = π c, up to φ²/60.
    let small = 1e-12_f64;
    let expected = (6.0 * PI * small).cbrt() / PI;
    assert_relative(1.0 - circular_path_overlap_inverse(small), expected, 1e-8);
}

#[test]
fn cube_roots_are_those_of_the_library() {
    for exponent in -300..0 {
        for mantissa in [1.0, 1.7, 2.3, 4.4, 6.1, 9.9] {
            let x = mantissa * 10.0_f64.powi(exponent);
            assert_relative(cube_root(x), x.cbrt(), 1e-15);
        }
    }
}

proptest! {
    #[test]
    fn inverse_of_the_overlap_recovers_the_shift(rho in 0.0_f64..1.0) {
        // chat′(0) = −4/π, chat′(1) = 0: rounding of the overlap, ε, moves ρ by ε/|chat′|,
        // which is ε^(2/3) at worst.
        let tolerance = 1e-10;
        prop_assert!((disc_overlap_inverse(disc_overlap(rho)) - rho).abs() < tolerance);
    }

    #[test]
    fn inverse_of_sinc_recovers_its_argument(x in 1e-3_f64..3.1) {
        // sinc′(x) ≈ −x/3: rounding moves x by 3 ε / x ≤ 7e−13.
        prop_assert!((sinc_inverse(sinc(x)) - x).abs() < 1e-12);
    }

    #[test]
    fn inverses_stay_in_range(value in proptest::num::f64::ANY) {
        prop_assert!((0.0..=1.0).contains(&disc_overlap_inverse(value)));
        prop_assert!((0.0..=PI).contains(&sinc_inverse(value)));
        prop_assert!((0.0..=1.0).contains(&circular_path_overlap_inverse(value)));
    }
}
