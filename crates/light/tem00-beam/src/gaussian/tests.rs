use core::f64::consts::SQRT_2;

use proptest::prelude::*;
use tem00_numerics::quadrature::integrate;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

const HENE: f64 = 632.8e-9;

fn beam() -> GaussianBeam {
    GaussianBeam::from_waist(HENE, 100e-6).unwrap()
}

#[test]
fn every_cross_section_carries_the_full_power() {
    for m_squared in [1.0, 3.0] {
        let beam = beam().with_m_squared(m_squared).unwrap();
        let z_r = beam.rayleigh_range();
        for z in [-10.0 * z_r, -z_r, 0.0, 0.3 * z_r, 100.0 * z_r] {
            // exp(−2 · 4²) ≈ 1e−14 of the power lies beyond four beam radii.
            let cutoff = 4.0 * beam.radius_at(z);
            let ring = |r| beam.irradiance_per_watt(r, z) * 2.0 * PI * r;
            let power = integrate(ring, [0.0, cutoff], 0.25 * cutoff);
            assert_absolute(power, 1.0, 1e-10);
        }
    }
}

#[test]
fn m_squared_scales_divergence_and_rayleigh_range_but_not_the_waist() {
    let ideal = beam();
    let real = ideal.with_m_squared(1.7).unwrap();
    assert_relative(real.divergence(), 1.7 * ideal.divergence(), 1e-15);
    assert_relative(real.rayleigh_range(), ideal.rayleigh_range() / 1.7, 1e-15);
    assert_relative(real.radius_at(0.0), 100e-6, 1e-15);
}

#[test]
fn divergence_and_waist_determine_each_other() {
    let beam = GaussianBeam::from_divergence(HENE, 2.5e-3).unwrap();
    let again = GaussianBeam::from_waist(HENE, beam.waist_radius()).unwrap();
    assert_relative(again.divergence(), 2.5e-3, 1e-15);
}

#[test]
fn curvature_is_the_relative_growth_of_the_radius() {
    let beam = beam();
    let z_r = beam.rayleigh_range();
    for x in [-20.0, -1.0, -0.2, 0.0, 0.5, 1.0, 3.0] {
        let h = 1e-4 * z_r;
        let growth = (beam.radius_at(x * z_r + h) / beam.radius_at(x * z_r - h)).ln() / (2.0 * h);
        // (h / z_R)² / 6 times the third derivative of ln w, at most 3 / z_R³, is 5e−9 / z_R.
        let difference = (growth - beam.curvature_at(x * z_r)) * z_r;
        assert!(difference.abs() < 1e-8, "z = {x} z_R: {difference:e}");
    }
}

#[test]
fn gouy_phase_accumulates_the_transverse_momentum() {
    // ζ' = λ / (π w²): the spread of transverse wave numbers costs axial phase
    // (Feng and Winful 2001).
    let beam = beam();
    for x in [-5.0, -1.0, 0.1, 1.0, 4.0] {
        let z = x * beam.rayleigh_range();
        let rate = |z: f64| HENE / (PI * beam.radius_at(z).powi(2));
        // From the waist outwards, on panels half as wide as the rate.
        let outwards = |s: f64| rate(s.copysign(z));
        let phase = integrate(outwards, [0.0, z.abs()], 0.5 * beam.rayleigh_range()).copysign(z);
        assert_absolute(phase, beam.gouy_phase_at(z), 1e-10);
    }
    assert_absolute(beam.gouy_phase_at(1e12), PI / 2.0, 1e-12);
}

/// Distances from 1e−30 m to 1e30 m on both sides of the waist, and the waist.
fn distances() -> impl Iterator<Item = f64> {
    let one_side = (-30..=30).map(|exponent| 1.7 * 10_f64.powi(exponent));
    one_side.flat_map(|z| [-z, z]).chain([0.0])
}

/// Beams from the smallest waist to the largest, the last two far from diffraction-limited.
fn beams() -> Vec<GaussianBeam> {
    [
        (1e-30, 1e-30, 1.0),
        (HENE, 100e-6, 1.0),
        (1e-30, 1e30, 1.0),
        (1064e-9, 5e-3, 25.0),
        (1e-9, 1e20, 1e25),
    ]
    .map(|(wavelength, waist_radius, m_squared)| {
        let beam = GaussianBeam::from_waist(wavelength, waist_radius).unwrap();
        beam.with_m_squared(m_squared).unwrap()
    })
    .to_vec()
}

