use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::AngularProfile;

const FAN: FanGeometry = FanGeometry {
    fan_angle: 0.5,
    apex_offset: 2e-3,
    focus_distance: 0.2,
    focus_curve: FocusCurve::EqualDistance,
};

fn focus() -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, 0.1e-3).unwrap()
}

/// Every profile, with each of the two curves of focus.
fn lines() -> Vec<LaserLine> {
    let table = [(-0.3, 0.5), (-0.1, 1.0), (0.12, 0.7), (0.29, 0.0)];
    let profiles = [
        LineProfile::GaussianTan,
        LineProfile::GaussianAngle,
        LineProfile::GaussianSin,
        LineProfile::UniformTan,
        LineProfile::UniformAngle,
        LineProfile::Powell { edge: 0.05 },
        LineProfile::Tabulated(AngularProfile::from_pairs(&table).unwrap()),
    ];
    let on = |profile: &LineProfile, focus_curve| {
        let fan = FanGeometry { focus_curve, ..FAN };
        LaserLine::new(focus(), fan, profile.clone()).unwrap()
    };
    let curves = [FocusCurve::EqualDistance, FocusCurve::EqualPlane];
    let lines = curves.map(|curve| profiles.each_ref().map(|profile| on(profile, curve)));
    lines.into_iter().flatten().collect()
}

fn gaussian() -> LaserLine {
    LaserLine::new(focus(), FAN, LineProfile::GaussianTan).unwrap()
}

/// ∫ f by the midpoint rule.
fn integrate(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    const INTERVALS: u32 = 20_000;
    let h = (b - a) / f64::from(INTERVALS);
    let nodes = (0..INTERVALS).map(|i| a + (f64::from(i) + 0.5) * h);
    nodes.map(f).sum::<f64>() * h
}

#[test]
fn power_between_angles_is_the_integral_of_the_power_per_angle() {
    for line in lines() {
        for (a, b) in [
            (-0.5, 0.5),
            (-0.28, -0.26),
            (0.1, 0.24),
            (0.25, 0.28),
            (-0.05, 0.27),
        ] {
            let expected = integrate(|theta| line.power_per_angle(theta), a, b);
            let power = line.power_between_angles(a, b);
            // A top hat may end anywhere in one interval: f h, with h < 1e-4/2, f < 2.1.
            let tolerance = match line.profile() {
                LineProfile::UniformTan | LineProfile::UniformAngle => 1.1e-4 * (b - a),
                _ => 1e-8,
            };
            assert_absolute(power, expected, tolerance);
            let reversed = line.power_between_angles(b, a);
            assert_eq!(power.to_bits(), reversed.to_bits(), "either order");
        }
        assert_absolute(line.power_between_angles(-2.0, 2.0), 1.0, 1e-15);
        let behind = line.power_per_angle(PI);
        assert!(behind < f64::MIN_POSITIVE, "behind the lens");
    }
}

#[test]
fn power_far_out_keeps_its_digits() {
    // ∫ over u > 6 σ, where 1 minus the distribution function has no digit left: Φ(−6), by the
    // continued fraction φ(x) / (x + 1/(x + 2/(x + …))).
    let x = 6.0;
    let fraction = (1..60).rev().fold(x, |tail, k| x + f64::from(k) / tail);
    let expected = (-0.5 * x * x).exp() / (2.0 * PI).sqrt() / fraction;
    let line = gaussian();
    let edge = (3.0 * line.half_slope()).atan();
    for (a, b) in [(edge, 1.5), (-1.5, -edge)] {
        assert_relative(line.power_between_angles(a, b), expected, 1e-13);
    }
}

#[test]
fn power_on_a_length_is_the_irradiance_on_the_strip() {
    for line in lines() {
        let z = 0.15;
        for (x_min, x_max) in [(-0.03, 0.01), (0.02, 0.033)] {
            let along = |x: f64| {
                let slope = x / (z + FAN.apex_offset);
                let w = line.half_thickness_at_angle(z, slope.atan());
                // The trapezoidal rule is exact for a Gaussian: spacing σ/2, up to 9 σ.
                let across = |i: i32| 0.25 * w * f64::from(i);
                let nodes =
                    (-36..=36).map(|i| line.irradiance_per_watt(DVec3::new(x, across(i), z)));
                nodes.sum::<f64>() * 0.25 * w
            };
            let h = (x_max - x_min) / 1000.0;
            let expected = (0..1000).map(|i| along(x_min + (f64::from(i) + 0.5) * h));
            let expected = expected.sum::<f64>() * h;
            let power = line.power_on_length(x_min, x_max, z);
            // Midpoint rule: (0.01 m / 1000)² g'' / 24 of the roll-off, of 2 mm.
            assert_absolute(power, expected, 2e-6);
        }
        assert!(
            line.power_on_length(-1.0, 1.0, -1e-9) <= 0.0,
            "behind the lens"
        );
    }
}

