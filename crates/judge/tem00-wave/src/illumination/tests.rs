use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

const WAVELENGTH: f64 = 650e-9;
const K: f64 = TAU / WAVELENGTH;

fn beam(waist_radius: f64) -> Illumination {
    Illumination::gaussian_beam(&BeamDescription {
        wavelength: WAVELENGTH,
        waist: DVec3::ZERO,
        direction: DVec3::Z,
        waist_radius,
    })
    .expect("a beam")
}

/// A fan that opens along x, with its waist 0.2 m from the apex.
fn fan(waist_radius: f64) -> Illumination {
    Illumination::fan(&FanDescription {
        wavelength: WAVELENGTH,
        apex: DVec3::ZERO,
        direction: DVec3::Z,
        opening: DVec3::X,
        half_angle: 0.3,
        waist_radius,
        waist_distance: 0.2,
    })
    .expect("a fan")
}

fn all() -> [Illumination; 4] {
    [
        Illumination::plane(WAVELENGTH, DVec3::new(1.0, -2.0, 0.5)).expect("a plane wave"),
        Illumination::point(WAVELENGTH, DVec3::new(0.1, 0.2, -0.3)).expect("a point source"),
        beam(50e-6),
        fan(50e-6),
    ]
}

/// Phase of `to` relative to `from`, in radians.
fn phase_between(light: &Illumination, from: DVec3, to: DVec3) -> f64 {
    (light.amplitude_at(to) / light.amplitude_at(from)).arg()
}

/// Second derivative of the phase along `step`, in rad/m², from three points.
fn phase_curvature(light: &Illumination, at: DVec3, step: DVec3) -> f64 {
    (phase_between(light, at, at + step) - phase_between(light, at - step, at))
        / step.length_squared()
}

#[test]
fn the_beam_has_its_radius_and_its_curvature() {
    let beam = beam(100e-6);
    let rayleigh_range = PI * 100e-6 * 100e-6 / WAVELENGTH;
    for z in [-0.3, -0.05, 1e-6, 0.048, 0.5] {
        let radius = 100e-6 * 1.0_f64.hypot(z / rayleigh_range);
        let axis = DVec3::new(0.0, 0.0, z);
        let at_radius = axis + radius * DVec3::new(0.6, 0.8, 0.0);
        let fall = beam.amplitude_at(at_radius).norm() / beam.amplitude_at(axis).norm();
        // A dozen roundings.
        assert_relative(fall, (-1.0_f64).exp(), 1e-13);
        let curvature = z / (z * z + rayleigh_range * rayleigh_range);
        // The phase is quadratic: the only error is its rounding, 1e−10 rad of 2π z/λ over the
        // square of the step.
        let measured = phase_curvature(&beam, axis, DVec3::X * 50e-6) / K;
        assert_absolute(measured, curvature, 4.0 * 1e-9 / (K * 2.5e-9));
    }
}

#[test]
fn the_beam_solves_the_paraxial_wave_equation() {
    let beam = beam(100e-6);
    let envelope = |p: DVec3| beam.amplitude_at(p) * phasor(-p.z / WAVELENGTH);
    let (h, hz) = (0.3e-6, 20e-6);
    for p in [
        DVec3::new(0.0, 0.0, 0.03),
        DVec3::new(70e-6, -40e-6, -0.06),
        DVec3::new(30e-6, 90e-6, 0.0),
    ] {
        let second =
            |e: DVec3| (envelope(p + e * h) + envelope(p - e * h) - 2.0 * envelope(p)) / (h * h);
        let across = second(DVec3::X) + second(DVec3::Y);
        let along = (envelope(p + DVec3::Z * hz) - envelope(p - DVec3::Z * hz)) / (2.0 * hz);
        let residual = across + Complex::new(0.0, 2.0 * K) * along;
        // The terms are of order 4/w² = 4e8 m⁻². Differences lose a few (h/w)² = 1e−5 of them, and
        // (hz/z_R)²/6 = 3e−8; the rounding of the phase, 3e−11 rad, leaves 4 · 3e−11/h² = 1300 m⁻².
        assert!(
            residual.norm() < 3e-5 * 4.0 / 1e-8,
            "residual {residual} of {across} at {p}"
        );
    }
}

#[test]
fn the_fan_has_two_curvatures() {
    let fan = fan(50e-6);
    let rayleigh_range = PI * 50e-6 * 50e-6 / WAVELENGTH;
    for distance in [0.15, 0.2, 0.3] {
        let at = DVec3::new(0.0, 0.0, distance);
        // The cosine series of the slant distance leaves (step/ρ)²/4 = 4e−7; rounding as above.
        let around = phase_curvature(&fan, at, DVec3::X * 200e-6) / K;
        assert_relative(around, 1.0 / distance, 1e-5);
        let across = phase_curvature(&fan, at, DVec3::Y * 20e-6) / K;
        let zeta = distance - 0.2;
        let expected = zeta / (zeta * zeta + rayleigh_range * rayleigh_range);
        assert_absolute(across, expected, 1e-3);
    }
}

