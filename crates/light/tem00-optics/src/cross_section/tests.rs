use core::f64::consts::SQRT_2;

use proptest::prelude::*;
use tem00_numerics::quadrature::integrate;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

fn spot(w_x: f64, w_y: f64) -> CrossSection {
    CrossSection::new([w_x, w_y]).unwrap()
}

/// The power within a centred circle by quadrature over its area, with equal weights around the
/// centre, where the integrand is periodic.
fn power_by_area(spot: &CrossSection, radius: f64) -> f64 {
    const SPOKES: u32 = 120;
    let ring = |r: f64| {
        let spoke = |i: u32| {
            let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(SPOKES)).sin_cos();
            spot.irradiance_per_watt([r * cos, r * sin])
        };
        (0..SPOKES).map(spoke).sum::<f64>() * 2.0 * PI * r / f64::from(SPOKES)
    };
    integrate(ring, [0.0, radius], 0.2)
}

#[test]
fn a_circle_holds_the_integral_over_its_area() {
    for [w_x, w_y] in [[1.0, 1.0], [1.0, 0.4], [0.7, 2.0]] {
        for radius in [0.2, 1.0, 1.6] {
            let spot = spot(w_x, w_y);
            let error = spot.power_in_circle(radius) - power_by_area(&spot, radius);
            // Both sides round a few hundred terms.
            assert!(error.abs() < 2e-12, "{w_x}, {w_y}, {radius}: {error:e}");
        }
    }
    // By quadrature at 45 digits, mpmath 1.3 (F. Johansson et al.).
    let got = spot(1.0, 22_662.801_882_568_81).power_in_circle(1_237.603_309_301_835_7);
    assert!((got - 0.086_971_134_390_103_03).abs() < 1e-13, "{got}");
}

#[test]
fn elliptic_beams_next_to_circular_ones_hold_as_much() {
    for exponent in -30..=30 {
        let radius = 3.0 * 10_f64.powi(exponent);
        let [round, other] = [1e-3, 1e-3 * (1.0 + 4e-16)].map(|w| spot(1e-3, w));
        let (closed, got) = (round.power_in_circle(radius), other.power_in_circle(radius));
        assert_relative(got, closed, 1e-12);
    }
}

#[test]
fn slim_beam_through_a_circle_is_cut_at_the_ends_of_a_diameter() {
    // With u = √2 h / w_y on a chord of half-length h at the depth h² / 2r from the end:
    // ∫ erfc(u) dx = w_y² / (2r) · ∫ u erfc(u) du = w_y² / (8r); the next order is w_y⁴ / r³.
    let radius = 0.5_f64;
    for slim in [1e-6, 1e-4, 1e-3_f64] {
        let density = (2.0 / PI).sqrt() * (-2.0 * radius * radius).exp();
        let expected = libm::erf(SQRT_2 * radius) - 2.0 * density * slim * slim / (8.0 * radius);
        for spot in [spot(1.0, slim), spot(slim, 1.0)] {
            let got = spot.power_in_circle(radius);
            let error = got - expected;
            let next = 10.0 * slim.powi(4);
            assert!(error.abs() < next + 2e-13, "{slim}: {error:e}");
        }
    }
}

#[test]
fn circle_radius_inverts_the_encircled_power() {
    for spot in [spot(1e-3, 1e-3), spot(1e-3, 0.3e-3), spot(1e-9, 1e3)] {
        for fraction in [1e-12, 1e-3, 0.3, 0.5, 0.864_664_716_763, 0.999, 1.0 - 1e-9] {
            let radius = spot.circle_radius(fraction).unwrap();
            assert_absolute(spot.power_in_circle(radius), fraction, 1e-12);
        }
        let none = spot.circle_radius(0.0).unwrap();
        assert!(none.abs() < f64::MIN_POSITIVE, "{none}");
    }
}

#[test]
fn square_slit_and_knife_edge_are_products_and_sums_of_error_functions() {
    let [w_x, w_y] = [1e-3, 0.4e-3];
    let spot = spot(w_x, w_y);
    for side in [1e-12, 1e-5, 0.3e-3, 1e-3, 5e-3] {
        let expected = libm::erf(side / (SQRT_2 * w_x)) * libm::erf(side / (SQRT_2 * w_y));
        // A product of two error functions of a few rounding errors each.
        assert_relative(spot.power_in_square(side), expected, 3e-15);
    }
    let [past_low, past_high] = [-0.2e-3, 0.9e-3].map(|x| spot.power_past_knife_edge(x));
    let slit = spot.power_in_slit(0.35e-3, 1.1e-3);
    assert!((past_low - past_high - slit).abs() < 1e-15, "{slit}");
    let across = spot.transposed().power_in_slit(0.1e-3, 0.2e-3);
    let rectangle = spot.power_in_rectangle([0.35e-3, 0.1e-3], [1.1e-3, 0.2e-3]);
    assert!((rectangle - slit * across).abs() < 1e-15, "{rectangle}");
}

#[test]
fn rectangle_holds_the_integral_over_its_area() {
    let spot = spot(1.0, 0.7);
    let ([x, y], [a, b]) = ([0.4, -0.9], [1.2, 0.8]);
    let column = |x: f64| {
        let (low, high) = (y - b / 2.0, y + b / 2.0);
        integrate(|y| spot.irradiance_per_watt([x, y]), [low, high], 0.5)
    };
    let expected = integrate(column, [x - a / 2.0, x + a / 2.0], 0.5);
    let got = spot.power_in_rectangle([x, y], [a, b]);
    assert_relative(got, expected, 4e-9);
}

