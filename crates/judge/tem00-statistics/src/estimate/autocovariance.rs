use core::ops::Range;

use num_complex::Complex;
use tem00_numerics::{
    Fft2, Fft2Scratch, Grid,
    cast::{to_f32, to_usize},
    check,
};

use crate::{
    StatisticsError,
    estimate::moments::{Scaled, check_finite},
};

/// Continuation of an image beyond its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Boundary {
    /// The image repeats, as a computed speckle pattern does.
    Periodic,
    /// Nothing is known beyond the edges, as for a camera's image.
    Finite,
}

/// Returns the normalised autocovariance of an image at every lag, in pixels: 1 at zero lag.
///
/// ```text
/// c(r) = ⟨ΔI(x) ΔI(x + r)⟩ / ⟨ΔI²⟩       ΔI = I − mean of the image
/// ```
///
/// For a [`Periodic`](Boundary::Periodic) image the average runs over all pixels, and the grid of
/// lags is as large as the image. For a [`Finite`](Boundary::Finite) image it runs over the pairs
/// of pixels that lie inside; the grid of lags is twice as large, and a lag of the full width or
/// height, for which there is no pair, holds 0. Lag `(x, y)` is stored at `(x, y)`, and negative
/// lags at the far end: read them with [`Grid::wrapped`].
///
/// # Bias
///
/// The mean of the image is not the expectation of its pixels: all lags of a speckle pattern are
/// too low by the coherence area divided by the area of the image, `4h² / πnₚ` for nₚ pixels. For a
/// tile computed from N unit phasors this is 1/N.
///
/// # Independence
///
/// No independence is assumed. The lags of one image are correlated with each other, and a lag near
/// the full size of a finite image is based on few pairs.
///
/// # Validity
///
/// The transforms are in `f32`: the error of the result is about 10⁻⁶, times the number of pixels
/// per pair in the finite case. The memory needed is about 20 bytes per lag.
///
/// # Errors
///
/// Returns an error if the image holds fewer than two pixels, one is not finite or all are the
/// same.
///
/// # Examples
///
/// Stripes that repeat every four pixels:
///
/// ```
/// use tem00_numerics::Grid;
/// use tem00_statistics::{Boundary, autocovariance};
///
/// let stripes = Grid::from_fn(8, 8, |x, _| [0.0, 1.0, 2.0, 1.0][x % 4]);
/// let covariance = autocovariance(&stripes, Boundary::Periodic)?;
/// assert!((covariance.wrapped(-4, 1) - 1.0).abs() < 1e-6);
/// assert!((covariance.wrapped(2, 0) + 1.0).abs() < 1e-6);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
pub fn autocovariance(image: &Grid<f32>, boundary: Boundary) -> Result<Grid<f32>, StatisticsError> {
    match boundary {
        Boundary::Periodic => autocovariance_from_spectrum(&power_spectrum(image)?),
        Boundary::Finite => {
            let (width, height) = (image.width(), image.height());
            let mut lags = transformed_back(&power(image, 2 * width, 2 * height)?)?;
            let zero = f64::from(lags[(0, 0)]);
            let count = (width * height) as f64;
            lags.for_each_row_mut(|y, row| {
                for (x, lag) in row.iter_mut().enumerate() {
                    let pairs = (pairs_at(x, width) * pairs_at(y, height)) as f64;
                    *lag = if pairs > 0.0 {
                        to_f32(f64::from(*lag) / zero * (count / pairs))
                    } else {
                        0.0
                    };
                }
            });
            Ok(lags)
        }
    }
}

