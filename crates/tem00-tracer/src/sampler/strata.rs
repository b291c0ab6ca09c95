/// The cells of a pixel in which its samples lie, one in each: equal areas, nearly square.
///
/// The cells stand in rows, of which some hold one cell more than others and are as much higher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Strata {
    samples: u32,
    rows: u32,
}

impl Strata {
    /// Divides a pixel into `samples` cells, at least one.
    pub(crate) fn new(samples: u32) -> Self {
        let root = samples.isqrt().max(1);
        // Of the two nearest squares, the nearer one gives the rows.
        let up = u64::from(samples) > u64::from(root) * (u64::from(root) + 1);
        Self {
            samples,
            rows: root + u32::from(up),
        }
    }

    /// Returns the number of cells.
    pub(crate) const fn samples(self) -> u32 {
        self.samples
    }

    /// Returns the position in the pixel, in [0, 1)², of a point `u` of cell `index`.
    pub(crate) fn position(self, index: u32, u: [f64; 2]) -> [f64; 2] {
        let start = |row: u64| row * u64::from(self.samples) / u64::from(self.rows);
        // The last row that starts at or before the cell.
        let row = (u64::from(index) * u64::from(self.rows) + u64::from(self.rows) - 1)
            / u64::from(self.samples);
        let row = if start(row) > u64::from(index) {
            row - 1
        } else {
            row
        };
        let (first, next) = (start(row), start(row + 1));
        let cells = (next - first) as f64;
        [
            ((u64::from(index) - first) as f64 + u[0]) / cells,
            (first as f64 + cells * u[1]) / f64::from(self.samples),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_equal_areas_and_cover_the_pixel() {
        for samples in [1, 2, 3, 5, 7, 12, 16, 17, 31, 256, 257] {
            let strata = Strata::new(samples);
            let mut area = 0.0;
            for index in 0..samples {
                let [left, top] = strata.position(index, [0.0, 0.0]);
                let [right, bottom] = strata.position(index, [1.0, 1.0]);
                let (width, height) = (right - left, bottom - top);
                let cell = width * height * f64::from(samples);
                assert!(
                    (cell - 1.0).abs() < 1e-12,
                    "cell {index} of {samples}: {cell}"
                );
                assert!(left >= 0.0 && right < 1.0 + 1e-12, "{left}, {right}");
                assert!((0.3..3.1).contains(&(width / height)), "{width} × {height}");
                area += cell / f64::from(samples);
            }
            assert!((area - 1.0).abs() < 1e-12, "{samples}");
            let [_, bottom] = strata.position(samples - 1, [0.0, 1.0]);
            assert!((bottom - 1.0).abs() < 1e-12, "{samples} end at {bottom}");
        }
    }

    #[test]
    fn squares_make_a_square_grid() {
        let strata = Strata::new(16);
        let [x, y] = strata.position(6, [0.5, 0.5]);
        assert!(
            (x - 2.5 / 4.0).abs() < 1e-15 && (y - 1.5 / 4.0).abs() < 1e-15,
            "{x}, {y}"
        );
    }
}
