use tem00_numerics::{Grid, cast::to_f32};

use crate::{
    StatisticsError,
    estimate::moments::{Scaled, check_finite},
};

/// Returns the contrast of an image within a square window at every pixel: the map of laser speckle
/// contrast imaging, in which speckle that moves during the exposure has a low contrast.
///
/// ```text
/// K = s / m         over window × window pixels, s² with the divisor n − 1
/// ```
///
/// The value at `(x, y)` belongs to the window whose first pixel is `(x, y)`; only windows inside
/// the image are used, so that the map is `window − 1` pixels smaller along both axes.
///
/// # Bias
///
/// A window of few speckles underestimates the contrast, because its own mean follows the pattern.
/// The expectation of s² is
///
/// ```text
/// σ² (1 − c̄) n / (n − 1)     c̄ the mean autocovariance of two pixels of the window, n = window²
/// ```
///
/// where for pixels much smaller than a speckle c̄ is the squared
/// [`pixel_contrast`](crate::pixel_contrast) of the window. K itself is lower still, because its
/// expectation is not the square root of this expectation. Nothing is corrected.
///
/// # Independence
///
/// No independence of the pixels is assumed. Windows that overlap share pixels.
///
/// # Errors
///
/// Returns an error if the window is smaller than two pixels or larger than the image, a pixel is
/// not finite, or the mean over a window is not positive.
///
/// # Examples
///
/// ```
/// use tem00_numerics::Grid;
/// use tem00_statistics::estimate::local_contrast;
///
/// let image = Grid::from_fn(4, 3, |x, _| [1.0, 1.0, 3.0, 3.0][x]);
/// let map = local_contrast(&image, 2)?;
/// assert_eq!((map.width(), map.height()), (3, 2));
/// assert_eq!(map[(0, 0)], 0.0);
/// assert!((map[(1, 0)] - 3.0_f32.sqrt().recip()).abs() < 1e-6); // s² = 4/3, m = 2
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - J. D. Briers and S. Webster, *Laser speckle contrast analysis (LASCA)*, 1996.
pub fn local_contrast(image: &Grid<f32>, window: usize) -> Result<Grid<f32>, StatisticsError> {
    StatisticsError::check_window(window, image)?;
    check_finite(image.values())?;
    let (width, height) = (image.width() - window + 1, image.height() - window + 1);
    let mut contrasts = Vec::with_capacity(width * height);
    let mut pixels = Vec::with_capacity(window * window);
    for y in 0..height {
        for x in 0..width {
            pixels.clear();
            for row in y..y + window {
                pixels.extend_from_slice(&image.row(row)[x..x + window]);
            }
            let scaled = Scaled::new(&pixels)?;
            scaled.check_mean()?;
            contrasts.push(to_f32(scaled.standard_deviation / scaled.mean));
        }
    }
    let at = |x: usize, y: usize| contrasts[y * width + x];
    Ok(Grid::from_fn(width, height, at))
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::{Contrast, Moments, airy_autocovariance, pixel_contrast, synthetic::speckle_tile};

    #[test]
    fn each_value_is_the_contrast_of_its_window() {
        let (tile, _) = speckle_tile(32, 8, 4);
        let image = Grid::from_fn(20, 13, |x, y| tile[(x, y)]);
        let map = local_contrast(&image, 5).unwrap();
        assert_eq!((map.width(), map.height()), (16, 9));
        for (x, y) in [(0, 0), (15, 0), (3, 8), (15, 8)] {
            let window = Grid::from_fn(5, 5, |i, j| image[(x + i, y + j)]);
            let contrast = Contrast::from_samples(window.values()).unwrap().value();
            assert_relative(f64::from(map[(x, y)]), contrast, 1e-7);
        }
    }

    /// c̄ over all pairs of pixels of a window.
    fn mean_covariance(window: u32, speckle_size: f64) -> f64 {
        let mut sum = 0.0;
        for x in 0..window {
            for y in 0..window {
                let pairs = |lag: u32| f64::from(window - lag) * if lag > 0 { 2.0 } else { 1.0 };
                let lag = f64::from(x).hypot(f64::from(y)) / speckle_size;
                sum += pairs(x) * pairs(y) * airy_autocovariance(lag);
            }
        }
        sum / f64::from(window).powi(4)
    }

    #[test]
    fn windows_miss_the_share_of_the_variance_that_is_stated() {
        const TILES: u64 = 6;
        let (size, diameter, window) = (128, 32, 7_u8);
        let mut variances = Vec::new();
        for seed in 0..TILES {
            let (tile, _) = speckle_tile(size, diameter, seed);
            let contrasts = local_contrast(&tile, usize::from(window)).unwrap();
            // Windows more than a speckle apart count as independent; K m is the standard
            // deviation.
            for y in (0..contrasts.height()).step_by(12) {
                for x in (0..contrasts.width()).step_by(12) {
                    let corner = Grid::from_fn(7, 7, |i, j| tile[(x + i, y + j)]);
                    let mean = Moments::from_samples(corner.values()).unwrap().mean();
                    variances.push((f64::from(contrasts[(x, y)]) * mean).powi(2));
                }
            }
        }
        let measured = Moments::from_samples(&variances).unwrap();
        let n = f64::from(window).powi(2);
        let law = (1.0 - mean_covariance(u32::from(window), 4.0)) * n / (n - 1.0);
        // The tolerance is 3.3 σ, plus 1/N for the 800 phasors.
        let tolerance = 3.3 * measured.standard_error() + 1.0 / 800.0;
        assert_absolute(measured.mean(), law, tolerance);
        assert!(law < 0.78 && tolerance < 0.15, "{law} ± {tolerance}");
        // For small pixels the window acts as one large pixel.
        let fine = mean_covariance(200, 100.0).sqrt();
        assert_relative(fine, pixel_contrast(2.0), 2e-4);
    }
}
