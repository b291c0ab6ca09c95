use core::mem::{offset_of, size_of};

use glam::DVec3;
use proptest::prelude::*;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use super::*;
use crate::optics::AstigmaticSystem;
use crate::real::sealed::Scalar;
use crate::{AstigmaticBeam, GaussianBeam, LocatedBeam, SpotLight};

const POWER: f64 = 5e-3;
const ORIGIN: DVec3 = DVec3::new(0.1, -0.2, 0.3);

fn placement() -> Placement {
    Placement {
        origin: ORIGIN,
        direction: DVec3::new(0.3, -0.5, 0.8),
        fan_axis: DVec3::new(1.0, 0.2, 0.1),
    }
}

/// Waists of 50 µm at 0.15 m and of 80 µm, with M² = 1.7, at −0.05 m.
fn elliptic() -> AstigmaticBeam {
    let narrow = GaussianBeam::from_waist(650e-9, 50e-6).unwrap();
    let wide = GaussianBeam::from_waist(650e-9, 80e-6)
        .and_then(|beam| beam.with_m_squared(1.7))
        .unwrap();
    let [x, y] = [(narrow, 0.15), (wide, -0.05)].map(|(b, z)| LocatedBeam::new(b, z).unwrap());
    AstigmaticBeam::new(x, y).unwrap()
}

/// The elliptic beam behind two oblique cylinder lenses, which turn and twist it.
fn general() -> GeneralAstigmaticBeam {
    let first = AstigmaticSystem::cylinder_lens(0.15, 0.5).unwrap();
    let gap = AstigmaticSystem::free_space(0.1).unwrap();
    let second = AstigmaticSystem::cylinder_lens(0.2, 1.3).unwrap();
    let system = first.then(gap).then(second);
    GeneralAstigmaticBeam::from(elliptic())
        .through(&system)
        .unwrap()
}

fn light() -> AstigmaticLight<f64> {
    AstigmaticLight::place(&general(), &placement(), POWER).unwrap()
}

fn rotated(local: DVec3) -> DVec3 {
    let frame = placement().frame().unwrap();
    frame.world_from_local_vector(local.to_array()).into()
}

fn world(local: DVec3) -> [f64; 3] {
    (ORIGIN + rotated(local)).to_array()
}

/// The number `i` of an even spread over (−½, ½).
fn spread(i: u32, step: f64) -> f64 {
    (f64::from(i) * step).fract() - 0.5
}

/// Points within one beam radius and a half, at distances up to 0.5 m.
fn lit_points() -> impl Iterator<Item = DVec3> {
    (0..50).map(|i| {
        let z = 0.25 + 0.5 * spread(i, 0.732_050_807_6);
        let moments = general().moments_at(z).position;
        let offset = [0.618_033_988_7, 0.414_213_562_4].map(|step| 2.0 * spread(i, step));
        // Twice a standard deviation is one beam radius.
        let factors = Ellipse::new(moments.x_axis.x, moments.x_axis.y, moments.y_axis.y).factors();
        let [x, y] = factors.spread(offset.map(|x| 4.0 * x));
        DVec3::new(x, y, z)
    })
}

#[test]
fn the_light_fills_seven_rows_of_four_scalars() {
    assert_eq!(size_of::<AstigmaticLight<f32>>(), 112, "f32");
    assert_eq!(size_of::<AstigmaticLight<f64>>(), 224, "f64");
    let rows = core::array::from_fn(|i| core::array::from_fn(|j| (4 * i + j) as f64));
    let light = AstigmaticLight::from_rows(rows);
    let bits = |rows: [[f64; 4]; 7]| rows.map(|row| row.map(f64::to_bits));
    assert_eq!(bits(light.to_rows()), bits(rows), "all rows");
    let checks = [
        (light.cutoff, offset_of!(AstigmaticLight<f64>, cutoff)),
        (
            light.position.xx,
            offset_of!(AstigmaticLight<f64>, position),
        ),
        (light.slope.xx, offset_of!(AstigmaticLight<f64>, slope)),
        (
            light.position_per_slope[0][0],
            offset_of!(AstigmaticLight<f64>, position_per_slope),
        ),
        (light.position_per_slope[1][0], 8 * 26),
    ];
    for (index, bytes) in checks {
        assert!((index * 8.0 - bytes as f64).abs() < 0.5, "{index}: {bytes}");
    }
}

