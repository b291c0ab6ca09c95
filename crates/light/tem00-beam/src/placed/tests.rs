use glam::DVec3;
use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::fan::Fan;
use super::phase_space::PhaseSpace;
use super::*;
use crate::normal::HALF_SPACING;
use crate::profile::SlopeProfile;
use crate::{
    AngularProfile, AstigmaticBeam, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile,
    LocatedBeam,
};

mod batches;
mod bounds;

const POWER: f64 = 5e-3;
const APEX_OFFSET: f64 = 2e-3;
const TABLE: [(f64, f64); 4] = [(-0.6, 0.5), (-0.1, 1.0), (0.2, 0.7), (0.5, 0.4)];
const PLACEMENT: Placement = Placement {
    origin: DVec3::new(0.1, -0.2, 0.3),
    direction: DVec3::new(0.3, -0.5, 0.8),
    fan_axis: DVec3::new(1.0, 0.2, 0.1),
};
const UPRIGHT: Placement = Placement {
    origin: DVec3::ZERO,
    direction: DVec3::Z,
    fan_axis: DVec3::X,
};

fn beam() -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, 50e-6).unwrap()
}

/// An elliptic beam whose principal axes are turned by 0.4 rad from the light's x and y.
fn elliptic() -> AstigmaticBeam {
    let wide = GaussianBeam::from_waist(650e-9, 80e-6).unwrap();
    let wide = wide.with_m_squared(1.7).unwrap();
    let axes = [(beam(), 0.15), (wide, -0.05)].map(|(b, z)| LocatedBeam::new(b, z).unwrap());
    let beam = AstigmaticBeam::new(axes[0], axes[1]).unwrap();
    beam.with_rotation(0.4).unwrap()
}

fn spot() -> SpotLight {
    SpotLight::place(&beam(), 0.15, &PLACEMENT, POWER).unwrap()
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

fn table() -> LineProfile {
    LineProfile::Tabulated(AngularProfile::from_pairs(&TABLE).unwrap())
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

fn place_at<'a>(line: &'a LaserLine, placement: &Placement) -> Box<dyn Emitter + 'a> {
    match LineLight::place(line, placement, POWER) {
        Ok(light) => Box::new(light),
        Err(_) => Box::new(TabulatedLineLight::place(line, placement, POWER).unwrap()),
    }
}

fn place(line: &LaserLine) -> Box<dyn Emitter + '_> {
    place_at(line, &PLACEMENT)
}

/// A line with a Powell profile.
fn powell() -> LineLight {
    let profile = LineProfile::Powell { edge: 0.1 };
    let line = laser(profile, FocusCurve::EqualDistance, 0.5);
    LineLight::place(&line, &PLACEMENT, POWER).unwrap()
}

/// World coordinates of a vector in the frame of the lights, which share it.
fn rotated(local: DVec3) -> DVec3 {
    let frame = PLACEMENT.frame().unwrap();
    DVec3::from(frame.world_from_local_vector(local.to_array()))
}

fn world(local: DVec3) -> [f64; 3] {
    (PLACEMENT.origin + rotated(local)).to_array()
}

#[test]
fn rows_give_the_fields_back() {
    fn numbers<const N: usize>() -> [[f64; 4]; N] {
        core::array::from_fn(|i| core::array::from_fn(|j| (4 * i + j) as f64))
    }
    assert_eq!(SpotLight::from_rows(numbers()).to_rows(), numbers(), "spot");
    assert_eq!(LineLight::from_rows(numbers()).to_rows(), numbers(), "line");
}

/// Compares the flux of a light at points with the flux of its beam, both in the frame of the
/// light.
fn check_flux(light: &dyn Emitter, flux: impl Fn(DVec3) -> DVec3, points: [[f64; 3]; 3]) {
    for local in points.map(DVec3::from) {
        let expected = rotated(POWER * flux(local));
        let got = DVec3::from(light.flux(world(local)));
        // 1e−16 m of rounding compared with a thickness of 5e−5 m.
        assert_absolute(got.distance(expected), 0.0, 1e-10 * expected.length());
        assert!(got.length() > 0.0, "{local} is lit");
    }
}

#[test]
fn a_placed_light_is_the_laser_in_another_frame() {
    for line in lasers(0.9) {
        let points = [[0.0, 0.0, 0.01], [0.03, 5e-5, 0.15], [-0.15, -1e-3, 0.4]];
        check_flux(&*place(&line), |p| line.flux_per_watt(p), points);
    }
    let points = [[0.0, 0.0, 0.01], [3e-4, -2e-4, 0.01], [5e-5, 1e-5, 0.15]];
    let from_waist = |p| beam().flux_per_watt(p - DVec3::Z * 0.15);
    check_flux(&spot(), from_waist, points);
    let light = SpotLight::place_astigmatic(&elliptic(), &PLACEMENT, POWER).unwrap();
    check_flux(&light, |p| elliptic().flux_per_watt(p), points);
}