/// Returns the [`autocovariance`] of a periodic image from its [`power_spectrum`], of which it is
/// the Fourier transform (Wiener and Khinchin).
///
/// # Errors
///
/// Returns an error if a value is not finite or their sum is not positive.
///
/// # Examples
///
/// ```
/// use tem00_numerics::Grid;
/// use tem00_statistics::{Boundary, autocovariance, estimate};
///
/// let image = Grid::from_fn(8, 8, |x, y| (x * y % 5) as f32);
/// let lags = estimate::autocovariance_from_spectrum(&estimate::power_spectrum(&image)?)?;
/// assert_eq!(lags, autocovariance(&image, Boundary::Periodic)?);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
pub fn autocovariance_from_spectrum(spectrum: &Grid<f32>) -> Result<Grid<f32>, StatisticsError> {
    check_finite(spectrum.values())?;
    let mut lags = transformed_back(spectrum)?;
    let variance = lags[(0, 0)];
    let allowed = "positive in the sum of its values";
    let holds = variance > 0.0 && variance.is_finite();
    check::that(holds, "spectrum", f64::from(variance), "", allowed)?;
    lags.for_each_row_mut(|_, row| row.iter_mut().for_each(|lag| *lag /= variance));
    Ok(lags)
}

/// Returns the power spectrum of the fluctuations of a periodic image, in pixels² per unit
/// variance.
///
/// ```text
/// S(f) = |Σ ΔI(x) exp(−2πi f·x)|² / Σ ΔI²      f = (kx / width, ky / height) cycles per pixel
/// ```
///
/// Frequency `(kx, ky)` is stored at `(kx, ky)`, and negative frequencies at the far end. The mean
/// of S over all frequencies is 1; for speckle of the size h pixels S is `h² S₁(|f| h)` with S₁ the
/// [`airy_power_spectrum`](crate::laws::airy_power_spectrum).
///
/// # Bias
///
/// The value at zero frequency is 0, because the mean is taken from the image itself; the other
/// values are too large by this amount. An image that is not periodic leaks: the jumps at its edges
/// appear along the axes as if they were part of it.
///
/// # Independence
///
/// No independence is assumed. For an image of any size each value is exponentially distributed
/// with its expectation as the mean, independently of the others except for S(−f) = S(f): use the
/// [`radial_average`].
///
/// # Errors
///
/// Returns an error if the image holds fewer than two pixels, one is not finite or all are the
/// same.
pub fn power_spectrum(image: &Grid<f32>) -> Result<Grid<f32>, StatisticsError> {
    power(image, image.width(), image.height())
}

/// The average of a grid over a ring of lags or frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// The mean distance of the cells from the origin.
    pub radius: f64,
    /// The mean of the values.
    pub mean: f64,
    /// The number of cells.
    pub count: usize,
}

/// Returns the averages of a grid of lags or frequencies over rings about its origin.
///
/// `step` is the size of a cell along x and y: `[1.0, 1.0]` for lags in pixels, `[1.0 / width,
/// 1.0 / height]` for frequencies in cycles per pixel. Ring k gathers the cells nearest to k times
/// the larger step, and the last one reaches half way along the shorter side.
///
/// # Bias
///
/// The average over a ring is the mean of the function, not its value at the mean radius: for a
/// parabola with the second derivative c″ they differ by `c″ step² / 24`.
///
/// # Independence
///
/// No independence is assumed. An autocovariance or power spectrum has the same value at opposite
/// cells: a ring holds half as many independent values as cells.
///
/// # Errors
///
/// Returns an error if a value is not finite or a step is not positive and finite.
///
/// # Examples
///
/// ```
/// use tem00_numerics::Grid;
/// use tem00_statistics::estimate::radial_average;
///
/// let grid = Grid::from_fn(4, 4, |x, y| if (x, y) == (0, 0) { 5.0 } else { 1.0 });
/// let rings = radial_average(&grid, [1.0, 1.0])?;
/// assert_eq!((rings[0].count, rings[0].mean), (1, 5.0));
/// assert_eq!((rings[1].count, rings[1].mean), (8, 1.0)); // four at 1, four at √2
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
pub fn radial_average(grid: &Grid<f32>, step: [f64; 2]) -> Result<Vec<Ring>, StatisticsError> {
    for size in step {
        check::positive("step", size, "")?;
    }
    check_finite(grid.values())?;
    let width = step[0].max(step[1]);
    let [aspect_x, aspect_y] = step.map(|size| size / width);
    let reach_x = (grid.width() / 2) as f64 * aspect_x;
    let reach_y = (grid.height() / 2) as f64 * aspect_y;
    let mut rings = vec![Ring::EMPTY; 1 + to_usize(reach_x.min(reach_y))];
    for (y, row) in grid.rows().enumerate() {
        let lag_y = distance_from_origin(y, grid.height()) * aspect_y;
        for (x, &value) in row.iter().enumerate() {
            let lag_x = distance_from_origin(x, grid.width()) * aspect_x;
            let radius = lag_x.hypot(lag_y);
            if let Some(ring) = rings.get_mut(to_usize(radius.round())) {
                ring.add(radius * width, value.into());
            }
        }
    }
    Ok(rings.into_iter().map(Ring::averaged).collect())
}

