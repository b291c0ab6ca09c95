use core::f64::consts::PI;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

/// Full fan angles: the usual one, and one where the tails are cut off at right angles.
const FAN_ANGLES: [f64; 2] = [0.5, 2.5];

fn profiles() -> [LineProfile; 8] {
    [
        LineProfile::GaussianTan,
        LineProfile::GaussianAngle,
        LineProfile::GaussianSin,
        LineProfile::UniformTan,
        LineProfile::UniformAngle,
        LineProfile::Powell { edge: 1e-3 },
        LineProfile::Powell { edge: 0.1 },
        LineProfile::Powell { edge: 1.0 },
    ]
}

fn densities() -> Vec<SlopeDensity> {
    let all = FAN_ANGLES.map(|angle| profiles().map(|p| p.slope_density(angle).unwrap()));
    all.concat()
}

/// ∫ f dθ over the slopes [a, b] by the midpoint rule, in a coordinate t that resolves both the top
/// and the edges of the density: its variable for a Gaussian or uniform profile, tan θ for a Powell
/// profile.
fn integrate(density: SlopeDensity, a: f64, b: f64) -> f64 {
    const INTERVALS: u32 = 20_000;
    let at = |t: f64| match density.variable {
        // dθ = dt / (1 + t²) and f (1 + t²)⁻¹ = g
        v if v < 0.5 => density.per_slope(t),
        v if v < 1.5 => density.per_angle(t.tan()),
        // dθ = dt / cos θ
        _ => density.per_angle(t.asin().tan()) / (1.0 - t * t).sqrt(),
    };
    let coordinate = |u: f64| match density.variable {
        v if v < 0.5 => u,
        v if v < 1.5 => u.atan(),
        _ => u.atan().sin(),
    };
    let (a, b) = (coordinate(a), coordinate(b));
    let h = (b - a) / f64::from(INTERVALS);
    (0..INTERVALS)
        .map(|i| at(a + (f64::from(i) + 0.5) * h))
        .sum::<f64>()
        * h
}

/// The slope beyond which less than 1e−30 of the power lies, or the largest slope.
fn end(density: SlopeDensity) -> f64 {
    density.largest_slope(6.0)
}

#[test]
fn densities_integrate_to_one() {
    for density in densities() {
        let end = end(density);
        let total = integrate(density, -end, end);
        // A density cut off at π/2 with 4 σ outside has the error h² f'/12 = 1e−8 of the rule.
        let tolerance = if density.mass < 1.0 { 3e-9 } else { 1e-12 };
        assert!((total - 1.0).abs() < tolerance, "{density:?}: {total}");
    }
}

#[test]
fn printed_forms_are_special_cases() {
    const FAN_ANGLE: f64 = 2.5;
    let t = (0.5 * FAN_ANGLE).tan();
    let sin = (0.5 * FAN_ANGLE).sin();
    let width = SQRT_2 * 0.1 * t;
    let densities = profiles().map(|profile| profile.slope_density(FAN_ANGLE).unwrap());
    let [tan, angle, sine, flat_tan, flat_angle, _, powell, _] = densities;
    for theta in [-1.3_f64, -1.2, 0.0, 0.4, 1.24, 1.4] {
        let (u, s) = (theta.tan(), theta.sin());
        let sec_sq = 1.0 + u * u;
        let inside = theta.abs() < 0.5 * FAN_ANGLE;
        let cases = [
            (
                tan,
                (2.0 / PI).sqrt() / t * (-2.0 * u * u / (t * t)).exp() * sec_sq,
            ),
            (
                angle,
                (8.0 / PI).sqrt() / FAN_ANGLE * (-8.0 * (theta / FAN_ANGLE).powi(2)).exp()
                    / libm::erf(SQRT_2 * PI / FAN_ANGLE),
            ),
            (
                sine,
                (2.0 / PI).sqrt() / sin * (-2.0 * s * s / (sin * sin)).exp() * theta.cos()
                    / libm::erf(SQRT_2 / sin),
            ),
            (flat_tan, if inside { 0.5 / t * sec_sq } else { 0.0 }),
            (flat_angle, if inside { 1.0 / FAN_ANGLE } else { 0.0 }),
            (
                powell,
                (libm::erf((u + t) / width) - libm::erf((u - t) / width)) / (4.0 * t) * sec_sq,
            ),
        ];
        for (density, expected) in cases {
            let error = density.per_angle(u) - expected;
            assert!(error.abs() < 1e-14, "θ = {theta}, {density:?}: {error:e}");
            // g du = f dθ
            assert_absolute(density.per_slope(u) * sec_sq, expected, 1e-14);
        }
    }
}

#[test]
fn samples_invert_the_cumulative_density() {
    for density in densities() {
        // Where the density ends abruptly, its tails have the digits of the slope only.
        let soft = density.sigma > 0.0 && density.mass >= 1.0;
        let tails: &[f64] = if soft { &[1e-15, 1e-9] } else { &[1e-8] };
        for &u in tails.iter().chain(&[1e-4, 0.01, 0.2, 0.5, 0.8, 0.999]) {
            let x = density.quantile(u);
            let mass = integrate(density, -end(density), -x.abs());
            let tail = u.min(1.0 - u);
            // Midpoint rule with 20000 points: h² g'' / 24 < 1e−6 of the mass at edge 1e−3.
            assert_relative(mass, tail, 2e-6);
            assert!(
                (x < 0.0) == (u < 0.5) || x.abs() < 1e-15,
                "{density:?}, u = {u}: {x}"
            );
        }
    }
}

#[test]
fn the_power_between_slopes_is_the_integral_of_the_density() {
    for density in densities() {
        for (p, q) in [(0.01, 0.2), (0.1, 0.7), (0.6, 0.98)] {
            let [a, b] = [p, q].map(|p| density.quantile(p));
            let power = density.between(a, b);
            assert!((power - (q - p)).abs() < 1e-12, "{density:?}: {power}");
            let integral = integrate(density, a, b);
            assert!((power - integral).abs() < 1e-8, "{density:?}: {integral}");
        }
        let total = density.between(f64::NEG_INFINITY, f64::INFINITY);
        assert_absolute(total, 1.0, 1e-15);
    }
}

#[test]
fn samples_grow_with_the_uniform_variate() {
    for density in densities() {
        let samples = (0..1000).map(|i| density.quantile(f64::from(i) / 1000.0));
        assert!(samples.clone().all(f64::is_finite), "{density:?}");
        assert!(samples.is_sorted(), "{density:?}");
    }
}

#[test]
fn the_cutoff_is_at_its_largest_slope() {
    for density in densities() {
        for cutoff in [0.5, 1.0, 4.0] {
            let end = density.largest_slope(cutoff);
            assert!(end.is_finite(), "{density:?}");
            assert!(
                density.reaches(0.999_999 * end, cutoff),
                "{density:?}: {end}"
            );
            // A cut-off beyond π/2 cuts nothing.
            let open = !density.reaches(1e100, cutoff);
            assert!(
                density.reaches(1.000_001 * end, cutoff) != open,
                "{density:?}: {end}"
            );
        }
    }
}

#[test]
fn slopes_next_to_infinity_carry_no_light() {
    for density in densities() {
        for u in [1e16, 1e30, 1e200, f64::MAX] {
            let g = density.per_slope(u);
            // f(π/2) is 0.06 at most, so g < 0.06 / u².
            assert!((0.0..1e-32).contains(&g), "{density:?}, u = {u:e}: {g:e}");
        }
    }
}