#[test]
fn radius_is_the_hyperbola_to_twelve_digits_at_every_distance() {
    for beam in beams() {
        let z_r = beam.rayleigh_range();
        for z in distances() {
            // Scaled by the larger leg, so that no square leaves the range.
            let (x, w0) = (z.abs() / z_r, beam.waist_radius());
            let expected = if x < 1.0 {
                w0 * (1.0 + x * x).sqrt()
            } else {
                w0 * x * (1.0 + 1.0 / (x * x)).sqrt()
            };
            // Ten roundings between the two.
            assert_relative(beam.radius_at(z), expected, 3e-15);
        }
    }
}

#[test]
fn curvature_is_one_over_z_plus_z_r_squared_over_z_to_twelve_digits() {
    for beam in beams() {
        let z_r = beam.rayleigh_range();
        for z in distances() {
            // R = z + z_R²/z is z_R (x + 1/x), which is the same at x and 1/x.
            let x = z / z_r;
            let expected = x / (1.0 + x * x) / z_r;
            // Ten roundings; below 1e−300 numbers have fewer digits.
            let tolerance = 3e-15 * expected.abs() + 1e-300;
            assert_absolute(beam.curvature_at(z), expected, tolerance);
        }
    }
}

#[test]
fn gouy_phase_is_the_argument_of_the_complex_beam_parameter_to_twelve_digits() {
    for beam in beams() {
        let z_r = beam.rayleigh_range();
        for z in distances() {
            // The argument of z_R + i z, which halves twice by half-angle formulas:
            // tan(ζ/2) = x / (1 + √(1 + x²)).
            let halved = |x: f64| x / (1.0 + 1.0_f64.hypot(x));
            let expected = 4.0 * halved(halved(z / z_r)).atan();
            // Ten roundings.
            assert_relative(beam.gouy_phase_at(z), expected, 3e-15);
            assert_relative(beam.gouy_phase_at(z), z.atan2(z_r), 1e-15);
        }
    }
}

#[test]
fn radius_and_curvature_survive_where_squares_of_the_distance_overflow() {
    let beam = GaussianBeam::from_waist(1e-30, 1e-30).unwrap();
    let radius = beam.radius_at(1e300);
    // δ = 1/π
    assert!((radius / 1e300 * PI - 1.0).abs() < 1e-15, "{radius}");
    let curvature = beam.curvature_at(1e300);
    assert!((curvature * 1e300 - 1.0).abs() < 1e-15, "{curvature}");
}

#[test]
fn depth_of_focus_is_where_the_radius_has_grown() {
    let beam = beam().with_m_squared(1.4).unwrap();
    for growth in [1.0 + 1e-9, 1.05, SQRT_2, 3.0, 1e200] {
        let depth = beam.depth_of_focus(growth).unwrap();
        for z in [-depth / 2.0, depth / 2.0] {
            assert_relative(beam.radius_at(z) / beam.waist_radius(), growth, 2e-15);
        }
    }
    // Near 1 the radius hides the depth, 2 z_R √(2 · 1e−9).
    let depth = beam.depth_of_focus(1.0 + 1e-9).unwrap() / beam.rayleigh_range();
    let expected = 2.0 * (2e-9_f64).sqrt();
    // 1 + 1e−9 itself is rounded by 1e−16, which is 1e−7 of its excess.
    assert!((depth / expected - 1.0).abs() < 1e-7, "{depth}");
    let confocal = beam.depth_of_focus(SQRT_2).unwrap() / beam.confocal_parameter();
    assert!((confocal - 1.0).abs() < 1e-15, "{confocal}");
}

#[test]
fn beam_parameter_product_is_waist_times_divergence() {
    for beam in beams() {
        let product = beam.waist_radius() * beam.divergence();
        assert_relative(beam.beam_parameter_product(), product, 1e-15);
    }
}

