use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::CrossSection;
use crate::fit::synthetic::{assert_chi_squared, assert_standard_normal, noise, pull};

const RADIUS: f64 = 0.6e-3;
const CENTRE: f64 = 7.1e-3;
const POWER: f64 = 3.4;

/// Positions of the edge, and the power at greater positions.
fn falling() -> (Vec<f64>, Vec<f64>) {
    let spot = CrossSection::new([RADIUS, RADIUS]).unwrap();
    let z: Vec<_> = (0..25).map(|i| 6e-3 + 0.1e-3 * f64::from(i)).collect();
    let passed = |x: &f64| POWER * spot.power_past_knife_edge(x - CENTRE);
    let powers = z.iter().map(passed).collect();
    (z, powers)
}

#[test]
fn trace_without_noise_gives_the_beam_back_in_both_directions() {
    let (x, falling) = falling();
    let rising: Vec<_> = falling.iter().map(|p| POWER - p).collect();
    for powers in [falling, rising] {
        let with_offset: Vec<_> = powers.iter().map(|p| p - 0.7).collect();
        let plain = KnifeEdgeFit::new(&x, &powers).unwrap();
        let offset = KnifeEdgeFit::with_background(&x, &with_offset).unwrap();
        assert_eq!(plain.background(), None, "none was fitted");
        let background = offset.background().unwrap().value;
        // Rounding of the powers, 1e−16, times the condition of the fit, about 10.
        assert_relative(background, -0.7, 1e-14);
        for (fit, powers) in [(plain, &powers), (offset, &with_offset)] {
            assert_relative(fit.radius().value, RADIUS, 1e-14);
            assert_relative(fit.centre().value, CENTRE, 1e-14);
            assert_relative(fit.power().value, POWER, 1e-14);
            for (&x, power) in x.iter().zip(powers) {
                assert_absolute(fit.power_at(x), *power, 1e-13);
            }
        }
    }
}

#[test]
fn standard_errors_are_those_of_repeated_measurements() {
    const FITS: usize = 400;
    const DEVIATION: f64 = 0.005 * POWER;
    let (x, powers) = falling();
    for (seed, parameters) in [(1, 3), (2, 4)] {
        let mut noise = noise(seed);
        let mut pulls = [const { Vec::new() }; 4];
        let mut sum = 0.0;
        for _ in 0..FITS {
            let measured: Vec<_> = powers.iter().map(|p| p + DEVIATION * noise()).collect();
            let fit = if parameters == 3 {
                KnifeEdgeFit::new(&x, &measured).unwrap()
            } else {
                KnifeEdgeFit::with_background(&x, &measured).unwrap()
            };
            // Dividing out the estimate of the noise leaves standard normal pulls; that estimate
            // itself follows a χ² distribution.
            let scatter = fit.residual_deviation() / DEVIATION;
            sum += scatter * scatter * (x.len() - parameters) as f64;
            pulls[0].push(pull(fit.radius(), RADIUS) * scatter);
            pulls[1].push(pull(fit.centre(), CENTRE) * scatter);
            pulls[2].push(pull(fit.power(), POWER) * scatter);
            pulls[3].extend(fit.background().map(|b| pull(b, 0.0) * scatter));
        }
        let freedom = FITS * (x.len() - parameters);
        assert_chi_squared(sum, freedom, "residuals");
        for (pulls, name) in pulls
            .iter()
            .zip(["radius", "centre", "power", "background"])
        {
            if !pulls.is_empty() {
                assert_standard_normal(pulls, name);
            }
        }
    }
}

#[test]
fn units_of_the_trace_do_not_matter() {
    let (x, powers) = falling();
    let mut noise = noise(3);
    let powers: Vec<_> = powers.iter().map(|p| p + 0.05 * noise()).collect();
    let plain = KnifeEdgeFit::with_background(&x, &powers).unwrap();
    for (length, power) in [(1e-20, 1e20), (1e3, 1e-6), (1e25, 1e-25)] {
        let x: Vec<_> = x.iter().map(|x| x * length).collect();
        let powers: Vec<_> = powers.iter().map(|p| p * power).collect();
        let fit = KnifeEdgeFit::with_background(&x, &powers).unwrap();
        let pairs = [
            (fit.radius(), plain.radius(), length),
            (fit.centre(), plain.centre(), length),
            (fit.power(), plain.power(), power),
        ];
        for (got, expected, unit) in pairs {
            // Rounding of the coordinates, times the condition of the fit.
            assert_relative(got.value, expected.value * unit, 1e-13);
            let error = expected.standard_error * unit;
            assert_relative(got.standard_error, error, 1e-12);
        }
        let residual = plain.residual_deviation() * power;
        assert_relative(fit.residual_deviation(), residual, 1e-12);
    }
}

#[test]
fn order_of_the_points_does_not_matter() {
    let (mut x, mut powers) = falling();
    x.swap(3, 20);
    powers.swap(3, 20);
    x.swap(0, 14);
    powers.swap(0, 14);
    let fit = KnifeEdgeFit::new(&x, &powers).unwrap();
    assert_relative(fit.radius().value, RADIUS, 1e-14);
}

#[test]
fn narrow_edges_in_a_long_trace_are_found() {
    let spot = CrossSection::new([3e-3, 3e-3]).unwrap();
    let x: Vec<_> = (0..=2_000).map(|i| 1e-3 * f64::from(i)).collect();
    let powers: Vec<_> = x
        .iter()
        .map(|x| spot.power_past_knife_edge(x - 1.8771))
        .collect();
    let fit = KnifeEdgeFit::new(&x, &powers).unwrap();
    assert_relative(fit.radius().value, 3e-3, 1e-12);
    assert_relative(fit.centre().value, 1.8771, 1e-12);
    let powers: Vec<_> = powers.iter().map(|p| p + 1e4).collect();
    let fit = KnifeEdgeFit::with_background(&x, &powers).unwrap();
    // The powers are rounded by 1e−12.
    assert_relative(fit.radius().value, 3e-3, 1e-10);
}

#[test]
fn negative_power_is_no_edge() {
    let x = [
        0.184_235_068_799_758_48,
        -0.783_577_761_237_425_7,
        -0.812_078_876_118_679,
        -0.809_237_185_304_745_8,
        -0.757_683_129_339_363_3,
    ];
    let powers = [-0.3, -0.3, -0.5, -0.5, -0.9];
    let result = KnifeEdgeFit::new(&x, &powers);
    assert_eq!(result, Err(FitError::NoEdge), "every power is negative");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_trace_ends_in_numbers_or_in_an_error(
        points in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 4..12),
        exponents in prop::array::uniform4(-30.0..29.0_f64),
    ) {
        let [x_unit, x_shift, unit, shift] = exponents.map(|exponent| 10_f64.powf(exponent));
        let x: Vec<_> = points.iter().map(|(x, _)| x * x_unit + x_shift).collect();
        let powers: Vec<_> = points.iter().map(|(_, p)| p * unit + shift).collect();
        let plain = KnifeEdgeFit::new(&x, &powers);
        let offset = KnifeEdgeFit::with_background(&x, &powers);
        for fit in [plain, offset].into_iter().flatten() {
            let estimates = [Some(fit.radius()), Some(fit.centre()), Some(fit.power())];
            let mut estimates = estimates.into_iter().chain([fit.background()]).flatten();
            let numbers = |e: Estimate| !e.value.is_nan() && !e.standard_error.is_nan();
            prop_assert!(estimates.all(numbers), "{:?}", fit);
            prop_assert!(!fit.power_at(x_shift).is_nan(), "{:?}", fit);
        }
    }
}
