use proptest::prelude::*;
use tem00_testkit::assert_relative;

use super::*;
use crate::fit::synthetic::{assert_chi_squared, assert_standard_normal, noise, pull};

const WAVELENGTH: f64 = 1064e-9;
const WAIST: f64 = 80e-6;
const POSITION: f64 = 0.35;
const M_SQUARED: f64 = 1.8;

/// Positions in Rayleigh ranges as ISO 11146-1 requires: six near the waist, six far from it.
const ISO: [f64; 12] = [
    -4.0, -3.0, -2.2, -0.9, -0.5, -0.15, 0.2, 0.6, 1.0, 2.5, 3.2, 4.1,
];

fn truth() -> GaussianBeam {
    let ideal = GaussianBeam::from_waist(WAVELENGTH, WAIST).unwrap();
    ideal.with_m_squared(M_SQUARED).unwrap()
}

/// Positions of a measurement, and the radii of the true beam there.
fn caustic() -> (Vec<f64>, Vec<f64>) {
    let beam = truth();
    let z: Vec<_> = ISO.map(|x| x * beam.rayleigh_range()).to_vec();
    let radii = z.iter().map(|&z| beam.radius_at(z)).collect();
    (z.iter().map(|z| POSITION + z).collect(), radii)
}

#[test]
fn radii_without_noise_give_the_beam_back() {
    let (z, w) = caustic();
    let beam = truth();
    let deviations: Vec<_> = w.iter().map(|w| 0.01 * w + 1e-6).collect();
    let errors = [
        RadiusErrors::Relative,
        RadiusErrors::Equal,
        RadiusErrors::Known(&deviations),
    ];
    for errors in errors {
        let fit = CausticFit::with_errors(WAVELENGTH, &z, &w, errors).unwrap();
        let pairs = [
            (fit.waist_radius(), WAIST),
            (fit.waist_position(), POSITION),
            (fit.divergence(), beam.divergence()),
            (fit.rayleigh_range(), beam.rayleigh_range()),
            (fit.m_squared(), M_SQUARED),
            (fit.beam_parameter_product(), beam.beam_parameter_product()),
        ];
        for (estimate, expected) in pairs {
            // Rounding of the radii, 1e−16, times the condition of the fit, about 10.
            assert_relative(estimate.value, expected, 1e-14);
        }
        let located = fit.beam().unwrap();
        assert_relative(located.beam().m_squared(), M_SQUARED, 1e-14);
        assert_relative(located.waist_distance(), POSITION, 1e-14);
        for (&z, &w) in z.iter().zip(&w) {
            assert_relative(fit.radius_at(z), w, 1e-14);
            assert_relative(located.radius_at(z), w, 1e-14);
        }
    }
}

/// Fits many noisy caustics and returns the pulls of w₀, z₀ and M², scaled to the true size of the
/// noise, and the sum of squared residuals in units of the noise.
fn repeated_fits(
    seed: u64,
    deviation: impl Fn(f64) -> f64,
    fit: impl Fn(&[f64], &[f64]) -> CausticFit,
    true_residual: f64,
) -> ([Vec<f64>; 3], f64) {
    const FITS: usize = 400;
    let (z, w) = caustic();
    let mut noise = noise(seed);
    let mut pulls = [const { Vec::new() }; 3];
    let mut sum = 0.0;
    for _ in 0..FITS {
        let measured: Vec<_> = w.iter().map(|w| w + deviation(*w) * noise()).collect();
        let fit = fit(&z, &measured);
        let scatter = fit.residual_deviation() / true_residual;
        sum += scatter * scatter * (z.len() - 3) as f64;
        let estimates = [
            pull(fit.waist_radius(), WAIST),
            pull(fit.waist_position(), POSITION),
            pull(fit.m_squared(), M_SQUARED),
        ];
        for (pulls, value) in pulls.iter_mut().zip(estimates) {
            pulls.push(value * scatter);
        }
    }
    (pulls, sum)
}

fn assert_pulls((pulls, sum): ([Vec<f64>; 3], f64)) {
    for (pulls, name) in pulls.iter().zip(["w₀", "z₀", "M²"]) {
        assert_standard_normal(pulls, name);
    }
    let freedom = pulls[0].len() * (ISO.len() - 3);
    assert_chi_squared(sum, freedom, "residuals");
}

