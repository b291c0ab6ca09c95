//! Straight rays, drawn from the phase-space density, carry the beam: its radius, its curvature and
//! its irradiance on any surface; and evaluation, sampling and densities agree.
//!
//! All seeds are fixed. A correct sampler fails a single test with a probability of about 1e−4,
//! stated where it is used.

use tem00_beam::{
    DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, Placement, RaySample,
    SpotLight,
};
use tem00_testkit::{Numbers, assert_absolute, assert_relative, chi_squared};

use crate::lights::{POWER, beam, elliptic, elliptic_light, lines, place};

/// Standard normal variates exceed this magnitude with probability 1e−4.
const SIGMAS: f64 = 3.9;

/// A frame in general position.
const PLACEMENT: Placement = Placement {
    origin: DVec3::new(0.1, -0.2, 0.3),
    direction: DVec3::new(0.3, -0.5, 0.8),
    fan_axis: DVec3::new(1.0, 0.2, 0.1),
};

/// A fan of 30° from an apex 2 mm behind the lens, in focus at 0.2 m.
const FAN: FanGeometry = FanGeometry {
    fan_angle: 0.523_598_775_598_298_8,
    apex_offset: 2e-3,
    focus_distance: 0.2,
    focus_curve: FocusCurve::EqualDistance,
};

fn spot(waist: f64, m_squared: f64, waist_distance: f64) -> (GaussianBeam, SpotLight) {
    let beam = beam(waist).with_m_squared(m_squared).expect("a valid beam");
    let light = SpotLight::place(&beam, waist_distance, &PLACEMENT, POWER);
    (beam, light.expect("a valid light"))
}

/// Every line, a spot and an elliptic beam.
fn lights(lasers: &[LaserLine]) -> impl Iterator<Item = Box<dyn Emitter + '_>> {
    let (_, spot) = spot(50e-6, 1.3, 0.15);
    let lines = lasers.iter().map(|line| place(line, &PLACEMENT));
    lines.chain([Box::new(spot) as _, elliptic_light(0.4, &PLACEMENT)])
}

/// The local axes of all lights.
fn axes() -> [DVec3; 3] {
    let ez = PLACEMENT.direction.normalize();
    let ey = ez.cross(PLACEMENT.fan_axis).normalize();
    [ey.cross(ez), ey, ez]
}

fn rotated(local: DVec3) -> DVec3 {
    let [ex, ey, ez] = axes();
    local.x * ex + local.y * ey + local.z * ez
}

/// World coordinates of a point given in the frame of the light.
fn world(local: DVec3) -> [f64; 3] {
    (PLACEMENT.origin + rotated(local)).to_array()
}

fn rays(light: &dyn Emitter, count: usize) -> Vec<RaySample> {
    let mut numbers = Numbers::new(2016);
    (0..count)
        .map(|_| light.sample_ray(numbers.units()))
        .collect()
}

/// The position and slope of a ray, in the frame of the light, at the distance z.
fn crossing(ray: &RaySample, z: f64) -> (DVec3, DVec3) {
    let local = |v: DVec3| DVec3::from(axes().map(|axis| v.dot(axis)));
    let origin = local(DVec3::from(ray.origin) - PLACEMENT.origin);
    let direction = local(DVec3::from(ray.direction));
    let slope = direction / direction.z;
    (origin + slope * (z - origin.z), slope)
}

#[test]
fn rays_of_a_spot_reproduce_radius_and_curvature() {
    const COUNT: usize = 100_000;
    let n = COUNT as f64;
    for m_squared in [1.0, 3.0] {
        let (beam, light) = spot(50e-6, m_squared, 0.15);
        let rays = rays(&light, COUNT);
        for z in [0.0, 0.1, 0.15, 0.2, 1.0] {
            let mut sums = [0.0; 5];
            for ray in &rays {
                let (p, s) = crossing(ray, z);
                let terms = [p.x, p.y, p.x * p.x, p.y * p.y, p.x * s.x];
                sums = core::array::from_fn(|i| sums[i] + terms[i] / n);
            }
            let [x, y, xx, yy, xs] = sums;
            let sigma = 0.5 * beam.radius_at(z - 0.15);
            // The variance of n normal variates has a relative deviation of √(2/n).
            for (mean, variance) in [(x, xx), (y, yy)] {
                assert_absolute(mean, 0.0, SIGMAS * sigma / n.sqrt());
                assert_relative(variance, sigma * sigma, SIGMAS * (2.0 / n).sqrt());
            }
            // The slope at a given x is spread by w₀ δ / 2w about x / R.
            let spread = 0.25 * beam.waist_radius() * beam.divergence() / sigma;
            let tolerance = SIGMAS * spread / (sigma * n.sqrt());
            assert_absolute(xs / xx, beam.curvature_at(z - 0.15), tolerance);
        }
    }
}

