use glam::DVec3;
use proptest::prelude::*;

use super::super::{Emitter, Placement, TabulatedLineLight};
use super::*;
use crate::{AngularProfile, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile};

const POWER: f64 = 5e-3;
const APEX_OFFSET: f64 = 2e-3;
const TABLE: [(f64, f64); 4] = [(-0.6, 0.5), (-0.1, 1.0), (0.2, 0.7), (0.5, 0.4)];

fn placement() -> Placement {
    Placement {
        origin: DVec3::new(0.1, -0.2, 0.3),
        direction: DVec3::new(0.3, -0.5, 0.8),
        fan_axis: DVec3::new(1.0, 0.2, 0.1),
    }
}

fn beam() -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, 50e-6).unwrap()
}

fn table() -> LineProfile {
    LineProfile::Tabulated(AngularProfile::from_pairs(&TABLE).unwrap())
}

fn smooth_profiles() -> [LineProfile; 6] {
    [
        LineProfile::GaussianTan,
        LineProfile::GaussianAngle,
        LineProfile::GaussianSin,
        LineProfile::UniformTan,
        LineProfile::UniformAngle,
        LineProfile::Powell { edge: 0.1 },
    ]
}

fn laser(profile: LineProfile, focus_curve: FocusCurve, fan_angle: f64) -> LaserLine {
    let fan = FanGeometry {
        fan_angle,
        apex_offset: APEX_OFFSET,
        focus_distance: 0.15,
        focus_curve,
    };
    LaserLine::new(beam(), fan, profile).unwrap()
}

/// Every profile on each of the two curves of focus.
fn lasers(fan_angle: f64) -> Vec<LaserLine> {
    let curves = [FocusCurve::EqualDistance, FocusCurve::EqualPlane];
    let profiles = || smooth_profiles().into_iter().chain([table()]);
    let on = |curve| profiles().map(move |profile| laser(profile, curve, fan_angle));
    curves.into_iter().flat_map(on).collect()
}

fn place(line: &LaserLine) -> Box<dyn Emitter + '_> {
    match LineLight::place(line, &placement(), POWER) {
        Ok(light) => Box::new(light),
        Err(_) => Box::new(TabulatedLineLight::place(line, &placement(), POWER).unwrap()),
    }
}

/// World coordinates of a vector in the frame of the lights.
fn rotated(local: DVec3) -> DVec3 {
    let frame = placement().frame().unwrap();
    DVec3::from(frame.world_from_local_vector(local.to_array()))
}

fn world(local: DVec3) -> [f64; 3] {
    (placement().origin + rotated(local)).to_array()
}

#[test]
fn a_placed_line_is_the_laser_in_another_frame() {
    for line in lasers(0.9) {
        let light = place(&line);
        for (x, y, z) in [(0.0, 0.0, 0.01), (0.03, 5e-5, 0.15), (-0.15, -1e-3, 0.4)] {
            let local = DVec3::new(x, y, z);
            let expected = rotated(POWER * line.flux_per_watt(local));
            let flux = DVec3::from(light.flux(world(local)));
            // 1e−16 m of rounding beside a thickness of 5e−5 m.
            let miss = flux.distance(expected);
            assert!(
                miss <= 1e-10 * expected.length(),
                "{line:?}, {local}: {flux}"
            );
            assert!(flux.length() > 0.0, "{line:?}: {local} is lit");
        }
    }
}

#[test]
fn a_line_without_its_table_is_dark() {
    let line = laser(table(), FocusCurve::EqualPlane, 0.9);
    let light = TabulatedLineLight::place(&line, &placement(), POWER).unwrap();
    let p = world(DVec3::new(0.0, 0.0, 0.15));
    assert!(light.next_event(p).is_some(), "with the table");
    assert!(light.line.next_event(p).is_none(), "without the table");
    let knots = &light.knots[..1];
    let dark = TabulatedLineLight { knots, ..light };
    assert!(dark.next_event(p).is_none(), "with one knot");
}

