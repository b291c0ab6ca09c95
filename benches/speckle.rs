//! Patterns per second against a dense transform, and look-ups per second.
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
    #[expect(clippy::cast_precision_loss, reason = "a 24-bit number")]
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
        #[expect(clippy::cast_precision_loss, reason = "a normalisation in f32")]
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

/// Positions all over the pattern, and along one row of pixels.
fn scattered(i: u32) -> (f64, f64) {
    let size = 1_024.0;
    (
        size * f64::from(weyl(2 * i)),
        size * f64::from(weyl(2 * i + 1)),
    )
}

fn coherent(i: u32) -> (f64, f64) {
    (0.8 * f64::from(i), 17.3)
}

fn look_ups(criterion: &mut Criterion) {
    const COUNT: u32 = 4_096;
    let field = PupilField::new(1_024, 512, 1).expect("a valid size");
    let path = SlicePath::Circle { half_period: 4 };
    let stack = SpeckleStack::generate(&field, path).expect("64 MiB of slices");
    let mut group = criterion.benchmark_group("look-up");
    group.throughput(Throughput::Elements(COUNT.into()));
    for (slices, u) in [("still", 2.0), ("blended", 2.4)] {
        for (order, position) in [
            ("scattered", scattered as fn(u32) -> (f64, f64)),
            ("coherent", coherent),
        ] {
            let positions: Vec<_> = (0..COUNT).map(position).collect();
            group.bench_function(BenchmarkId::new(order, slices), |bencher| {
                bencher.iter(|| -> f64 {
                    let intensity = |&(x, y): &(f64, f64)| stack.intensity_at(x, y, black_box(u));
                    positions.iter().map(intensity).sum()
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, patterns, look_ups);
criterion_main!(benches);