#[test]
fn far_and_narrow_slits_keep_their_relative_accuracy() {
    let spot = spot(1.0, 1.0);
    let density = |x: f64| (2.0 / PI).sqrt() * (-2.0 * x * x).exp();
    for centre in [0.0, -0.5, 3.0, 12.0] {
        let width = 1e-9;
        let got = spot.power_in_slit(centre, width);
        // The next term is (4 x · width)² / 24 = 1e−16 of the first; exp(−2x²) amplifies the
        // rounding of its argument by 4x².
        let tolerance = 2e-15 * (1.0 + centre * centre);
        assert_relative(got, width * density(centre), tolerance);
    }
    // On both sides of the switch to the series, which is at a width of √2 · 3e−3 w or less.
    for (centre, width) in [(0.3, 4.2e-3), (0.3, 4.3e-3), (2.0, 1.4e-3), (2.0, 1.6e-3)] {
        let (a, b) = (centre - width / 2.0, centre + width / 2.0);
        let expected = integrate(density, [a, b], 1.0);
        // A difference of error functions loses 1 / width.
        assert_relative(spot.power_in_slit(centre, width), expected, 2e-13);
    }
}

#[test]
fn tenth_and_ninetieth_percent_lie_the_knife_edge_width_apart() {
    let spot = spot(1e-3, 3e-3);
    for (spot, width) in [spot, spot.transposed()]
        .iter()
        .zip(spot.knife_edge_width())
    {
        let above = spot.power_past_knife_edge(width / 2.0);
        let below = spot.power_past_knife_edge(-width / 2.0);
        assert!((above - 0.1).abs() < 1e-15, "{above}");
        assert!((below - 0.9).abs() < 1e-15, "{below}");
    }
}

#[test]
fn widths_are_those_of_the_irradiance() {
    let spot = spot(1e-3, 0.4e-3);
    let peak = spot.irradiance_per_watt([0.0, 0.0]);
    let [x, y] = spot.fwhm();
    for edge in [[x / 2.0, 0.0], [0.0, -y / 2.0]] {
        assert_relative(spot.irradiance_per_watt(edge), peak / 2.0, 1e-15);
    }
    let slit = |x: f64| x * x * (2.0 / PI).sqrt() / 1e-3 * (-2.0 * (x / 1e-3).powi(2)).exp();
    let deviation = integrate(slit, [-6e-3, 6e-3], 1e-3).sqrt();
    assert_relative(spot.d4_sigma()[0], 4.0 * deviation, 1e-12);
    assert_relative(spot.d4_sigma()[1], 0.8e-3, 1e-15);
    // ∫ E² dA is half the peak irradiance for 1 W.
    assert_relative(spot.effective_area(), 2.0 / peak, 1e-15);
}

#[test]
fn both_tails_keep_their_relative_accuracy() {
    let spot = spot(1.0, 1.0);
    let (near, far) = (
        spot.power_past_knife_edge(8.0),
        spot.power_past_knife_edge(9.0),
    );
    for centre in [8.5, -8.5] {
        // The argument of exp(−128) is rounded by 1e−14.
        assert_relative(spot.power_in_slit(centre, 1.0), near - far, 1e-13);
    }
}

#[test]
fn apertures_without_an_edge_pass_everything_and_those_of_negative_size_nothing() {
    for spot in [spot(1.0, 1.0), spot(1.0, 2.0), spot(1e-30, 1e30)] {
        for (size, power) in [(f64::INFINITY, 1.0), (-1.0, 0.0)] {
            assert_absolute(spot.power_in_circle(size), power, 1e-15);
            assert_absolute(spot.power_in_square(size), power, 1e-15);
            assert_absolute(spot.power_in_slit(0.1, size), power, 1e-15);
        }
        let all = spot.power_past_knife_edge(f64::NEG_INFINITY);
        assert_absolute(all, 1.0, 1e-15);
    }
    // One radius is 1e−330 of the other, which underflows; ±w hold erf √2 of the power.
    for radii in [[1e-30, 1e300], [1e300, 1e-30]] {
        let power = (CrossSection { radii }).power_in_circle(1e300);
        assert_absolute(power, libm::erf(SQRT_2), 1e-13);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_query_yields_nan(
        exponents in prop::array::uniform2(-29.9..29.9_f64),
        x in proptest::num::f64::ANY,
        y in proptest::num::f64::ANY,
        size in proptest::num::f64::ANY,
    ) {
        let spot = spot(10_f64.powf(exponents[0]), 10_f64.powf(exponents[1]));
        let [x, y, size] = [x, y, size].map(|v| if v.is_finite() { v } else { f64::MAX });
        let powers = [
            spot.power_in_circle(size),
            spot.power_in_square(size),
            spot.power_in_rectangle([x, y], [size, y]),
            spot.power_in_slit(x, size),
            spot.power_past_knife_edge(x),
        ];
        prop_assert!(
            powers.iter().all(|p| (0.0..=1.0).contains(p)),
            "{:?}: {:?}", spot, powers
        );
        prop_assert!(!spot.irradiance_per_watt([x, y]).is_nan(), "{:?}", spot);
    }
}