#[test]
fn the_cutoff_of_a_profile_is_in_its_own_variable() {
    const CUTOFF: f64 = 0.75;
    let fan_angle = 0.9_f64;
    // The end of the light is at v = 1.5 σ, 0.75 of the edge, or at the edge of a top hat.
    let edge = 0.5 * fan_angle;
    let expected = [
        0.75 * edge.tan(),
        (0.75 * edge).tan(),
        (0.75 * edge.sin()).asin().tan(),
        edge.tan(),
        edge.tan(),
        edge.tan() * (1.0 + 2.0 * 0.75 * 0.1),
    ];
    for (profile, end) in smooth_profiles().into_iter().zip(expected) {
        let line = laser(profile, FocusCurve::EqualPlane, fan_angle);
        let mut light = LineLight::place(&line, &placement(), POWER).unwrap();
        light.cutoff = CUTOFF;
        let lit = [0.999_999, 1.000_001].map(|part| {
            let p = DVec3::new(part * end * (0.2 + APEX_OFFSET), 0.0, 0.2);
            light.next_event(world(p)).is_some()
        });
        assert_eq!(lit, [true, false], "{line:?}");
    }
}

#[test]
fn bounds_hold_all_that_is_lit() {
    const EXTENT: f64 = 0.4;
    for (fan_angle, width) in [(0.9, 1.0), (2.4, 4.0)] {
        for line in lasers(fan_angle) {
            let light = place(&line);
            let bounds = light.bounds(EXTENT);
            let (min, max) = (DVec3::from(bounds.min), DVec3::from(bounds.max));
            assert!(min.is_finite() && max.is_finite(), "{line:?}: {bounds:?}");
            let mut lit = 0;
            for i in 0..8_000 {
                // A lattice without a common period.
                let fraction = |step: f64| (f64::from(i) * step).fract() - 0.5;
                let local = DVec3::new(
                    width * fraction(0.618_033_988_7),
                    8e-3 * fraction(0.414_213_562_4),
                    EXTENT * (fraction(0.732_050_807_6) + 0.5),
                );
                let p = world(local);
                let Some(event) = light.next_event(p) else {
                    continue;
                };
                lit += 1;
                let point = DVec3::from(p);
                assert!(
                    point.cmpge(min).all() && point.cmple(max).all(),
                    "{line:?}: {local}"
                );
                let travel = -DVec3::from(event.wi);
                let angle = travel.angle_between(DVec3::from(bounds.axis));
                assert!(angle <= bounds.half_angle, "{line:?}: {local}, {angle}");
            }
            assert!(lit > 200, "the test must meet the light: {lit}");
        }
    }
}

/// The direction density of the rays that `light` draws with the outermost variates.
fn outermost(light: &impl Emitter) -> [f64; 2] {
    [0.0, 1.0 - 2.0 * HALF_SPACING].map(|u| light.sample_ray([0.5, 0.5, u, 0.5]).pdf.direction)
}

#[test]
fn rounding_carries_no_drawn_ray_over_the_ends_of_a_profile() {
    for i in 0..100 {
        let end = 0.1 + 0.01 * f64::from(i);
        // The ends hold so much power that the outermost variates come within a rounding of them.
        let table = [
            (-end, 1.0),
            (0.02 - end, 0.0),
            (end - 0.02, 0.0),
            (end, 1.0),
        ];
        let profile = AngularProfile::from_pairs(&table).unwrap();
        let line = laser(LineProfile::Tabulated(profile), FocusCurve::EqualPlane, 0.9);
        let light = TabulatedLineLight::place(&line, &placement(), POWER).unwrap();
        for pdf in outermost(&light) {
            assert!(pdf > 0.0, "the table ends at {end}");
        }
        for profile in [LineProfile::UniformTan, LineProfile::UniformAngle] {
            let line = laser(profile, FocusCurve::EqualPlane, 2.0 * end);
            let light = LineLight::place(&line, &placement(), POWER).unwrap();
            for pdf in outermost(&light) {
                assert!(pdf > 0.0, "the top hat ends at {end}");
            }
        }
    }
}

/// The thickest point of a line is at an end of the fan at the farthest distance or at the lens.
#[test]
fn the_thickest_point_lies_on_the_bounds() {
    for focus_curve in [FocusCurve::EqualDistance, FocusCurve::EqualPlane] {
        for extent in [0.1, 1.0] {
            let line = laser(LineProfile::UniformAngle, focus_curve, 0.9);
            let light = LineLight::place(&line, &placement(), POWER).unwrap();
            let edge = 0.45_f64;
            let corners = [(0.0, 0.0), (0.0, edge), (extent, edge)];
            let thickest = corners
                .map(|(z, theta)| {
                    // On the circle, the nearest point counts in every direction.
                    line.half_thickness_at_angle(z, theta)
                })
                .into_iter()
                .fold(0.0, f64::max);
            let half_width = light.reach(extent).half_width;
            let y = half_width[1] / (light.cutoff * thickest);
            let x = half_width[0] / (edge.tan() * (extent + APEX_OFFSET));
            assert!(
                (y - 1.0).abs() < 1e-12 && (x - 1.0).abs() < 1e-12,
                "{x}, {y}"
            );
        }
    }
}

