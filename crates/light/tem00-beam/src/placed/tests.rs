use core::mem::{offset_of, size_of};

use glam::DVec3;
use proptest::prelude::*;

use super::fan::Fan;
use super::phase_space::PhaseSpace;
use super::*;
use crate::GaussianBeam;
use crate::profile::SlopeProfile;
use crate::{
    AngularProfile, AstigmaticBeam, FanGeometry, FocusCurve, LaserLine, LineProfile, LocatedBeam,
};

const ORIGIN: DVec3 = DVec3::new(0.1, -0.2, 0.3);
const POWER: f64 = 5e-3;

fn placement() -> Placement {
    Placement {
        origin: ORIGIN,
        direction: DVec3::new(0.3, -0.5, 0.8),
        fan_axis: DVec3::new(1.0, 0.2, 0.1),
    }
}

fn beam() -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, 50e-6).unwrap()
}

fn spot() -> SpotLight {
    SpotLight::place(&beam(), 0.15, &placement(), POWER).unwrap()
}

fn laser_line(profile: LineProfile) -> LaserLine {
    let fan = FanGeometry {
        fan_angle: 0.5,
        apex_offset: 2e-3,
        focus_distance: 0.15,
        focus_curve: FocusCurve::EqualDistance,
    };
    LaserLine::new(beam(), fan, profile).unwrap()
}

fn line() -> LineLight {
    let line = laser_line(LineProfile::Powell { edge: 0.1 });
    LineLight::place(&line, &placement(), POWER).unwrap()
}

/// World coordinates of a point in the frame of the lights, which share it.
fn world(local: DVec3) -> [f64; 3] {
    let light = spot();
    let [ex, ey, ez] = [light.ex, light.ey, light.ez].map(DVec3::from);
    (ORIGIN + local.x * ex + local.y * ey + local.z * ez).to_array()
}

fn rotated(local: DVec3) -> DVec3 {
    DVec3::from(world(local)) - ORIGIN
}

#[test]
fn lights_fill_rows_of_four_scalars() {
    assert_eq!(size_of::<SpotLight>(), 192, "spot");
    assert_eq!(size_of::<LineLight>(), 224, "line");
    assert_eq!(size_of::<NextEvent>(), 64, "next event");
    assert_eq!(size_of::<RaySample>(), 96, "ray");
}

/// 0.3 m and 5 mW have other digits in `f32`; the padding is 0.
#[test]
fn kernels_get_rows_in_single_precision() {
    for (rows, single) in spot().to_rows().iter().zip(spot().to_rows_f32()) {
        for (double, single) in rows.iter().zip(single) {
            let error = f64::from(single) - double;
            assert!(
                error.abs() <= 0.5 * f64::from(f32::EPSILON) * double.abs(),
                "{double}"
            );
        }
    }
    let rows = line().to_rows_f32();
    assert_eq!(rows[6][2].to_bits(), 650e-9_f32.to_bits(), "the wavelength");
}

#[test]
fn lights_can_be_shared_between_threads() {
    fn shared<T: Copy + Send + Sync>() {}
    shared::<SpotLight>();
    shared::<LineLight>();
}

#[test]
fn rows_hold_the_fields_in_the_order_of_memory() {
    fn numbers<const N: usize>() -> [[f64; 4]; N] {
        core::array::from_fn(|i| core::array::from_fn(|j| (4 * i + j) as f64))
    }
    fn bits<const N: usize>(rows: [[f64; 4]; N]) -> [[u64; 4]; N] {
        rows.map(|row| row.map(f64::to_bits))
    }
    let spot = SpotLight::from_rows(numbers());
    let line = LineLight::from_rows(numbers());
    assert_eq!(bits(spot.to_rows()), bits(numbers()), "spot");
    assert_eq!(bits(line.to_rows()), bits(numbers()), "line");
    let checks = [
        (spot.power, offset_of!(SpotLight, power)),
        (spot.cutoff, offset_of!(SpotLight, cutoff)),
        (spot.wavelength, offset_of!(SpotLight, wavelength)),
        (spot.ez[0], offset_of!(SpotLight, ez)),
        (spot.y.w0_sq, offset_of!(SpotLight, y)),
        (line.apex_offset, offset_of!(LineLight, apex_offset)),
        (line.source_radius, offset_of!(LineLight, source_radius)),
        (line.y.w0_sq, offset_of!(LineLight, y)),
        (line.flat, offset_of!(LineLight, flat)),
        (line.sigma, offset_of!(LineLight, sigma)),
        (line.variable, offset_of!(LineLight, variable)),
        (line.mass, offset_of!(LineLight, mass)),
        (line.half_slope, offset_of!(LineLight, half_slope)),
        (line.focus_on_plane, offset_of!(LineLight, focus_on_plane)),
        (line.wavelength, offset_of!(LineLight, wavelength)),
    ];
    for (index, bytes) in checks {
        assert!((index * 8.0 - bytes as f64).abs() < 0.5, "{index}: {bytes}");
    }
}

