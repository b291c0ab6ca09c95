//! Heights of rough plates, and random numbers.

use core::f64::consts::{SQRT_2, TAU};
use std::sync::OnceLock;

use tem00::wave::{Complex, DVec3};
use tem00_testkit::Numbers;

/// Random numbers of a surface.
pub(crate) struct Random(Numbers);

impl Random {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(Numbers::new(seed))
    }

    /// Uniform in (0, 1).
    pub(crate) const fn uniform(&mut self) -> f64 {
        // Numbers are multiples of ε/2, of which 0 has no logarithm.
        self.0.unit() + 0.25 * f64::EPSILON
    }

    /// A direction at most so many degrees from an axis.
    pub(crate) fn direction(&mut self, degrees: f64, axis: DVec3) -> DVec3 {
        let (first, second) = axis.any_orthonormal_pair();
        let (sin, cos) = (degrees * self.uniform()).to_radians().sin_cos();
        let (turn_sin, turn_cos) = (TAU * self.uniform()).sin_cos();
        axis * cos + (first * turn_cos + second * turn_sin) * sin
    }

    pub(crate) fn complex_gaussian(&mut self) -> Complex<f64> {
        Complex::from_polar((-self.uniform().ln()).sqrt(), TAU * self.uniform())
    }

    pub(crate) fn gaussian(&mut self) -> f64 {
        SQRT_2 * self.complex_gaussian().re
    }
}

/// Heights of the scatterers on a lattice of sites.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Heights {
    Flat,
    /// Independent normal heights. Each of the four sites of a square speckle has `strata`
    /// scatterers, all of them from different quantiles: the whole distribution of a dense relief
    /// by few scatterers, without the floor of `1/N` that N heights drawn independently leave.
    Dense {
        rms: f64,
        strata: usize,
    },
    /// Independent normal heights, which make the phases of scatterers of equal amplitude. Squared
    /// contrasts are those of a dense relief times `1 − 1/N` where all parts of a speckle have the
    /// same mean path.
    Alone {
        rms: f64,
    },
    /// Normal heights whose correlation falls as exp(−d²/ℓ²), ℓ in speckles.
    Correlated {
        rms: f64,
        length: f64,
    },
}

impl Heights {
    /// Sites along a side of a speckle. Two are as good as a continuous surface for independent
    /// amplitudes, of smooth heights over two speckles, too.
    pub(crate) const fn sites_per_speckle(&self) -> usize {
        match self {
            Self::Flat | Self::Dense { .. } | Self::Alone { .. } => 2,
            Self::Correlated { length, .. } => {
                if *length < 2.0 {
                    4
                } else {
                    2
                }
            }
        }
    }

    /// Returns the heights of the scatterers of each site.
    pub(crate) fn over(
        &self,
        [columns, rows]: [usize; 2],
        density: usize,
        random: &mut Random,
    ) -> Vec<Vec<f64>> {
        match *self {
            Self::Flat => vec![vec![0.0]; columns * rows],
            Self::Dense { rms, strata } => {
                let blocks = columns * rows / 4;
                let first: Vec<f64> = (0..blocks).map(|_| 4.0 * random.uniform()).collect();
                let heights = |site: usize| {
                    let (x, y) = (site % columns, site / columns);
                    let within = (x % 2 + 2 * (y % 2)) as f64;
                    let turned = within + first[x / 2 + y / 2 * (columns / 2)].floor();
                    let stratum = |m: usize, random: &mut Random| {
                        let quarter = (turned + m as f64).rem_euclid(4.0);
                        let place = 4.0 * m as f64 + quarter + random.uniform();
                        rms * normal_quantile(place / (4 * strata) as f64)
                    };
                    (0..strata).map(|m| stratum(m, random)).collect()
                };
                (0..columns * rows).map(heights).collect()
            }
            Self::Alone { rms } => (0..columns * rows)
                .map(|_| vec![rms * random.gaussian()])
                .collect(),
            Self::Correlated { rms, length } => {
                let smooth = smooth([columns, rows], length * density as f64, random);
                smooth.iter().map(|height| vec![rms * height]).collect()
            }
        }
    }
}

/// Returns the height below which a fraction of standard normal heights lie.
fn normal_quantile(fraction: f64) -> f64 {
    /// Steps of the sum over the density, from −6 on.
    const STEP: f64 = 1e-3;
    static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let density = |i: i32| {
            let x = f64::from(i) * STEP - 6.0;
            (-0.5 * x * x).exp() * STEP / TAU.sqrt()
        };
        let sum = |sum: &mut f64, i: i32| {
            *sum += density(i);
            Some(*sum)
        };
        (0..12_000).scan(0.0, sum).collect()
    });
    table.partition_point(|&below| below < fraction) as f64 * STEP - 6.0
}

/// Returns normal numbers of variance 1 whose correlation falls as exp(−d²/ℓ²) over a lattice that
/// repeats, ℓ in lattice points: white noise under a Gaussian.
fn smooth([columns, rows]: [usize; 2], length: f64, random: &mut Random) -> Vec<f64> {
    let mut values: Vec<f64> = (0..columns * rows).map(|_| random.gaussian()).collect();
    for (stride, count) in [(1, columns), (columns, rows)] {
        let kernel: Vec<f64> = (0..count)
            .map(|i| {
                let near = i.min(count - i) as f64 / length;
                (-2.0 * near * near).exp()
            })
            .collect();
        let norm = kernel.iter().map(|k| k * k).sum::<f64>().sqrt();
        values = (0..values.len())
            .map(|at| {
                let place = at / stride % count;
                let start = at - place * stride;
                let shifted = kernel
                    .iter()
                    .enumerate()
                    .map(|(i, k)| k * values[start + (place + i) % count * stride]);
                shifted.sum::<f64>() / norm
            })
            .collect();
    }
    values
}
