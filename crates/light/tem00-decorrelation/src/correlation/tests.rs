use core::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use tem00_testkit::assert_absolute;

use super::*;

/// The correlation of a pupil displaced by `s` diameters and defocused by the path difference
/// `beta` r² over the unit disc, by quadrature over the area of the overlap.
///
/// `reference` is the centre of the defocus: 0.5 puts it in the middle of the overlap, where the
/// cross-correlation peaks; 0 puts it at the centre of the undisplaced pupil, which corresponds to
/// the displacement of the projected point with the reference in focus.
fn area_integral(s: f64, beta: f64, reference: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    // The left and the right half of the overlap are integrated separately, as there is a corner
    // between them.
    for side in [-1.0, 1.0] {
        for (position, weight_x) in double_exponential() {
            let x = 0.5 * (1.0 - s) * (1.0 + position);
            let height = (1.0 - (x + s).powi(2)).max(0.0).sqrt();
            let along = (side * x + (1.0 - 2.0 * reference) * s).powi(2);
            let weight_x = 0.5 * (1.0 - s) * weight_x * height / PI;
            for (position, weight) in double_exponential() {
                let y = height * position;
                let (sin, cos) = (beta * (along + y * y)).sin_cos();
                re += cos * weight_x * weight;
                im += sin * weight_x * weight;
            }
        }
    }
    re * re + im * im
}

/// Nodes and weights on [−1, 1] of the double-exponential rule, which roots at the ends do not
/// disturb: x = tanh(π/2 · sinh t). At |t| = 3.2 the remaining interval is 1e−16.
fn double_exponential() -> impl Iterator<Item = (f64, f64)> {
    const STEP: f64 = 1.0 / 32.0;
    (-102..=102).map(|i| {
        let t = STEP * f64::from(i);
        let u = FRAC_PI_2 * t.sinh();
        (u.tanh(), STEP * FRAC_PI_2 * t.cosh() / u.cosh().powi(2))
    })
}

/// The laws by integral, with the centre of their defocus.
const INTEGRALS: [(CorrelationLaw, f64); 2] = [
    (CorrelationLaw::AtImageDisplacement, 0.0),
    (CorrelationLaw::AtPeak, 0.5),
];

#[test]
fn overlap_correlation_has_the_reference_values() {
    // Squares of chat(s) to 15 digits, computed in extended precision.
    let reference = [
        (0.1, 0.872_888_571_569_538_f64),
        (0.25, 0.685_037_642_474_293),
        (0.5, 0.391_002_218_955_771),
        (0.75, 0.144_293_612_814_387),
    ];
    for (s, chat) in reference {
        assert_absolute(pupil_overlap_correlation(s), chat * chat, 2e-15);
    }
}

#[test]
fn axial_correlation_has_the_reference_values() {
    // sinc²(π a_O/2) at a_O = 0.5, 1, 1.5, computed in extended precision.
    let reference = [
        (0.25, 0.810_569_469_138_7),
        (0.5, 0.405_284_734_569_4),
        (0.75, 0.090_063_274_348_7),
    ];
    for (x, expected) in reference {
        assert_absolute(axial_correlation(x), expected, 1e-13);
    }
    assert!(axial_correlation(1.0) == 0.0, "not a zero");
    assert!(axial_correlation(f64::NEG_INFINITY) == 0.0, "the limit");
    assert!(axial_correlation(f64::MAX) == 0.0, "an overflow");
    // The revival, at a_O = 2.86.
    assert_absolute(axial_correlation(1.43), 0.0472, 5e-5);
}

#[test]
fn integrals_are_those_over_the_area_of_the_lens() {
    for (law, reference) in INTEGRALS {
        for (s, x) in [
            (0.0, 0.3),
            (0.001, 2.3),
            (0.1, 0.625),
            (0.26, 0.66),
            (0.5, 1.7),
            (0.7, 4.4),
            (0.95, 3.0),
        ] {
            let (exact, area) = (
                law.correlation(s, x),
                area_integral(s, 2.0 * PI * x, reference),
            );
            assert_absolute(exact, area, 1e-12);
        }
    }
}

