//! Nanoseconds per single call of a light through the C interface and of the library itself.
//!
//! Both answer the same questions about the same points; the difference is what the interface
//! checks.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use std::{hint::black_box, ptr};

use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use tem00_beam::{DVec3, Emitter, GaussianBeam, SpotLight};
use tem00_capi::{
    Light, NextEvent, Placement, RaySample, SpotDescription, tem00_light_create_spot,
    tem00_light_destroy, tem00_light_irradiance, tem00_light_next_event, tem00_light_radiance,
    tem00_light_sample_ray,
};

/// Few enough for the questions to stay in the nearest cache.
const QUESTIONS: u32 = 1_024;

const SPOT: SpotDescription = SpotDescription {
    placement: Placement {
        origin: [0.0; 3],
        direction: [0.0, 0.0, 1.0],
        fan_axis: [1.0, 0.0, 0.0],
    },
    wavelength: 650e-9,
    power: 5e-3,
    waist_radius: 50e-6,
    waist_distance: 0.15,
    m_squared: 1.0,
};

/// A light of the interface that frees itself.
struct Handle(*mut Light);

impl Handle {
    fn new() -> Self {
        let mut light = ptr::null_mut();
        // SAFETY: the pointers are valid.
        unsafe { tem00_light_create_spot(&SPOT, &raw mut light) };
        Self(light)
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: it was created by the interface and is not used again.
        unsafe { tem00_light_destroy(self.0) };
    }
}

fn library() -> SpotLight {
    let beam = GaussianBeam::from_waist(SPOT.wavelength, SPOT.waist_radius).expect("a valid beam");
    let placement = tem00_beam::Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::X,
    };
    SpotLight::place(&beam, SPOT.waist_distance, &placement, SPOT.power).expect("a valid light")
}

/// The number `i` of an even spread over [0, 1).
fn spread(i: u32, step: f64) -> f64 {
    (f64::from(i) * step).fract()
}

/// Points inside the beam, 0.3 m from the aperture.
fn points() -> Vec<[f64; 3]> {
    let across = |i, step| 1.6e-3 * (spread(i, step) - 0.5);
    (0..QUESTIONS)
        .map(|i| [across(i, 0.618_033_988_7), across(i, 0.414_213_562_4), 0.3])
        .collect()
}

fn variates() -> Vec<[f64; 4]> {
    let steps = [
        0.618_033_988_7,
        0.414_213_562_4,
        0.732_050_807_6,
        0.236_067_977_5,
    ];
    (0..QUESTIONS)
        .map(|i| steps.map(|step| spread(i, step)))
        .collect()
}

type Group<'a> = BenchmarkGroup<'a, criterion::measurement::WallTime>;

/// Asks every question once per iteration.
fn ask_all<Q, R>(group: &mut Group<'_>, side: &str, questions: &[Q], ask: impl Fn(&Q) -> R) {
    group.throughput(Throughput::Elements(questions.len() as u64));
    group.bench_function(side, |bencher| {
        bencher.iter(|| {
            for question in questions {
                black_box(ask(black_box(question)));
            }
        });
    });
}

fn next_event(criterion: &mut Criterion) {
    let (handle, light, points) = (Handle::new(), library(), points());
    let mut group = criterion.benchmark_group("next_event");
    ask_all(&mut group, "rust", &points, |p| light.next_event(*p));
    ask_all(&mut group, "c", &points, |p| {
        let mut event = NextEvent::default();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_light_next_event(handle.0, p.as_ptr(), &raw mut event) };
        (status, event)
    });
}

fn irradiance(criterion: &mut Criterion) {
    let (handle, light, points) = (Handle::new(), library(), points());
    let mut group = criterion.benchmark_group("irradiance");
    ask_all(&mut group, "rust", &points, |p| light.irradiance(*p));
    ask_all(&mut group, "c", &points, |p| {
        let mut irradiance = 0.0;
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_light_irradiance(handle.0, p.as_ptr(), &raw mut irradiance) };
        (status, irradiance)
    });
}

fn sample_ray(criterion: &mut Criterion) {
    let (handle, light, variates) = (Handle::new(), library(), variates());
    let mut group = criterion.benchmark_group("sample_ray");
    ask_all(&mut group, "rust", &variates, |u| light.sample_ray(*u));
    ask_all(&mut group, "c", &variates, |u| {
        let mut ray = RaySample::default();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_light_sample_ray(handle.0, u.as_ptr(), &raw mut ray) };
        (status, ray)
    });
}

/// Of rays along the axis, whose direction the interface checks.
fn radiance(criterion: &mut Criterion) {
    const DIRECTION: [f64; 3] = [0.0, 0.0, 1.0];
    let (handle, light, points) = (Handle::new(), library(), points());
    let mut group = criterion.benchmark_group("radiance");
    ask_all(&mut group, "rust", &points, |p| {
        light.radiance(*p, black_box(DIRECTION))
    });
    ask_all(&mut group, "c", &points, |p| {
        let (d, mut radiance) = (black_box(DIRECTION), 0.0);
        // SAFETY: the pointers are valid.
        let status =
            unsafe { tem00_light_radiance(handle.0, p.as_ptr(), d.as_ptr(), &raw mut radiance) };
        (status, radiance)
    });
}

criterion_group!(benches, next_event, irradiance, sample_ray, radiance);
criterion_main!(benches);
