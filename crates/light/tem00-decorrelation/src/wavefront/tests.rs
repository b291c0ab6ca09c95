use proptest::prelude::*;

use super::*;

fn norm(m: DMat3) -> f64 {
    m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[test]
fn tensor_of_a_phase_is_that_of_its_wave() {
    // The path of a point source at 0.25 m, by central differences over h.
    let source = DVec3::new(0.09, -0.12, 0.2);
    let path = |x: DVec3| (x - source).length();
    let h = 1e-4;
    let second = |a: DVec3, b: DVec3| {
        let (a, b) = (a * h, b * h);
        (path(a + b) - path(a - b) - path(b - a) + path(-a - b)) / (4.0 * h * h)
    };
    let column = |a| {
        DVec3::new(
            second(DVec3::X, a),
            second(DVec3::Y, a),
            second(DVec3::Z, a),
        )
    };
    let tensor = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
    let measured = Wavefront::from_tensor(source, tensor).unwrap();
    let sphere = Wavefront::spherical(source, 4.0).unwrap();
    // (h/R)² R⁻¹ of truncation and ε R / h² of rounding.
    let difference = norm(measured.curvature() - sphere.curvature());
    assert!(difference < 1e-5, "difference {difference:e}");
}

#[test]
fn a_mirror_curves_the_wave_as_coddington_says() {
    // Collimated light on a concave mirror of the radius R at the angle θ: foci at R cos θ / 2 in
    // the plane of incidence and R / (2 cos θ) across it.
    let (radius, angle) = (0.4, 0.6_f64);
    let incident = DVec3::new(angle.sin(), 0.0, -angle.cos());
    let normal = DVec3::Z;
    let reflected = incident - normal * (2.0 * incident.dot(normal));
    let dp = [DVec3::new(3e-3, 1e-3, 0.0), DVec3::new(-1e-3, 2e-3, 0.0)];
    // The normals lead to the centre of the sphere.
    let dl = dp.map(|t| {
        let dn = -t / radius;
        2.0 * (normal * incident.dot(dn) + dn * incident.dot(normal))
    });
    let wave = Wavefront::from_differentials(-reflected, dp, dl).unwrap();
    let [along, across] = [2.0 / (radius * angle.cos()), 2.0 * angle.cos() / radius];
    let expected = Wavefront::astigmatic(-reflected, DVec3::X, -along, -across).unwrap();
    let difference = norm(wave.curvature() - expected.curvature());
    // Rounding of entries of 6/m.
    assert!(difference < 1e-14, "difference {difference:e}");
}

#[test]
fn a_focus_is_seen_from_no_direction() {
    let wave = Wavefront::astigmatic(DVec3::Z, DVec3::X, 4.0, -8.0).unwrap();
    // The apex of the fan is 0.25 m up, its line focus 0.125 m down.
    for focus in [DVec3::new(0.1, 0.0, 0.25), DVec3::new(0.0, 0.2, -0.125)] {
        assert_eq!(wave.direction_from(focus), None, "at {focus}");
    }
    // Past the line focus the light still comes from above, and has crossed over.
    let past = wave.direction_from(DVec3::new(0.0, 0.1, -0.25)).unwrap();
    let expected = DVec3::new(0.0, -0.8, 1.0).normalize();
    assert!((past - expected).length() < 1e-15, "{past}");
}

prop_compose! {
    fn directions()(x in -1.0_f64..1.0, y in -1.0_f64..1.0, z in 0.1_f64..1.0) -> DVec3 {
        DVec3::new(x, y, z)
    }
}

proptest! {
    #[test]
    fn a_point_source_stays_where_it_is(
        source in directions(),
        distance in 0.05_f64..5.0,
        offset in directions(),
        size in -0.9_f64..0.9,
    ) {
        let source = source.normalize() * distance;
        let offset = offset.normalize() * (size * distance);
        let wave = Wavefront::spherical(source, 1.0 / distance).unwrap();
        let direction = wave.direction_from(offset).unwrap();
        // A tenth of the distance is left at least, and amplifies rounding squared.
        prop_assert!((direction - (source - offset).normalize()).length() < 1e-13);
    }

    #[test]
    fn differentials_of_a_wave_are_those_of_its_tensor(
        direction in directions(),
        axis in directions(),
        tangents in [directions(), directions()],
        along in -20.0_f64..20.0,
        across in -20.0_f64..20.0,
    ) {
        let [direction, axis] = [direction.normalize(), axis.normalize()];
        let dp = tangents;
        let seen = direction.dot(dp[0].cross(dp[1])).abs();
        prop_assume!(direction.cross(axis).length() > 0.1 && seen > 0.05);
        let wave = Wavefront::astigmatic(direction, axis, along, across).unwrap();
        // The directions seen a step to either side.
        let h = 1e-5;
        let dl = dp.map(|t| {
            let [ahead, behind] = [h, -h].map(|h| wave.direction_from(t * h).unwrap());
            (ahead - behind) / (2.0 * h)
        });
        let measured = Wavefront::from_differentials(direction, dp, dl).unwrap();
        // (h K)² K of truncation and ε/h of rounding, over the area that is seen.
        let difference = norm(measured.curvature() - wave.curvature());
        prop_assert!(difference < 1e-4, "{}", difference);
    }

    #[test]
    fn waves_of_any_size_have_a_direction_or_none(
        direction in directions(),
        axis in directions(),
        offset in directions(),
        exponents in [-30.0_f64..30.0, -30.0..30.0, -30.0..30.0],
    ) {
        let [along, across, size] = exponents.map(|x| 10.0_f64.powf(x));
        if let Ok(wave) = Wavefront::astigmatic(direction, axis, along, -across)
            && let Some(seen) = wave.direction_from(offset * size)
        {
            prop_assert!((seen.length() - 1.0).abs() < 1e-14, "{}", seen);
        }
    }
}