impl Ring {
    const EMPTY: Self = Self {
        radius: 0.0,
        mean: 0.0,
        count: 0,
    };

    const fn add(&mut self, radius: f64, value: f64) {
        self.radius += radius;
        self.mean += value;
        self.count += 1;
    }

    /// Turns sums into means. No ring is empty: each holds a cell of the axis with the larger step.
    fn averaged(self) -> Self {
        Self {
            radius: self.radius / self.count as f64,
            mean: self.mean / self.count as f64,
            count: self.count,
        }
    }
}

/// Returns every `stride`-th pixel of every `stride`-th row.
///
/// Samples of a speckle pattern that are at least the first zero of the autocovariance apart, 1.22
/// speckle sizes, have a correlation below 0.018 and count as independent in the tests of this
/// crate. The last, incomplete stride is left out, so that this also holds across the edges of a
/// periodic pattern.
///
/// # Errors
///
/// Returns an error if `stride` is zero or a sample is not finite.
///
/// # Examples
///
/// ```
/// use tem00_numerics::Grid;
/// use tem00_statistics::estimate::decorrelated_samples;
///
/// let grid = Grid::from_fn(7, 4, |x, y| (10 * y + x) as f32);
/// assert_eq!(decorrelated_samples(&grid, 3)?, [0.0, 3.0]);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
pub fn decorrelated_samples(grid: &Grid<f32>, stride: usize) -> Result<Vec<f64>, StatisticsError> {
    check::that(stride > 0, "stride", stride, "", "at least 1")?;
    check_finite(grid.values())?;
    // At least one sample along each axis, and none closer than a stride to the first of the next
    // period.
    let columns = (grid.width() / stride).max(1);
    let rows = (grid.height() / stride).max(1);
    Ok(grid
        .rows()
        .step_by(stride)
        .take(rows)
        .flat_map(|row| row.iter().step_by(stride).take(columns))
        .map(|&value| f64::from(value))
        .collect())
}

/// Returns the squared magnitudes of the Fourier transform of an image's fluctuations, in a
/// periodic array of zeros of the given size; per pixel, where the variance is 1.
fn power(image: &Grid<f32>, width: usize, height: usize) -> Result<Grid<f32>, StatisticsError> {
    let scaled = Scaled::new(image.values())?;
    scaled.check_varies()?;
    let fluctuations = |columns: Range<usize>, y, values: &mut [Complex<f32>]| {
        for (value, &pixel) in values.iter_mut().zip(&image.row(y)[columns]) {
            *value = to_f32(scaled.standardise(pixel)).into();
        }
    };
    // The squares of values of unit variance add up to the divisor of the variance.
    let scale = to_f32(((image.values().len() - 1) as f64).recip());
    let transform = Fft2::with_aperture(width, height, image.width(), image.height())?;
    let mut power = Grid::filled(width, height, 0.0);
    let squared = |_, _, amplitude: Complex<f32>| amplitude.norm_sqr() * scale;
    transform.forward_from(
        fluctuations,
        &mut power,
        &mut Fft2Scratch::default(),
        squared,
    );
    Ok(power)
}