#[test]
fn the_beam_is_twisted_and_its_ellipse_turns() {
    let k = light().position_per_slope;
    assert!((k[0][1] - k[1][0]).abs() > 1e-3, "{k:?}");
    let turn = general().orientation_at(0.3) - general().orientation_at(0.0);
    assert!(turn.abs() > 0.2, "{turn}");
}

#[test]
fn a_placed_beam_is_the_beam_in_another_frame() {
    for local in lit_points() {
        let expected = rotated(POWER * general().flux_per_watt(local));
        let flux = DVec3::from(light().flux(world(local)));
        // 1e−16 m of rounding beside a radius of 2e−5 m.
        let error = flux.distance(expected) / expected.length();
        assert!(error < 1e-9, "{local}: {error:e}");
    }
}

#[test]
fn a_beam_with_simple_astigmatism_is_that_of_a_spot() {
    for rotation in [0.0, 0.4] {
        let beam = elliptic().with_rotation(rotation).unwrap();
        let spot = SpotLight::place_astigmatic(&beam, &placement(), POWER).unwrap();
        let light = AstigmaticLight::place(&beam.into(), &placement(), POWER).unwrap();
        for (i, z) in [(1, 0.05), (2, 0.15), (3, 0.3), (4, 0.45)] {
            let local = DVec3::new(1e-4 * spread(i, 0.618), 1e-4 * spread(i, 0.414), z);
            let p = world(local);
            let (a, b) = (light.next_event(p).unwrap(), spot.next_event(p).unwrap());
            let error = DVec3::from(a.wi).distance(b.wi.into());
            assert!(error < 1e-13, "{local}: {error:e}");
            assert!((a.e_perp / b.e_perp - 1.0).abs() < 1e-11, "{local}");
            let drawn = light.next_event_sampled(p, [0.3, 0.8]).unwrap();
            let direction = drawn.wi.map(|x| -x);
            let (a, b) = (light.ray_pdf(p, direction), spot.ray_pdf(p, direction));
            let densities = [
                [a.position, b.position],
                [a.direction_given_position, b.direction_given_position],
                [a.direction, b.direction],
                [a.position_given_direction, b.position_given_direction],
            ];
            for [a, b] in densities {
                assert!((a / b - 1.0).abs() < 1e-9, "{local}: {a}, {b}");
            }
            let ratio = light.radiance(p, direction) / spot.radiance(p, direction);
            assert!((ratio - 1.0).abs() < 1e-9, "{local}: {ratio}");
        }
        let (near, far) = (light.bounds(0.4), spot.bounds(0.4));
        assert!(
            (near.half_angle / far.half_angle - 1.0).abs() < 1e-12,
            "{rotation}"
        );
    }
}

/// ∫ f du dv over the square of `half` by the midpoint rule, exponentially exact for a Gaussian.
fn integrate(half: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    const CELLS: i32 = 300;
    let h = 2.0 * half / f64::from(CELLS);
    let at = |i: i32| (f64::from(i) + 0.5) * h - half;
    let row = |j| (0..CELLS).map(|i| f(at(i), at(j))).sum::<f64>();
    (0..CELLS).map(row).sum::<f64>() * h * h
}

