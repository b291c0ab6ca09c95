use core::f64::consts::PI;

/// The mean number of speckles per area, in units of h⁻²: one per
/// [`COHERENCE_AREA`](crate::laws::COHERENCE_AREA).
pub const SPECKLE_DENSITY: f64 = PI / 4.0;

/// The mean number of phase singularities per area, in units of h⁻².
///
/// ```text
/// σ_k² / 2π = π / (8 h²)        σ_k² = π²/4h², the variance of the wave number along one axis
/// ```
///
/// At each singularity the intensity is zero and the phase turns once around, in one sense or the
/// other with equal frequency. There is one singularity per two speckles. The value holds for fully
/// developed speckle behind a circular pupil.
///
/// # References
///
/// - M. V. Berry, *Disruption of wavefronts: statistics of dislocations in incoherent Gaussian
///   random waves*, 1978.
/// - M. V. Berry and M. R. Dennis, *Phase singularities in isotropic random waves*, 2000.
pub const VORTEX_DENSITY: f64 = PI / 8.0;

/// The mean square of the slope of the intensity along one axis, in units of the squared mean
/// intensity per h².
///
/// ```text
/// ⟨(∂I/∂x)²⟩ = 2σ_k² ⟨I⟩² = π² ⟨I⟩² / (2 h²)
/// ```
///
/// It is the curvature of the [`airy_autocovariance`](crate::airy_autocovariance) at its maximum.
pub const MEAN_SQUARE_SLOPE: f64 = PI * PI / 2.0;

/// Returns the number of upward crossings of a `level`, in units of the mean intensity, by the
/// intensity of fully developed speckle, per length h of a straight line.
///
/// ```text
/// N(x) = (√π / 2) √x exp(−x)
/// ```
///
/// The number of downward crossings is the same. Half the mean is crossed upwards 0.380 times per
/// speckle size, more often than any other level. The pupil is circular.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::level_crossings;
///
/// assert!((level_crossings(0.5) - 0.380_1).abs() < 1e-4);
/// ```
///
/// # References
///
/// - S. O. Rice, *Mathematical analysis of random noise*, 1945, §3.3.
/// - K. Ebeling, *Statistical properties of spatial derivatives of the amplitude and intensity of
///   monochromatic speckle patterns*, 1979.
pub fn level_crossings(level: f64) -> f64 {
    // exp(−750) is 0.
    let level = level.clamp(0.0, 750.0);
    0.5 * PI.sqrt() * level.sqrt() * (-level).exp()
}

/// Returns the fraction of the area of fully developed speckle that is brighter than `level`, in
/// units of the mean intensity: `exp(−level)`, and 1 below zero.
pub fn area_fraction_above(level: f64) -> f64 {
    (-level.max(0.0)).exp()
}

#[cfg(test)]
mod tests {
    use tem00_numerics::Grid;
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::{airy_autocovariance, laws::COHERENCE_AREA, synthetic::speckle_tile};

    const TILES: u64 = 8;
    const SIZE: usize = 512;
    const DIAMETER: usize = 32;
    /// The speckle size in pixels.
    const H: f64 = 16.0;

    /// The means of `counts` over the tiles, per pixel.
    fn per_pixel<const N: usize>(counts: impl Fn(&Grid<f32>) -> [f64; N]) -> [f64; N] {
        let mut sums = [0.0; N];
        for seed in 0..TILES {
            let tile = counts(&speckle_tile(SIZE, DIAMETER, seed).0);
            sums.iter_mut()
                .zip(tile)
                .for_each(|(sum, count)| *sum += count);
        }
        sums.map(|sum| sum / TILES as f64 / (SIZE * SIZE) as f64)
    }

    fn signed(index: usize) -> i64 {
        i64::try_from(index).unwrap()
    }

