/// Returns the speckle size before widening by square pixels without gaps, from the `measured`
/// size, both in pixels; `None` if it was below 0.95 pixels, where the pixels hide it.
///
/// ```text
/// measured² = h² + 0.64 + 0.30 / h²
/// ```
///
/// # Validity
///
/// The formula is fitted to the autocovariance of a circular pupil behind such pixels, as sampled
/// by them: the error of h is 1 % at most.
///
/// # Examples
///
/// ```
/// use tem00_statistics::estimate::size_before_pixels;
///
/// // Speckles of two pixels look 9 % wider.
/// let size = size_before_pixels(2.172).expect("wider than a pixel");
/// assert!((size - 2.0).abs() < 0.01);
/// assert_eq!(size_before_pixels(1.0), None);
/// ```
pub fn size_before_pixels(measured: f64) -> Option<f64> {
    let excess = measured * measured - 0.64;
    let root = (excess * excess - 4.0 * 0.30).sqrt();
    let size = (0.5 * (excess + root)).sqrt();
    // The comparison is also false where there is no root.
    (size >= 0.95).then_some(size)
}

#[cfg(test)]
mod tests {
    use tem00_numerics::Grid;

    use tem00_numerics::cast::to_f32;

    use super::*;
    use crate::{SpeckleSize, airy_autocovariance};

    /// The Airy autocovariance of speckles of `size` pixels behind square pixels, by the midpoint
    /// rule over the differences of two points in them.
    fn behind_pixels(size: f64, lag: f64) -> f64 {
        const STEPS: u32 = 100;
        let difference = |step: u32| (f64::from(step) + 0.5) / 50.0 - 1.0;
        let mut sum = 0.0;
        for y in (0..STEPS).map(difference) {
            for x in (0..STEPS).map(difference) {
                let weight = (1.0 - x.abs()) * (1.0 - y.abs());
                sum += weight * airy_autocovariance((lag + x).hypot(y) / size);
            }
        }
        sum
    }

    #[test]
    fn widening_is_undone() {
        for size in [0.96, 1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 20.0] {
            let line: Vec<f64> = (0..13_u32)
                .map(|lag| behind_pixels(size, lag.into()))
                .collect();
            let along = |lag: usize| to_f32(line[lag.min(25 - lag)] / line[0]);
            let lags = Grid::from_fn(25, 25, |x, y| along(x).min(along(y)));
            let measured = SpeckleSize::from_autocovariance(&lags).expect("it falls");
            let found = size_before_pixels(measured.x()).expect("above a pixel");
            assert!((found / size - 1.0).abs() < 0.01, "{found} for {size}");
        }
    }

    #[test]
    fn speckles_smaller_than_a_pixel_have_no_size() {
        assert_eq!(size_before_pixels(1.0), None);
        assert_eq!(size_before_pixels(1.3), None);
        assert_eq!(size_before_pixels(1.34), None);
    }
}