#[test]
fn rays_of_a_wide_fan_pass_apex_and_waist_within_diffraction() {
    const COUNT: usize = 50_000;
    let n = COUNT as f64;
    let fan = FanGeometry {
        fan_angle: 120_f64.to_radians(),
        apex_offset: 0.3,
        ..FAN
    };
    for line in lines(fan) {
        let light = place(&line, &PLACEMENT);
        let [mut at_apex, mut at_waist] = [0.0; 2];
        for ray in rays(&*light, COUNT) {
            let (p, s) = crossing(&ray, 0.0);
            let sec = 1_f64.hypot(s.x);
            let b = (p.x - fan.apex_offset * s.x) / sec;
            let along = (p.x * s.x + fan.apex_offset) / sec;
            let y = p.y + s.y / sec * (line.waist_slant_distance_at(s.x) - along);
            at_apex += (2.0 * b / line.source_radius()).powi(2) / n;
            at_waist += (2.0 * y / line.focus().waist_radius()).powi(2) / n;
        }
        for mean_square in [at_apex, at_waist] {
            assert_relative(mean_square, 1.0, SIGMAS * (2.0 / n).sqrt());
        }
    }
}

/// Bins on each side of a rectangle, points of the quadrature on each side of a bin, and rays.
const BINS: usize = 16;
const FINE: usize = 12;
const RAYS: usize = 60_000;

/// Holds samples (s, t) in bins up to ±`half` against their probability density, over `min` bins
/// or more that expect ten samples.
#[track_caller]
fn check_samples(
    samples: impl ExactSizeIterator<Item = [f64; 2]>,
    density: impl Fn(f64, f64) -> f64,
    half: [f64; 2],
    min: usize,
) {
    let count = samples.len() as f64;
    let mut counts = vec![0.0; BINS * BINS];
    let bin = |s: f64, half: f64| {
        let t = (s / half + 1.0) * 0.5 * BINS as f64;
        (0..BINS).find(|&bin| (bin as f64..(bin + 1) as f64).contains(&t))
    };
    for [s, t] in samples {
        if let (Some(i), Some(j)) = (bin(s, half[0]), bin(t, half[1])) {
            counts[i * BINS + j] += 1.0;
        }
    }
    let [a, b] = half.map(|half| 2.0 * half / (BINS * FINE) as f64);
    let at = |i: usize, j: usize| {
        let middle = |i: usize, h: f64, half: f64| (i as f64 + 0.5) * h - half;
        density(middle(i, a, half[0]), middle(j, b, half[1]))
    };
    let expected = |bin: usize| {
        let (i, j) = (bin / BINS * FINE, bin % BINS * FINE);
        let cells = (i..i + FINE).flat_map(|i| (j..j + FINE).map(move |j| (i, j)));
        cells.map(|(i, j)| at(i, j)).sum::<f64>() * a * b * count
    };
    let bins = (0..BINS * BINS).map(|bin| (counts[bin], expected(bin)));
    let (counts, expected): (Vec<_>, Vec<_>) =
        bins.filter(|&(_, expected)| expected > 10.0).unzip();
    assert!(counts.len() > min, "{} bins", counts.len());
    let p = chi_squared(&counts, &expected, 0);
    assert!(p > 1e-4, "p = {p}");
}

/// Holds rays that hit a rectangle, tilted by `tilt` degrees, against next-event irradiance.
#[track_caller]
fn check_surface(light: &dyn Emitter, z: f64, tilt: f64, half: [f64; 2], min: usize) {
    let (sin, cos) = tilt.to_radians().sin_cos();
    let (along, centre) = (DVec3::new(cos, 0.0, sin), DVec3::new(0.0, 0.0, z));
    let normal = along.cross(DVec3::Y);
    let rays = rays(light, RAYS);
    let hits = rays.iter().map(|ray| {
        let (p, s) = crossing(ray, 0.0);
        let hit = p + s * (normal.dot(centre - p) / normal.dot(s)) - centre;
        [hit.dot(along), hit.y]
    });
    let irradiance = |s: f64, t: f64| {
        let event = light.next_event(world(centre + along * s + DVec3::Y * t));
        event.map_or(0.0, |event| {
            event.e_perp * DVec3::from(event.wi).dot(rotated(normal)).abs()
        })
    };
    check_samples(hits, |s, t| irradiance(s, t) / POWER, half, min);
}

