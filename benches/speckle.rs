//! Patterns per second against a dense transform, stacks, and look-ups per second beside what
//! memory allows.
//!
//! The peer is what one writes first with `rustfft`: all rows, a transposition, all rows again and
//! `|·|²`, from phasors that are already there. Ours includes their generation.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use core::f32::consts::TAU;
use std::{hint::black_box, sync::Arc};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use tem00::{
    Camera, CameraDescription, DVec2, DVec3, Laser, Pose, Speckle,
    decorrelation::{CameraFrame, RigidChange, RigidMotions},
    numerics::Grid,
    shading::{BLOCK, LightPath, Perspective, SeenPoint, SpeckleLaw},
    speckle::{PupilField, SlicePath, SpeckleScratch, SpeckleStack, StackOptions},
};

/// A Weyl sequence: an even spread without a generator.
fn weyl(i: u32) -> f32 {
    let value = (i.wrapping_mul(2_654_435_769) >> 8) as f32;
    value / 16_777_216.0
}

struct Dense {
    size: usize,
    phasors: Vec<Complex<f32>>,
    fft: Arc<dyn Fft<f32>>,
    scale: f32,
}

impl Dense {
    fn new(size: usize, diameter: usize) -> Self {
        let mut phasors = vec![Complex::new(0.0, 0.0); size * size];
        let mut count = 0_u32;
        for y in 0..=diameter {
            for x in 0..=diameter {
                let (dx, dy) = (2 * x.abs_diff(diameter / 2), 2 * y.abs_diff(diameter / 2));
                if dx * dx + dy * dy <= diameter * diameter {
                    phasors[y * size + x] = Complex::from_polar(1.0, TAU * weyl(count));
                    count += 1;
                }
            }
        }
        let scale = 1.0 / count as f32;
        Self {
            size,
            phasors,
            fft: FftPlanner::new().plan_fft_forward(size),
            scale,
        }
    }

    fn pattern(&self) -> Vec<f32> {
        let mut values = self.phasors.clone();
        self.fft.process(&mut values);
        let mut columns = self.transposed(&values);
        self.fft.process(&mut columns);
        columns.iter().map(|u| self.scale * u.norm_sqr()).collect()
    }

    /// In tiles that fit the nearest cache. The pattern stays transposed, which costs nothing.
    fn transposed(&self, values: &[Complex<f32>]) -> Vec<Complex<f32>> {
        const TILE: usize = 16;
        let size = self.size;
        let mut columns = vec![Complex::new(0.0, 0.0); size * size];
        for y0 in (0..size).step_by(TILE) {
            for x0 in (0..size).step_by(TILE) {
                for y in y0..(y0 + TILE).min(size) {
                    for x in x0..(x0 + TILE).min(size) {
                        columns[x * size + y] = values[y * size + x];
                    }
                }
            }
        }
        columns
    }
}

fn patterns(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("pattern");
    group.sample_size(10);
    for size in [512, 1_024, 2_048, 4_096] {
        group.throughput(Throughput::Elements((size * size) as u64));
        let field = PupilField::new(size, size / 2, 1).expect("a valid size");
        group.bench_function(BenchmarkId::new("tem00", size), |bencher| {
            bencher.iter(|| black_box(field.pattern()));
        });
        let mut intensity = Grid::filled(size, size, 0.0);
        let mut scratch = SpeckleScratch::default();
        group.bench_function(BenchmarkId::new("tem00, memory reused", size), |bencher| {
            bencher.iter(|| {
                field.pattern_into([0.0; 2], 0.0, &mut intensity, &mut scratch);
                black_box(&intensity);
            });
        });
        let dense = Dense::new(size, size / 2);
        group.bench_function(BenchmarkId::new("dense rustfft", size), |bencher| {
            bencher.iter(|| black_box(dense.pattern()));
        });
    }
    group.finish();
}