#[test]
fn densities_of_rays_integrate_to_one() {
    let light = light();
    // Six standard deviations of the widest part; the tails hold 2e−9 of the probability.
    let widest = 3.0 * light.slope.largest().sqrt();
    let direction = integrate(widest, |x, y| {
        let cos = 1.0 / secant([x, y]);
        light.densities([0.0; 2], [x, y]).direction * cos * cos * cos
    });
    assert!((direction - 1.0).abs() < 1e-8, "{direction}");
    let widest = 3.0 * light.position.largest().sqrt();
    let slope = [3e-3, -2e-3];
    let k = light.position_per_slope;
    let centre = [0, 1].map(|i| k[i][0] * slope[0] + k[i][1] * slope[1]);
    let position = integrate(widest, |x, y| {
        light
            .densities([centre[0] + x, centre[1] + y], slope)
            .position_given_direction
    });
    assert!((position - 1.0).abs() < 1e-8, "{position}");
}

#[test]
fn radiance_integrates_to_the_irradiance() {
    let light = light();
    for local in lit_points().step_by(7) {
        let p = world(local);
        let mean = light.flow(local.to_array()).slope;
        let conditional = light.conditional_slope(
            light.position_per_slope_at(local.z),
            light.radii_sq(light.position_per_slope_at(local.z)).1,
        );
        let half = 3.0 * (1.0 / conditional.x + 1.0 / conditional.y).sqrt();
        // cos θ dω = cos⁴ θ ds_x ds_y
        let irradiance = integrate(half, |x, y| {
            let slope = [mean[0] + x, mean[1] + y];
            let cos = 1.0 / secant(slope);
            let direction = rotated(DVec3::new(slope[0], slope[1], 1.0) * cos);
            light.radiance(p, direction.to_array()) * cos.powi(4)
        });
        let ratio = irradiance / light.irradiance(p);
        assert!((ratio - 1.0).abs() < 1e-7, "{local}: {ratio}");
    }
}

#[test]
fn samples_carry_their_own_densities() {
    let light = light();
    for i in 1..200 {
        let u = [
            0.618_033_988_7,
            0.414_213_562_4,
            0.732_050_807_6,
            0.236_067_977_5,
        ]
        .map(|step| spread(i, step) + 0.5);
        let ray = light.sample_ray(u);
        let pdf = light.ray_pdf(ray.origin, ray.direction);
        // The waist of 1e−5 m is found with 1e−16 m of rounding, and 4 deviations off centre.
        assert!(
            (pdf.position_given_direction / ray.pdf.position_given_direction - 1.0).abs() < 1e-9,
            "{u:?}"
        );
        assert!(
            (pdf.direction / ray.pdf.direction - 1.0).abs() < 1e-9,
            "{u:?}"
        );
        let radiance = light.radiance(ray.origin, ray.direction);
        let flux = radiance * ray.cos / (ray.pdf.position_given_direction * ray.pdf.direction);
        assert!((flux / ray.flux - 1.0).abs() < 1e-9, "{u:?}: {flux}");
    }
    for (local, u) in lit_points().zip([[0.3, 0.9], [0.5, 0.04], [0.77, 0.6]].iter().cycle()) {
        let p = world(local);
        let event = light.next_event_sampled(p, *u).unwrap();
        let radiance = light.radiance(p, event.wi.map(|x| -x));
        let ratio = event.value * event.pdf / radiance;
        assert!((ratio - 1.0).abs() < 1e-8, "{local}: {ratio}");
        let ratio = light.next_event_pdf(p, event.wi) / event.pdf;
        assert!((ratio - 1.0).abs() < 1e-8, "{local}: {ratio}");
    }
}

#[test]
fn sampled_next_events_average_to_the_mean_flow() {
    const SIDE: u32 = 64;
    let light = light();
    for local in lit_points().step_by(9) {
        let p = world(local);
        let mut flux = DVec3::ZERO;
        for i in 0..SIDE * SIDE {
            let u = [i % SIDE, i / SIDE].map(|k| (f64::from(k) + 0.5) / f64::from(SIDE));
            let event = light.next_event_sampled(p, u).unwrap();
            flux -= event.value * DVec3::from(event.wi);
        }
        let mean = flux / f64::from(SIDE * SIDE);
        // value · wi is E (s, 1) exactly, and the midpoints of a symmetric density average to 0.
        let error = mean.distance(light.flux(p).into()) / mean.length();
        assert!(error < 1e-12, "{local}: {error:e}");
    }
}