    /// The sum of `f(value, right neighbour)` over a periodic tile.
    fn over_neighbours(tile: &Grid<f32>, f: impl Fn(f64, f64) -> f64) -> f64 {
        let mut sum = 0.0;
        for y in 0..SIZE {
            for x in 0..SIZE {
                let right = *tile.wrapped(signed(x) + 1, signed(y));
                sum += f(f64::from(tile[(x, y)]), f64::from(right));
            }
        }
        sum
    }

    #[test]
    fn mean_square_slope_is_the_curvature_of_the_autocovariance() {
        // c = 1 − ½ ⟨I_x²⟩ r² + O(r⁴), here 5π⁴/192 r⁴.
        let r = 1e-3;
        let curvature = 2.0 * (1.0 - airy_autocovariance(r)) / (r * r);
        assert_relative(curvature, MEAN_SQUARE_SLOPE, 2e-6);
    }

    #[test]
    fn drawn_speckle_has_the_mean_square_slope() {
        let [slope] = per_pixel(|tile| [over_neighbours(tile, |a, b| (b - a).powi(2))]);
        // The slope squared has the variance of I's derivative, ⟨I_x⁴⟩ = 24σ_k⁴ = 6 ⟨I_x²⟩², about
        // √5 per sample and two samples per coherence area: 3.3 σ. Differences over h/16 are
        // smaller by the factor 1 − (5π²/96)(1/16)²·…, 0.2 %; the corners of the lattice add 0.4 %.
        let samples = 2.0 * TILES as f64 * PI / 4.0 * (DIAMETER * DIAMETER) as f64;
        let tolerance = 3.3 * (5.0 / samples).sqrt() + 6e-3;
        assert_relative(slope * H * H, MEAN_SQUARE_SLOPE, tolerance);
    }

    #[test]
    fn drawn_speckle_crosses_levels_as_often_as_stated() {
        let levels = [0.5, 1.0, 2.0];
        let rises = per_pixel(|tile| {
            levels.map(|level| {
                over_neighbours(tile, |a, b| f64::from(u8::from(a < level && b >= level)))
            })
        });
        for (level, share) in levels.into_iter().zip(rises) {
            let crossings = share * H;
            let exact = level_crossings(level);
            // The error is at most the Poisson error of independent rows at the distance h: 3.3 σ.
            // Double crossings within h/16 are missed, of the order of 1 %, and the lattice mask
            // has an error of 0.2 %.
            let count = exact / H * TILES as f64 * (SIZE * SIZE) as f64 / H;
            let tolerance = 3.3 / count.sqrt() + 0.012;
            assert_relative(crossings, exact, tolerance);
        }
        assert!(level_crossings(-1.0).abs() < f64::MIN_POSITIVE);
        assert!(level_crossings(f64::INFINITY) < 1e-300);
    }

    #[test]
    fn drawn_speckle_is_brighter_than_a_level_on_the_stated_area() {
        let levels = [0.1, 1.0, 3.0];
        let above = |tile: &Grid<f32>, level: f64| {
            let bright = tile
                .values()
                .iter()
                .filter(|&&value| f64::from(value) > level);
            bright.count() as f64
        };
        let measured = per_pixel(|tile| levels.map(|level| above(tile, level)));
        for (level, area) in levels.into_iter().zip(measured) {
            let share = area_fraction_above(level);
            let samples = TILES as f64 * PI / 4.0 * (DIAMETER * DIAMETER) as f64;
            // The tolerance is 3.3 binomial σ, plus 1/N = 1/800 for the fixed mean.
            let tolerance = 3.3 * (share * (1.0 - share) / samples).sqrt() + 1.0 / 800.0;
            assert_absolute(area, share, tolerance);
        }
        assert_absolute(area_fraction_above(-3.0), 1.0, 1e-15);
    }

    #[test]
    fn densities_are_one_and_one_half_per_coherence_area() {
        assert_absolute(SPECKLE_DENSITY * COHERENCE_AREA, 1.0, 1e-15);
        assert_absolute(VORTEX_DENSITY * COHERENCE_AREA, 0.5, 1e-15);
    }
}