#[test]
fn rays_of_beams_reproduce_the_irradiance_of_tilted_surfaces() {
    let (beam, light) = spot(5e-6, 1.0, 0.02);
    let w = beam.radius_at(0.03);
    check_surface(&light, 0.05, 60.0, [3.0 * w, 1.6 * w], 100);
    let light = elliptic_light(0.4, &PLACEMENT);
    for z in [0.01, 0.05, 0.3] {
        let [a, b] = elliptic(0.4).radii_at(z);
        let w = (a * b).sqrt();
        check_surface(&*light, z, 60.0, [3.0 * w, 1.6 * w], 60);
    }
}

#[test]
fn rays_of_a_line_reproduce_the_irradiance_of_tilted_surfaces() {
    for line in lines(FAN) {
        let light = place(&line, &PLACEMENT);
        for z in [0.02, 0.2, 0.4] {
            let half = [line.half_length_at(z), 2.0 * line.half_thickness_at(z)];
            check_surface(&*light, z, 50.0, half, 100);
        }
    }
}

/// Holds the slopes of rays against the density of their directions.
#[track_caller]
fn check_directions(light: &dyn Emitter, half: [f64; 2]) {
    let rays = rays(light, RAYS);
    let slopes = rays.iter().map(|ray| {
        let (_, slope) = crossing(ray, 0.0);
        [slope.x, slope.y]
    });
    // dω = cos³ ds_x ds_y
    let density = |s: f64, t: f64| {
        let slope = DVec3::new(s, t, 1.0);
        let direction = rotated(slope.normalize()).to_array();
        let pdf = light.ray_pdf(PLACEMENT.origin.to_array(), direction);
        pdf.direction * slope.length().powi(-3)
    };
    check_samples(slopes, density, half, 100);
}

#[test]
fn rays_have_the_density_of_their_directions() {
    let (round, light) = spot(20e-6, 1.3, 0.1);
    check_directions(&light, [1.2 * round.divergence(); 2]);
    let [a, b] = elliptic(0.4).axes().map(|axis| axis.beam().divergence());
    check_directions(&*elliptic_light(0.4, &PLACEMENT), [1.2 * (a * b).sqrt(); 2]);
    for line in lines(FAN) {
        // Bins of slope that end at the edges of the top hats, where their density jumps.
        let half_slope = 4.0 / 3.0 * line.half_slope();
        let half = [half_slope, 1.2 * line.focus().divergence()];
        check_directions(&*place(&line, &PLACEMENT), half);
    }
}

/// ∫ L cos dω over the slopes about `centre`, within nine `sigma`, with `dω = cos³ ds_x ds_y`.
fn integrate_radiance(light: &dyn Emitter, p: [f64; 3], centre: [f64; 2], sigma: [f64; 2]) -> f64 {
    let [h_x, h_y] = sigma.map(|sigma| 0.25 * sigma);
    let at = |i: i32, j: i32| {
        let [x, y] = [f64::from(i) * h_x, f64::from(j) * h_y];
        let slope = DVec3::new(centre[0] + x, centre[1] + y, 1.0);
        let direction = rotated(slope.normalize()).to_array();
        light.radiance(p, direction) * slope.length().powi(-4)
    };
    let steps = || -36..=36;
    let row = |i: i32| steps().map(move |j| at(i, j)).sum::<f64>();
    steps().map(row).sum::<f64>() * h_x * h_y
}

#[test]
fn radiance_of_a_spot_integrates_to_the_irradiance() {
    for m_squared in [1.0, 3.0] {
        let (beam, light) = spot(50e-6, m_squared, 0.15);
        for z in [0.001, 0.14, 0.4] {
            let w = beam.radius_at(z - 0.15);
            let p = world(DVec3::new(0.5 * w, -0.7 * w, z));
            let slope = [0.5 * w, -0.7 * w].map(|x| x * beam.curvature_at(z - 0.15));
            let spread = 0.5 * beam.waist_radius() * beam.divergence() / w;
            let sum = integrate_radiance(&light, p, slope, [spread; 2]);
            // Rounding of world coordinates: 1e−16 m beside beam radii of 1e−4 m.
            assert_relative(sum, light.irradiance(p), 1e-10);
        }
    }
}

