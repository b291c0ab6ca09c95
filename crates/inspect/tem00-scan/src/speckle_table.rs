use glam::DVec2;
use tem00_numerics::cast::to_usize;
use tem00_numerics::parallel;

use crate::sensor_speckle::SensorSpeckle;

/// Covariance of the speckle in the pixels of a sensor, for displacements that are whole pixels
/// apart from each other.
///
/// ```text
/// c(d) = ∫∫ Λ(u) Λ(v) c(dₓ + s u, d_y + s v) du dv      Λ(u) = 1 − |u| from −1 to 1
/// ```
///
/// with the side s of the sensitive part of a pixel: the autocovariance of [`SensorSpeckle`],
/// integrated over two pixels.
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007: the autocovariance of speckle in an image,
///   and integration over a detector.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SpeckleTable {
    /// The displacement to which whole pixels are added.
    offset: [f64; 2],
    /// The covariances by column and row, both from −reach to reach.
    values: Vec<f64>,
    reach: [usize; 2],
}

/// Distance up to which covariances are kept, in speckle sizes: beyond it, the covariances of a row
/// add up to less than 10⁻⁴ of the first.
const REACH: f64 = 12.0;

/// The maximum number of pixels to either side that are kept.
const MAX: usize = 256;

impl SpeckleTable {
    /// Integrates the covariances for the displacements that differ from `offset`, in pixels to the
    /// right and down, by whole pixels.
    pub(super) fn new(speckle: &SensorSpeckle, offset: [f64; 2]) -> Self {
        Self::within(speckle, offset, speckle.size().map(pixels_within_reach))
    }

    /// Integrates the covariances of the pixels of one column, up to `rows` rows apart.
    pub(super) fn of_column(speckle: &SensorSpeckle, rows: usize) -> Self {
        Self::within(speckle, [0.0; 2], [0, rows])
    }

    /// Returns the number of rows beyond which the covariances of a speckle count as 0.
    pub(super) fn rows_within_reach(speckle: &SensorSpeckle) -> usize {
        pixels_within_reach(speckle.size()[1])
    }

    /// Interpolates between tables of one size in two rows of two.
    pub(super) fn between(corners: [[&Self; 2]; 2], position: DVec2) -> Self {
        let mix = |a: f64, b: f64, fraction: f64| a + fraction * (b - a);
        let value = |index: usize| {
            let rows = corners.map(|row| {
                let [left, right] = row.map(|table| table.values[index]);
                mix(left, right, position.x)
            });
            mix(rows[0], rows[1], position.y)
        };
        let first = corners[0][0];
        Self {
            values: (0..first.values.len()).map(value).collect(),
            ..*first
        }
    }

    fn within(speckle: &SensorSpeckle, offset: [f64; 2], reach: [usize; 2]) -> Self {
        let offset = offset.map(f64::fract);
        let [columns, rows] = reach.map(|reach| 2 * reach + 1);
        let value = |index: usize| {
            let steps = [index % columns, index / columns];
            speckle.covariance([0, 1].map(|axis| {
                let whole = steps[axis] as f64 - reach[axis] as f64;
                offset[axis] + whole
            }))
        };
        let count = columns * rows;
        let mut values: Vec<f64>;
        if offset.iter().all(|&part| part == 0.0) {
            // Covariances are the same on both sides of the middle.
            values = parallel::map(count / 2 + 1, value);
            values.extend_from_within(..count / 2);
            values[count / 2 + 1..].reverse();
        } else {
            values = parallel::map(count, value);
        }
        Self {
            offset,
            values,
            reach,
        }
    }

    /// Returns the number of columns to either side beyond which covariances count as 0.
    pub(super) const fn columns(&self) -> usize {
        self.reach[0]
    }

    /// The index of a displacement along one axis.
    fn index(&self, axis: usize, displacement: f64) -> Option<usize> {
        let steps = (displacement - self.offset[axis]).round() + self.reach[axis] as f64;
        (0.0..=2.0 * self.reach[axis] as f64)
            .contains(&steps)
            .then(|| to_usize(steps))
    }