#[test]
fn next_event_and_flux_light_a_surface_alike() {
    let spot = spot();
    let lights: [(&dyn Emitter, DVec3); 2] = [
        (&spot, DVec3::new(2e-4, 1e-4, 0.2)),
        (&powell(), DVec3::new(0.04, 1e-4, 0.2)),
    ];
    for (light, local) in lights {
        let p = world(local);
        let n = DVec3::new(0.2, 0.5, -0.7).normalize();
        let event = light.next_event(p).unwrap();
        let received = -DVec3::from(light.flux(p)).dot(n);
        let wi = DVec3::from(event.wi);
        assert_relative(event.e_perp * wi.dot(n), received, 1e-14);
        assert_absolute(wi.length(), 1.0, 1e-15);
        let reached = DVec3::from(p) + wi * event.distance;
        let point = DVec3::from(event.point);
        assert_absolute(reached.distance(point), 0.0, 1e-15);
        let axis = DVec3::from(spot.ez);
        // On the aperture plane.
        assert_absolute((point - PLACEMENT.origin).dot(axis), 0.0, 1e-16);
        let plane = DVec3::from(light.flux(p)).dot(axis);
        assert_relative(light.irradiance(p), plane, 1e-14);
    }
}

#[test]
fn nothing_arrives_beyond_the_cutoff_or_behind_the_aperture() {
    let (mut spot, mut line) = (spot(), powell());
    (spot.cutoff, line.cutoff) = (2.5, 2.5);
    let w = beam().radius_at(0.1);
    let thickness = beam().radius_at((0.252_f64).hypot(0.02) - 0.152);
    let edge = line.profile().largest_slope(line.cutoff) * 0.252;
    let expected_edge = 0.25_f64.tan() * (1.0 + 2.0 * 2.5 * 0.1) * 0.252;
    assert_relative(edge, expected_edge, 1e-14);
    let cases: [(&dyn Emitter, [f64; 3], bool); 8] = [
        (&spot, [1.5 * w, 1.99 * w, 0.25], true),
        (&spot, [1.5 * w, 2.01 * w, 0.25], false),
        (&spot, [0.0, 0.0, -1e-6], false),
        (&line, [0.02, 2.49 * thickness, 0.25], true),
        (&line, [0.02, 2.51 * thickness, 0.25], false),
        (&line, [0.999 * edge, 0.0, 0.25], true),
        (&line, [-1.001 * edge, 0.0, 0.25], false),
        (&line, [0.0, 0.0, -1e-6], false),
    ];
    for (light, local, lit) in cases {
        let p = world(local.into());
        let answers = [
            light.next_event(p).is_some(),
            light.next_event_sampled(p, [0.3, 0.6]).is_some(),
            light.irradiance(p) > 0.0,
            DVec3::from(light.flux(p)) != DVec3::ZERO,
        ];
        assert_eq!(answers, [lit; 4], "{local:?}");
    }
}

#[test]
fn a_line_without_its_table_is_dark() {
    let line = laser(table(), FocusCurve::EqualPlane, 0.9);
    let light = TabulatedLineLight::place(&line, &PLACEMENT, POWER).unwrap();
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
        let mut light = LineLight::place(&line, &PLACEMENT, POWER).unwrap();
        light.cutoff = CUTOFF;
        let lit = [0.999_999, 1.000_001].map(|part| {
            let p = DVec3::new(part * end * (0.2 + APEX_OFFSET), 0.0, 0.2);
            light.next_event(world(p)).is_some()
        });
        assert_eq!(lit, [true, false], "{line:?}");
    }
}

/// Fractions from −½ to ½ of a lattice without a common period.
fn fractions(i: i32) -> [f64; 3] {
    [0.618_033_988_7, 0.414_213_562_4, 0.732_050_807_6]
        .map(|step| (f64::from(i) * step).fract() - 0.5)
}

/// The direction density of the rays that `light` draws with the outermost variates.
fn outermost(light: &dyn Emitter) -> [f64; 2] {
    [0.0, 1.0 - 2.0 * HALF_SPACING].map(|u| light.sample_ray([0.5, 0.5, u, 0.5]).pdf.direction)
}