#[test]
fn one_displacement_alone_leaves_the_integrals_to_the_closed_forms() {
    // Over many panels too: 3000 lengths turn the phase by 19 000 radians, which rounds by 4e−12.
    for (law, _) in INTEGRALS {
        for value in [0.0, 0.1, 0.4, 0.9, 0.999_999, 1.0, 1.43, 2.0, 77.7, 3_000.3] {
            if value <= 1.0 {
                let (shifted, closed) =
                    (law.integral(value, 0.0), pupil_overlap_correlation(value));
                assert_absolute(shifted, closed, 1e-13);
            }
            let (defocused, closed) = (law.integral(0.0, value), axial_correlation(value));
            assert_absolute(defocused, closed, 1e-13);
        }
    }
}

#[test]
fn the_product_is_as_exact_for_little_defocus() {
    for (law, reference) in INTEGRALS {
        for s in [1e-6, 0.03, 0.4, 0.7, 0.97] {
            for x in [1e-9, 1e-5, 3e-5, 3.1e-5, 2.9e-4] {
                let gamma = law.correlation(s, x);
                assert_absolute(gamma, area_integral(s, 2.0 * PI * x, reference), 1e-8);
            }
        }
    }
}

#[test]
fn integrals_are_steady_where_the_product_takes_over() {
    for (law, _) in INTEGRALS {
        for s in [0.0, 1e-6, 0.03, 0.4, 0.5, 0.7, 0.97] {
            for x in [
                3_199.5,
                3_199.999_999,
                3_200.0,
                3_200.5,
                1e6,
                1e30,
                f64::MAX,
            ] {
                let gamma = law.correlation(s, x);
                assert!(
                    (0.0..1e-8).contains(&gamma),
                    "{law:?} at {s}, {x}: {gamma:e}"
                );
            }
        }
    }
}

#[test]
fn inverses_reach_both_ends() {
    for (gamma, end) in [(1.0, 0.0), (0.0, 1.0)] {
        let inverses = [equivalent_pupil_shift(gamma), equivalent_axial_shift(gamma)];
        for inverse in inverses.map(Result::unwrap) {
            assert!((inverse - end).abs() < 1e-15, "{gamma}: {inverse}");
        }
    }
}

proptest! {
    #[test]
    fn inverses_have_the_correlation_asked_for(gamma in 0.0_f64..1.0) {
        // Rounding of s by ε changes γ by up to 4ε.
        let across = pupil_overlap_correlation(equivalent_pupil_shift(gamma).unwrap());
        prop_assert!((across - gamma).abs() < 1e-14);
        let axial = axial_correlation(equivalent_axial_shift(gamma).unwrap());
        prop_assert!((axial - gamma).abs() < 1e-14);
    }

    #[test]
    fn every_law_is_even_and_between_none_and_all(
        s in -1.2_f64..1.2,
        x in -20.0_f64..20.0,
    ) {
        for (law, _) in INTEGRALS {
            let gamma = law.correlation(s, x);
            prop_assert!((0.0..=1.0).contains(&gamma));
            for mirrored in [law.correlation(-s, x), law.correlation(s, -x)] {
                prop_assert_eq!(gamma.to_bits(), mirrored.to_bits());
            }
            // Phasors over the lens add up to its area at most.
            prop_assert!(gamma <= pupil_overlap_correlation(s) + 1e-14);
        }
    }

    #[test]
    fn any_finite_input_has_a_correlation(
        s in proptest::num::f64::NORMAL, x in proptest::num::f64::NORMAL,
    ) {
        for (law, _) in INTEGRALS {
            prop_assert!((0.0..=1.0).contains(&law.correlation(s, x)));
        }
    }
}