    /// Returns the covariance of the speckle factors of two pixels, a displacement in pixels apart;
    /// 0 beyond 12 speckle sizes.
    pub(super) fn covariance(&self, displacement: [f64; 2]) -> f64 {
        let [column, row] = [0, 1].map(|axis| self.index(axis, displacement[axis]));
        match (column, row) {
            (Some(column), Some(row)) => self.values[row * (2 * self.reach[0] + 1) + column],
            _ => 0.0,
        }
    }
}

fn pixels_within_reach(size: f64) -> usize {
    to_usize((REACH * size).ceil().clamp(2.0, MAX as f64))
}

#[cfg(test)]
mod tests {
    use glam::DMat2;
    use tem00_statistics::{
        laws::{PixelAutocovariance, PixelColumn},
        pixel_contrast,
    };

    use super::*;

    fn speckle(size: f64, sensitive_side: f64) -> SensorSpeckle {
        SensorSpeckle {
            speckles_per_pixel: DMat2::from_diagonal(DVec2::splat(size.recip())),
            sensitive_side,
            variance: 1.0,
        }
    }

    #[test]
    fn a_pixel_has_the_contrast_of_integrated_speckle() {
        for (size, side) in [(0.5, 1.0), (1.0, 0.9), (2.0, 1.0), (4.0, 0.7)] {
            let table = SpeckleTable::new(&speckle(size, side), [0.0; 2]);
            let contrast = pixel_contrast(side / size);
            // Panels of half a speckle leave 10⁻⁷ to four nodes.
            let error = table.covariance([0.0; 2]) - contrast * contrast;
            assert!(error.abs() < 1e-6, "h = {size}: {error:e}");
        }
    }

    #[test]
    fn rows_and_averaged_columns_have_the_covariances_of_the_spectrum() {
        for (size, side) in [(1.15, 1.0), (2.5, 0.8)] {
            let table = SpeckleTable::new(&speckle(size, side), [0.0; 2]);
            let of_columns = |averaged_columns| {
                PixelAutocovariance::new(&PixelColumn {
                    size: [side / size; 2],
                    pitch: [1.0 / size; 2],
                    pixels: 6,
                    averaged_columns,
                })
                .unwrap()
            };
            let (one, three) = (of_columns(1), of_columns(3));
            for lag in 0..6 {
                let at = |column: f64| table.covariance([column, lag as f64]);
                let mean = (3.0 * at(0.0) + 4.0 * at(1.0) + 2.0 * at(2.0)) / 9.0;
                // Panels of half a speckle leave 10⁻⁷ to four nodes.
                let errors = [at(0.0) - one.covariance(lag), mean - three.covariance(lag)];
                assert!(errors.iter().all(|e| e.abs() < 1e-6), "{lag}: {errors:?}");
            }
        }
    }

    #[test]
    fn the_covariance_falls_on_all_sides_alike() {
        let speckle = speckle(2.0, 1.0);
        let table = SpeckleTable::new(&speckle, [0.0; 2]);
        let beside = table.covariance([3.0, 1.0]);
        assert!(beside < 0.1 * table.covariance([0.0; 2]), "{beside}");
        for same in [[-3.0, 1.0], [3.0, -1.0], [1.0, 3.0]] {
            let other = table.covariance(same);
            assert!((beside - other).abs() < 1e-12, "{same:?}: {other}");
        }
        assert!(
            table.covariance([100.0, 0.0]).abs() < 1e-300,
            "beyond the table"
        );
    }

    #[test]
    fn displacements_may_be_fractions_of_a_pixel() {
        let speckle = speckle(2.0, 1.0);
        let offset = [7.25, -3.5];
        let table = SpeckleTable::new(&speckle, offset);
        for displacement in [[0.25, 0.5], [1.25, -0.5], [-0.75, 2.5]] {
            let direct = speckle.covariance(displacement);
            let found = table.covariance(displacement);
            assert!((found - direct).abs() < 1e-14, "{displacement:?}: {found}");
        }
    }
}
