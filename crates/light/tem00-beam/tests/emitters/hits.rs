//! Light that a material's ray meets, beside sampled next events.

use tem00_beam::{DVec3, Emitter, LaserLine, SpotLight};
use tem00_testkit::{Numbers, assert_absolute, assert_relative};

use super::{fans, lights};
use crate::lights::{POWER, UPRIGHT, beam, place};

/// A lobe about the axis: slopes are normal with this deviation.
#[derive(Clone, Copy)]
struct Lobe {
    mean: [f64; 2],
    deviation: [f64; 2],
}

impl Lobe {
    /// A direction towards the light, drawn by a pair of uniforms (Box and Muller 1958).
    fn draw(&self, u: [f64; 2]) -> DVec3 {
        let (sin, cos) = (core::f64::consts::TAU * u[1]).sin_cos();
        let r = (-2.0 * (1.0 - u[0]).ln()).sqrt();
        let slope = [r * cos, r * sin];
        let [x, y] = [0, 1].map(|i| self.mean[i] + self.deviation[i] * slope[i]);
        -DVec3::new(x, y, 1.0).normalize()
    }

    /// The density of a direction, per steradian.
    fn pdf(&self, wi: DVec3) -> f64 {
        let slope = [wi.x / wi.z, wi.y / wi.z];
        let t = [0, 1].map(|i| (slope[i] - self.mean[i]) / self.deviation[i]);
        let peak = 1.0 / (core::f64::consts::TAU * self.deviation[0] * self.deviation[1]);
        peak * (-0.5 * (t[0] * t[0] + t[1] * t[1])).exp() / wi.z.abs().powi(3)
    }
}

/// Means and standard errors of the irradiance of a plane square to the axis, from sampled next
/// events, from rays of the lobe, and from both with the balance heuristic.
fn estimates(light: &dyn Emitter, p: [f64; 3], lobe: Lobe) -> [(f64, f64); 3] {
    const COUNT: u32 = 20_000;
    let mut numbers = Numbers::new(11);
    let mut sums = [[0.0; 2]; 3];
    for _ in 0..COUNT {
        let event = light
            .next_event_sampled(p, numbers.units())
            .expect("the point is lit");
        let towards = DVec3::from(event.wi);
        let sampled = event.value * towards.z.abs();
        let weight = event.pdf / (event.pdf + lobe.pdf(towards));

        let wi = lobe.draw(numbers.units());
        let q = lobe.pdf(wi);
        let hit = light.hit(p, wi.to_array());
        let met = hit.map_or(0.0, |hit| hit.radiance * wi.z.abs() / q);
        let share = hit.map_or(0.0, |hit| q / (q + hit.pdf));

        let terms = [sampled, met, weight * sampled + share * met];
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum = [sum[0] + term, sum[1] + term * term];
        }
    }
    sums.map(|[sum, squares]| {
        let n = f64::from(COUNT);
        let mean = sum / n;
        (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt())
    })
}

/// Holds the three estimates against the irradiance within four standard errors, or, where an
/// estimate has next to no variance, the rounding of coordinates.
fn check(light: &dyn Emitter, p: [f64; 3], lobe: Lobe) {
    let expected = light.irradiance(p);
    for (mean, error) in estimates(light, p, lobe) {
        assert_absolute(mean, expected, 4.0 * error + 1e-7 * expected);
        assert!(error < 0.05 * expected, "the test must be sharp: {error}");
    }
}

#[test]
fn sampled_events_and_rays_of_a_material_share_the_light_of_a_beam() {
    let beam = beam(3e-6);
    let light = SpotLight::place(&beam, 20e-6, &UPRIGHT, POWER).expect("a valid light");
    for (z, x) in [(1e-6, 2e-6), (40e-6, 1e-6), (100e-6, -4e-6)] {
        let w = beam.radius_at(z - 20e-6);
        let spread = 0.5 * beam.waist_radius() * beam.divergence() / w;
        let slope = x * beam.curvature_at(z - 20e-6);
        let lobe = Lobe {
            mean: [slope + spread, 0.0],
            deviation: [2.0 * spread, 1.5 * spread],
        };
        check(&light, [x, 0.0, z], lobe);
    }
}

