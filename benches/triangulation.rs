//! Columns per second of every line detector, on one core, against the loop one writes first.
//!
//! The peer takes the centre of gravity of a whole column with a known background: it neither
//! searches for the line nor judges it.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use tem00::{
    numerics::Grid,
    triangulation::{DetectorSettings, LineDetector, LineMethod},
};

const ROWS: usize = 1024;
const COLUMNS: u32 = 256;
const BACKGROUND: f32 = 16.0;

/// A sloping line of the radius 6 pixels, with ripples in place of noise.
fn column(x: u32) -> Vec<f32> {
    let centre = 400.0 + 0.3 * x as f32;
    let value = |y: u32| {
        let u = (y as f32 + 0.5 - centre) / 6.0;
        let ripple = (y * y * 7 + x * 13) % 5;
        BACKGROUND + ripple as f32 + 200.0 * (-2.0 * u * u).exp()
    };
    (0..u32::try_from(ROWS).expect("few rows"))
        .map(value)
        .collect()
}

fn detector(method: LineMethod) -> LineDetector {
    let settings = DetectorSettings {
        method,
        ..DetectorSettings::default()
    };
    LineDetector::new(settings).expect("a valid detector")
}

/// The centre of gravity in the words of its formula.
fn first_written(column: &[f32]) -> f32 {
    let (mut sum, mut moment) = (0.0, 0.0);
    let mut y = 0.5;
    for value in column {
        sum += value - BACKGROUND;
        moment += (value - BACKGROUND) * y;
        y += 1.0;
    }
    moment / sum
}

fn detectors(criterion: &mut Criterion) {
    let columns: Vec<Vec<f32>> = (0..COLUMNS).map(column).collect();
    let mut group = criterion.benchmark_group("lines in columns");
    group.throughput(Throughput::Elements(u64::from(COLUMNS)));
    group.bench_function("first written", |bencher| {
        bencher.iter(|| -> f32 { columns.iter().map(|c| first_written(black_box(c))).sum() });
    });
    for method in LineMethod::ALL {
        let detector = detector(method);
        group.bench_function(method.name(), |bencher| {
            let place = |column: &Vec<f32>| detector.detect_column(black_box(column))[0].position;
            bencher.iter(|| -> f64 { columns.iter().map(place).sum() });
        });
    }
    group.finish();
}

fn images(criterion: &mut Criterion) {
    let columns: Vec<Vec<f32>> = (0..COLUMNS).map(column).collect();
    let image = Grid::from_fn(columns.len(), ROWS, |x, y| columns[x][y]);
    let mut group = criterion.benchmark_group("lines in images, all threads");
    group.throughput(Throughput::Elements(u64::from(COLUMNS)));
    for method in [
        LineMethod::CentreOfGravity,
        LineMethod::Steger { sigma: 2.0 },
    ] {
        let detector = detector(method);
        group.bench_function(method.name(), |bencher| {
            bencher.iter(|| detector.detect(black_box(&image)));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = detectors, images
}
criterion_main!(benches);