#[test]
fn the_line_is_thinnest_where_its_focus_curve_says() {
    let w0 = focus().waist_radius();
    for line in lines() {
        for theta in [-0.25, 0.0, 0.1, 0.25_f64] {
            let circle = 0.202 * theta.cos() - FAN.apex_offset;
            let z = match line.fan().focus_curve {
                FocusCurve::EqualDistance => circle,
                FocusCurve::EqualPlane => 0.2,
            };
            let thickness = line.half_thickness_at_angle(z, theta);
            assert_relative(thickness, w0, 1e-12);
            // The flow is parallel to the fan plane there, and has the waist's profile across.
            let x = (z + FAN.apex_offset) * theta.tan();
            let [centre, edge] = [0.0, w0].map(|y| line.flux_per_watt(DVec3::new(x, y, z)));
            assert_absolute(edge.z / centre.z, (-2.0_f64).exp(), 1e-12);
            assert!((edge.y / edge.z).abs() < 1e-12, "{line:?}: {edge}");
            for off in [-1e-3, 1e-3] {
                assert!(
                    line.half_thickness_at_angle(z + off, theta) > thickness,
                    "{line:?}"
                );
            }
        }
        let on_axis = line.half_thickness_at_angle(0.3, 0.0) / line.half_thickness_at(0.3);
        assert!((on_axis - 1.0).abs() < 1e-15, "{line:?}");
    }
}

#[test]
fn flux_is_the_power_per_angle_over_the_slant_distance() {
    let theta: f64 = 0.21;
    let r = 0.17;
    for line in lines() {
        let point = DVec3::new(r * theta.sin(), 0.0, r * theta.cos() - FAN.apex_offset);
        let w = focus().radius_at(r - line.waist_slant_distance_at(theta.tan()));
        let expected = line.power_per_angle(theta) / r * (2.0 / PI).sqrt() / w;
        let flux = line.flux_per_watt(point);
        // x carries an error of 1e−16 of z, and the roll-off is steep: 20 per unit slope.
        assert!((flux.length() / expected - 1.0).abs() < 1e-13, "{flux}");
        assert!((flux.x / flux.z - theta.tan()).abs() < 1e-14, "{flux}");
    }
}

#[test]
fn the_lens_and_its_back_are_no_singularity() {
    for line in lines() {
        let lens = line.flux_per_watt(DVec3::ZERO);
        assert!(lens.z > 0.0 && lens.is_finite(), "{lens}");
        let behind = line.flux_per_watt(DVec3::new(0.0, 0.0, -1e-9));
        assert_eq!(behind, DVec3::ZERO, "behind the lens");
    }
}

#[test]
fn dimensions_follow_the_geometry() {
    let line = gaussian();
    let half_slope = 0.25_f64.tan();
    assert_absolute(line.half_length_at(0.198), 0.2 * half_slope, 1e-15);
    assert_absolute(line.half_thickness_at(0.2), 0.1e-3, 1e-18);
    let waist = 650e-9 / (PI * half_slope);
    assert_relative(line.source_radius(), waist, 1e-14);
    let edge = DVec3::new(line.half_length_at(0.1), 0.0, 0.1);
    let centre = DVec3::new(0.0, 0.0, 0.1);
    // Between them the thickness differs, since the waist lies on a circle.
    let thickness = |p: DVec3| focus().radius_at(p.x.hypot(p.z + 2e-3) - 0.202);
    let ratio = line.irradiance_per_watt(edge) * thickness(edge)
        / (line.irradiance_per_watt(centre) * thickness(centre));
    assert_absolute(ratio, (-2.0_f64).exp(), 1e-14);
}
