use super::*;

const FAN: FanGeometry = FanGeometry {
    fan_angle: 0.5,
    apex_offset: 2e-3,
    focus_distance: 0.2,
    focus_curve: FocusCurve::EqualDistance,
};

fn focus() -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, 0.1e-3).unwrap()
}

fn lines() -> [LaserLine; 2] {
    [LineProfile::GaussianTan, LineProfile::Powell { edge: 0.05 }]
        .map(|profile| LaserLine::new(focus(), FAN, profile).unwrap())
}

#[test]
fn power_per_angle_integrates_to_one() {
    const INTERVALS: u32 = 20_000;
    for line in lines() {
        let h = PI / f64::from(INTERVALS);
        let total: f64 = (0..INTERVALS)
            .map(|i| line.power_per_angle(-FRAC_PI_2 + (f64::from(i) + 0.5) * h))
            .sum();
        assert!((total * h - 1.0).abs() < 1e-12, "{line:?}: {}", total * h);
        assert!(
            line.power_per_angle(PI) < f64::MIN_POSITIVE,
            "behind the lens"
        );
    }
}

#[test]
fn flux_is_the_power_per_angle_over_the_slant_distance() {
    let theta: f64 = 0.21;
    let r = 0.17;
    for line in lines() {
        let point = DVec3::new(r * theta.sin(), 0.0, r * theta.cos() - FAN.apex_offset);
        let w = focus().radius_at(r - 0.202);
        let expected = line.power_per_angle(theta) / r * (2.0 / PI).sqrt() / w;
        let flux = line.flux_per_watt(point);
        // x carries an error of 1e−16 of z, and the roll-off is steep: 20 per unit slope.
        assert!((flux.length() / expected - 1.0).abs() < 1e-13, "{flux}");
        assert!((flux.x / flux.z - theta.tan()).abs() < 1e-14, "{flux}");
    }
}

#[test]
fn flux_has_no_divergence() {
    for line in lines() {
        let z_r = focus().rayleigh_range();
        for p in [
            DVec3::new(0.01, 5e-5, 0.15),
            DVec3::new(-0.02, 8e-5, 0.3),
            DVec3::new(0.05, -1e-4, 0.2),
        ] {
            let slope = |axis: DVec3, h: f64| {
                let step = axis * h;
                let change = line.flux_per_watt(p + step) - line.flux_per_watt(p - step);
                change.dot(axis) / (2.0 * h)
            };
            let divergence = slope(DVec3::X, 1e-6) + slope(DVec3::Y, 1e-8) + slope(DVec3::Z, 1e-6);
            // The terms that cancel are of the size F / z_R. A central difference errs by
            // (h/l)² / 6 · F / l with the shortest lengths l: the roll-off of 1 mm along the
            // line, 0.1 mm across it; 1e−5 of F / z_R covers both.
            let scale = line.flux_per_watt(p).length() / z_r;
            let relative = divergence / scale;
            assert!(relative.abs() < 1e-5, "{p}: {relative:e}");
        }
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
    let [line, _] = lines();
    let half_slope = 0.25_f64.tan();
    assert!(
        (line.half_length_at(0.198) - 0.2 * half_slope).abs() < 1e-15,
        "{line:?}"
    );
    assert!(
        (line.half_thickness_at(0.2) - 0.1e-3).abs() < 1e-18,
        "{line:?}"
    );
    let waist = 650e-9 / (PI * half_slope);
    assert!(
        (line.source_radius() / waist - 1.0).abs() < 1e-14,
        "{line:?}"
    );
    let edge = DVec3::new(line.half_length_at(0.1), 0.0, 0.1);
    let centre = DVec3::new(0.0, 0.0, 0.1);
    // Between them the thickness differs, since the waist lies on a circle.
    let thickness = |p: DVec3| focus().radius_at(p.x.hypot(p.z + 2e-3) - 0.202);
    let ratio = line.irradiance_per_watt(edge) * thickness(edge)
        / (line.irradiance_per_watt(centre) * thickness(centre));
    assert!(
        (ratio - (-2.0_f64).exp()).abs() < 1e-14,
        "1/e² at the edge: {ratio}"
    );
}

#[test]
fn impossible_geometry_is_rejected() {
    let with = |fan| LaserLine::new(focus(), fan, LineProfile::GaussianTan);
    for fan_angle in [0.0, -0.1, PI, f64::NAN, f64::INFINITY] {
        let result = with(FanGeometry { fan_angle, ..FAN });
        assert!(matches!(result, Err(BeamError::FanAngle(_))), "{fan_angle}");
    }
    for apex_offset in [0.0, -1e-3, 80e-6, 1e31, f64::NAN] {
        let result = with(FanGeometry { apex_offset, ..FAN });
        assert!(
            matches!(result, Err(BeamError::ApexOffset { .. })),
            "{apex_offset}"
        );
    }
    for focus_distance in [f64::NAN, f64::INFINITY, -1e31] {
        let result = with(FanGeometry {
            focus_distance,
            ..FAN
        });
        assert!(
            matches!(result, Err(BeamError::FocusDistance(_))),
            "{focus_distance}"
        );
    }
    let result = LaserLine::new(focus(), FAN, LineProfile::Powell { edge: 0.0 });
    assert!(matches!(result, Err(BeamError::Edge(_))), "{result:?}");
}