#[test]
fn radiance_of_a_line_integrates_to_the_irradiance() {
    for line in lines(FAN) {
        let light = place(&line, &PLACEMENT);
        for (u, z) in [(0.0, 0.1), (0.2, 0.19), (-0.25, 0.4)] {
            let sec = 1_f64.hypot(u);
            let r = (z + FAN.apex_offset) * sec;
            let from_waist = r - line.waist_slant_distance_at(u);
            let w = line.focus().radius_at(from_waist);
            let p = world(DVec3::new(u * (z + FAN.apex_offset), 0.6 * w, z));
            let slope_y = 0.6 * w * line.focus().curvature_at(from_waist) * sec;
            let spread_x = 0.5 * line.source_radius() / r * sec * sec;
            let spread_y = 0.5 * line.focus().waist_radius() * line.focus().divergence() / w * sec;
            let sum = integrate_radiance(&*light, p, [u, slope_y], [spread_x, spread_y]);
            // The closed form neglects (w_b / r)² = 6e−11 and smaller, times the curvature of the
            // profile, 1e2; coordinates of 0.5 m are rounded to 1e−16 m beside w_b = 8e−7 m.
            assert_relative(sum, light.irradiance(p), 2e-8);
        }
    }
}

#[test]
fn radiance_times_cosine_over_densities_is_the_power() {
    let lasers: Vec<LaserLine> = lines(FAN).collect();
    for light in lights(&lasers) {
        for ray in rays(&*light, 1000) {
            let (drawn, asked) = (ray.pdf, light.ray_pdf(ray.origin, ray.direction));
            let joint = drawn.direction * drawn.position_given_direction;
            // Rounding of world coordinates, 1e−16 m, beside a source of 4e−7 m, five σ out.
            let given = asked.position_given_direction;
            assert_relative(given, drawn.position_given_direction, 1e-8);
            assert_relative(asked.direction, drawn.direction, 1e-8);
            let radiance = light.radiance(ray.origin, ray.direction);
            assert_relative(radiance * ray.cos / joint, ray.flux, 1e-8);
            // Up to 20 from exponents of as many units, cancelled down from 1e−4 m.
            let other = drawn.position * drawn.direction_given_position;
            assert_relative(other, joint, 1e-11);
        }
    }
}

/// Holds the mean of sampled next events, on a tilted surface, against the delta form.
fn check_sampled_mean(light: &dyn Emitter, local: DVec3) {
    const COUNT: usize = 20_000;
    let p = world(local);
    let n = rotated(DVec3::new(0.3, 0.8, -0.4).normalize());
    let delta = light.next_event(p).expect("the point is lit");
    let expected = delta.e_perp * DVec3::from(delta.wi).dot(n);
    let mut numbers = Numbers::new(2016);
    let (mut mean, mut square) = (0.0, 0.0);
    for _ in 0..COUNT {
        let event = light.next_event_sampled(p, numbers.units());
        let event = event.expect("the point is lit");
        let term = event.value * DVec3::from(event.wi).dot(n);
        mean += term / COUNT as f64;
        square += term * term / COUNT as f64;
    }
    // The line's closed form is off by (w_b / r)² = 6e−11, far below the standard error.
    let error = ((square - mean * mean) / COUNT as f64).sqrt();
    assert_absolute(mean, expected, SIGMAS * error);
    assert!(error < 0.01 * expected, "the test must be sharp: {error}");
}

#[test]
fn sampled_next_events_average_to_the_delta_form() {
    let (beam, spot) = spot(5e-6, 1.0, 0.02);
    let w = beam.radius_at(0.03);
    check_sampled_mean(&spot, DVec3::new(0.7 * w, 0.4 * w, 0.05));
    for line in lines(FAN) {
        let thickness = line.half_thickness_at(0.1);
        let point = DVec3::new(0.02, thickness, 0.1);
        check_sampled_mean(&*place(&line, &PLACEMENT), point);
    }
}

#[test]
fn uniforms_at_their_ends_give_finite_rays() {
    let lasers: Vec<LaserLine> = lines(FAN).collect();
    let last = 1.0 - f64::EPSILON / 2.0;
    for light in lights(&lasers) {
        for bits in 0..16 {
            let u = core::array::from_fn(|i| if bits >> i & 1 == 0 { 0.0 } else { last });
            let ray = light.sample_ray(u);
            assert!(DVec3::from(ray.origin).is_finite(), "{ray:?}");
            assert_absolute(DVec3::from(ray.direction).length(), 1.0, 1e-15);
            let pdf = [ray.pdf.position_given_direction, ray.pdf.direction];
            assert!(pdf.iter().all(|&pdf| pdf > 0.0), "{ray:?}");
        }
    }
}
