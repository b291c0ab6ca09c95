//! Moments of intensities over many surfaces.

use rayon::prelude::*;
use tem00::wave::Estimate;

use super::heights::Random;

/// Moments of one surface: ⟨I⟩, ⟨I²⟩ of all wave numbers together and of single ones.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Moments {
    mixed: [f64; 2],
    single: [f64; 2],
}

impl Moments {
    pub(crate) fn new(mixed: &[f64], images: &[Vec<f64>]) -> Self {
        Self::of_products([mixed, mixed], images, [0, 0], [mixed.len(), 1])
    }

    /// The same with the products of the pixels of two images of a repeating patch, at a lag.
    pub(crate) fn of_products(
        [first, second]: [&[f64]; 2],
        images: &[Vec<f64>],
        lag: [usize; 2],
        [columns, rows]: [usize; 2],
    ) -> Self {
        let mut mixed = [0.0; 2];
        for (place, &value) in first.iter().enumerate() {
            let (x, y) = (
                (place % columns + lag[0]) % columns,
                (place / columns + lag[1]) % rows,
            );
            let other = second[y * columns + x];
            mixed[0] += 0.5 * (value + other);
            mixed[1] += value * other;
        }
        let all = || images.iter().flatten();
        let single = [all().sum::<f64>(), all().map(|value| value * value).sum()];
        let count = first.len() as f64;
        Self {
            mixed: mixed.map(|sum| sum / count),
            single: single.map(|sum| sum / (count * images.len() as f64)),
        }
    }

    pub(crate) fn mean(all: impl ExactSizeIterator<Item = Self>) -> Self {
        let count = all.len() as f64;
        let sum = all.fold(Self::default(), |sum, one| sum.plus(&one, 1.0));
        Self {
            mixed: sum.mixed.map(|sum| sum / count),
            single: sum.single.map(|sum| sum / count),
        }
    }

    fn plus(self, other: &Self, sign: f64) -> Self {
        let add = |a: [f64; 2], b: [f64; 2]| [a[0] + sign * b[0], a[1] + sign * b[1]];
        Self {
            mixed: add(self.mixed, other.mixed),
            single: add(self.single, other.single),
        }
    }

    /// The covariance over that of single wave numbers, which is that of fully developed speckle.
    fn covariance(&self, count: f64) -> f64 {
        let relative = |[mean, square]: [f64; 2]| square * count / (mean * mean) - 1.0;
        relative(self.mixed) / relative(self.single)
    }
}

/// Returns the contrast and its standard error, from leaving out one surface at a time.
pub(crate) fn contrast(surfaces: &[Moments]) -> Estimate {
    jackknife(surfaces, f64::sqrt)
}

/// Returns the covariance over the squared mean.
pub(crate) fn covariance(surfaces: &[Moments]) -> Estimate {
    jackknife(surfaces, |covariance| covariance)
}

fn jackknife(surfaces: &[Moments], f: impl Fn(f64) -> f64) -> Estimate {
    let count = surfaces.len() as f64;
    let total = surfaces
        .iter()
        .fold(Moments::default(), |sum, one| sum.plus(one, 1.0));
    let without = |one: &Moments| f(total.plus(one, -1.0).covariance(count - 1.0));
    let partial: Vec<f64> = surfaces.iter().map(without).collect();
    let spread = Estimate::of_repetitions(&partial).expect("surfaces");
    Estimate {
        value: f(total.covariance(count)),
        standard_error: spread.standard_error * (count - 1.0),
    }
}

/// Calls `measure` with the random numbers of each of some surfaces, on all processors.
pub(crate) fn for_surfaces<T: Send>(
    count: u64,
    seed: u64,
    measure: impl Fn(&mut Random) -> T + Sync,
) -> Vec<T> {
    let one = |surface| measure(&mut Random::new(seed << 32 | surface));
    (0..count).into_par_iter().map(one).collect()
}

/// Asserts that a number found by waves is within a tolerance of a law, and within four standard
/// errors or half a percent, for the lattices.
pub(crate) fn assert_agrees(name: &str, waves: Estimate, law: f64, tolerance: f64) {
    let deviation = (waves.value - law).abs();
    assert!(
        deviation < tolerance && deviation < 4.0 * waves.standard_error.hypot(1.3e-3),
        "{name}: waves {:.4} ± {:.4}, law {law:.4}",
        waves.value,
        waves.standard_error
    );
}

/// Asserts that a number found by waves is more than six standard errors from another.
pub(crate) fn assert_refutes(name: &str, waves: Estimate, number: f64) {
    let errors = (waves.value - number).abs() / waves.standard_error;
    assert!(
        errors > 6.0,
        "{name}: waves {:.4} ± {:.4}, not {number:.4}",
        waves.value,
        waves.standard_error
    );
}
