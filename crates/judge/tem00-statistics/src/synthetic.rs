//! Speckle for the tests of this crate, computed from the definition alone.

use num_complex::Complex;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00_numerics::{Fft2, Grid};

/// Returns a periodic speckle pattern of mean 1, `size` pixels wide, from unit phasors of random
/// phase on a disc `diameter` lattice points across, and the number of phasors.
///
/// The speckle size is `size / diameter` pixels. `diameter` is even.
pub(crate) fn speckle_tile(size: usize, diameter: usize, seed: u64) -> (Grid<f32>, usize) {
    let (aperture, count) = phasor_disc(diameter, seed);
    let scale = f32::from(count).recip();
    let tile = transformed(&aperture, size).map(|field| field.norm_sqr() * scale);
    (tile, usize::from(count))
}

/// Returns the complex field of such a pattern, up to a phase that is linear in x and y.
pub(crate) fn field_tile(size: usize, diameter: usize, seed: u64) -> Grid<Complex<f32>> {
    transformed(&phasor_disc(diameter, seed).0, size)
}

fn transformed(aperture: &Grid<Complex<f32>>, size: usize) -> Grid<Complex<f32>> {
    let side = aperture.width();
    let transform = Fft2::with_aperture(size, size, side, side).unwrap();
    transform.forward(aperture, |_, _, field| field)
}

/// Exponential samples of mean 1.
pub(crate) fn exponential_samples(count: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
    (0..count).map(|_| exponential_sample(rng)).collect()
}

pub(crate) fn exponential_sample(rng: &mut ChaCha8Rng) -> f64 {
    -(1.0 - rng.random::<f64>()).ln()
}

fn phasor_disc(diameter: usize, seed: u64) -> (Grid<Complex<f32>>, u16) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let side = diameter + 1;
    let radius = (diameter / 2) as f64;
    let mut aperture = Grid::filled(side, side, Complex::new(0.0_f32, 0.0));
    let mut count = 0_u16;
    for y in 0..side {
        for x in 0..side {
            if (x as f64 - radius).hypot(y as f64 - radius) <= radius {
                let phase = core::f32::consts::TAU * rng.random::<f32>();
                aperture[(x, y)] = Complex::from_polar(1.0, phase);
                count += 1;
            }
        }
    }
    (aperture, count)
}
