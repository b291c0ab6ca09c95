//! Look-ups on the card beside those of the library, in stacks of the library and of the card.

use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};
use tem00_gpu::{Gpu, GpuStack};
use tem00_numerics::Grid;
use tem00_speckle::{Complex, Pupil, PupilField, SlicePath, SpeckleStack, Transmission};

/// Points about the pattern and the path, some on slices and samples, whose coordinates `f32`
/// holds.
fn points(stack: &SpeckleStack, count: usize) -> Vec<[f32; 3]> {
    let mut generator = ChaCha8Rng::seed_from_u64(5);
    let [width, height] = stack.size();
    let periods = [width, height, stack.slice_count()].map(|n| n as f32);
    let mut random = || generator.next_u32() as f32 / u32::MAX as f32;
    let mut points: Vec<[f32; 3]> = (0..count)
        .map(|_| periods.map(|period| period * (3.0 * random() - 1.0)))
        .collect();
    for (i, point) in points.iter_mut().enumerate() {
        match i % 10 {
            0 => *point = point.map(f32::floor),
            1 => point[2] = point[2].round(),
            // On both sides of the seams.
            2 => point[0] = periods[0] - 0.5,
            3 => point[1] = -1e-6,
            _ => {}
        }
    }
    points
}

fn deviations(card: &[f32], library: &SpeckleStack, points: &[[f32; 3]]) -> [f64; 2] {
    let (mut square, mut worst) = (0.0, 0.0_f64);
    for (card, [x, y, u]) in card
        .iter()
        .zip(points.iter().map(|point| point.map(f64::from)))
    {
        let error = (f64::from(*card) - library.intensity_at(x, y, u)).abs();
        square += error * error;
        worst = worst.max(error);
    }
    [(square / points.len() as f64).sqrt(), worst]
}

fn half_open() -> Pupil {
    let grid = Grid::from_fn(40, 30, |x, y| {
        let amplitude = if x + y < 40 { 1.0 } else { 0.2 };
        Complex::from_polar(amplitude, 0.05 * (x * y % 50) as f32)
    });
    Pupil::Sampled(Transmission::from_complex(grid).expect("a transmission"))
}

/// Fields and paths.
fn stacks() -> Vec<(PupilField, SlicePath)> {
    let circle = SlicePath::Circle { half_period: 5 };
    let straight = SlicePath::Straight {
        half_period: 8,
        length: 3,
    };
    let square = || PupilField::new(240, 96, 3).expect("a field");
    let samples = Grid::from_fn(120, 90, |x, y| {
        Complex::from_polar(1.0, (x * x * y + 7 * y * y) as f32)
    });
    vec![
        (square(), circle),
        (square(), straight),
        (square(), SlicePath::Still),
        (square().with_pupil(half_open()).expect("a pupil"), circle),
        (
            PupilField::from_speckle_size([320, 180], 2.0, 8).expect("a field"),
            straight,
        ),
        (
            PupilField::from_samples(samples, [128; 2], 2.0).expect("a field"),
            circle,
        ),
    ]
}

#[test]
fn look_ups_agree() {
    let gpu = Gpu::new().expect("an adapter");
    for (field, path) in stacks() {
        let library = SpeckleStack::generate(&field, path).expect("a stack");
        let points = points(&library, 20_000);
        let uploaded = GpuStack::upload(&gpu, &library).expect("a stack");
        let generated = GpuStack::generate(&gpu, &field, path).expect("a stack");
        for (stack, name) in [(uploaded, "uploaded"), (generated, "generated")] {
            let card = stack.intensities(&points).expect("intensities");
            let [rms, worst] = deviations(&card, &library, &points);
            assert!(
                rms < 2e-6 && worst < 3e-5,
                "{name}, {path:?}: {rms:e} rms, {worst:e} at worst"
            );
        }
    }
}