#[test]
fn rays_have_the_moments_of_the_beam() {
    const RAYS: u32 = 40_000;
    let light = light();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let rays: Vec<_> = (0..RAYS).map(|_| light.draw(random.random())).collect();
    for z in [0.0, 0.1, 0.3] {
        let moments = general().moments_at(z);
        let mean = |f: &dyn Fn([f64; 2], [f64; 2]) -> f64| {
            let at = |&([x, y], s): &([f64; 2], [f64; 2])| f([x + z * s[0], y + z * s[1]], s);
            rays.iter().map(at).sum::<f64>() / f64::from(RAYS)
        };
        for i in 0..2 {
            for j in 0..2 {
                let (xx, ss) = (moments.position, moments.slope);
                let cases = [
                    (
                        mean(&|x, _| x[i] * x[j]),
                        xx.col(j)[i],
                        xx.col(i)[i],
                        xx.col(j)[j],
                    ),
                    (
                        mean(&|x, s| x[i] * s[j]),
                        moments.mixed.col(j)[i],
                        xx.col(i)[i],
                        ss.col(j)[j],
                    ),
                    (
                        mean(&|_, s| s[i] * s[j]),
                        ss.col(j)[i],
                        ss.col(i)[i],
                        ss.col(j)[j],
                    ),
                ];
                for (got, expected, a, b) in cases {
                    // The product of two normal variates has the variance ⟨a²⟩⟨b²⟩ + ⟨ab⟩². Five
                    // deviations are exceeded once in 50 000 runs of the 36 checks.
                    let deviation = ((a * b + expected * expected) / f64::from(RAYS)).sqrt();
                    let error = (got - expected) / deviation;
                    assert!(error.abs() < 5.0, "z = {z}, ({i}, {j}): {error}");
                }
            }
        }
    }
}

#[test]
fn bounds_hold_all_that_is_lit() {
    const EXTENT: f64 = 0.4;
    let light = light();
    let bounds = light.bounds(EXTENT);
    let (min, max) = (DVec3::from(bounds.min), DVec3::from(bounds.max));
    let reach = light.reach(EXTENT);
    let mut lit = 0;
    let mut steepest = 0.0_f64;
    for i in 0..64_000 {
        let local = DVec3::new(
            2.0 * reach.half_width[0] * spread(i, 0.618_033_988_7),
            2.0 * reach.half_width[1] * spread(i, 0.414_213_562_4),
            EXTENT * (spread(i, 0.732_050_807_6) + 0.5),
        );
        let p = world(local);
        let Some(event) = light.next_event(p) else {
            continue;
        };
        lit += 1;
        let point = DVec3::from(p);
        assert!(point.cmpge(min).all() && point.cmple(max).all(), "{local}");
        let angle = (-DVec3::from(event.wi)).angle_between(DVec3::from(bounds.axis));
        steepest = steepest.max(angle);
    }
    assert!(lit > 10_000, "the test must meet the light: {lit}");
    let slack = 1.0 - steepest / bounds.half_angle;
    assert!((0.0..0.3).contains(&slack), "{slack}");
}

