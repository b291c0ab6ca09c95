//! Nanoseconds per query of a placed light, call by call and in batches.
//!
//! The peer is the irradiance of a spot as one writes it first: a plain loop over the same slices
//! with the exponential of the standard library. `benches/peers/run.sh` adds NumPy.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use tem00::beam::{
    DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight, LineProfile,
    NextEventSlices, Placement, SpotLight,
};

/// Few enough for coordinates and results to stay in the nearer caches.
const POINTS: u32 = 4_096;
const POWER: f64 = 5e-3;
const WAIST_DISTANCE: f64 = 0.15;

fn placement() -> Placement {
    Placement {
        origin: DVec3::new(0.1, -0.2, 0.3),
        direction: DVec3::new(0.3, -0.5, 0.8),
        fan_axis: DVec3::new(1.0, 0.2, 0.1),
    }
}

fn focus() -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, 50e-6).expect("a valid beam")
}

fn spot() -> SpotLight {
    SpotLight::place(&focus(), WAIST_DISTANCE, &placement(), POWER).expect("a valid light")
}

fn line(profile: LineProfile) -> LineLight {
    let fan = FanGeometry {
        fan_angle: 0.5,
        apex_offset: 2e-3,
        focus_distance: WAIST_DISTANCE,
        focus_curve: FocusCurve::EqualDistance,
    };
    let line = LaserLine::new(focus(), fan, profile).expect("a valid line");
    LineLight::place(&line, &placement(), POWER).expect("a valid light")
}

/// The number `i` of an even spread over (−½, ½).
fn spread(i: u32, step: f64) -> f64 {
    (f64::from(i) * step).fract() - 0.5
}

/// Points before the light, over a width and a height in metres; three in four are lit by a spot of
/// 4 mm.
fn points(width: f64, height: f64) -> [Vec<f64>; 3] {
    let light = spot();
    let [ex, ey, ez] = [light.ex, light.ey, light.ez].map(DVec3::from);
    let point = |i| {
        DVec3::from(light.origin)
            + width * spread(i, 0.618_033_988_7) * ex
            + height * spread(i, 0.414_213_562_4) * ey
            + (0.3 + 0.2 * spread(i, 0.732_050_807_6)) * ez
    };
    let points: Vec<DVec3> = (0..POINTS).map(point).collect();
    [0, 1, 2].map(|k| points.iter().map(|p| p[k]).collect())
}

/// Hands over each point in registers, as a renderer does that has just computed it.
#[inline(always)]
fn each<R>([x, y, z]: &[Vec<f64>; 3], query: impl Fn([f64; 3]) -> R) {
    for ((&x, &y), &z) in x.iter().zip(y).zip(z) {
        black_box(query([black_box(x), black_box(y), black_box(z)]));
    }
}

/// Times single calls at `points`, each with the uniform variates in `u`.
fn calls(
    criterion: &mut Criterion,
    name: &str,
    light: &impl Emitter,
    (points, u): (&[Vec<f64>; 3], [f64; 4]),
) {
    let mut group = criterion.benchmark_group("call");
    group.throughput(Throughput::Elements(POINTS.into()));
    group.bench_function(BenchmarkId::new("irradiance", name), |bencher| {
        bencher.iter(|| each(points, |p| light.irradiance(p)));
    });
    group.bench_function(BenchmarkId::new("next event", name), |bencher| {
        bencher.iter(|| each(points, |p| light.next_event(p)));
    });
    group.bench_function(BenchmarkId::new("sampled next event", name), |bencher| {
        let sampled = |p| light.next_event_sampled(p, [black_box(u[0]), u[1]]);
        bencher.iter(|| each(points, sampled));
    });
    group.bench_function(BenchmarkId::new("ray", name), |bencher| {
        let ray = |_| light.sample_ray([black_box(u[0]), u[1], u[2], u[3]]);
        bencher.iter(|| each(points, ray));
    });
}

/// Times batches over `points`.
fn batches(
    criterion: &mut Criterion,
    name: &str,
    light: &impl Emitter,
    (points, zero): (&[Vec<f64>; 3], f64),
) {
    let mut group = criterion.benchmark_group("batch");
    group.throughput(Throughput::Elements(POINTS.into()));
    let [x, y, z] = points;
    let mut out = [(); 5].map(|()| vec![zero; x.len()]);
    group.bench_function(BenchmarkId::new("irradiance", name), |bencher| {
        bencher.iter(|| light.irradiance_batch(black_box(x), y, z, black_box(&mut out[0])));
    });
    group.bench_function(BenchmarkId::new("next event", name), |bencher| {
        bencher.iter(|| {
            let [wi_x, wi_y, wi_z, distance, e_perp] = black_box(&mut out);
            let slices = NextEventSlices {
                wi: [wi_x, wi_y, wi_z],
                distance,
                e_perp,
            };
            light.next_event_batch(black_box(x), y, z, slices);
        });
    });
}

/// The irradiance of a spot, as one writes it first.
fn naive(light: &SpotLight, points: &[Vec<f64>; 3], out: &mut [f64]) {
    let [x, y, z] = points;
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    for (i, out) in out.iter_mut().enumerate() {
        let [ox, oy, oz] = light.origin;
        let d = [x[i] - ox, y[i] - oy, z[i] - oz];
        let (u, v, w) = (dot(d, light.ex), dot(d, light.ey), dot(d, light.ez));
        let wx_sq = light.x.w0_sq + light.x.theta_sq * (w - light.x.z0).powi(2);
        let wy_sq = light.y.w0_sq + light.y.theta_sq * (w - light.y.z0).powi(2);
        let rho_sq = u * u / wx_sq + v * v / wy_sq;
        *out = if w < 0.0 || rho_sq > light.cutoff * light.cutoff {
            0.0
        } else {
            2.0 * light.power / (core::f64::consts::PI * (wx_sq * wy_sq).sqrt())
                * (-2.0 * rho_sq).exp()
        };
    }
}

fn lights(criterion: &mut Criterion) {
    let near = points(4e-3, 4e-3);
    let wide = points(0.12, 4e-3);
    let u = [0.3, 0.6, 0.7, 0.2];
    let light = spot();
    calls(criterion, "spot f64", &light, (&near, u));
    batches(criterion, "spot f64", &light, (&near, 0.0));
    for (name, profile) in [
        ("line f64", LineProfile::GaussianTan),
        ("Powell line f64", LineProfile::Powell { edge: 0.1 }),
    ] {
        let light = line(profile);
        calls(criterion, name, &light, (&wide, u));
        batches(criterion, name, &light, (&wide, 0.0));
    }
}

fn peers(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("plain loop");
    group.throughput(Throughput::Elements(POINTS.into()));
    let points = points(4e-3, 4e-3);
    let mut out = vec![0.0; points[0].len()];
    group.bench_function("spot f64", |bencher| {
        bencher.iter(|| naive(black_box(&spot()), &points, black_box(&mut out)));
    });
}

criterion_group!(benches, lights, peers);
criterion_main!(benches);
