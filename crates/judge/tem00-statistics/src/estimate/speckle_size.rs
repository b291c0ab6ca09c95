use tem00_numerics::Grid;

use crate::{
    Boundary, StatisticsError, airy_autocovariance, autocovariance,
    estimate::Axis,
    estimate::moments::check_finite,
    laws::{AIRY_FIRST_ZERO, AIRY_HALF_WIDTH},
};

/// The speckle size h along both axes of an image, in pixels.
///
/// ```text
/// h = (lag at which the autocovariance is 1/2) / 0.514497
/// ```
///
/// Between the two pixels around the half value, the lag is interpolated on a scale on which the
/// autocovariance of a circular pupil is a straight line, so that for such a pupil the size is
/// exact from one pixel on.
///
/// # Bias
///
/// Pixels that integrate over their area widen the autocovariance: the measured size of speckles of
/// 1, 1.5, 2, 3, 4 and 8 pixels is 39 %, 15 %, 8.6 %, 3.6 %, 2.0 % and 0.5 % too large. Because the
/// mean is taken from the image itself, the measured size is too small by the fraction
/// `0.86 h² / nₚ` for nₚ pixels.
///
/// # Independence
///
/// No independence is assumed. The relative standard deviation of h from image to image is 0.62 /
/// n, where the image is n speckle sizes wide and high.
///
/// # Examples
///
/// ```
/// use tem00_numerics::Grid;
/// use tem00_statistics::{SpeckleSize, airy_autocovariance};
///
/// let lag = |i: usize| i.min(32 - i) as f64;
/// let covariance =
///     Grid::from_fn(32, 32, |x, y| airy_autocovariance(lag(x).hypot(lag(y)) / 3.2) as f32);
/// let size = SpeckleSize::from_autocovariance(&covariance)?;
/// assert!((size.x() - 3.2).abs() < 1e-5);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckleSize {
    x: f64,
    y: f64,
}

impl SpeckleSize {
    /// Measures the speckle size of `image`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`autocovariance`] and of
    /// [`from_autocovariance`](Self::from_autocovariance).
    pub fn from_image(image: &Grid<f32>, boundary: Boundary) -> Result<Self, StatisticsError> {
        Self::from_autocovariance(&autocovariance(image, boundary)?)
    }

    /// Measures the speckle size from an autocovariance, with zero lag at `(0, 0)`.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is not finite, if the value at zero lag is not positive, if
    /// speckles are smaller than a pixel, or if the autocovariance does not fall to one half within
    /// half the grid.
    pub fn from_autocovariance(lags: &Grid<f32>) -> Result<Self, StatisticsError> {
        Ok(Self {
            x: Self::along(Axis::X, lags)?,
            y: Self::along(Axis::Y, lags)?,
        })
    }

    /// Measures the speckle size along one axis from an autocovariance, with zero lag at `(0, 0)`,
    /// in pixels. The image need not resolve or contain the speckle along the other axis.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`from_autocovariance`](Self::from_autocovariance), for this axis
    /// alone.
    pub fn along(axis: Axis, lags: &Grid<f32>) -> Result<f64, StatisticsError> {
        let zero = f64::from(lags[(0, 0)]);
        check_finite(lags.values())?;
        if zero <= 0.0 {
            return Err(StatisticsError::refused(
                "lags",
                zero,
                "positive and finite at zero lag",
            ));
        }
        let along_x = |lag| f64::from(lags[(lag, 0)]) / zero;
        let along_y = |lag| f64::from(lags[(0, lag)]) / zero;
        match axis {
            Axis::X => size_along(axis, along_x, lags.width()),
            Axis::Y => size_along(axis, along_y, lags.height()),
        }
    }

    /// Returns the speckle size along x, in pixels.
    pub const fn x(&self) -> f64 {
        self.x
    }

    /// Returns the speckle size along y, in pixels.
    pub const fn y(&self) -> f64 {
        self.y
    }

    /// Returns the geometric mean of both sizes, in pixels: the size of a round speckle of the same
    /// area.
    pub fn mean(&self) -> f64 {
        (self.x * self.y).sqrt()
    }
}

