use core::{
    error, fmt,
    ops::{Index, IndexMut},
};

use crate::parallel;

/// A rectangular array in row-major order: `(x, y)` lies at `y · width + x`.
///
/// # Examples
///
/// ```
/// use tem00_numerics::Grid;
///
/// let grid = Grid::from_fn(3, 2, |x, y| 10 * y + x);
/// assert_eq!(grid[(2, 1)], 12);
/// assert_eq!(grid.rows().next(), Some(&[0, 1, 2][..]));
/// assert_eq!(*grid.wrapped(-1, 2), 2); // one left of and one below the corner (0, 1)
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<T> {
    width: usize,
    height: usize,
    values: Vec<T>,
}

impl<T> Grid<T> {
    /// Creates a grid from its values in row-major order.
    ///
    /// # Errors
    ///
    /// Returns an error if `width` or `height` is zero or if `values` does not hold exactly
    /// `width · height` values.
    pub fn from_vec(width: usize, height: usize, values: Vec<T>) -> Result<Self, GridError> {
        if width == 0 || height == 0 {
            return Err(GridError::Empty { width, height });
        }
        if width.checked_mul(height) != Some(values.len()) {
            return Err(GridError::Length {
                width,
                height,
                length: values.len(),
            });
        }
        Ok(Self {
            width,
            height,
            values,
        })
    }

    /// Creates a grid whose value at `(x, y)` is `value(x, y)`.
    ///
    /// # Panics
    ///
    /// Panics unless `width > 0` and `height > 0`.
    pub fn from_fn(width: usize, height: usize, value: impl Fn(usize, usize) -> T) -> Self {
        assert!(width > 0 && height > 0, "a grid is at least 1 × 1");
        let value = &value;
        let values = (0..height)
            .flat_map(|y| (0..width).map(move |x| value(x, y)))
            .collect();
        Self {
            width,
            height,
            values,
        }
    }

    /// Returns the number of columns.
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    pub const fn height(&self) -> usize {
        self.height
    }

    /// Returns all values in row-major order.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Returns all values in row-major order, mutably.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Converts the grid into its values in row-major order.
    pub fn into_values(self) -> Vec<T> {
        self.values
    }

    /// Returns the rows from the first to the last.
    pub fn rows(&self) -> core::slice::ChunksExact<'_, T> {
        self.values.chunks_exact(self.width)
    }

    /// Calls `each(y, row)` for every row; with the feature `parallel`, by all threads of the
    /// current rayon pool.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_numerics::Grid;
    ///
    /// let mut grid = Grid::filled(2, 3, 0);
    /// grid.for_each_row_mut(|y, row| row.fill(y + 1));
    /// assert_eq!(grid.values(), [1, 1, 2, 2, 3, 3]);
    /// ```
    pub fn for_each_row_mut(&mut self, each: impl Fn(usize, &mut [T]) + Sync)
    where
        T: Send,
    {
        let width = self.width();
        parallel::for_each_chunk(self.values_mut(), width, each);
    }

    /// Returns row `y`.
    ///
    /// # Panics
    ///
    /// Panics unless `y < height`.
    pub fn row(&self, y: usize) -> &[T] {
        &self.values[y * self.width..(y + 1) * self.width]
    }

    /// Returns the value at `(x mod width, y mod height)`: the grid repeats periodically.
    pub fn wrapped(&self, x: i64, y: i64) -> &T {
        &self[(wrap_index(x, self.width), wrap_index(y, self.height))]
    }

    /// Returns a grid of the same shape whose values are `map` of the values of this grid.
    pub fn map<U>(&self, map: impl FnMut(&T) -> U) -> Grid<U> {
        Grid {
            width: self.width,
            height: self.height,
            values: self.values.iter().map(map).collect(),
        }
    }
}

impl<T: Clone> Grid<T> {
    /// Creates a grid that holds `value` everywhere.
    ///
    /// # Panics
    ///
    /// Panics unless `width > 0` and `height > 0`.
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        assert!(width > 0 && height > 0, "a grid is at least 1 × 1");
        Self {
            width,
            height,
            values: vec![value; width * height],
        }
    }
}

impl<T> Index<(usize, usize)> for Grid<T> {
    type Output = T;

    fn index(&self, (x, y): (usize, usize)) -> &T {
        assert!(x < self.width, "column {x} of a grid {} wide", self.width);
        &self.values[y * self.width + x]
    }
}

impl<T> IndexMut<(usize, usize)> for Grid<T> {
    fn index_mut(&mut self, (x, y): (usize, usize)) -> &mut T {
        assert!(x < self.width, "column {x} of a grid {} wide", self.width);
        &mut self.values[y * self.width + x]
    }
}