#[test]
fn widths_follow_from_the_radius() {
    let beam = beam();
    for z in [-0.1, 0.0, 0.4] {
        let w = beam.radius_at(z);
        assert_relative(beam.d4_sigma_at(z), 2.0 * w, 1e-14);
        assert_relative(beam.fwhm_at(z), 1.177_410_022_515_475 * w, 1e-14);
    }
}

#[test]
fn encircled_power_is_the_integral_of_the_irradiance() {
    let beam = beam();
    for z in [0.0, 0.2] {
        let w = beam.radius_at(z);
        for rho in [0.1, 0.5, 1.0, 2.0] {
            let ring = |r| beam.irradiance_per_watt(r, z) * 2.0 * PI * r;
            let power = integrate(ring, [0.0, rho * w], w);
            let closed = beam.encircled_power(rho * w, z);
            assert_absolute(power, closed, 1e-11);
        }
    }
    let within_w = beam.encircled_power(beam.radius_at(0.3), 0.3);
    // 1 − e⁻²
    assert_absolute(within_w, 0.864_664_716_763_387_3, 1e-14);
}

#[test]
fn flux_has_no_divergence() {
    let beam = beam();
    let (w0, z_r) = (beam.waist_radius(), beam.rayleigh_range());
    for z in [-2.0, -0.5, 0.3, 1.0, 5.0] {
        let w = beam.radius_at(z * z_r);
        let p = DVec3::new(0.6 * w, -0.4 * w, z * z_r);
        let (h, h_z) = (1e-4 * w0, 1e-4 * z_r);
        let slope = |axis: DVec3, h: f64| {
            let step = axis * h;
            let change = beam.flux_per_watt(p + step) - beam.flux_per_watt(p - step);
            change.dot(axis) / (2.0 * h)
        };
        let divergence = slope(DVec3::X, h) + slope(DVec3::Y, h) + slope(DVec3::Z, h_z);
        // The terms that cancel are of the size E/R; a central difference errs by h²/6 of the
        // third derivative, here at most 60 in units of w₀ and z_R: 1e−7 of E/z_R.
        let scale = beam.flux_per_watt(p).z / z_r;
        assert_absolute(divergence / scale, 0.0, 2e-7);
    }
}

#[test]
fn flux_is_zero_where_the_irradiance_vanishes() {
    // At the waist's side, x / R alone would overflow.
    let beam = GaussianBeam::from_waist(1e-29, 1e-29).unwrap();
    let far = DVec3::new(1e300, 0.0, beam.rayleigh_range());
    assert_eq!(beam.flux_per_watt(far), DVec3::ZERO, "{far}");
}

#[test]
fn paraxial_limit_follows_m_squared() {
    let tight = GaussianBeam::from_waist(HENE, 1.01 * 2.0 * HENE / PI).unwrap();
    assert!(tight.divergence() < 0.5, "{}", tight.divergence());
    let limit = 1.1 * 2.0 * HENE / PI;
    for (waist, possible) in [(0.999_999 * limit, false), (1.000_001 * limit, true)] {
        let beam = GaussianBeam::from_waist(HENE, waist).unwrap();
        assert_eq!(beam.with_m_squared(1.1).is_ok(), possible, "{waist}");
    }
}

proptest! {
    #[test]
    fn no_query_yields_nan(
        wavelength in -29.0..5.0_f64,
        ratio in 0.0..20.0_f64,
        x in proptest::num::f64::NORMAL,
        y in proptest::num::f64::NORMAL,
        z in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
    ) {
        let wavelength = 10_f64.powf(wavelength);
        let beam = GaussianBeam::from_waist(wavelength, wavelength * 10_f64.powf(ratio)).unwrap();
        let queries = [
            beam.radius_at(z),
            beam.curvature_at(z),
            beam.gouy_phase_at(z),
            beam.peak_irradiance_per_watt(z),
            beam.irradiance_per_watt(x, z),
            beam.encircled_power(x.abs(), z),
            beam.fwhm_at(z),
            beam.d4_sigma_at(z),
            beam.flux_per_watt(DVec3::new(x, y, z)).length(),
        ];
        prop_assert!(queries.iter().all(|q| !q.is_nan()), "{:?}: {:?}", beam, queries);
    }
}
