use glam::DVec3;
use tem00_numerics::{
    Grid, Refusal,
    cast::{to_f32, to_usize},
    check,
};
use tem00_triangulation::TriangulationError;

use crate::{frame::MeasuredPoint, quantised::range};

/// The heights of a part on a grid.
///
/// Row 0 is the first profile, or the smallest position along the scan; holes are NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// The heights, in metres; NaN where nothing was measured.
    pub heights: Grid<f32>,
    /// Their standard uncertainties, in metres; NaN where nothing was measured.
    pub uncertainties: Grid<f32>,
    /// The grey values of the line, summed across it, in DN; NaN where nothing was measured.
    pub reflectances: Grid<f32>,
    /// The widths of the line, in pixels; NaN where nothing was measured.
    pub widths: Grid<f32>,
    /// The meaning of columns and rows.
    pub raster: Raster,
}

/// Meaning of the columns and rows of a height map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Raster {
    /// Columns of the image, `columns` of them to a column of the map, and profiles.
    Image {
        /// The number of columns of the image that a column of the map is the mean of.
        columns: usize,
    },
    /// Squares of the part.
    Part {
        /// The lengths along the first two axes at the lower edges of the first cell, in metres.
        origin: [f64; 2],
        /// The side of a cell, in metres.
        pitch: f64,
    },
}

/// The maximum number of cells of a map.
const MAX_CELLS: f64 = 16_777_216.0;

impl HeightMap {
    /// Arranges profiles, one above the other, in the columns of an image that has `columns` of
    /// them.
    ///
    /// `height` is the direction of heights, of length 1.
    ///
    /// # Panics
    ///
    /// Panics unless `columns` and `averaged` are positive, and if there are no profiles.
    pub fn of_profiles(
        profiles: &[Vec<MeasuredPoint>],
        height: DVec3,
        [columns, averaged]: [usize; 2],
    ) -> Self {
        assert!(
            columns > 0 && averaged > 0 && !profiles.is_empty(),
            "{} profiles of {columns} columns, {averaged} to a mean",
            profiles.len()
        );
        let mut map = Self::empty(
            [columns.div_ceil(averaged), profiles.len()],
            Raster::Image { columns: averaged },
        );
        for (row, profile) in profiles.iter().enumerate() {
            let mut valid: Vec<&MeasuredPoint> = profile.iter().filter(|p| p.is_valid()).collect();
            // Of several points in a column the brightest comes last and stays.
            valid.sort_by(|a, b| a.seen.reflectance.total_cmp(&b.seen.reflectance));
            for point in valid {
                let at = (point.seen.column / averaged, row);
                map.heights[at] = to_f32(point.position.dot(height));
                map.uncertainties[at] = to_f32(point.uncertainty_along(height));
                map.reflectances[at] = to_f32(point.seen.reflectance);
                map.widths[at] = to_f32(point.seen.width);
            }
        }
        map
    }

    /// Sorts points into square cells of a side of `pitch` metres along the first two axes; heights
    /// are along the third. All are of length 1 and square to each other.
    ///
    /// The points with the smallest lengths lie in the middle of the first cells, so that profiles
    /// that are one pitch apart each lie in the middle of their own row.
    ///
    /// A cell holds the means of its points, and the root mean square of their uncertainties:
    /// points of one cell share their speckle, so that their mean is hardly better than one point.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no valid points, if the pitch is not positive and finite, or
    /// if the map would have more than 2²⁴ cells.
    pub fn of_points(
        profiles: &[Vec<MeasuredPoint>],
        [across, along, height]: [DVec3; 3],
        pitch: f64,
    ) -> Result<Self, TriangulationError> {
        check_pitch(pitch)?;
        let points = || profiles.iter().flatten().filter(|point| point.is_valid());
        let coordinates =
            |point: &MeasuredPoint| [across, along].map(|axis| point.position.dot(axis));
        let (origin, size) = extent(points().map(coordinates), pitch)?;
        let mut map = Self::empty(size, Raster::Part { origin, pitch });
        let mut sums = Grid::filled(size[0], size[1], [0.0_f64; 5]);
        for point in points() {
            let cell = coordinates(point);
            let cell = [0, 1].map(|axis| index((cell[axis] - origin[axis]) / pitch, size[axis]));
            let uncertainty = point.uncertainty_along(height);
            let sum = &mut sums[(cell[0], cell[1])];
            sum[0] += 1.0;
            sum[1] += point.position.dot(height);
            sum[2] += uncertainty * uncertainty;
            sum[3] += point.seen.reflectance;
            sum[4] += point.seen.width;
        }
        let filled = sums.values().iter().enumerate();
        for (i, [count, sums @ ..]) in filled.filter(|(_, sum)| sum[0] > 0.0) {
            let [height, square, reflectance, width] = sums.map(|sum| sum / count);
            map.heights.values_mut()[i] = to_f32(height);
            map.uncertainties.values_mut()[i] = to_f32(square.sqrt());
            map.reflectances.values_mut()[i] = to_f32(reflectance);
            map.widths.values_mut()[i] = to_f32(width);
        }
        Ok(map)
    }

    fn empty([width, height]: [usize; 2], raster: Raster) -> Self {
        let holes = || Grid::filled(width, height, f32::NAN);
        Self {
            heights: holes(),
            uncertainties: holes(),
            reflectances: holes(),
            widths: holes(),
            raster,
        }
    }

    /// Returns the minimum and the maximum height, in metres, or `None` where all are holes.
    pub fn range(&self) -> Option<[f64; 2]> {
        range(&self.heights)
    }

    /// Returns the fraction of the cells that are holes, from 0 to 1.
    pub fn holes(&self) -> f64 {
        let values = self.heights.values();
        let holes = values.iter().filter(|height| height.is_nan()).count();
        holes as f64 / values.len() as f64
    }
}

/// Checks that cells have a size.
pub(super) fn check_pitch(pitch: f64) -> Result<(), TriangulationError> {
    Ok(check::positive("pitch", pitch, "m").map(drop)?)
}

/// The lower corner of a grid that begins half a cell below all positions, in metres, and its
/// number of cells.
fn extent(
    positions: impl Iterator<Item = [f64; 2]>,
    pitch: f64,
) -> Result<([f64; 2], [usize; 2]), TriangulationError> {
    let start = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let (low, high) = positions.fold(start, |(low, high), position| {
        let axes = [0, 1];
        (
            axes.map(|axis| low[axis].min(position[axis])),
            axes.map(|axis| high[axis].max(position[axis])),
        )
    });
    if low[0] > high[0] {
        return Err(TriangulationError::TooFew {
            what: "valid points for a height map",
            got: 0,
            needed: 1,
        });
    }
    let origin = low.map(|low| low - 0.5 * pitch);
    let cells = [0, 1].map(|axis| cell((high[axis] - origin[axis]) / pitch) + 1.0);
    let count = cells[0] * cells[1];
    if count.is_nan() || count > MAX_CELLS {
        let allowed = "so large that the height map has at most 2²⁴ cells";
        return Err(Refusal::new("pitch", pitch, allowed).in_unit("m").into());
    }
    Ok((origin, cells.map(to_usize)))
}

/// The cell of a position, in cells from the lower edge of the first.
///
/// An edge belongs to the cell above it, also where rounding puts a position just below the edge:
/// half of a pitch of two steps, say, is a position on an edge.
fn cell(position: f64) -> f64 {
    const ROUNDING: f64 = 1e-6;
    (position + ROUNDING).floor()
}

/// The index of the [`cell`] of a position.
fn index(position: f64, size: usize) -> usize {
    to_usize(cell(position)).min(size - 1)
}