/// Reasons for which a grid is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GridError {
    /// The grid has no rows or no columns.
    Empty {
        /// The requested number of columns.
        width: usize,
        /// The requested number of rows.
        height: usize,
    },
    /// The number of values is not `width · height`.
    Length {
        /// The requested number of columns.
        width: usize,
        /// The requested number of rows.
        height: usize,
        /// The number of given values.
        length: usize,
    },
}

impl fmt::Display for GridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { width, height } => {
                write!(f, "a grid must be at least 1 × 1, got {width} × {height}")
            }
            Self::Length {
                width,
                height,
                length,
            } => write!(
                f,
                "a {width} × {height} grid needs width · height values, got {length}"
            ),
        }
    }
}

impl error::Error for GridError {}

/// Returns the cell `⌊x⌋ mod period` and the fraction `x − ⌊x⌋` of a coordinate on a periodic grid.
///
/// The fraction lies in [0, 1) and the period is exactly `period`. The reduction is done in `f64`:
/// in `f32` a coordinate of 10⁷ has already lost its fraction.
///
/// # Panics
///
/// Panics unless `x` is finite and `period > 0`.
///
/// # Examples
///
/// ```
/// use tem00_numerics::wrap_coordinate;
///
/// assert_eq!(wrap_coordinate(-0.25, 8), (7, 0.75));
/// assert_eq!(wrap_coordinate(8.5, 8), (0, 0.5));
/// ```
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the reduced cell lies in [0, period)"
)]
pub fn wrap_coordinate(x: f64, period: usize) -> (usize, f64) {
    assert!(period > 0, "a period of zero cells");
    assert!(x.is_finite(), "the coordinate {x} is not finite");
    let floor = x.floor();
    let cell = if floor.abs() < WHOLE_I64 {
        wrap_index(floor as i64, period)
    } else {
        floor.rem_euclid(period as f64) as usize
    };
    // A tiny negative x has x − ⌊x⌋ = 1 after rounding.
    (cell.min(period - 1), (x - floor).min(ALMOST_ONE))
}

/// Below 2⁶³ every integral `f64` fits an `i64`, whose remainder is several times faster.
const WHOLE_I64: f64 = (1_u64 << 63) as f64;

/// The largest `f64` below one.
const ALMOST_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "the result lies in [0, period) and grids are far smaller than 2⁶³"
)]
fn wrap_index(index: i64, period: usize) -> usize {
    index.rem_euclid(period as i64) as usize
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn values_must_fill_the_grid() {
        assert_eq!(
            Grid::from_vec(2, 3, vec![0; 5]),
            Err(GridError::Length {
                width: 2,
                height: 3,
                length: 5
            })
        );
        assert_eq!(
            Grid::from_vec(0, 3, Vec::<u8>::new()),
            Err(GridError::Empty {
                width: 0,
                height: 3
            })
        );
        // width · height overflows usize and must not wrap to zero.
        assert!(
            Grid::from_vec(1 << 33, 1 << 33, Vec::<u8>::new()).is_err(),
            "an overflowing product is no length"
        );
    }

    #[test]
    fn rows_are_stored_one_after_the_other() {
        let grid = Grid::from_fn(4, 3, |x, y| (x, y));
        assert_eq!(grid.values()[2 * 4 + 1], (1, 2));
        assert_eq!(grid.row(2)[1], (1, 2));
        assert_eq!(grid.rows().len(), 3);
    }

    proptest! {
        #[test]
        fn a_grid_repeats_with_its_size(x in -1_000_i64..1_000, y in -1_000_i64..1_000) {
            let grid = Grid::from_fn(7, 5, |x, y| 7 * y + x);
            prop_assert_eq!(grid.wrapped(x, y), grid.wrapped(x + 7, y - 5));
        }

        #[test]
        fn wrapping_keeps_the_coordinate_up_to_whole_periods(
            x in -1e12_f64..1e12, period in 1_usize..5_000,
        ) {
            let (cell, fraction) = wrap_coordinate(x, period);
            prop_assert!(cell < period && (0.0..1.0).contains(&fraction), "{cell} + {fraction}");
            let turns = (x - (cell as f64 + fraction)) / period as f64;
            // x has 12 digits before the point: 1e12 · 2⁻⁵³ ≈ 1.1e−4 of absolute rounding.
            prop_assert!((turns - turns.round()).abs() < 2.5e-4, "{turns} turns");
        }
    }

    #[test]
    fn huge_coordinates_keep_their_remainder() {
        // 2⁷⁰ = 16¹⁷ · 4, and 16 ≡ 1 modulo 5.
        let x = 2.0_f64.powi(70);
        assert_eq!(wrap_coordinate(x, 5), (4, 0.0));
        assert_eq!(wrap_coordinate(-x, 5), (1, 0.0));
    }

    #[test]
    fn the_fraction_of_a_tiny_negative_coordinate_stays_below_one() {
        let (cell, fraction) = wrap_coordinate(-1e-300, 8);
        assert_eq!(cell, 7);
        assert!(fraction < 1.0, "fraction {fraction}");
    }
}