#[test]
fn standard_errors_from_the_scatter_are_those_of_repeated_measurements() {
    // Dividing out the estimate of the noise leaves standard normal pulls; that estimate itself
    // follows a χ² distribution. The noise is small, so that the model is linear over it.
    let relative = |z: &[f64], w: &[f64]| CausticFit::new(WAVELENGTH, z, w).unwrap();
    assert_pulls(repeated_fits(1, |w| 5e-3 * w, relative, 5e-3));
    let equal = |z: &[f64], w: &[f64]| {
        CausticFit::with_errors(WAVELENGTH, z, w, RadiusErrors::Equal).unwrap()
    };
    assert_pulls(repeated_fits(2, |_| 0.5e-6, equal, 0.5e-6));
}

#[test]
fn standard_errors_from_known_deviations_are_those_of_repeated_measurements() {
    let deviation = |w: f64| 2e-3 * w + 0.2e-6;
    let known: Vec<_> = caustic().1.into_iter().map(deviation).collect();
    let errors = RadiusErrors::Known(&known);
    let fit = |z: &[f64], w: &[f64]| {
        let fit = CausticFit::with_errors(WAVELENGTH, z, w, errors).unwrap();
        // Undo the scaling of the pulls: these errors do not follow from the scatter.
        let scale = |estimate: Estimate| Estimate {
            standard_error: estimate.standard_error * fit.residual_deviation(),
            ..estimate
        };
        CausticFit {
            waist_radius: scale(fit.waist_radius),
            waist_position: scale(fit.waist_position),
            beam_parameter_product: scale(fit.beam_parameter_product),
            ..fit
        }
    };
    assert_pulls(repeated_fits(3, deviation, fit, 1.0));
}

#[test]
fn errors_of_derived_quantities_follow_from_those_of_repeated_measurements() {
    let (z, w) = caustic();
    let beam = truth();
    let mut noise = noise(4);
    let mut pulls = [const { Vec::new() }; 2];
    for _ in 0..400 {
        let measured: Vec<_> = w.iter().map(|w| w * (1.0 + 5e-3 * noise())).collect();
        let fit = CausticFit::new(WAVELENGTH, &z, &measured).unwrap();
        let scatter = fit.residual_deviation() / 5e-3;
        pulls[0].push(pull(fit.divergence(), beam.divergence()) * scatter);
        pulls[1].push(pull(fit.rayleigh_range(), beam.rayleigh_range()) * scatter);
    }
    assert_standard_normal(&pulls[0], "δ");
    assert_standard_normal(&pulls[1], "z_R");
}

#[test]
fn no_neighbour_fits_better() {
    let (z, w) = caustic();
    let mut noise = noise(5);
    let measured: Vec<_> = w.iter().map(|w| w * (1.0 + 0.1 * noise())).collect();
    let fit = CausticFit::new(WAVELENGTH, &z, &measured).unwrap();
    let sum = |waist: f64, position: f64, divergence: f64| -> f64 {
        let model = |z: f64| waist.hypot(divergence * (z - position));
        let deviations = z.iter().zip(&measured).map(|(&z, w)| (w / model(z)).ln());
        deviations.map(|d| d * d).sum()
    };
    let best = [fit.waist_radius(), fit.waist_position(), fit.divergence()];
    let [a, b, c] = best.map(|estimate| estimate.value);
    let minimum = sum(a, b, c);
    let freedom = (z.len() - 3) as f64;
    assert_relative(fit.residual_deviation(), (minimum / freedom).sqrt(), 1e-12);
    let [da, db, dc] = best.map(|estimate| 1e-3 * estimate.standard_error);
    for sign in [-1.0, 1.0] {
        let neighbours = [
            sum(a + sign * da, b, c),
            sum(a, b + sign * db, c),
            sum(a, b, c + sign * dc),
        ];
        for neighbour in neighbours {
            assert!(neighbour > minimum, "{neighbour} < {minimum}");
        }
    }
}