#[test]
fn a_ray_that_overflows_passes_the_light() {
    let line = laser(LineProfile::GaussianTan, FocusCurve::EqualDistance, 0.9);
    let upright = Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::X,
    };
    let light = LineLight::place(&line, &upright, POWER).unwrap();
    let pdf = light.ray_pdf([0.0, 0.0, 4e306], [-1.0, 0.0, 5e-9]);
    assert_eq!(densities(pdf).map(f64::to_bits), [0; 4], "{pdf:?}");
}

fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![
        proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        -1.0..1.0_f64,
        (-30.0..30.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent)),
    ]
}

/// Directions, half of them nearly at right angles to the axis, in the frame of the light.
fn directions() -> impl Strategy<Value = DVec3> {
    let steep = (-300.0..0.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent));
    let z = prop_oneof![-1.0..1.0_f64, steep];
    (-1.0..1.0_f64, -1.0..1.0_f64, z)
        .prop_map(|(x, y, z)| DVec3::new(x, y, z).normalize_or(DVec3::Z))
}

fn densities(pdf: RayPdf) -> [f64; 4] {
    [
        pdf.position,
        pdf.direction_given_position,
        pdf.direction,
        pdf.position_given_direction,
    ]
}

/// Asks a light everything about a point and a direction.
fn check(light: &impl Emitter, p: [f64; 3], d: [f64; 3], u: [f64; 4]) -> Result<(), TestCaseError> {
    let valid = |x: f64| x >= 0.0;
    prop_assert!(valid(light.irradiance(p)), "irradiance");
    prop_assert!(light.flux(p).iter().all(|f| f.is_finite()), "flux");
    if let Some(event) = light.next_event(p) {
        prop_assert!(valid(event.e_perp) && valid(event.distance), "{:?}", event);
    }
    if let Some(event) = light.next_event_sampled(p, [u[0], u[1]]) {
        prop_assert!(valid(event.value) && valid(event.pdf), "{:?}", event);
    }
    prop_assert!(valid(light.radiance(p, d)), "radiance");
    prop_assert!(valid(light.next_event_pdf(p, d)), "density");
    if let Some(hit) = light.hit(p, d) {
        prop_assert!(valid(hit.radiance) && valid(hit.pdf), "{:?}", hit);
    }
    let end = core::array::from_fn(|i| p[i] + 10.0 * d[i].abs());
    let bound = light.power_bound(p, end);
    prop_assert!(valid(bound) && bound <= light.power(), "{:?}", bound);
    let pdf = light.ray_pdf(p, d);
    prop_assert!(densities(pdf).into_iter().all(valid), "{:?}", pdf);
    let ray = light.sample_ray(u);
    prop_assert!(ray.origin.iter().all(|x| x.is_finite()), "{:?}", ray);
    prop_assert!(densities(ray.pdf).into_iter().all(valid), "{:?}", ray);
    prop_assert!(valid(ray.cos), "{:?}", ray);
    Ok(())
}

proptest! {
    #[test]
    fn no_finite_point_yields_nan(
        index in 0..14_usize,
        fan_angle in prop_oneof![0.1..3.0_f64, Just(0.05), Just(3.1)],
        p in [finite(), finite(), finite()],
        d in directions(),
        u in [0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64],
    ) {
        let line = &lasers(fan_angle)[index];
        let direction = d.to_array();
        let upright = Placement {
            origin: DVec3::ZERO,
            direction: DVec3::Z,
            fan_axis: DVec3::X,
        };
        match line.profile() {
            LineProfile::Tabulated(_) => {
                let light = TabulatedLineLight::place(line, &upright, POWER).unwrap();
                check(&light, p, direction, u)?;
            }
            _ => {
                let light = LineLight::place(line, &upright, POWER).unwrap();
                check(&light, p, direction, u)?;
            }
        }
    }
}