/// 32 slices, beside as many patterns into memory that is used again.
fn stacks(criterion: &mut Criterion) {
    const SIZE: usize = 1_024;
    const SLICES: usize = 32;
    let mut group = criterion.benchmark_group("stack");
    group.sample_size(10);
    group.throughput(Throughput::Elements((SLICES * SIZE * SIZE) as u64));
    let field = PupilField::new(SIZE, SIZE / 2, 1).expect("a valid size");
    let path = SlicePath::Circle {
        half_period: SLICES / 2,
    };
    group.bench_function(BenchmarkId::new("slices", SLICES), |bencher| {
        bencher.iter_with_large_drop(|| SpeckleStack::generate(&field, path));
    });
    let mut intensity = Grid::filled(SIZE, SIZE, 0.0);
    let mut scratch = SpeckleScratch::default();
    group.bench_function(BenchmarkId::new("patterns", SLICES), |bencher| {
        bencher.iter(|| {
            for _ in 0..SLICES {
                field.pattern_into([0.0; 2], 0.0, &mut intensity, &mut scratch);
                black_box(&intensity);
            }
        });
    });
    group.bench_function(
        BenchmarkId::new("patterns in fresh memory", SLICES),
        |bencher| {
            bencher
                .iter_with_large_drop(|| (0..SLICES).map(|_| field.pattern()).collect::<Vec<_>>());
        },
    );
    group.finish();
}

/// Positions all over the pattern, and along rows of pixels.
fn scattered(i: u32) -> (f64, f64) {
    let size = 1_024.0;
    (
        size * f64::from(weyl(2 * i)),
        size * f64::from(weyl(2 * i + 1)),
    )
}

fn coherent(i: u32) -> (f64, f64) {
    (
        0.8 * f64::from(i % 1_280),
        17.3 + 0.8 * f64::from(i / 1_280),
    )
}

fn stack() -> SpeckleStack {
    let field = PupilField::new(1_024, 512, 1).expect("a valid size");
    let path = SlicePath::Circle { half_period: 4 };
    SpeckleStack::generate(&field, path).expect("64 MiB of slices")
}

/// One by one and in batches: a few rows of pixels, and as many points as fill all cache lines.
fn look_ups(criterion: &mut Criterion) {
    let stack = stack();
    let mut group = criterion.benchmark_group("look-up");
    for (slices, u) in [("still", 2.0), ("blended", 2.4)] {
        for (order, position, count) in [
            ("scattered", scattered as fn(u32) -> (f64, f64), 4_096),
            ("coherent", coherent, 4_096),
            ("scattered everywhere", scattered, 1 << 20),
            ("coherent everywhere", coherent, 1 << 20),
        ] {
            let (x, y): (Vec<_>, Vec<_>) = (0..count).map(position).unzip();
            let u = vec![u; x.len()];
            let mut intensity = vec![0.0; x.len()];
            group.throughput(Throughput::Elements(count.into()));
            group.bench_function(BenchmarkId::new(order, slices), |bencher| {
                bencher.iter(|| -> f64 {
                    let points = x.iter().zip(&y).zip(black_box(&u));
                    let look_up = |((&x, &y), &u)| stack.intensity_at(x, y, u);
                    points.map(look_up).sum()
                });
            });
            let batch = format!("{order}, batch");
            group.bench_function(BenchmarkId::new(batch, slices), |bencher| {
                bencher.iter(|| {
                    stack.intensity_batch(&x, &y, black_box(&u), &mut intensity);
                    black_box(&intensity);
                });
            });
        }
    }
    group.finish();
}

/// Reading coefficients one after the other: of one slice, which the last cache may hold, and of
/// all.
fn bandwidth(criterion: &mut Criterion) {
    let stack = stack();
    let mut group = criterion.benchmark_group("bandwidth");
    for slices in [1, stack.slice_count()] {
        let bytes = stack.memory_bytes() / stack.slice_count() as u64 * slices as u64;
        group.throughput(Throughput::Bytes(bytes));
        group.bench_function(BenchmarkId::new("slices", slices), |bencher| {
            bencher.iter(|| {
                let sums = (0..slices).map(|i| sum(stack.coefficients(i).values()));
                sums.sum::<f32>()
            });
        });
    }
    group.finish();
}

