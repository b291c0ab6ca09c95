//! Speed of judging set-ups: speckled line images, budgets by formulas and by trials.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use std::{hint::black_box, sync::atomic::AtomicBool};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use tem00::triangulation::{Budget, LineImage, Setup, SimulationOptions, parse_setup, simulate};

fn setup() -> Setup {
    parse_setup(
        r#"
        laser = { wavelength = "650 nm", power = "5 mW", line_thickness = "0.2 mm", line_length = "50 mm" }
        surface = { reflectance = 0.5 }
        sensor = { quantum_efficiency = 0.6, exposure = "0.1 ms" }
        [camera]
        focal_length = "25 mm"
        f_number = 8
        pixel_pitch = "3.45 um"
        resolution = [640, 480]
        distance = "300 mm"
        angle = "30 deg"
        "#,
    )
    .expect("a set-up")
}

fn images(criterion: &mut Criterion) {
    const SIZE: [usize; 2] = [640, 80];
    let lines = LineImage::of_setup(&setup(), SIZE).expect("a valid image");
    let mut group = criterion.benchmark_group("line images, all threads");
    group.throughput(Throughput::Elements(SIZE.iter().product::<usize>() as u64));
    group.bench_function("speckled", |bencher| {
        bencher.iter(|| lines.speckled(black_box(7), |x| 40.0 + 0.001 * x));
    });
    group.finish();
}

fn budgets(criterion: &mut Criterion) {
    let setup = setup();
    let mut group = criterion.benchmark_group("budgets");
    group.bench_function("by formulas", |bencher| {
        bencher.iter(|| Budget::new(black_box(&setup)));
    });
    let options = SimulationOptions {
        trials: 10,
        seed: 1,
    };
    group.throughput(Throughput::Elements(10));
    group.bench_function("by trials, all threads", |bencher| {
        bencher.iter(|| simulate(&setup, options, &|_| (), &AtomicBool::new(false)));
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = images, budgets
}
criterion_main!(benches);
