//! Thousands of surface points per second for the displacement and the correlation of speckle
//! between two states, call by call and for the points of a body, and the time of each law of
//! correlation.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use tem00::decorrelation::{
    CameraFrame, ChangedPoint, Configuration, ConfigurationData, CorrelationLaw, DVec3,
    Illumination, ImagingGeometry, LensData, RigidChange, RigidMotion, RigidMotions, SpeckleMotion,
};

/// Few enough for coordinates and results to stay in the nearer caches.
const POINTS: u32 = 4_096;
const SOURCE: DVec3 = DVec3::new(0.1, 0.05, 0.25);
const PUPIL: DVec3 = DVec3::new(0.02, -0.01, 0.3);

/// Points of a hand's breadth of a plane.
fn points() -> impl Iterator<Item = DVec3> {
    let spread = |i: u32, step: f64| 0.1 * ((f64::from(i) * step).fract() - 0.5);
    (0..POINTS)
        .map(move |i| DVec3::new(spread(i, 0.618_033_988_7), spread(i, 0.414_213_562_4), 0.0))
}

fn camera() -> CameraFrame {
    CameraFrame::look_at(PUPIL, DVec3::ZERO, DVec3::Y).expect("a valid view")
}

/// A motion that leaves half of the correlation, across the line of sight and along it.
fn motions() -> RigidMotions {
    RigidMotions {
        surface: RigidMotion::along(DVec3::new(0.3e-3, 0.0, 5e-3)).expect("a translation"),
        ..RigidMotions::default()
    }
}

fn by_calls(geometry: &ImagingGeometry, motions: &RigidMotions, point: DVec3) -> SpeckleMotion {
    let before = Configuration::new(ConfigurationData {
        wavelength: 650e-9,
        point,
        normal: DVec3::Z,
        illumination: Illumination::point_source(SOURCE).expect("a source"),
        camera: camera(),
        pupil: PUPIL,
    });
    let before = before.expect("a visible point");
    let after = before.moved(motions).expect("a visible point");
    SpeckleMotion::between(geometry, &before, &after)
}

fn motion(criterion: &mut Criterion) {
    let geometry = ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    });
    let geometry = geometry.expect("a valid lens");
    let (points, motions): (Vec<_>, _) = (points().collect(), motions());
    let mut group = criterion.benchmark_group("motion");
    group.throughput(Throughput::Elements(POINTS.into()));
    group.bench_function("call", |bencher| {
        bencher.iter(|| {
            for &point in &points {
                black_box(by_calls(&geometry, black_box(&motions), point));
            }
        });
    });
    let change = RigidChange::new(camera(), PUPIL, &motions).expect("a change");
    group.bench_function("body", |bencher| {
        bencher.iter(|| {
            for &position in &points {
                let origin = change.origin(position);
                black_box(change.at(&ChangedPoint {
                    position,
                    normal: DVec3::Z,
                    to_source: [
                        (SOURCE - origin).normalize(),
                        (SOURCE - position).normalize(),
                    ],
                }));
            }
        });
    });
}

fn laws(criterion: &mut Criterion) {
    use CorrelationLaw::{AtImageDisplacement, AtPeak};
    let mut group = criterion.benchmark_group("law");
    for law in [AtPeak, AtImageDisplacement] {
        for x in [0.6, 60.0] {
            group.bench_function(BenchmarkId::new(format!("{law:?}"), x), |bencher| {
                bencher.iter(|| law.correlation(black_box(0.2), black_box(x)));
            });
        }
    }
}

criterion_group!(benches, motion, laws);
criterion_main!(benches);