#[test]
fn the_widest_points_lie_on_the_bounds() {
    let light = light();
    for l in [0.1, 0.4] {
        let reach = light.reach(l);
        for z in [1e-12, l] {
            // The point of the ellipse xᵀ V⁻¹ x = cutoff² that is farthest along x or y.
            let (v, _) = light.radii_sq(light.position_per_slope_at(z));
            let tip = light.cutoff / v.xx.sqrt();
            let lit = |scale: f64| {
                let p = world(scale * DVec3::new(tip * v.xx, tip * v.xy, 0.0) + z * DVec3::Z);
                light.irradiance(p) > 0.0
            };
            assert!(lit(1.0 - 1e-9) && !lit(1.0 + 1e-9), "z = {z}");
            assert!(light.cutoff * v.xx.sqrt() <= reach.half_width[0], "z = {z}");
            assert!(light.cutoff * v.yy.sqrt() <= reach.half_width[1], "z = {z}");
        }
    }
}

#[test]
fn invalid_powers_are_rejected() {
    for power in [-1e-3, 1e101, f64::NAN, f64::INFINITY] {
        let result = AstigmaticLight::place(&general(), &placement(), power);
        assert!(
            matches!(result, Err(e) if e.parameter() == "power"),
            "{power}"
        );
    }
}

#[test]
fn single_precision_is_refused_where_it_cannot_hold_the_light() {
    // A line of 200 : 1, oblique and upright; a determinant that underflows; too much power.
    let refused = |beam: AstigmaticBeam, power| {
        let light = AstigmaticLight::place(&beam.into(), &placement(), power).unwrap();
        match light.to_f32() {
            Ok(_) => false,
            Err(error) => {
                assert!(error.parameter() == "single_precision", "{error}");
                true
            }
        }
    };
    let thin = AstigmaticBeam::from_divergences(650e-9, [1e-4, 0.3]).unwrap();
    assert!(!refused(thin, 1.0), "along the axes");
    assert!(refused(thin.with_rotation(0.7).unwrap(), 1.0), "oblique");
    let tiny = AstigmaticBeam::from_divergences(1e-14, [0.1, 0.1]).unwrap();
    assert!(refused(tiny, 1.0), "an area of 1e−54 m⁴");
    assert!(refused(elliptic(), 1e32), "the irradiance overflows");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Rounding moves a point by ε|p| and that changes ln E by 4 x/w² times as much, x ≤ ρ w.
    #[test]
    fn single_precision_errs_by_the_rounding_of_coordinates(
        rho in 0.0..1.5_f64,
        azimuth in 0.0..6.3_f64,
        z in 0.0..0.5_f64,
    ) {
        let light = light();
        let (v, determinant) = light.radii_sq(light.position_per_slope_at(z));
        let (sin, cos) = azimuth.sin_cos();
        let factors = v.factors_with(determinant);
        let [x, y] = factors.spread([2.0 * rho * cos, 2.0 * rho * sin]);
        let p = world(DVec3::new(x, y, z));
        let single = p.map(<f32 as Scalar>::of);
        let double = single.map(f64::from);
        let got = f64::from(light.to_f32().unwrap().irradiance(single));
        let error = got / light.irradiance(double) - 1.0;
        // The smallest radius: det V is the product of the two squared radii.
        let w = (determinant / v.largest()).sqrt();
        // Origin, three axes and the difference are each rounded by ε/2 of less than 1 m.
        let epsilon = f64::from(f32::EPSILON);
        let moved = 4.0 * epsilon * DVec3::from(double).length().max(0.5);
        let ratio = |e: Ellipse<f64>| e.largest().powi(2) / e.determinant();
        let oblique = epsilon * (ratio(light.position) + ratio(light.slope));
        let bound = 4.0 * rho.max(0.1) * moved / w + 4.0 * (moved / w).powi(2) + oblique + 2e-6;
        prop_assert!(error.abs() <= bound, "{} > {}", error, bound);
    }

    #[test]
    fn no_finite_point_yields_nan(
        x in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        y in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        z in proptest::num::f64::NORMAL | proptest::num::f64::ZERO,
        near in any::<bool>(),
        u in 0.0..1.0_f64,
    ) {
        let light = light();
        let p = if near { world(DVec3::new(x.sin() * 1e-3, y.sin() * 1e-3, z.abs())) } else { [x, y, z] };
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