/// The sum of all parts, in as many pieces as keep the vector units busy.
fn sum(values: &[Complex<f32>]) -> f32 {
    let mut sums = [0.0; 64];
    for part in values.as_chunks::<32>().0 {
        for (sums, value) in sums.as_chunks_mut::<2>().0.iter_mut().zip(part) {
            sums[0] += value.re;
            sums[1] += value.im;
        }
    }
    sums.iter().sum()
}

/// The factors of an image of a plane that has moved, beside the same from the crates below, and
/// their law alone.
fn factors(criterion: &mut Criterion) {
    let camera = Camera::new(CameraDescription::default()).expect("a camera");
    let laser = Laser::spot(650e-9, 3e-3);
    let laser = laser.placed(DVec3::new(0.2, 0.0, 0.4), DVec3::ZERO, DVec3::X);
    let (laser, pose) = (laser.expect("a laser"), DVec3::new(1e-4, 0.0, 2e-4));
    let pose = Pose::along(pose).expect("a pose");
    let speckle = Speckle::new(&camera, &laser, 1)
        .for_poses(&[pose])
        .prepare();
    let speckle = speckle.expect("speckle");
    let frame = speckle.frame(&pose.into()).expect("a frame");
    let point = |pixel: DVec2| {
        let ray = camera.ray(pixel);
        ray.origin - ray.origin.z / ray.direction.z * ray.direction
    };
    let (width, height) = (camera.width(), camera.height());
    let pixels = (0..width * height).map(|i| [i % width, i / width].map(|i| i as f64 + 0.5));
    let points: Vec<_> = pixels.map(|pixel| point(pixel.into())).collect();
    let (normals, mut values) = (vec![DVec3::Z; points.len()], vec![0.0; points.len()]);

    let mut group = criterion.benchmark_group("factor");
    group.throughput(Throughput::Elements(points.len() as u64));
    group.bench_function("factors", |bencher| {
        bencher.iter(|| frame.factors(black_box(&points), &normals, &mut values));
    });
    let axes = CameraFrame::from_axes(camera.axes()).expect("axes");
    let motions = RigidMotions {
        surface: pose,
        ..RigidMotions::default()
    };
    let law = SpeckleLaw {
        change: &RigidChange::new(axes, camera.position(), &motions).expect("a change"),
        lasers: [&laser; 2],
        perspective: &Perspective::new(camera),
        geometry: speckle.geometry(),
    };
    let stack = speckle
        .plan()
        .stack(1, StackOptions::default())
        .expect("a stack");
    let per_pixel = law
        .geometry
        .pattern_coordinate(DVec2::ONE, DVec2::ZERO, stack.speckle_size());
    group.bench_function("by hand", |bencher| {
        bencher.iter(|| {
            for (points, values) in points.chunks(BLOCK).zip(values.chunks_mut(BLOCK)) {
                let mut shifts = [None; BLOCK];
                let (mut x, mut y, mut u) = ([0.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
                let seen = |&position: &DVec3| SeenPoint {
                    pixel: camera.project(position).unwrap_or(DVec2::ZERO),
                    position,
                    normal: DVec3::Z,
                };
                law.shifts(LightPath::Direct, points.iter().map(seen), &mut shifts);
                for (i, (point, shift)) in points.iter().zip(&shifts).enumerate() {
                    let shift = shift.unwrap_or_default();
                    let place = (seen(point).pixel - shift.displacement) * per_pixel;
                    (x[i], y[i], u[i]) = (place.x, place.y, shift.pupil);
                }
                stack.coordinates_within(stack.path().reach(), &mut u);
                stack.intensity_batch(&x, &y, &u, values);
            }
        });
    });
    let mut shifts = vec![None; points.len()];
    group.bench_function("the law alone", |bencher| {
        bencher.iter(|| frame.shifts(black_box(&points), &normals, &mut shifts));
    });
    group.finish();
}

criterion_group!(benches, patterns, stacks, look_ups, factors, bandwidth);
criterion_main!(benches);
