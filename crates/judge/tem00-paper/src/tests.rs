//! The sampler of rays of section 4: a uniform point of the aperture disc, a uniform direction of
//! the modified cone.

use core::f64::consts::{PI, TAU};

use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00_beam::{GaussianBeam, LocatedBeam};
use tem00_numerics::quadrature::integrate;
use tem00_testkit::assert_absolute;

/// The modified divergence `θ′ = θ √(−½ ln l)`, which reaches down to the fraction `l` of the peak.
fn modified_divergence(beam: &GaussianBeam, l: f64) -> f64 {
    beam.divergence() * (-0.5 * l.ln()).sqrt()
}

struct Sampler {
    aperture_radius: f64,
    half_angle: f64,
}

struct Ray {
    origin: DVec3,
    direction: DVec3,
    pdf_position: f64,
    pdf_direction: f64,
}

impl Sampler {
    fn new(beam: &LocatedBeam, l: f64) -> Self {
        Self {
            aperture_radius: beam.radius_at(0.0),
            half_angle: modified_divergence(beam.beam(), l),
        }
    }

    fn sample(&self, u: [f64; 4]) -> Ray {
        let radius = self.aperture_radius * u[0].sqrt();
        // 1 − cos θ′, without cancellation in a narrow cone.
        let height = 2.0 * (0.5 * self.half_angle).sin().powi(2);
        let drop = u[2] * height;
        let sine = (drop * (2.0 - drop)).sqrt();
        let around = |turns: f64, radius: f64, z: f64| {
            let (sin, cos) = (TAU * turns).sin_cos();
            DVec3::new(radius * cos, radius * sin, z)
        };
        Ray {
            origin: around(u[1], radius, 0.0),
            direction: around(u[3], sine, 1.0 - drop),
            pdf_position: 1.0 / (PI * self.aperture_radius * self.aperture_radius),
            pdf_direction: 1.0 / (TAU * height),
        }
    }
}

fn beam() -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, 50e-6).unwrap()
}

/// The beam with its waist at the signed distance `waist` from the aperture.
fn located(waist: f64) -> LocatedBeam {
    LocatedBeam::new(beam(), waist).unwrap()
}

#[test]
fn the_cone_loses_what_is_beyond_it() {
    let delta = beam().divergence();
    for l in [0.5, (-2.0_f64).exp(), 1e-2, 1e-4] {
        let edge = modified_divergence(&beam(), l);
        let profile = |s: f64| (-2.0 * (s / delta).powi(2)).exp();
        assert!((profile(edge) / l - 1.0).abs() < 1e-12, "l = {l}");
        let norm = 2.0 / (PI * delta * delta);
        let inside = integrate(|s| norm * profile(s) * TAU * s, [0.0, edge], 0.25 * edge);
        assert!((1.0 - inside - l).abs() < 1e-8, "l = {l}: {inside}");
        let norm = 2.0 * (2.0 / PI).sqrt() / delta;
        let inside = integrate(|s| norm * profile(s), [0.0, edge], 0.25 * edge);
        let lost = libm::erfc((-l.ln()).sqrt());
        assert_absolute(1.0 - inside, lost, 1e-8);
    }
}

#[test]
fn the_literal_weight_adds_up_to_power_times_solid_angle() {
    const COUNT: u32 = 40_000;
    let l = 1e-4;
    let z = 1.0;
    let sampler = Sampler::new(&located(0.0), l);
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..COUNT {
        let ray = sampler.sample(rng.random());
        let hit = ray.origin + ray.direction * (z / ray.direction.z);
        let irradiance = beam().irradiance_per_watt(hit.truncate().length(), z);
        // The surface is perpendicular to the axis, so cos θ_s is cos θ and cancels.
        let weight = irradiance / (ray.pdf_position * ray.pdf_direction);
        sum += weight / f64::from(COUNT);
        squares += weight * weight / f64::from(COUNT);
    }
    let error = ((squares - sum * sum) / f64::from(COUNT)).sqrt();
    let solid_angle = PI * (50e-6 / z).powi(2);
    // A fraction l, and (w_A / w)² = 1.5e−4 more at the rim, falls outside the cone.
    let bias = 3e-4 * solid_angle;
    assert_absolute(sum, solid_angle, 3.9 * error + bias);
    assert!(
        error < 0.02 * solid_angle,
        "the test must be sharp: {error:e}"
    );
}

/// The overlap of two discs of the radii `a` and `b` whose centres are `d` apart.
fn shared_area(a: f64, b: f64, d: f64) -> f64 {
    let smaller = a.min(b);
    if d <= (a - b).abs() {
        return PI * smaller * smaller;
    }
    if d >= a + b {
        return 0.0;
    }
    let sector = |r: f64, other: f64| {
        let cos = (d * d + r * r - other * other) / (2.0 * d * r);
        r * r * cos.acos()
    };
    let kite = (a + b - d) * (d + a - b) * (d - a + b) * (a + b + d);
    sector(a, b) + sector(b, a) - 0.5 * kite.sqrt()
}

#[test]
fn the_printed_sampler_misses_light_unless_the_waist_is_on_the_aperture() {
    const COUNT: u32 = 40_000;
    let l = 1e-2;
    for (waist, z, lost) in [(-0.15, 0.05, 0.84), (0.15, 0.05, 0.76), (-0.15, 0.15, 0.40)] {
        let sampler = Sampler::new(&located(waist), l);
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        let weights = (0..COUNT).map(|_| {
            let ray = sampler.sample(rng.random());
            let hit = ray.origin + ray.direction * (z / ray.direction.z);
            let irradiance = beam().irradiance_per_watt(hit.truncate().length(), z - waist);
            // Per solid angle of the disc, which makes it a power.
            let solid_angle = PI * (sampler.aperture_radius / z).powi(2);
            irradiance / (ray.pdf_position * ray.pdf_direction * solid_angle)
        });
        let (sum, squares) = weights.fold((0.0, 0.0), |(sum, squares), weight| {
            (sum + weight, squares + weight * weight)
        });
        let count = f64::from(COUNT);
        let found = sum / count;
        let error = ((squares / count - found * found) / count).sqrt();

        // A point is hit as often as the disc of the cone around it overlaps the aperture.
        let (disc, cone) = (sampler.aperture_radius, sampler.half_angle.tan() * z);
        let hits = |r: f64| shared_area(disc, cone, r) / (PI * disc * disc);
        let expected = integrate(
            |r| TAU * r * hits(r) * beam().irradiance_per_watt(r, z - waist),
            [0.0, disc + cone],
            0.01 * (disc + cone),
        );
        assert_absolute(found, expected, 3.9 * error);
        assert_absolute(1.0 - expected, lost, 0.01);
    }
}