#[test]
fn a_placed_light_is_the_laser_in_another_frame() {
    for profile in [LineProfile::GaussianTan, LineProfile::Powell { edge: 0.1 }] {
        let laser = laser_line(profile);
        let light = LineLight::place(&laser, &placement(), POWER).unwrap();
        for (x, y, z) in [(0.0, 0.0, 0.01), (0.03, 5e-5, 0.15), (-0.05, -1e-3, 0.4)] {
            let local = DVec3::new(x, y, z);
            let expected = rotated(POWER * laser.flux_per_watt(local));
            let flux = DVec3::from(light.flux(world(local)));
            // 1e−16 m of rounding beside a thickness of 5e−5 m.
            assert!(
                flux.distance(expected) <= 1e-10 * expected.length(),
                "{local}: {flux}"
            );
        }
    }
    for (x, y, z) in [(0.0, 0.0, 0.01), (3e-4, -2e-4, 0.01), (5e-5, 1e-5, 0.15)] {
        let local = DVec3::new(x, y, z);
        let from_waist = local - DVec3::Z * 0.15;
        let expected = rotated(POWER * beam().flux_per_watt(from_waist));
        let flux = DVec3::from(spot().flux(world(local)));
        assert!(
            flux.distance(expected) <= 1e-10 * expected.length(),
            "{local}: {flux}"
        );
    }
}

/// An elliptic beam whose principal axes are turned by 0.4 rad from the light's x and y.
fn elliptic() -> AstigmaticBeam {
    let wide = GaussianBeam::from_waist(650e-9, 80e-6)
        .and_then(|beam| beam.with_m_squared(1.7))
        .unwrap();
    let axes = [(beam(), 0.15), (wide, -0.05)].map(|(b, z)| LocatedBeam::new(b, z).unwrap());
    let beam = AstigmaticBeam::new(axes[0], axes[1]).unwrap();
    beam.with_rotation(0.4).unwrap()
}

#[test]
fn a_placed_elliptic_beam_is_the_beam_in_another_frame() {
    let light = SpotLight::place_astigmatic(&elliptic(), &placement(), POWER).unwrap();
    for (x, y, z) in [(0.0, 0.0, 0.01), (3e-4, -2e-4, 0.01), (5e-5, 1e-4, 0.15)] {
        let local = DVec3::new(x, y, z);
        let expected = rotated(POWER * elliptic().flux_per_watt(local));
        let flux = DVec3::from(light.flux(world(local)));
        // 1e−16 m of rounding beside a radius of 5e−5 m.
        assert!(
            flux.distance(expected) <= 1e-10 * expected.length(),
            "{local}: {flux}"
        );
    }
}

#[test]
fn lights_say_what_they_were_placed_with() {
    let tabulated = laser_line(LineProfile::Tabulated(
        AngularProfile::new(&[-0.2, 0.2], &[1.0, 1.0]).unwrap(),
    ));
    let tabulated = TabulatedLineLight::place(&tabulated, &placement(), POWER).unwrap();
    let (spot, line) = (spot(), line());
    let lights: [&dyn Emitter; 3] = [&spot, &line, &tabulated];
    for light in lights {
        let said = [light.power(), light.wavelength()];
        assert_eq!(said.map(f64::to_bits), [POWER, 650e-9].map(f64::to_bits));
        assert_eq!(DVec3::from(light.origin()), ORIGIN);
        let axis = DVec3::from(light.axis());
        assert!(
            axis.distance(placement().direction.normalize()) < 1e-15,
            "{axis}"
        );
    }
}

