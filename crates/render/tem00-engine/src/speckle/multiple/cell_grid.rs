use glam::DVec2;
use tem00_numerics::cast::to_usize;

/// Square cells over an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CellGrid {
    pub columns: usize,
    pub rows: usize,
    /// The side of a cell, in pixels.
    pub side: usize,
}

/// The reach of a mean over neighbouring cells.
const NEIGHBOURS: usize = 2;

impl CellGrid {
    /// Divides an image into at most `cells` cells along its longer side.
    pub(crate) fn over([width, height]: [usize; 2], cells: usize) -> Self {
        const MIN_SIDE: usize = 4;
        let side = width.max(height).div_ceil(cells).max(MIN_SIDE);
        Self {
            columns: width.div_ceil(side),
            rows: height.div_ceil(side),
            side,
        }
    }

    /// Returns the cells around a cell, itself included.
    pub(super) fn neighbours(self, index: usize) -> impl Iterator<Item = usize> {
        let (row, column) = (index / self.columns, index % self.columns);
        let around = |middle: usize, count: usize| {
            middle.saturating_sub(NEIGHBOURS)..count.min(middle + NEIGHBOURS + 1)
        };
        let columns = around(column, self.columns);
        around(row, self.rows).flat_map(move |row| {
            columns
                .clone()
                .map(move |column| row * self.columns + column)
        })
    }

    /// The four cells whose middles surround an image point, with the weights of bilinear
    /// interpolation.
    pub(super) fn around(self, pixel: DVec2) -> impl Iterator<Item = (usize, f64)> {
        let axis = |position: f64, count: usize| {
            let last = (count - 1) as f64;
            let position = (position / self.side as f64 - 0.5).clamp(0.0, last);
            let first = to_usize(position).min(count.saturating_sub(2));
            let fraction = position - first as f64;
            [
                (first, 1.0 - fraction),
                ((first + 1).min(count - 1), fraction),
            ]
        };
        let columns = axis(pixel.x, self.columns);
        axis(pixel.y, self.rows)
            .into_iter()
            .flat_map(move |(row, v)| {
                columns.map(|(column, u)| (row * self.columns + column, u * v))
            })
            .filter(|(_, weight)| *weight > 0.0)
    }
}
