//! Terms per second of the sum over scatterers, on one core, against the loop one writes first.
//!
//! The peer takes sine and cosine of each phase from the standard library.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use core::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use tem00::wave::{
    Amplitudes, Arrangement, Complex, DVec3, Grid, Illumination, PatchDescription, RoughSurface,
    Roughness, displacement_between,
};

const WAVELENGTH: f64 = 650e-9;

fn surface() -> RoughSurface {
    RoughSurface::patch(&PatchDescription {
        centre: DVec3::ZERO,
        normal: DVec3::Z,
        along: DVec3::X,
        size: [2e-3, 2e-3],
        scatterers: [100, 100],
        arrangement: Arrangement::Lattice,
        roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
        seed: 1,
    })
    .expect("a valid patch")
}

/// The same sum in the words of its formula.
fn first_written(sources: &[(DVec3, Complex<f64>)], point: DVec3) -> Complex<f64> {
    let wave = |&(position, amplitude): &(DVec3, Complex<f64>)| {
        let distance = position.distance(point);
        amplitude * Complex::from_polar(1.0 / distance, TAU * distance / WAVELENGTH)
    };
    sources.iter().map(wave).sum()
}

fn sums(criterion: &mut Criterion) {
    let surface = surface();
    let light = Illumination::plane(WAVELENGTH, DVec3::NEG_Z).expect("a plane wave");
    let lit = surface.lit_by(&light);
    let incident = |position| light.amplitude_at(position);
    let scatterers = surface.scatterers().iter();
    let sources: Vec<_> = scatterers
        .map(|s| (s.position, s.amplitude * incident(s.position)))
        .collect();
    let mut group = criterion.benchmark_group("sum of waves");
    group.throughput(Throughput::Elements(sources.len() as u64));
    let point = DVec3::new(1e-3, 2e-3, 0.3);
    group.bench_function("tem00", |bencher| {
        bencher.iter(|| lit.field_at(black_box(point)));
    });
    group.bench_function("standard sine and cosine", |bencher| {
        bencher.iter(|| first_written(&sources, black_box(point)));
    });
    group.finish();
}

fn displacements(criterion: &mut Criterion) {
    const SIZE: usize = 256;
    let plane = Illumination::plane(WAVELENGTH, DVec3::NEG_Z).expect("a plane wave");
    let lit = surface().lit_by(&plane);
    // Every fourth sample of a coarse field, spread by linear interpolation: its details do not
    // count.
    let coarse = Grid::from_fn(64, 64, |x, y| {
        let point = DVec3::new(x as f64 * 50e-6, y as f64 * 50e-6, 0.3);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "patterns are stored as f32"
        )]
        let intensity = lit.field_at(point).norm_sqr() as f32;
        intensity
    });
    let pattern = |shift: usize| {
        Grid::from_fn(SIZE, SIZE, |x, y| {
            let mix = ((x + shift) % 4) as f32 / 4.0;
            let (column, row) = ((x + shift) / 4, y / 4);
            let next = (column + 1) % 64;
            coarse[(column % 64, row)] * (1.0 - mix) + coarse[(next, row)] * mix
        })
    };
    let (first, second) = (pattern(0), pattern(3));
    let mut group = criterion.benchmark_group("displacement");
    group.sample_size(20);
    group.throughput(Throughput::Elements((SIZE * SIZE) as u64));
    group.bench_function("tem00", |bencher| {
        bencher.iter(|| displacement_between(black_box(&first), black_box(&second)));
    });
    group.finish();
}

criterion_group!(benches, sums, displacements);
criterion_main!(benches);
