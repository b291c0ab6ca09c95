use core::f64::consts::PI;

use proptest::prelude::*;
use tem00_testkit::assert_absolute;

use crate::abcd::tests::{lens, mirror, space};

#[test]
fn the_mode_of_a_symmetric_resonator_is_that_of_kogelnik_and_li() {
    let wavelength = 1064e-9;
    for (length, radius) in [(0.3, 0.16), (0.5, 5.0), (1e-2, 100.0), (1.0, 0.500_1)] {
        let half = space(0.5 * length);
        let round_trip = half
            .then(mirror(1.0 / radius))
            .then(space(length))
            .then(mirror(1.0 / radius))
            .then(half);
        let mode = round_trip.eigenmode().unwrap();
        let mode = mode.to_located_beam(wavelength, 1.0).unwrap();
        let squared: f64 = wavelength / (2.0 * PI) * (length * (2.0 * radius - length)).sqrt();
        let ratio = mode.beam().waist_radius() / squared.sqrt();
        // Close to the concentric limit the trace is rounded to 1e−16 of what is left of 4e−4.
        assert!((ratio - 1.0).abs() < 1e-12, "{length}, {radius}: {ratio}");
        assert!(mode.waist_distance().abs() < 1e-11 * length, "{mode:?}");
    }
}

#[test]
fn unstable_resonators_have_no_mode() {
    let plane = mirror(0.0);
    let arm = space(0.3);
    for (first, second) in [
        (plane, plane),
        (mirror(-1.0), plane),
        (mirror(20.0), plane),
        (mirror(20.0), mirror(20.0)),
    ] {
        let round_trip = arm.then(first).then(arm).then(second);
        assert!(!round_trip.is_stable(), "{round_trip:?}");
        let refusal = round_trip.eigenmode().unwrap_err();
        assert_eq!(refusal.parameter, "half_trace", "{refusal}");
        assert!(round_trip.half_trace().abs() >= 1.0 - 1e-15, "{refusal}");
    }
}

#[test]
fn a_weak_lens_keeps_a_mode_to_full_precision() {
    // A plane resonator with a thermal lens: 1 − |A + D|/2 = L/f = 3e−16 is below the rounding of
    // A, yet the mode is known: z_R² = L f for a round trip that begins behind the plane mirror.
    let (length, f) = (0.3, 1e15);
    let half = space(0.5 * length);
    let round_trip = half.then(lens(f)).then(half);
    let mode = round_trip.eigenmode().unwrap();
    assert_absolute(mode.rayleigh_range() / (length * f).sqrt(), 1.0, 1e-15);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn two_mirrors_are_stable_where_the_product_of_their_g_is_between_0_and_1(
        length in 0.05..2.0_f64,
        first in -4.0..4.0_f64,
        second in -4.0..4.0_f64,
    ) {
        let arm = space(length);
        let round_trip = arm.then(mirror(second)).then(arm).then(mirror(first));
        let product = (1.0 - length * first) * (1.0 - length * second);
        // The entries are at most 1e3 times a rounding of 1e−16.
        prop_assume!(product.abs() > 1e-12 && (product - 1.0).abs() > 1e-12);
        prop_assert_eq!(round_trip.is_stable(), product > 0.0 && product < 1.0);
        let expected = 2.0 * product - 1.0;
        prop_assert!((round_trip.half_trace() - expected).abs() < 1e-12, "{:?}", round_trip);
    }

    #[test]
    fn an_eigenmode_comes_back_as_it_was(
        length in 0.05..2.0_f64,
        first in -4.0..4.0_f64,
        second in -4.0..4.0_f64,
        f in 0.2..3.0_f64,
    ) {
        let arm = space(0.5 * length);
        let round_trip = arm
            .then(lens(f))
            .then(arm)
            .then(mirror(second))
            .then(arm)
            .then(lens(f))
            .then(arm)
            .then(mirror(first));
        let sine_squared = 1.0 - round_trip.half_trace().powi(2);
        if sine_squared < 1e-3 {
            // Close to the limit the mode depends on the rounding of the round trip.
            prop_assert!(sine_squared > -1e-3 || !round_trip.is_stable(), "{:?}", round_trip);
            return Ok(());
        }
        let mode = round_trip.eigenmode().unwrap();
        let again = round_trip.transform_parameter(&mode).unwrap();
        // Entries below 1e3, rounded to 1e−13, over a sine of 0.03.
        let error = (again.to_complex() - mode.to_complex()).norm() / mode.to_complex().norm();
        prop_assert!(error < 1e-11, "{:?}: {:e}", round_trip, error);
        // On the mirror the wavefront is the mirror's own, seen reversed by it.
        let difference = mode.curvature() + first;
        let size = mode.to_complex().inv().norm();
        prop_assert!(difference.abs() < 1e-11 * size.max(first.abs()), "{:?}", mode);
    }
}
