use super::*;

#[test]
fn bounds_hold_all_that_is_lit() {
    const EXTENT: f64 = 0.4;
    let [narrow, wide] = [0.9, 2.4].map(lasers);
    let lights = narrow.iter().map(|line| (place(line), 1.0));
    let lights = lights.chain(wide.iter().map(|line| (place(line), 4.0)));
    for (light, width) in lights.chain([(Box::new(spot()) as _, 4e-3)]) {
        let bounds = light.bounds(EXTENT);
        let (min, max) = (DVec3::from(bounds.min), DVec3::from(bounds.max));
        assert!(min.is_finite() && max.is_finite(), "{bounds:?}");
        let mut lit = 0;
        for i in 0..8_000 {
            let [x, y, z] = fractions(i);
            let p = world(DVec3::new(width * x, 8e-3 * y, EXTENT * (z + 0.5)));
            let Some(event) = light.next_event(p) else {
                continue;
            };
            lit += 1;
            let point = DVec3::from(p);
            assert!(point.cmpge(min).all() && point.cmple(max).all(), "{point}");
            let travel = -DVec3::from(event.wi);
            let angle = travel.angle_between(DVec3::from(bounds.axis));
            assert!(angle <= bounds.half_angle, "{point}, {angle}");
        }
        assert!(lit > 200, "the test must meet the light: {lit}");
    }
}

#[test]
fn bounds_are_those_of_the_corners_of_the_light() {
    const EXTENT: f64 = 0.4;
    let lights: [(&dyn Emitter, [f64; 2]); 2] = [
        (&spot(), spot().reach(EXTENT).half_width),
        (&powell(), powell().reach(EXTENT).half_width),
    ];
    for (light, [x, y]) in lights {
        let corners = (0..8).map(|corner| {
            let side = |bit: i32| if corner & bit == 0 { -1.0 } else { 1.0 };
            let z = 0.5 * EXTENT * (1.0 + side(4));
            DVec3::from(world(DVec3::new(side(1) * x, side(2) * y, z)))
        });
        let low = corners.clone().fold(DVec3::INFINITY, DVec3::min);
        let high = corners.fold(DVec3::NEG_INFINITY, DVec3::max);
        let bounds = light.bounds(EXTENT);
        assert!(low.abs_diff_eq(DVec3::from(bounds.min), 1e-14), "{low}");
        assert!(high.abs_diff_eq(DVec3::from(bounds.max), 1e-14), "{high}");
    }
}

/// The thickest point of a line is at an end of the fan at the farthest distance or at the lens.
#[test]
fn the_thickest_point_and_the_steepest_ray_lie_on_the_bounds() {
    for focus_curve in [FocusCurve::EqualDistance, FocusCurve::EqualPlane] {
        for extent in [0.1, 1.0] {
            let line = laser(LineProfile::UniformAngle, focus_curve, 0.9);
            let light = LineLight::place(&line, &PLACEMENT, POWER).unwrap();
            let edge = 0.45_f64;
            let corners = [(0.0, 0.0), (0.0, edge), (extent, edge)];
            // On the circle, the nearest point counts in every direction.
            let thickness = corners.map(|(z, theta)| line.half_thickness_at_angle(z, theta));
            let thickest = thickness.into_iter().fold(0.0, f64::max);
            let half_width = light.reach(extent).half_width;
            assert_relative(half_width[1], light.cutoff * thickest, 1e-12);
            assert_relative(half_width[0], edge.tan() * (extent + APEX_OFFSET), 1e-12);
        }
    }
    let line = powell();
    let z = 0.4 + line.apex_offset;
    let slope = 0.999_99 * line.profile().largest_slope(line.cutoff);
    let w = beam().radius_at(z * 1_f64.hypot(slope) - 0.152);
    let p = world(DVec3::new(slope * z, 0.999_99 * line.cutoff * w, 0.4));
    let bounds = line.bounds(0.4);
    let travel = -DVec3::from(line.next_event(p).unwrap().wi);
    let angle = travel.angle_between(DVec3::from(bounds.axis));
    // The flow has nearly its asymptotic slope, (z_R / 0.3 m)² / 2 = 8e−4 below it.
    let slack = 1.0 - angle / bounds.half_angle;
    assert!((0.0..1e-3).contains(&slack), "{slack:e}");
}

#[test]
fn a_cone_of_bounds_is_missed_by_few_rays() {
    for light in [&spot() as &dyn Emitter, &powell()] {
        let cone = light.bounds(1.0).half_angle.cos();
        for i in 0..4096_usize {
            // Up to 4.75 standard deviations, along x and y together 6.7 of the 8 within the cone.
            let variates = [1e-6, 0.01, 0.2, 0.4, 0.6, 0.8, 0.99, 1.0 - 1e-6];
            let digit = |shift: usize| variates[i >> shift & 7];
            let ray = light.sample_ray([digit(0), digit(3), digit(6), digit(9)]);
            assert!(ray.cos >= cone, "{ray:?}");
        }
    }
}
