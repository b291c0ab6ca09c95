use core::f64::consts::{PI, TAU};

use glam::DVec3;
use tem00_numerics::Grid;

use crate::{TracerError, error::check};

/// Columns whose radiances share one entry of the cumulative sums: sums for each column would take
/// more memory than the map.
const BLOCK: usize = 32;

/// A map of latitude by longitude with the sums needed to draw directions from it.
///
/// In its own axes the middle of the map is towards x, its right towards y, and its upper edge
/// towards z.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RadianceMap {
    radiance: Grid<f32>,
    /// For each row, the sums of the radiances before each block of columns.
    before_block: Grid<f64>,
    /// Σ radiance × solid angle of the rows up to and with each row, in W/m².
    up_to_row: Vec<f64>,
}

impl RadianceMap {
    pub(super) fn new(radiance: Grid<f32>) -> Result<Self, TracerError> {
        let allowed = "finite and not negative, everywhere in the map";
        for &value in radiance.values() {
            check("radiance", f64::from(value), 0.0..f64::INFINITY, allowed)?;
        }
        let mut before_block =
            Grid::filled(radiance.width().div_ceil(BLOCK), radiance.height(), 0.0);
        let blocks_per_row = before_block.width();
        let (mut up_to_row, mut total) = (Vec::with_capacity(radiance.height()), 0.0);
        let sums = before_block.values_mut().chunks_exact_mut(blocks_per_row);
        for (y, (row, sums)) in radiance.rows().zip(sums).enumerate() {
            let mut sum = 0.0;
            for (block, before) in row.chunks(BLOCK).zip(sums) {
                *before = sum;
                sum = block.iter().fold(sum, |sum, value| sum + f64::from(*value));
            }
            total += sum * solid_angle_of_pixel(y, radiance.width(), radiance.height());
            up_to_row.push(total);
        }
        Ok(Self {
            radiance,
            before_block,
            up_to_row,
        })
    }

    /// Returns the integral of the radiance over all directions, in W/m².
    pub(super) fn total(&self) -> f64 {
        self.up_to_row.last().copied().unwrap_or(0.0)
    }

    /// Returns the radiance of a direction, of unit length.
    pub(super) fn radiance(&self, direction: DVec3) -> f64 {
        let (width, height) = (self.radiance.width(), self.radiance.height());
        let from_up = libm::atan2(direction.truncate().length(), direction.z) / PI;
        let around = libm::atan2(direction.y, direction.x) / TAU + 0.5;
        let row = index(from_up, height);
        f64::from(self.radiance.row(row)[index(around, width)])
    }

    /// Draws a direction in proportion to the radiance; returns it with the radiance, or `None`
    /// from a black map.
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> Option<(DVec3, f64)> {
        let (y, down) = self.sample_row(v)?;
        let (x, across) = self.sample_column(y, u)?;
        let (width, height) = (self.radiance.width() as f64, self.radiance.height() as f64);
        // Within a row the cosine of the angle from `up` is uniform, and so is the azimuth.
        let [upper, lower] = [y as f64, y as f64 + 1.0].map(|edge| libm::cos(PI * edge / height));
        let z = upper + down * (lower - upper);
        let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let (sin, cos) = libm::sincos(TAU * ((x as f64 + across) / width - 0.5));
        let radiance = f64::from(self.radiance.row(y)[x]);
        Some((DVec3::new(radius * cos, radius * sin, z), radiance))
    }

    /// Returns a row, drawn in proportion to its light, and the fraction of it that is above.
    fn sample_row(&self, v: f64) -> Option<(usize, f64)> {
        let target = v * self.total();
        let row = self.up_to_row.partition_point(|sum| *sum <= target);
        let end = *self.up_to_row.get(row)?;
        let start = row
            .checked_sub(1)
            .map_or(0.0, |above| self.up_to_row[above]);
        Some((row, fraction(target, start, end)))
    }

    /// Returns a column of a row, drawn in proportion to its radiance, and the fraction of it that
    /// is to the left.
    fn sample_column(&self, y: usize, u: f64) -> Option<(usize, f64)> {
        let (values, sums) = (self.radiance.row(y), self.before_block.row(y));
        let block_of = |block: usize| values.chunks(BLOCK).nth(block);
        let last = sums.len() - 1;
        let add = |sum: f64, value: &f32| sum + f64::from(*value);
        let total = block_of(last)?.iter().fold(sums[last], add);
        let target = u * total;
        let block = sums.partition_point(|sum| *sum <= target) - 1;
        let mut start = sums[block];
        for (column, value) in block_of(block)?.iter().enumerate() {
            let end = add(start, value);
            if target < end {
                return Some((block * BLOCK + column, fraction(target, start, end)));
            }
            start = end;
        }
        None
    }
}

/// (target − start) / (end − start), for start ≤ target < end.
fn fraction(target: f64, start: f64, end: f64) -> f64 {
    (target - start) / (end - start)
}

/// The index of the cell of [0, 1] that holds `fraction`; both ends belong to the cells there.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a fraction of a count is a count"
)]
fn index(fraction: f64, count: usize) -> usize {
    ((fraction * count as f64) as usize).min(count - 1)
}

/// 2π/width (cos θ₀ − cos θ₁), in steradian, for the rows θ₀ to θ₁ from `up`, without cancellation.
fn solid_angle_of_pixel(row: usize, width: usize, height: usize) -> f64 {
    let step = PI / height as f64;
    let middle = step * (row as f64 + 0.5);
    TAU / width as f64 * 2.0 * libm::sin(middle) * libm::sin(0.5 * step)
}