#[test]
fn units_and_origin_of_the_data_do_not_matter() {
    let (z, w) = caustic();
    let mut noise = noise(6);
    let w: Vec<_> = w.iter().map(|w| w * (1.0 + 0.05 * noise())).collect();
    let plain = CausticFit::new(WAVELENGTH, &z, &w).unwrap();
    for unit in [1e-20, 1e6, 1e25] {
        let scaled = |values: &[f64]| values.iter().map(|v| v * unit).collect::<Vec<_>>();
        let fit = CausticFit::new(WAVELENGTH * unit, &scaled(&z), &scaled(&w)).unwrap();
        let pairs = [
            (fit.m_squared(), plain.m_squared(), 1.0),
            (fit.waist_radius(), plain.waist_radius(), unit),
            (fit.waist_position(), plain.waist_position(), unit),
            (fit.rayleigh_range(), plain.rayleigh_range(), unit),
            (fit.divergence(), plain.divergence(), 1.0),
        ];
        for (got, expected, unit) in pairs {
            // Rounding of the coordinates, times the condition of the fit.
            assert_relative(got.value, expected.value * unit, 1e-13);
            assert_relative(got.standard_error, expected.standard_error * unit, 1e-12);
        }
    }
    let shifted: Vec<_> = z.iter().map(|z| z + 64.0).collect();
    let fit = CausticFit::new(WAVELENGTH, &shifted, &w).unwrap();
    let moved = fit.waist_position().value - plain.waist_position().value;
    // Positions near 64 m are rounded by 1e−14 m.
    assert!((moved - 64.0).abs() < 1e-13, "{moved}");
}

#[test]
fn waists_that_the_polynomial_misses_are_found() {
    let (z, w) = caustic();
    let (z, w) = (&z[5..], &w[5..]);
    let noisy = |seed: u64| {
        let mut noise = noise(seed);
        let measured: Vec<_> = w.iter().map(|w| w * (0.3 * noise()).exp()).collect();
        measured
    };
    let missed = (0..300).filter(|&seed| {
        let data = Caustic::new(z, &noisy(seed), RadiusErrors::Relative).unwrap();
        data.polynomial().is_none()
    });
    let found = missed.filter(|&seed| CausticFit::new(WAVELENGTH, z, &noisy(seed)).is_ok());
    // Most of these data have no waist at all; 11 of them do.
    assert!(found.count() > 5, "the guess finds too few");
}

#[test]
fn two_radii_at_one_place_do_not_spoil_the_guess() {
    let (z, w) = ([0.0, 0.0, 1.0, 2.0], [1.0, 1.1, 2.0, 3.0]);
    let guess = Caustic::new(&z, &w, RadiusErrors::Relative)
        .unwrap()
        .guess()
        .unwrap();
    assert!(guess.iter().all(|p| p.is_finite()), "{guess:?}");
}

#[test]
fn noise_below_the_diffraction_limit_is_no_beam() {
    let (z, w) = caustic();
    let fit = CausticFit::new(M_SQUARED * WAVELENGTH * 1.01, &z, &w).unwrap();
    assert!(fit.m_squared().value < 1.0, "{fit:?}");
    assert_eq!(fit.beam().unwrap_err().parameter, "m_squared");
}

#[test]
fn cones_and_caustics_that_bend_the_wrong_way_leave_a_parameter_open() {
    let z = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let cone = z.map(|z| 1e-3 * z);
    let wrong = [1.0, 1.1, 1.15, 1.16, 1.1, 0.9].map(|w| 1e-3 * w);
    for radii in [cone, wrong] {
        let result = CausticFit::new(WAVELENGTH, &z, &radii);
        assert!(
            matches!(result, Err(FitError::Undetermined | FitError::NotConverged)),
            "{result:?}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_data_end_in_numbers_or_in_an_error(
        points in prop::collection::vec((-30.0..30.0_f64, any::<bool>(), -30.0..30.0_f64), 4..12),
        span in 0.0..30.0_f64,
    ) {
        // From data of one order of magnitude to data that span all of them.
        let size = |exponent: f64| 10_f64.powf(exponent * span / 30.0);
        let sign = |negative| if negative { -1.0 } else { 1.0 };
        let z: Vec<_> = points.iter().map(|&(z, side, _)| sign(side) * size(z)).collect();
        let w: Vec<_> = points.iter().map(|&(_, _, w)| size(w)).collect();
        for errors in [RadiusErrors::Relative, RadiusErrors::Equal, RadiusErrors::Known(&w)] {
            if let Ok(fit) = CausticFit::with_errors(WAVELENGTH, &z, &w, errors) {
                let estimates = [
                    fit.waist_radius(), fit.waist_position(), fit.divergence(),
                    fit.rayleigh_range(), fit.m_squared(),
                ];
                let finite = |e: &Estimate| !e.value.is_nan() && !e.standard_error.is_nan();
                prop_assert!(estimates.iter().all(finite), "{:?}", fit);
                prop_assert!(!fit.radius_at(1.0).is_nan(), "{:?}", fit);
            }
        }
    }
}