#[test]
fn sampled_events_and_rays_of_a_material_share_the_light_of_a_line() {
    for line in fans() {
        let focus = line.focus();
        let u = 0.1;
        let z_a = line.fan().apex_offset;
        let (x, z) = (u * (0.02 + z_a), 0.02);
        let r = (z + z_a) * 1_f64.hypot(u);
        let w = focus.radius_at(r - line.waist_slant_distance_at(u));
        let spread_y = 0.5 * focus.waist_radius() * focus.divergence() / w;
        let spread_x = 0.5 * line.source_radius() / r;
        let lobe = Lobe {
            mean: [u + spread_x, spread_y],
            deviation: [2.0 * spread_x, 2.0 * spread_y],
        };
        check(&*place(&line, &UPRIGHT), [x, 0.0, z], lobe);
    }
}

#[test]
fn a_hit_is_the_sampled_event_of_its_direction() {
    let lasers: Vec<LaserLine> = fans().collect();
    let mut numbers = Numbers::new(12);
    for light in lights(&lasers) {
        let p = [1e-5, 2e-5, 0.03];
        for _ in 0..200 {
            let event = light
                .next_event_sampled(p, numbers.units())
                .expect("the point is lit");
            let hit = light.hit(p, event.wi).expect("a ray of the light");
            let miss = DVec3::from(hit.point).distance(event.point.into());
            assert!(miss < 1e-16, "{miss:e}");
            assert_absolute(hit.distance, event.distance, 1e-16);
            // 1e−18 m of rounding beside a source of 4e−7 m, five σ out.
            assert_relative(hit.pdf, event.pdf, 1e-9);
            assert_relative(hit.radiance, event.value * event.pdf, 1e-9);
            let travel = event.wi.map(|x| -x);
            let asked = [light.next_event_pdf(p, event.wi), light.radiance(p, travel)];
            let met = [hit.pdf, hit.radiance];
            assert_eq!(met.map(f64::to_bits), asked.map(f64::to_bits));
            assert!(light.hit(p, travel).is_none(), "with the light");
        }
        let towards = [0.0, 0.0, -1.0];
        assert!(light.hit([0.0, 0.0, -1e-3], towards).is_none(), "behind");
        assert!(light.hit([0.0, 0.1, 0.03], towards).is_none(), "dark");
        assert!(light.hit(p, [1.0, 0.0, 0.0]).is_none(), "across");
    }
}

#[test]
fn batches_of_records_have_the_bits_of_single_calls() {
    let mut numbers = Numbers::new(13);
    let lasers: Vec<LaserLine> = fans().collect();
    for light in lights(&lasers) {
        let u: [[f64; 4]; 50] = core::array::from_fn(|_| numbers.units());
        let mut rays = vec![light.sample_ray([0.5; 4]); u.len()];
        light.sample_ray_batch(&u, &mut rays);
        for (ray, &u) in rays.iter().zip(&u) {
            assert_eq!(*ray, light.sample_ray(u));
        }
        // Points of rays, and every other one 1 cm beside.
        let p: [[f64; 3]; 50] = core::array::from_fn(|i| {
            let point = DVec3::from(rays[i].origin) + 0.03 * DVec3::from(rays[i].direction);
            let beside = if i % 2 == 0 { 0.0 } else { 1e-2 };
            (point + DVec3::Y * beside).to_array()
        });
        let u = u.map(|[.., a, b]| [a, b]);
        let lit = light.next_event_sampled([0.0, 0.0, 0.03], [0.5; 2]);
        let mut events = vec![lit.expect("the axis is lit"); p.len()];
        light.next_event_sampled_batch(&p, &u, &mut events);
        let mut dark = 0;
        for (i, event) in events.into_iter().enumerate() {
            match light.next_event_sampled(p[i], u[i]) {
                Some(single) => assert_eq!(event, single),
                None => {
                    dark += 1;
                    assert!(event.value.to_bits() == 0 && event.pdf.to_bits() == 0);
                    assert_eq!(event.wi.map(f64::to_bits), [0; 3]);
                }
            }
        }
        assert!((1..50).contains(&dark), "both kinds of points: {dark}");
    }
}