fn size_along(
    axis: Axis,
    covariance: impl Fn(usize) -> f64,
    lags: usize,
) -> Result<f64, StatisticsError> {
    let largest_lag = lags.saturating_sub(1) / 2;
    let too_coarse = StatisticsError::TooCoarse { axis, largest_lag };
    let outer = (1..=largest_lag)
        .find(|&lag| covariance(lag) <= 0.5)
        .ok_or(too_coarse)?;
    let neighbours = covariance(1);
    if neighbours < airy_autocovariance(1.0) {
        return Err(StatisticsError::Unresolved { axis, neighbours });
    }
    let inner_argument = airy_argument(covariance(outer - 1));
    let outer_argument = airy_argument(covariance(outer));
    let fraction = (AIRY_HALF_WIDTH - inner_argument) / (outer_argument - inner_argument);
    Ok((outer as f64 - 1.0 + fraction) / AIRY_HALF_WIDTH)
}

/// Returns the r before the first zero at which the Airy autocovariance is `value`.
fn airy_argument(value: f64) -> f64 {
    if value >= 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, AIRY_FIRST_ZERO);
    // The bracket halves to below the spacing of numbers near 1.
    for _ in 0..54 {
        let middle = 0.5 * (low + high);
        if airy_autocovariance(middle) > value {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use tem00_numerics::cast::to_f32;
    use tem00_testkit::assert_relative;

    use super::*;
    use crate::synthetic::speckle_tile;

    fn airy_lags(size: usize, [h_x, h_y]: [f64; 2]) -> Grid<f32> {
        let lag = |i: usize| i.min(size - i) as f64;
        Grid::from_fn(size, size, |x, y| {
            to_f32(airy_autocovariance((lag(x) / h_x).hypot(lag(y) / h_y)))
        })
    }

    #[test]
    fn airy_autocovariance_gives_its_size_between_the_pixels() {
        for h in [1.01, 1.5, 1.943, 1.944, 2.0, 3.7, 11.3] {
            let size = SpeckleSize::from_autocovariance(&airy_lags(64, [h, 1.3 * h])).unwrap();
            // f32 values, whose slope is 0.1 at least: 6e−8 / 0.1 in units of h.
            assert_relative(size.x(), h, 2e-6);
            assert_relative(size.y(), 1.3 * h, 2e-6);
            assert_relative(size.mean(), 1.3_f64.sqrt() * h, 2e-6);
        }
    }

    #[test]
    fn one_axis_is_measured_where_the_other_cannot_be() {
        let lags = airy_lags(64, [3.0, 80.0]);
        let coarse = StatisticsError::TooCoarse {
            axis: Axis::Y,
            largest_lag: 31,
        };
        assert_eq!(SpeckleSize::from_autocovariance(&lags), Err(coarse.clone()));
        assert_eq!(SpeckleSize::along(Axis::Y, &lags), Err(coarse));
        let size = SpeckleSize::along(Axis::X, &lags).unwrap();
        // f32 values, whose slope is 0.1 at least: 6e−8 / 0.1 in units of h.
        assert_relative(size, 3.0, 2e-6);
    }

    #[test]
    fn computed_speckle_has_the_size_of_its_pupil() {
        const TILES: u64 = 8;
        let (size, diameter) = (256, 64);
        for boundary in [Boundary::Periodic, Boundary::Finite] {
            let mut sum = 0.0;
            for seed in 0..TILES {
                let (tile, _) = speckle_tile(size, diameter, seed);
                let measured = SpeckleSize::from_image(&tile, boundary).unwrap();
                sum += measured.x() + measured.y();
            }
            let mean = sum / (2 * TILES) as f64;
            // One size has the relative standard deviation 0.62 / C; the two axes count as one, 3.3
            // σ. The bias is 0.86 / C² and the square of the spread, and C of the lattice mask has
            // an error of 1e−3.
            let spread = 0.62 / diameter as f64;
            let tolerance = 3.3 * spread / (TILES as f64).sqrt() + 1e-3 + 2.0 * spread * spread;
            assert_relative(mean, 4.0, tolerance);
        }
    }

    #[test]
    fn sizes_spread_from_tile_to_tile_as_stated() {
        const TILES: u64 = 100;
        let (size, diameter) = (64, 32);
        let mut samples = Vec::new();
        for seed in 0..TILES {
            let (tile, _) = speckle_tile(size, diameter, seed);
            let measured = SpeckleSize::from_image(&tile, Boundary::Periodic).unwrap();
            samples.push(measured.x());
        }
        let spread = crate::Moments::from_samples(&samples)
            .unwrap()
            .standard_deviation()
            / 2.0;
        // A spread from 100 samples has a relative standard error of 1/√200 = 7 %, here 3.3 σ, to
        // first order in 1/C.
        let tolerance = 3.3 * 0.07 + 2.0 / diameter as f64;
        assert_relative(spread, 0.62 / diameter as f64, tolerance);
    }
}