/// Returns the transform of a power spectrum, which is even, so that the forward transform is the
/// backward one.
fn transformed_back(power: &Grid<f32>) -> Result<Grid<f32>, StatisticsError> {
    let transform = Fft2::new(power.width(), power.height())?;
    let copied = |columns: Range<usize>, y, values: &mut [Complex<f32>]| {
        for (value, &power) in values.iter_mut().zip(&power.row(y)[columns]) {
            *value = power.into();
        }
    };
    let mut lags = Grid::filled(power.width(), power.height(), 0.0);
    let real = |_, _, sum: Complex<f32>| sum.re;
    transform.forward_from(copied, &mut lags, &mut Fft2Scratch::default(), real);
    Ok(lags)
}

/// Returns the number of pairs among `size` pixels at the lag of `index`, in a grid of 2 · `size`
/// lags.
fn pairs_at(index: usize, size: usize) -> usize {
    size.abs_diff(index)
}

/// Returns the magnitude of the lag at `index`.
fn distance_from_origin(index: usize, size: usize) -> f64 {
    index.min(size - index) as f64
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use tem00_testkit::assert_absolute;

    use super::*;
    use crate::{airy_autocovariance, laws::airy_power_spectrum, synthetic::speckle_tile};

    fn noise(width: usize, height: usize) -> Grid<f32> {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let values = (0..width * height).map(|_| 3.0 + rng.random::<f32>());
        Grid::from_vec(width, height, values.collect()).unwrap()
    }

    fn signed(size: usize) -> i64 {
        i64::try_from(size).unwrap()
    }

    /// The autocovariance by its definition, as a sum over pairs.
    fn by_definition(image: &Grid<f32>, lag: [i64; 2], boundary: Boundary) -> f64 {
        let count = image.values().len() as f64;
        let mean = image.values().iter().map(|&v| f64::from(v)).sum::<f64>() / count;
        let (width, height) = (signed(image.width()), signed(image.height()));
        let (mut sum, mut pairs, mut variance) = (0.0, 0.0, 0.0);
        for y in 0..height {
            for x in 0..width {
                let (to_x, to_y) = (x + lag[0], y + lag[1]);
                let here = f64::from(*image.wrapped(x, y)) - mean;
                variance += here * here / count;
                let inside = (0..width).contains(&to_x) && (0..height).contains(&to_y);
                if inside || boundary == Boundary::Periodic {
                    sum += here * (f64::from(*image.wrapped(to_x, to_y)) - mean);
                    pairs += 1.0;
                }
            }
        }
        sum / pairs / variance
    }

    #[test]
    fn autocovariance_is_its_definition() {
        for (width, height) in [(12, 9), (7, 7), (1, 6), (16, 1)] {
            let image = noise(width, height);
            for boundary in [Boundary::Periodic, Boundary::Finite] {
                let lags = autocovariance(&image, boundary).unwrap();
                let (reach_x, reach_y) = (signed(width) - 1, signed(height) - 1);
                for lag_y in -reach_y..=reach_y {
                    for lag_x in -reach_x..=reach_x {
                        let direct = by_definition(&image, [lag_x, lag_y], boundary);
                        // Two f32 transforms of up to 432 values, and up to 108 pixels per pair.
                        let tolerance = 108.0 * 8.0 * f64::from(f32::EPSILON);
                        assert_absolute(f64::from(*lags.wrapped(lag_x, lag_y)), direct, tolerance);
                    }
                }
            }
        }
    }

    #[test]
    fn lags_without_a_pair_are_zero() {
        let lags = autocovariance(&noise(6, 5), Boundary::Finite).unwrap();
        assert_eq!((lags.width(), lags.height()), (12, 10));
        assert!(
            lags.row(5)
                .iter()
                .all(|&value| value.abs() < f32::MIN_POSITIVE)
        );
        assert!(lags.rows().all(|row| row[6].abs() < f32::MIN_POSITIVE));
    }

    #[test]
    fn speckle_has_the_airy_autocovariance() {
        const TILES: u32 = 16;
        let (size, diameter) = (192, 48);
        let mut sums = vec![0.0; size / 2];
        for seed in 0..u64::from(TILES) {
            let (tile, _) = speckle_tile(size, diameter, seed);
            let lags = autocovariance(&tile, Boundary::Periodic).unwrap();
            for (sum, value) in sums.iter_mut().zip(lags.row(0)) {
                *sum += f64::from(*value) / f64::from(TILES);
            }
        }
        let (_, phasors) = speckle_tile(size, diameter, 0);
        let speckle_size = size as f64 / (2.0 * (phasors as f64 / core::f64::consts::PI).sqrt());
        // The standard deviation of one lag of one tile is √(2 Σ chat² (cos − c)²) / N, 0.77 / C
        // where c is small and less elsewhere; 48 lags at once and α = 0.001 in all are 4.3 σ. The
        // mask's lattice adds 2e−4.
        let tolerance = 4.3 * 0.77 / diameter as f64 / f64::from(TILES).sqrt() + 2e-4;
        for (lag, value) in sums.iter().enumerate().take(48) {
            let theory = airy_autocovariance(lag as f64 / speckle_size) - 1.0 / phasors as f64;
            assert_absolute(*value, theory, tolerance);
        }
    }

    #[test]
    fn power_spectrum_of_speckle_is_the_overlap_of_its_pupil() {
        let (size, diameter) = (256, 64);
        let (tile, _) = speckle_tile(size, diameter, 3);
        let spectrum = power_spectrum(&tile).unwrap();
        let mean = spectrum.values().iter().map(|&v| f64::from(v)).sum::<f64>() / 65_536.0;
        // Parseval, in f32: 65536 squares of either sign of rounding.
        assert_absolute(mean, 1.0, 1e-5);
        let speckle_size = (size / diameter) as f64;
        let step = 1.0 / size as f64;
        for ring in radial_average(&spectrum, [step, step]).unwrap() {
            let theory = speckle_size.powi(2) * airy_power_spectrum(ring.radius * speckle_size);
            if ring.radius < 2.5 * step {
                continue; // fewer than ten independent values
            }
            // Exponential values, half of them independent: 4.6 σ are α = 0.001 for all rings,
            // since the sum of ten exponentials is not yet normal. For chat itself, 8e−4 is 1.2
            // ε^(3/2) half a ring from its edge, and 1.2e−3 is the fraction of four of the 3217
            // points of the mask's lattice.
            let spread = theory / (0.5 * ring.count as f64).sqrt();
            let chat = speckle_size.powi(2) * 4.0 / core::f64::consts::PI * 2e-3;
            assert_absolute(ring.mean, theory, 4.6 * spread + chat);
        }
    }

    #[test]
    fn rings_of_a_parabola_hold_its_mean() {
        let square = |index: usize, size: usize| (index.min(size - index) as f32).powi(2);
        let grid = Grid::from_fn(40, 24, |x, y| square(x, 40) + 4.0 * square(y, 24));
        let rings = radial_average(&grid, [1.0, 2.0]).unwrap();
        // Half way along x is 20, along y 24; rings are two wide.
        assert_eq!(rings.len(), 11);
        // From 1 to 3: 4 cells on the axis y = 0 and 5 on either side of it.
        assert_eq!((rings[0].count, rings[1].count), (1, 14));
        for (index, ring) in rings.iter().enumerate() {
            // ⟨r²⟩ − ⟨r⟩² is the variance within a ring two wide, at most 1.
            let variance = ring.mean - ring.radius * ring.radius;
            assert!(
                (-1e-9..=1.0).contains(&variance),
                "ring {index}: {variance}"
            );
            assert!((ring.radius - 2.0 * index as f64).abs() <= 1.0, "{index}");
        }
    }

    #[test]
    fn samples_keep_their_distance_across_the_edges() {
        let grid = Grid::from_fn(11, 9, |x, y| (x + 100 * y) as f32);
        let samples = decorrelated_samples(&grid, 4).unwrap();
        assert_eq!(samples, [0.0, 4.0, 400.0, 404.0]);
        assert_eq!(decorrelated_samples(&grid, 50).unwrap(), [0.0]);
    }
}
