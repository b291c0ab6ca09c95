//! The joint density of a ray in both of its factorings: they agree, their parts integrate to 1,
//! and rays are where the density of the position says.

use tem00_beam::{DVec3, Emitter, LaserLine, RayPdf};
use tem00_testkit::{Numbers, assert_absolute, chi_squared};

use super::fans;
use crate::lights::{UPRIGHT, elliptic_light, end_of, place, slopes};

/// `σ_b/r`: the angle, on the axis, that the rays of a point of the lens differ by.
const APEX_ANGLE: f64 = 4.1e-4;

fn pdf(light: &dyn Emitter, [x, y]: [f64; 2], [s, t]: [f64; 2]) -> RayPdf {
    let direction = DVec3::new(s, t, 1.0).normalize();
    light.ray_pdf([x, y, 0.0], direction.to_array())
}

/// ∫ f(s) ds over `count` steps of `h` on either side of `centre`.
fn integrate(centre: f64, h: f64, count: i32, f: impl Fn(f64) -> f64) -> f64 {
    (-count..=count)
        .map(|i| f(centre + f64::from(i) * h))
        .sum::<f64>()
        * h
}

#[test]
fn the_direction_at_a_position_of_a_beam_has_a_density() {
    let light = elliptic_light(0.0, &UPRIGHT);
    let mut numbers = Numbers::new(6);
    for _ in 0..8 {
        let [x, y, _] = light.sample_ray(numbers.units()).origin;
        let mean = light
            .flux([x, y, 0.0])
            .map(|f| f / light.irradiance([x, y, 0.0]));
        // Slopes up to 0.1 on either side of the mean, which 20 σ do not exceed.
        let sum = integrate(mean[0], 2e-4, 500, |s| {
            integrate(mean[1], 2e-4, 500, |t| {
                let cos = (1.0 + s * s + t * t).sqrt().recip();
                pdf(&*light, [x, y], [s, t]).direction_given_position * cos.powi(3)
            })
        });
        assert_absolute(sum, 1.0, 1e-9);
    }
}

/// ∫ of the density of the direction at (x, y) on the lens of a line, over all directions.
fn directions_at(line: &LaserLine, [x, y]: [f64; 2]) -> f64 {
    let light = place(line, &UPRIGHT);
    let z_a = line.fan().apex_offset;
    let sec = 1_f64.hypot(x / z_a);
    let from_waist = z_a * sec - line.waist_slant_distance_at(x / z_a);
    let focus = line.focus();
    let w = focus.radius_at(from_waist);
    let spread = 0.5 * focus.waist_radius() * focus.divergence() / w * sec;
    let mean = y * focus.curvature_at(from_waist) * sec;
    let width = 0.5 * line.source_radius() / z_a * sec;
    // The density jumps at the ends of some profiles, which are to lie in the middle of a step.
    let (h, end) = (0.01 * width, end_of(line));
    let centre = end + (((x / z_a - end) / h).round() + 0.5) * h;
    integrate(centre, h, 800, |s| {
        integrate(mean, 0.5 * spread, 16, |t| {
            let cos = (1.0 + s * s + t * t).sqrt().recip();
            pdf(&*light, [x, y], [s, t]).direction_given_position * cos.powi(3)
        })
    })
}

#[test]
fn the_direction_at_a_position_of_a_line_has_a_density() {
    for line in fans() {
        assert!(0.5 * line.source_radius() < APEX_ANGLE * 1e-3, "{line:?}");
        for x in [0.0, 0.1e-3, -0.2e-3] {
            assert_absolute(directions_at(&line, [x, 2e-4]), 1.0, 1e-5);
        }
    }
}

#[test]
fn beside_an_abrupt_end_the_density_is_good_to_first_order() {
    for line in fans() {
        let end = end_of(&line) * line.fan().apex_offset;
        for deviations in [-2.0, -0.5, 0.0, 0.5, 2.0] {
            let x = end + deviations * 0.5 * line.source_radius();
            assert_absolute(directions_at(&line, [x, 2e-4]), 1.0, 4.0 * APEX_ANGLE);
        }
    }
}

#[test]
fn the_density_of_the_position_on_the_lens_integrates_to_one() {
    for line in fans() {
        let light = place(&line, &UPRIGHT);
        let z_a = line.fan().apex_offset;
        let mut sum = 0.0;
        for (u, du) in slopes(&line) {
            let r = z_a * 1_f64.hypot(u);
            let w = line.focus().radius_at(r - line.waist_slant_distance_at(u));
            let across = |y| pdf(&*light, [u * z_a, y], [u, 0.0]).position;
            sum += integrate(0.0, 0.25 * w, 16, across) * z_a * du;
        }
        // What an abrupt end loses beyond itself, 0.4 σ of the 2 × 0.26 in slope, at both ends.
        assert_absolute(sum, 1.0, 2.0 * APEX_ANGLE);
    }
}

/// Holds the positions of drawn rays along x, in bins up to ±`half`, against their density there.
#[track_caller]
fn check_positions(light: &dyn Emitter, half: f64, y: f64) {
    const BINS: usize = 16;
    const RAYS: u32 = 60_000;
    const FINE: i32 = 10;
    let mut numbers = Numbers::new(7);
    let mut counts = [0.0; BINS];
    for _ in 0..RAYS {
        let x = light.sample_ray(numbers.units()).origin[0];
        let place = 0.5 * (x / half + 1.0) * BINS as f64;
        if let Some(bin) = (0..BINS).find(|&bin| (bin as f64..(bin + 1) as f64).contains(&place)) {
            counts[bin] += 1.0;
        }
    }
    let width = 2.0 * half / BINS as f64;
    let along = |x| integrate(0.0, 0.02 * y, 50, |y| pdf(light, [x, y], [0.0; 2]).position);
    let expected: [f64; BINS] = core::array::from_fn(|bin| {
        let middle = (bin as f64 + 0.5) * width - half;
        let h = width / f64::from(2 * FINE + 1);
        f64::from(RAYS) * integrate(middle, h, FINE, along)
    });
    let p = chi_squared(&counts, &expected, 0);
    assert!(p > 1e-4, "p = {p}");
}

#[test]
fn rays_leave_the_aperture_with_the_density_of_their_positions() {
    check_positions(&*elliptic_light(0.0, &UPRIGHT), 150e-6, 1e-3);
    for line in fans() {
        check_positions(&*place(&line, &UPRIGHT), 0.2e-3, 2e-3);
    }
}