#[test]
fn the_fan_solves_the_paraxial_wave_equation_across_the_line() {
    let fan = fan(50e-6);
    let envelope = |y: f64, z: f64| {
        let amplitude = fan.amplitude_at(DVec3::new(0.0, y, z));
        amplitude * phasor(-z / WAVELENGTH) * z.sqrt()
    };
    let (h, hz) = (0.5e-6, 5e-6);
    for (y, z) in [(0.0, 0.2), (30e-6, 0.21), (-60e-6, 0.18)] {
        let across = (envelope(y + h, z) + envelope(y - h, z) - 2.0 * envelope(y, z)) / (h * h);
        let along = (envelope(y, z + hz) - envelope(y, z - hz)) / (2.0 * hz);
        let residual = across + Complex::new(0.0, 2.0 * K) * along;
        // The terms are of order 2/w² = 8e8 m⁻². Differences lose a few (h/w)² = 1e−4 of them; the
        // rounding of the phase, 3e−10 rad, leaves 4 · 3e−10/h² = 5000 m⁻².
        assert!(
            residual.norm() < 3e-4 * 8e8,
            "residual {residual} of {across} at {y:e}, {z}"
        );
    }
}

#[test]
fn every_slice_of_the_fan_carries_the_same_power() {
    let fan = fan(50e-6);
    // ρ ∫ |U|² dy in the direction θ, by the trapezoidal rule over ± 8 radii.
    let power = |slant: f64, theta: f64| {
        let (x, z) = (slant * theta.sin(), slant * theta.cos());
        let zeta = slant - 0.2;
        let radius = 50e-6 * 1.0_f64.hypot(zeta * WAVELENGTH / (PI * 50e-6 * 50e-6));
        let step = radius / 20.0;
        let density = |i: i32| {
            fan.amplitude_at(DVec3::new(x, f64::from(i) * step, z))
                .norm_sqr()
        };
        (-160..=160).map(density).sum::<f64>() * step * slant
    };
    // ∫ exp(−2y²/w₀²) dy = w₀ √(π/2), in the waist 0.2 m away and everywhere.
    let in_waist = 50e-6 * (0.5 * PI).sqrt();
    for slant in [0.05, 0.2, 0.7] {
        // The trapezoidal rule is exact for a Gaussian; the rest is rounding.
        assert_relative(power(slant, 0.0), in_waist, 1e-12);
        // At the edge of the fan irradiance has fallen to 1/e².
        let edge = in_waist * (-2.0_f64).exp();
        assert_relative(power(slant, 0.3), edge, 1e-12);
    }
}

#[test]
fn there_is_no_light_behind_the_apex() {
    for z in [0.0, -1e-9, -1.0] {
        let amplitude = fan(50e-6).amplitude_at(DVec3::new(0.0, 0.0, z));
        assert_eq!(amplitude, Complex::new(0.0, 0.0));
    }
}

#[test]
fn a_point_source_spreads_over_spheres() {
    let source = DVec3::new(0.1, 0.2, -0.3);
    let light = Illumination::point(WAVELENGTH, source).expect("a point source");
    let whole = 1e6 * WAVELENGTH;
    let amplitude = light.amplitude_at(source + DVec3::new(0.6, 0.0, 0.8) * whole);
    // A million turns, rounded to 1e−10.
    assert!((amplitude * whole - 1.0).norm() < 2e-9, "{amplitude}");
}

#[test]
fn light_that_moves_with_the_observer_looks_the_same() {
    let motion = RigidMotion::rotation(DVec3::new(1.0, 0.4, -2.0), 2.1, DVec3::new(0.3, 0.1, 0.0))
        .expect("a rotation")
        .then(&RigidMotion::translation(DVec3::new(-0.2, 0.5, 0.1)).expect("a translation"));
    for light in all() {
        let moved = light.moved(&motion);
        let point = DVec3::new(10e-6, -20e-6, 0.21);
        let origin = DVec3::new(5e-6, 0.0, 0.2);
        let before = light.amplitude_at(point) / light.amplitude_at(origin);
        let after =
            moved.amplitude_at(motion.point(point)) / moved.amplitude_at(motion.point(origin));
        // Positions of 1 m are rounded to 2e−16 m, several times: 1e−8 rad at most.
        assert!((before - after).norm() < 1e-8 * before.norm(), "{light:?}");
    }
}

#[test]
fn light_travels_in_its_direction() {
    for (light, at) in [
        (all()[0], DVec3::ZERO),
        (all()[2], DVec3::new(0.0, 0.0, 0.01)),
        (all()[3], DVec3::new(0.0, 0.0, 0.2)),
    ] {
        let direction = light.axes.z_axis;
        let step = 0.1 * WAVELENGTH;
        let turned = phase_between(&light, at, at + direction * step);
        // A tenth of a turn, minus a Gouy phase of step/z_R ≤ 6e−6.
        assert!((turned - 0.1 * TAU).abs() < 1e-5, "{turned} in {light:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn light_is_finite_at_every_finite_point(
        x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64, exponent in -320..300_i32
    ) {
        let point = DVec3::new(x, y, z) * 10.0_f64.powi(exponent);
        for light in all() {
            let amplitude = light.amplitude_at(point);
            prop_assert!(amplitude.is_finite(), "{} at {} in {:?}", amplitude, point, light);
        }
    }
}