#[test]
fn rounding_carries_no_drawn_ray_over_the_ends_of_a_profile() {
    for i in 0..100 {
        let end = 0.1 + 0.01 * f64::from(i);
        // The ends hold so much power that the outermost variates come within a rounding of them.
        let gap = end - 0.02;
        let table = [(-end, 1.0), (-gap, 0.0), (gap, 0.0), (end, 1.0)];
        let table = LineProfile::Tabulated(AngularProfile::from_pairs(&table).unwrap());
        for profile in [table, LineProfile::UniformTan, LineProfile::UniformAngle] {
            let line = laser(profile, FocusCurve::EqualPlane, 2.0 * end);
            let pdf = outermost(&*place(&line));
            assert!(pdf.iter().all(|&pdf| pdf > 0.0), "{end}, {line:?}");
        }
    }
}

#[test]
fn extreme_lights_and_rays_give_finite_numbers() {
    let dark = SpotLight::place(&beam(), 0.1, &PLACEMENT, 0.0).unwrap();
    let p = world(DVec3::new(0.0, 0.0, 0.1));
    assert!(dark.next_event(p).is_none(), "no power, no event");
    assert!(dark.sample_ray([0.5; 4]).flux <= 0.0, "no flux");
    let smallest = GaussianBeam::from_waist(1e-30, 1e-30).unwrap();
    let strongest = SpotLight::place(&smallest, 0.0, &UPRIGHT, 1e100).unwrap();
    let flux = strongest.flux([0.0; 3]);
    assert!(strongest.irradiance([0.0; 3]) > 1e159, "{flux:?}");
    assert!(flux.iter().all(|f| f.is_finite()), "{flux:?}");
    let line = laser(LineProfile::GaussianTan, FocusCurve::EqualDistance, 0.9);
    let pdf = place_at(&line, &UPRIGHT).ray_pdf([0.0, 0.0, 4e306], [-1.0, 0.0, 5e-9]);
    assert_eq!(densities(pdf).map(f64::to_bits), [0; 4], "{pdf:?}");
}

fn densities(pdf: RayPdf) -> [f64; 4] {
    [
        pdf.position,
        pdf.direction_given_position,
        pdf.direction,
        pdf.position_given_direction,
    ]
}

fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![
        proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        -1.0..1.0_f64,
        (-30.0..30.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent)),
    ]
}

/// Directions, half of them nearly perpendicular to the axis, in the frame of the light.
fn directions() -> impl Strategy<Value = DVec3> {
    let steep = (-300.0..0.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent));
    let z = prop_oneof![-1.0..1.0_f64, steep];
    (-1.0..1.0_f64, -1.0..1.0_f64, z)
        .prop_map(|(x, y, z)| DVec3::new(x, y, z).normalize_or(DVec3::Z))
}

/// All results of a light for a point and a direction, none of which may be negative or NaN.
fn answers(light: &dyn Emitter, p: [f64; 3], d: [f64; 3], u: [f64; 4]) -> Vec<f64> {
    let mut answers = vec![light.irradiance(p), light.radiance(p, d)];
    answers.push(light.next_event_pdf(p, d));
    if let Some(event) = light.next_event(p) {
        answers.extend([event.e_perp, event.distance]);
    }
    if let Some(event) = light.next_event_sampled(p, [u[0], u[1]]) {
        answers.extend([event.value, event.pdf]);
    }
    if let Some(hit) = light.hit(p, d) {
        answers.extend([hit.radiance, hit.pdf]);
    }
    let ray = light.sample_ray(u);
    answers.push(ray.cos);
    answers.extend(densities(ray.pdf));
    answers.extend(densities(light.ray_pdf(p, d)));
    answers
}

proptest! {
    #[test]
    fn no_finite_point_yields_nan(
        index in 0..15_usize,
        fan_angle in prop_oneof![0.1..3.0_f64, Just(0.05), Just(3.1)],
        p in [finite(), finite(), finite()],
        d in directions(),
        u in [0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64],
    ) {
        let lasers = lasers(fan_angle);
        let light = match lasers.get(index) {
            Some(line) => place_at(line, &UPRIGHT),
            None => Box::new(SpotLight::place(&beam(), 0.15, &UPRIGHT, POWER).unwrap()),
        };
        let answers = answers(&*light, p, d.to_array(), u);
        prop_assert!(answers.iter().all(|&x| x >= 0.0), "{answers:?}");
        let vectors = [light.flux(p), light.sample_ray(u).origin];
        prop_assert!(vectors.as_flattened().iter().all(|x| x.is_finite()), "{vectors:?}");
        let end = core::array::from_fn(|i| p[i] + 10.0 * d[i].abs());
        let bound = light.power_bound(p, end);
        prop_assert!((0.0..=light.power()).contains(&bound), "{bound}");
    }
}
