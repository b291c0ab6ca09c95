//! Values over a plane, as colours.

use std::sync::Arc;

use kuva::prelude::{ColorMap, Heatmap, Plot};
use tem00_numerics::Grid;

use super::{
    colours::HOLE,
    drawing::{Drawing, Panel, panel},
};

/// The maximum number of cells that are drawn along an axis.
const MAX_CELLS: usize = 200;

/// Values over a plane, as colours next to a scale; a value that is not finite is a hole.
///
/// More than 200 cells along an axis are drawn as the means of blocks of them.
#[derive(Clone, Debug)]
pub struct HeatMap<'a> {
    /// The quantity that the colours stand for, with the unit.
    pub title: &'a str,
    /// The labels of the axes, across and up.
    pub labels: [&'a str; 2],
    /// The ranges of the axes.
    pub ranges: [(f64, f64); 2],
    /// `true` if both axes are lengths: they get one scale, and circles are circles.
    pub to_scale: bool,
    /// The kind of the values: each quantity has its own colours.
    pub scale: Scale,
    /// The values; the first row is at the *bottom*, where the axis up begins.
    pub values: &'a Grid<f32>,
}

/// The colours of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Viridis.
    Height,
    /// Magma.
    Uncertainty,
}

impl HeatMap<'_> {
    /// Draws the map.
    pub fn draw(&self) -> Drawing {
        Drawing::of_panel(self.panel())
    }

    fn panel(&self) -> Panel {
        let rows = self.cells();
        let finite = rows.iter().flatten().any(|value| value.is_finite());
        let [x, y] = self.ranges;
        let spans = [x, y].iter().all(|(from, to)| to - from > 0.0);
        let map = (finite && spans).then(|| {
            let map = Heatmap::new().with_data(rows);
            let mut map = map.with_color_map(self.scale.colours());
            (map.cell_size, map.x_range, map.y_range) = (1.0, Some(x), Some(y));
            Plot::from(map)
        });
        let (plots, layout) = panel(Vec::from_iter(map), self.title, self.labels);
        let to_scale = self.to_scale && !plots.is_empty();
        let layout = if to_scale {
            layout.with_equal_aspect()
        } else {
            layout
        };
        (plots, layout)
    }

    /// Returns the cells that are drawn, from the bottom up.
    fn cells(&self) -> Vec<Vec<f64>> {
        let size = [self.values.width(), self.values.height()];
        let [columns, rows] = size.map(|cells| cells.min(MAX_CELLS));
        let bounds =
            |index: usize, cells: usize, of: usize| (index * of / cells, (index + 1) * of / cells);
        let cell = |x, y| {
            mean(
                self.values,
                bounds(x, columns, size[0]),
                bounds(y, rows, size[1]),
            )
        };
        (0..rows)
            .map(|y| (0..columns).map(|x| cell(x, y)).collect())
            .collect()
    }
}

impl Scale {
    /// Returns the colours, and a separate colour for holes.
    fn colours(self) -> ColorMap {
        let colours = match self {
            Self::Height => ColorMap::Viridis,
            Self::Uncertainty => ColorMap::Magma,
        };
        ColorMap::Custom(Arc::new(move |value: f64| {
            if value.is_finite() {
                colours.map(value)
            } else {
                HOLE.to_owned()
            }
        }))
    }
}

/// Returns the colour of a height, from 0 for the minimum to 1 for the maximum.
pub fn height_colour(height: f64) -> String {
    ColorMap::Viridis.map(height)
}

/// Returns the mean of the finite values of a block, or 0 / 0 = NaN, a hole, if there are none.
fn mean(values: &Grid<f32>, (x0, x1): (usize, usize), (y0, y1): (usize, usize)) -> f64 {
    let cells = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y)));
    let finite = cells
        .map(|cell| f64::from(values[cell]))
        .filter(|value| value.is_finite());
    let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(values: &Grid<f32>) -> HeatMap<'_> {
        HeatMap {
            title: "height (mm)",
            labels: ["x (mm)", "frame"],
            ranges: [(-5.0, 5.0), (0.0, 10.0)],
            to_scale: false,
            scale: Scale::Height,
            values,
        }
    }

    #[test]
    fn large_maps_are_drawn_as_means_of_blocks() {
        let values = Grid::from_fn(450, 3, |x, y| if x == 0 { f32::NAN } else { y as f32 });
        let cells = map(&values).cells();
        assert_eq!((cells.len(), cells[0].len()), (3, MAX_CELLS));
        // The hole is left out of the mean of its block.
        for (row, expected) in cells.iter().zip([0.0, 1.0, 2.0]) {
            assert!(
                row.iter().all(|value| (value - expected).abs() < 1e-12),
                "{row:?}"
            );
        }
    }

    #[test]
    fn holes_are_no_numbers_and_a_map_of_them_has_axes_all_the_same() {
        for filled in [1.0, f32::NAN] {
            let values = Grid::from_fn(2, 2, |x, y| if x + y == 0 { f32::NAN } else { filled });
            let drawing = map(&values).draw();
            let svg = drawing.svg();
            let words = ["height (mm)", "x (mm)", "frame"];
            assert!(words.iter().all(|word| svg.contains(word)), "{svg}");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
    }

    /// Returns the colours of the pixels of the picture in a drawing, row by row from the top.
    fn pixels(svg: &str) -> Vec<Vec<[u8; 4]>> {
        use base64::{Engine, engine::general_purpose::STANDARD};
        let (_, data) = svg.split_once("base64,").expect("a picture");
        let (data, _) = data.split_once('"').expect("it ends");
        let bytes = STANDARD.decode(data).expect("base64");
        let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        let mut reader = decoder.read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
        let info = reader.next_frame(&mut pixels).expect("an image");
        let row = |row: &[u8]| row.chunks(4).map(|p| [p[0], p[1], p[2], p[3]]).collect();
        pixels.chunks(info.line_size).map(row).collect()
    }

    #[test]
    fn cells_are_a_picture_that_shows_the_first_row_below() {
        // The ends of viridis after its authors: #440154 and #fde725.
        let (low, high, hole) = ([0x44, 0x01, 0x54, 255], [0xfd, 0xe7, 0x25, 255], [0; 4]);
        let values = Grid::from_fn(3, 2, |x, y| match (x, y) {
            (1, 0) => f32::NAN,
            (0, 0) => 1.0,
            _ => 4.0,
        });
        let drawing = map(&values).draw();
        let expected = vec![vec![high; 3], vec![low, hole, high]];
        assert_eq!(pixels(drawing.svg()), expected);
        let large = map(&Grid::from_fn(200, 200, |x, y| (x * y) as f32)).draw();
        let length = large.svg().len();
        assert!(length < 200_000, "{length} bytes for 40,000 cells");
    }
}
