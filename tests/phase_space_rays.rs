//! Rays drawn from the phase space of a beam reproduce its radius and irradiance at every distance,
//! and agree with next-event estimation on a tilted surface.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use tem00::{
    beam::{
        DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight, LineProfile,
        Placement, SpotLight,
    },
    statistics::chi_squared,
};

const RAYS: u32 = 100_000;
const WAVELENGTH: f64 = 650e-9;
const WAIST_DISTANCE: f64 = 0.15;

fn placement() -> Placement {
    Placement {
        origin: DVec3::new(0.01, -0.02, 0.03),
        direction: DVec3::new(0.2, -0.1, 1.0),
        fan_axis: DVec3::X,
    }
}

fn spot() -> (GaussianBeam, SpotLight<f64>) {
    let beam = GaussianBeam::from_waist(WAVELENGTH, 80e-6)
        .and_then(|beam| beam.with_m_squared(1.3))
        .expect("a valid beam");
    let light = SpotLight::place(&beam, WAIST_DISTANCE, &placement(), 1.0).expect("a valid light");
    (beam, light)
}

fn line() -> LineLight<f64> {
    let focus = GaussianBeam::from_waist(WAVELENGTH, 0.1e-3).expect("a valid beam");
    let fan = FanGeometry {
        fan_angle: 10_f64.to_radians(),
        apex_offset: 5e-3,
        focus_distance: WAIST_DISTANCE,
        focus_curve: FocusCurve::EqualDistance,
    };
    let line = LaserLine::new(focus, fan, LineProfile::GaussianTan).expect("a valid line");
    LineLight::place(&line, &placement(), 1.0).expect("a valid light")
}

/// The light's axes x, y, z and its origin.
fn axes(ex: [f64; 3], ey: [f64; 3], ez: [f64; 3]) -> [DVec3; 3] {
    [ex, ey, ez].map(DVec3::from_array)
}

fn rays(light: &impl Emitter<f64>, seed: u64) -> impl Iterator<Item = (DVec3, DVec3)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    (0..RAYS).map(move |_| {
        let ray = light.sample_ray(random.random());
        (
            DVec3::from_array(ray.origin),
            DVec3::from_array(ray.direction),
        )
    })
}

#[test]
fn rays_spread_as_the_beam_does() {
    let (beam, light) = spot();
    let [x, y, z] = axes(light.ex, light.ey, light.ez);
    let origin = DVec3::from_array(light.origin);
    for distance in [0.02, WAIST_DISTANCE, 0.3, 1.0] {
        let mut squares = 0.0;
        for (point, direction) in rays(&light, 1) {
            let t = (distance - (point - origin).dot(z)) / direction.dot(z);
            let offset = point + t * direction - origin;
            squares += offset.dot(x).powi(2) + offset.dot(y).powi(2);
        }
        // Per axis the standard deviation is w/2.
        let radius = (2.0 * squares / f64::from(RAYS)).sqrt();
        let error = radius / beam.radius_at(distance - WAIST_DISTANCE) - 1.0;
        // The variance of 2 · RAYS normal numbers spreads by √(2/(2 RAYS)), the radius by half that.
        let spread = 0.5 / f64::from(RAYS).sqrt();
        assert!(error.abs() < 4.0 * spread, "at {distance} m: {error:e}");
    }
}

/// A plane before the light, tilted by 50° about an oblique axis.
struct Target {
    centre: DVec3,
    u: DVec3,
    v: DVec3,
}

impl Target {
    fn new(origin: [f64; 3], [x, y, z]: [DVec3; 3], distance: f64) -> Self {
        let (sin, cos) = 50_f64.to_radians().sin_cos();
        let u = (x + 0.4 * y).normalize();
        Self {
            centre: DVec3::from_array(origin) + distance * z,
            u,
            v: cos * z.cross(u) + sin * z,
        }
    }

    fn normal(&self) -> DVec3 {
        self.u.cross(self.v)
    }
}

/// Bins the rays on the target and compares with the irradiance of next-event estimation.
fn agreement(light: &impl Emitter<f64>, target: &Target, half: [f64; 2], seed: u64) -> f64 {
    const BINS: usize = 24;
    const SUBCELLS: usize = 12;
    let normal = target.normal();
    let mut observed = vec![0_u64; BINS * BINS];
    for (point, direction) in rays(light, seed) {
        let t = normal.dot(target.centre - point) / normal.dot(direction);
        let offset = point + t * direction - target.centre;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the bin lies in [0, BINS)"
        )]
        let bin = |value: f64, half: f64| {
            let bin = ((value / half + 1.0) * 0.5 * BINS as f64).floor();
            (0.0..BINS as f64).contains(&bin).then_some(bin as usize)
        };
        if let (Some(i), Some(j)) = (
            bin(offset.dot(target.u), half[0]),
            bin(offset.dot(target.v), half[1]),
        ) {
            observed[j * BINS + i] += 1;
        }
    }
    // The expected counts: the irradiance, integrated over fine cells of each bin.
    let fine = BINS * SUBCELLS;
    let mut expected = vec![0.0; BINS * BINS];
    let area = 4.0 * half[0] * half[1] / (fine * fine) as f64;
    for j in 0..fine {
        for i in 0..fine {
            let at = |k: usize, half: f64| ((k as f64 + 0.5) / fine as f64 * 2.0 - 1.0) * half;
            let point = target.centre + at(i, half[0]) * target.u + at(j, half[1]) * target.v;
            if let Some(event) = light.next_event(point.to_array()) {
                let cosine = normal.dot(DVec3::from_array(event.wi)).abs();
                expected[j / SUBCELLS * BINS + i / SUBCELLS] +=
                    f64::from(RAYS) * event.e_perp * cosine * area;
            }
        }
    }
    // What misses the target is one more bin.
    observed.push(u64::from(RAYS) - observed.iter().sum::<u64>());
    expected.push((f64::from(RAYS) - expected.iter().sum::<f64>()).max(0.0));
    chi_squared(&observed, &expected, 1)
        .expect("enough rays")
        .p_value
}

/// A correct sampler fails at a given seed with this probability.
const SIGNIFICANCE: f64 = 1e-3;

#[test]
fn rays_of_a_spot_agree_with_its_next_event_irradiance() {
    let (beam, light) = spot();
    let axes = axes(light.ex, light.ey, light.ez);
    for (seed, distance) in [(10, 0.1), (11, WAIST_DISTANCE), (12, 0.4)] {
        let target = Target::new(light.origin, axes, distance);
        let radius = beam.radius_at(distance - WAIST_DISTANCE);
        let p = agreement(&light, &target, [1.5 * radius, 2.4 * radius], seed);
        assert!(p > SIGNIFICANCE, "at {distance} m: p = {p:e}");
    }
}

#[test]
fn rays_of_a_line_agree_with_its_next_event_irradiance() {
    let light = line();
    let axes = axes(light.ex, light.ey, light.ez);
    for (seed, distance) in [(20, 0.1), (21, WAIST_DISTANCE), (22, 0.3)] {
        // Along the light's own axes, so that the bins resolve the thickness of the line.
        let (sin, cos) = 50_f64.to_radians().sin_cos();
        let target = Target {
            centre: DVec3::from_array(light.origin) + distance * axes[2],
            u: axes[0],
            v: cos * axes[1] + sin * axes[2],
        };
        let p = agreement(&light, &target, [0.09 * distance, 0.6e-3], seed);
        assert!(p > SIGNIFICANCE, "at {distance} m: p = {p:e}");
    }
}