#[test]
fn next_event_and_flux_light_a_surface_alike() {
    let (spot, line) = (spot(), line());
    let lights: [(&dyn Emitter, DVec3); 2] = [
        (&spot, DVec3::new(2e-4, 1e-4, 0.2)),
        (&line, DVec3::new(0.04, 1e-4, 0.2)),
    ];
    for (light, local) in lights {
        let p = world(local);
        let n = DVec3::new(0.2, 0.5, -0.7).normalize();
        let event = light.next_event(p).unwrap();
        let received = -DVec3::from(light.flux(p)).dot(n);
        let wi = DVec3::from(event.wi);
        assert!(
            (event.e_perp * wi.dot(n) / received - 1.0).abs() < 1e-14,
            "{event:?}"
        );
        assert!((wi.length() - 1.0).abs() < 1e-15, "{event:?}");
        let reached = DVec3::from(p) + wi * event.distance;
        let miss = reached.distance(DVec3::from(event.point));
        assert!(miss < 1e-15, "{event:?}: {miss:e}");
        let axis = DVec3::from(spot.ez);
        let height = (DVec3::from(event.point) - ORIGIN).dot(axis);
        assert!(height.abs() < 1e-16, "on the aperture plane: {height:e}");
        let plane = -DVec3::from(light.flux(p)).dot(-axis);
        assert!((light.irradiance(p) / plane - 1.0).abs() < 1e-14, "{plane}");
    }
}

#[test]
fn nothing_arrives_beyond_the_cutoff_or_behind_the_aperture() {
    let mut spot = spot();
    spot.cutoff = 2.5;
    let w = beam().radius_at(0.1);
    let mut line = line();
    line.cutoff = 2.5;
    let r = (0.252_f64).hypot(0.02);
    let thickness = beam().radius_at(r - 0.152);
    let edge = line.profile().largest_slope(line.cutoff) * 0.252;
    let expected_edge = 0.25_f64.tan() * (1.0 + 2.0 * 2.5 * 0.1) * 0.252;
    assert!((edge / expected_edge - 1.0).abs() < 1e-14, "{edge}");
    let cases: [(&dyn Emitter, DVec3, bool); 8] = [
        (&spot, DVec3::new(1.5 * w, 1.99 * w, 0.25), true),
        (&spot, DVec3::new(1.5 * w, 2.01 * w, 0.25), false),
        (&spot, DVec3::new(0.0, 0.0, -1e-6), false),
        (&line, DVec3::new(0.02, 2.49 * thickness, 0.25), true),
        (&line, DVec3::new(0.02, 2.51 * thickness, 0.25), false),
        (&line, DVec3::new(0.999 * edge, 0.0, 0.25), true),
        (&line, DVec3::new(-1.001 * edge, 0.0, 0.25), false),
        (&line, DVec3::new(0.0, 0.0, -1e-6), false),
    ];
    for (light, local, lit) in cases {
        let p = world(local);
        assert_eq!(light.next_event(p).is_some(), lit, "{local}");
        assert_eq!(
            light.next_event_sampled(p, [0.3, 0.6]).is_some(),
            lit,
            "{local}"
        );
        assert_eq!(light.irradiance(p) > 0.0, lit, "{local}");
        assert_eq!(DVec3::from(light.flux(p)) != DVec3::ZERO, lit, "{local}");
    }
}

#[test]
fn bounds_hold_all_that_is_lit() {
    const EXTENT: f64 = 0.4;
    let (spot, line) = (spot(), line());
    let lights: [(&dyn Emitter, f64); 2] = [(&spot, 4e-3), (&line, 0.4)];
    for (light, width) in lights {
        let bounds = light.bounds(EXTENT);
        let (min, max) = (DVec3::from(bounds.min), DVec3::from(bounds.max));
        let mut lit = 0;
        for i in 0..64_000 {
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
            assert!(point.cmpge(min).all() && point.cmple(max).all(), "{local}");
            let travel = -DVec3::from(event.wi);
            let angle = travel.angle_between(DVec3::from(bounds.axis));
            assert!(angle <= bounds.half_angle, "{local}: {angle}");
        }
        assert!(lit > 1000, "the test must meet the light: {lit}");
    }
}

