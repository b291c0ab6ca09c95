//! Statistics of stacks that were generated on the card, and what is refused.

use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};
use tem00_gpu::{Gpu, GpuError, GpuStack};
use tem00_speckle::{PupilField, SlicePath, SpeckleError, StackOptions};
use tem00_statistics::{Moments, airy_autocovariance, exponential_cumulative, kolmogorov_smirnov};

const SIZE: usize = 1024;
const SPECKLE: f32 = 2.0;

/// Points of each stack: a place in each of so many cells along both axes, two speckles wide.
const CELLS: usize = 250;

/// A million look-ups.
const STACKS: u64 = 16;

/// Slices that have nothing in common.
const PATH: SlicePath = SlicePath::Circle { half_period: 1 };

fn stack(gpu: &Gpu, seed: u64) -> GpuStack {
    let field = PupilField::new(SIZE, SIZE / 2, seed).expect("a field");
    GpuStack::generate(gpu, &field, PATH).expect("a stack")
}

/// Places two speckles apart on average, anywhere between samples.
fn places(seed: u64) -> Vec<[f32; 2]> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut random = || (generator.next_u32() >> 8) as f32 / 16_777_216.0;
    let cell = SIZE as f32 / CELLS as f32;
    // All cells at the same place within themselves.
    let at = [random(), random()];
    (0..CELLS * CELLS)
        .map(|i| [0, 1].map(|axis| cell * ([i % CELLS, i / CELLS][axis] as f32 + at[axis])))
        .collect()
}

#[test]
fn a_million_look_ups_have_the_exponential_law() {
    let gpu = Gpu::new().expect("an adapter");
    let mut generator = ChaCha8Rng::seed_from_u64(99);
    let mut intensities = Vec::new();
    for seed in 0..STACKS {
        let mut u = || 2.0 * (generator.next_u32() >> 8) as f32 / 16_777_216.0;
        let points: Vec<_> = places(seed).iter().map(|&[x, y]| [x, y, u()]).collect();
        let values = stack(&gpu, seed).intensities(&points).expect("intensities");
        intensities.extend(values.into_iter().map(f64::from));
    }
    assert_eq!(intensities.len(), 1_000_000);
    let test = kolmogorov_smirnov(&intensities, exponential_cumulative).expect("samples");
    let moments = Moments::from_samples(&intensities).expect("samples");
    let contrast = moments.standard_deviation() / moments.mean();
    assert!(test.p_value > 0.01, "p = {}", test.p_value);
    assert!((contrast - 1.0).abs() < 5e-3, "contrast {contrast}");
    // The mean of a million independent ones is good to 1e-3.
    assert!(
        (moments.mean() - 1.0).abs() < 4e-3,
        "mean {}",
        moments.mean()
    );
}

#[test]
fn neighbours_have_the_autocovariance_of_airy() {
    let gpu = Gpu::new().expect("an adapter");
    let speckles = [0.25, 0.5, 0.75, 1.0, 1.22, 1.6];
    let mut sums = [0.0; 6];
    for seed in 0..STACKS {
        let stack = stack(&gpu, seed);
        let look_up = |shift: [f32; 2]| {
            let points: Vec<_> = places(seed)
                .iter()
                .map(|[x, y]| [x + SPECKLE * shift[0], y + SPECKLE * shift[1], 0.0])
                .collect();
            stack.intensities(&points).expect("intensities")
        };
        let here = look_up([0.0; 2]);
        for (i, (sum, distance)) in sums.iter_mut().zip(speckles).enumerate() {
            let (sin, cos) = (i as f32).sin_cos();
            let there = look_up([cos * distance, sin * distance]);
            let products = here.iter().zip(&there);
            *sum += products
                .map(|(a, b)| f64::from((a - 1.0) * (b - 1.0)))
                .sum::<f64>();
        }
    }
    for (sum, distance) in sums.iter().zip(speckles) {
        let measured = sum / 1e6;
        let expected = airy_autocovariance(f64::from(distance));
        // A product has a standard deviation of 1 to √8, and the spline 4e−3 of its own at the finest speckle.
        let tolerance = 4.0 * (1.0 + 7.0 * expected).sqrt() / 1e3 + 4e-3;
        assert!(
            (measured - expected).abs() < tolerance,
            "{distance} speckles: {measured}, not {expected}"
        );
    }
}

#[test]
fn stacks_that_cannot_be_are_refused() {
    let gpu = Gpu::new().expect("an adapter");
    let field = PupilField::new(64, 32, 1).expect("a field");
    let frugal = StackOptions {
        memory_limit: 65_535,
    };
    let refused = GpuStack::generate_with(&gpu, &field, PATH, frugal).expect_err("memory");
    let [needed, limit] = [65_536, 65_535];
    assert_eq!(refused, SpeckleError::MemoryLimit { needed, limit }.into());
    let path = SlicePath::Circle { half_period: 0 };
    let refused = GpuStack::generate(&gpu, &field, path).expect_err("a path");
    assert!(
        refused.to_string().starts_with("half_period must be"),
        "{refused}"
    );
    // More than any device has: 4 TiB.
    let field = PupilField::new(4096, 1024, 1).expect("a field");
    let path = SlicePath::Circle {
        half_period: 1 << 14,
    };
    let refused = GpuStack::generate(&gpu, &field, path).expect_err("a buffer");
    let needed = path.memory_bytes(field.size());
    assert!(
        matches!(refused, GpuError::TooLarge { what: "the stack", needed: got, .. } if got == needed),
        "{refused}"
    );
}
