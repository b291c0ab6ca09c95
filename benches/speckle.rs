//! Patterns per second against a dense transform, stacks, and look-ups per second beside what memory
//! allows.
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
    numerics::Grid,
    speckle::{PupilField, SlicePath, SpeckleScratch, SpeckleStack},
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

/// Reading coefficients one after the other: of one slice, which the last cache may hold, and of all.
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

criterion_group!(benches, patterns, stacks, look_ups, bandwidth);
criterion_main!(benches);