#[test]
fn bounds_are_those_of_the_corners_of_the_light() {
    const EXTENT: f64 = 0.4;
    let (spot, line) = (spot(), line());
    let lights: [(&dyn Emitter, [f64; 2]); 2] = [
        (&spot, spot.reach(EXTENT).half_width),
        (&line, line.reach(EXTENT).half_width),
    ];
    for (light, [x, y]) in lights {
        let corners = (0..8).map(|corner| {
            let side = |bit: i32| if corner & bit == 0 { -1.0 } else { 1.0 };
            let z = 0.5 * EXTENT * (1.0 + side(4));
            DVec3::from(world(DVec3::new(side(1) * x, side(2) * y, z)))
        });
        let (low, high) = corners.fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), corner| (low.min(corner), high.max(corner)),
        );
        let bounds = light.bounds(EXTENT);
        assert!(low.abs_diff_eq(DVec3::from(bounds.min), 1e-14), "{low}");
        assert!(high.abs_diff_eq(DVec3::from(bounds.max), 1e-14), "{high}");
    }
}

#[test]
fn the_corner_of_a_fan_lies_on_its_bounds() {
    const EXTENT: f64 = 0.4;
    let line = line();
    let z = EXTENT + line.apex_offset;
    let slope = 0.999_99 * line.profile().largest_slope(line.cutoff);
    let w = beam().radius_at(z * 1_f64.hypot(slope) - 0.152);
    let y = 0.999_99 * line.cutoff * w;
    let p = world(DVec3::new(slope * z, y, EXTENT));
    let bounds = line.bounds(EXTENT);
    let travel = -DVec3::from(line.next_event(p).unwrap().wi);
    let angle = travel.angle_between(DVec3::from(bounds.axis));
    // The flow has nearly its asymptotic slope, (z_R / 0.3 m)² / 2 = 8e−4 below it.
    let slack = 1.0 - angle / bounds.half_angle;
    assert!((0.0..1e-3).contains(&slack), "{slack:e}");
    let reach = line.reach(EXTENT);
    let slack = [slope * z / reach.half_width[0], y / reach.half_width[1]].map(|r| 1.0 - r);
    assert!(
        slack.iter().all(|slack| (0.0..1e-4).contains(slack)),
        "{slack:?}"
    );
}

#[test]
fn a_cone_of_bounds_is_missed_by_few_rays() {
    let (spot, line) = (spot(), line());
    let lights: [&dyn Emitter; 2] = [&spot, &line];
    for light in lights {
        let bounds = light.bounds(1.0);
        let cone = bounds.half_angle.cos();
        for i in 0..4096_usize {
            // Up to 4.75 standard deviations, along x and y together 6.7 of the 8 within the cone.
            let variates = [1e-6, 0.01, 0.2, 0.4, 0.6, 0.8, 0.99, 1.0 - 1e-6];
            let digit = |shift: usize| variates[i >> shift & 7];
            let ray = light.sample_ray([digit(0), digit(3), digit(6), digit(9)]);
            assert!(ray.cos >= cone, "{ray:?}");
        }
    }
}

/// More points than a vector holds, and a remainder; lit ones and some of either unlit kind.
fn batch_points() -> [Vec<f64>; 3] {
    let points: Vec<[f64; 3]> = (0..203)
        .map(|i| {
            let fraction = |step: f64| (f64::from(i) * step).fract() - 0.5;
            world(DVec3::new(
                6e-3 * fraction(0.618_033_988_7),
                1e-3 * fraction(0.414_213_562_4),
                0.2 + 0.5 * fraction(0.732_050_807_6),
            ))
        })
        .collect();
    [0, 1, 2].map(|k| points.iter().map(|p| p[k]).collect())
}

