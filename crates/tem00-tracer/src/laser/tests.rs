use tem00_beam::{AngularProfile, FocusCurve};

use super::*;

/// A line of 60° in focus at 0.3 m, from the origin along z.
fn line(profile: LineProfile, focus_curve: FocusCurve) -> Laser {
    let shape = BeamShape::Line {
        waist_radius: 0.1e-3,
        m_squared: 1.0,
        fan: FanGeometry {
            fan_angle: 60_f64.to_radians(),
            apex_offset: 2e-3,
            focus_distance: 0.3,
            focus_curve,
        },
        profile,
    };
    Laser::new(LaserDescription {
        wavelength: 650e-9,
        power: 5e-3,
        position: DVec3::ZERO,
        look_at: DVec3::Z,
        line_direction: DVec3::X,
        shape,
    })
    .unwrap()
}

#[test]
fn the_wavefront_across_a_line_is_flat_where_its_focus_curve_says() {
    let slope = 0.4_f64;
    let on_plane = DVec3::new(0.302 * slope, 0.0, 0.3);
    let cos = slope.atan().cos();
    let on_circle = DVec3::new(0.302 * slope * cos, 0.0, 0.302 * cos - 2e-3);
    let cases = [
        (FocusCurve::EqualPlane, on_plane, on_circle),
        (FocusCurve::EqualDistance, on_circle, on_plane),
    ];
    for (focus_curve, flat, curved) in cases {
        let laser = line(LineProfile::GaussianTan, focus_curve);
        let across = [flat, curved].map(|point| {
            let direction = laser.illuminate(point).unwrap().direction;
            let curvature = laser.wavefront_at(point, direction).unwrap().curvature();
            DVec3::Y.dot(curvature * DVec3::Y)
        });
        assert!(across[0].abs() < 1e-9, "{focus_curve:?}: {across:?}");
        assert!(across[1].abs() > 1.0, "{focus_curve:?}: {across:?}");
    }
}

#[test]
fn a_tabulated_line_lights_what_its_table_says() {
    let table = AngularProfile::from_pairs(&[(-0.2, 1.0), (0.0, 2.0), (0.4, 0.0)]).unwrap();
    let laser = line(LineProfile::Tabulated(table), FocusCurve::EqualPlane);
    let at = |theta: f64| {
        let point = DVec3::new(0.302 * theta.tan(), 0.0, 0.3);
        let light = laser.illuminate(point);
        light.map_or(0.0, |light| light.irradiance)
    };
    // E = P f(θ) / r · √(2/π) / w₀ on the plane of focus, and ∫ f = 0.3 + 0.4.
    for (theta, f) in [(0.0, 2.0), (-0.1, 1.5), (0.2, 1.0)] {
        let r = 0.302 / f64::cos(theta);
        let expected = 5e-3 * (f / 0.7) / r * core::f64::consts::FRAC_2_PI.sqrt() / 0.1e-3;
        let error = at(theta) / expected - 1.0;
        assert!(error.abs() < 1e-12, "{theta}: {error:e}");
    }
    assert!(at(-0.21) <= 0.0 && at(0.41) <= 0.0, "outside the table");
}