/// Compares both batch forms with single calls, bit for bit, and returns the number of lit points.
fn lit_in_batch(light: &impl Emitter) -> usize {
    let [x, y, z] = batch_points();
    let mut out = vec![vec![1.0; x.len()]; 6];
    let [e, wi_x, wi_y, wi_z, distance, e_perp] = out.get_disjoint_mut([0, 1, 2, 3, 4, 5]).unwrap();
    light.irradiance_batch(&x, &y, &z, e);
    let slices = NextEventSlices {
        wi: [wi_x, wi_y, wi_z],
        distance,
        e_perp,
    };
    light.next_event_batch(&x, &y, &z, slices);
    let mut lit = 0;
    for i in 0..x.len() {
        let p = [x[i], y[i], z[i]];
        let event = light.next_event(p);
        lit += usize::from(event.is_some());
        let [a, b, c] = event.map_or([0.0; 3], |event| event.wi);
        let distance = event.map_or(0.0, |event| event.distance);
        let e_perp = event.map_or(0.0, |event| event.e_perp);
        let expected = [light.irradiance(p), a, b, c, distance, e_perp];
        let got = core::array::from_fn(|k| out[k][i]);
        assert_eq!(
            got.map(|t: f64| t.to_bits()),
            expected.map(|t| t.to_bits()),
            "{i}"
        );
    }
    lit
}

#[test]
fn batches_equal_single_calls_to_the_last_bit() {
    let spot = spot();
    let mut lit = vec![lit_in_batch(&spot)];
    for profile in [
        LineProfile::GaussianTan,
        LineProfile::GaussianAngle,
        LineProfile::GaussianSin,
        LineProfile::UniformTan,
        LineProfile::Powell { edge: 0.1 },
    ] {
        let line = LineLight::place(&laser_line(profile), &placement(), POWER).unwrap();
        lit.push(lit_in_batch(&line));
    }
    assert!(lit.iter().all(|lit| (20..180).contains(lit)), "{lit:?}");
}

#[test]
#[should_panic(expected = "must be of equal length, got 3, 3, 3 and [4]")]
fn batches_of_unequal_length_panic() {
    spot().irradiance_batch(&[0.0; 3], &[0.0; 3], &[0.0; 3], &mut [0.0; 4]);
}

#[test]
#[should_panic(expected = "must be of equal length, got 1, 1, 1 and [1, 1, 1, 2, 1]")]
fn batches_of_next_events_of_unequal_length_panic() {
    let out = NextEventSlices {
        wi: [&mut [0.0], &mut [0.0], &mut [0.0]],
        distance: &mut [0.0; 2],
        e_perp: &mut [0.0],
    };
    spot().next_event_batch(&[0.0], &[0.0], &[0.0], out);
}

#[test]
fn a_laser_without_power_is_dark() {
    let light = SpotLight::place(&beam(), 0.1, &placement(), 0.0).unwrap();
    let p = world(DVec3::new(0.0, 0.0, 0.1));
    assert!(light.next_event(p).is_none(), "no event");
    assert!(
        light.sample_ray([0.5; 4]).flux.abs() < f64::MIN_POSITIVE,
        "no flux"
    );
}

#[test]
fn the_strongest_light_of_the_smallest_waist_is_finite() {
    let smallest = GaussianBeam::from_waist(1e-30, 1e-30).unwrap();
    let light = SpotLight::place(&smallest, 0.0, &placement(), 1e100).unwrap();
    let p = ORIGIN.to_array();
    let flux = light.flux(p);
    assert!(light.irradiance(p) > 1e159, "{flux:?}");
    assert!(flux.iter().all(|f| f.is_finite()), "{flux:?}");
}

proptest! {
    #[test]
    fn no_finite_point_yields_nan(
        x in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        y in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        z in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        u in 0.0..1.0_f64,
    ) {
        let (spot, line) = (spot(), line());
        let lights: [&dyn Emitter; 2] = [&spot, &line];
        for light in lights {
            let p = [x, y, z];
            prop_assert!(light.irradiance(p) >= 0.0, "irradiance");
            prop_assert!(light.flux(p).iter().all(|f| f.is_finite()), "flux");
            if let Some(event) = light.next_event(p) {
                prop_assert!(event.e_perp > 0.0 && event.distance >= 0.0, "{:?}", event);
            }
            if let Some(event) = light.next_event_sampled(p, [u, 1.0 - u]) {
                prop_assert!(event.value > 0.0 && event.pdf > 0.0, "{:?}", event);
            }
            let direction = DVec3::new(x, y, z).normalize_or(DVec3::Z).to_array();
            prop_assert!(light.radiance(p, direction) >= 0.0, "radiance");
        }
    }
}
