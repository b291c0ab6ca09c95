use std::sync::Arc;

use num_complex::Complex;
use tem00_numerics::{
    Grid,
    cast::{to_c64, to_i64, to_signed, to_usize},
    check,
};

use crate::SpeckleError;

/// Amplitude transmission of a pupil of any shape, on a grid over the pupil's bounding square.
///
/// Column x of n applies to the strip from x/n to (x + 1)/n of the pupil's diameter, and rows
/// likewise; the transmission is not interpolated between the centres of the cells. A grid at least
/// as fine as the pupil's lattice loses no detail. Copies share the grid.
///
/// # Examples
///
/// Half a disc:
///
/// ```
/// use tem00_speckle::{Pupil, PupilField, Transmission};
/// use tem00_numerics::Grid;
///
/// let open = |x: usize, y: usize| {
///     let (x, y) = (x as f32 + 0.5 - 32.0, y as f32 + 0.5 - 32.0);
///     if x > 0.0 && x.hypot(y) < 32.0 { 1.0 } else { 0.0 }
/// };
/// let half = Transmission::new(&Grid::from_fn(64, 64, open))?;
/// let field = PupilField::new(256, 64, 1)?.with_pupil(Pupil::Sampled(half))?;
///
/// // Speckles behind it are twice as wide as high: the correlation at lags that correspond.
/// let x = field.amplitude_correlation([4.0, 0.0]).norm();
/// let y = field.amplitude_correlation([0.0, 4.0]).norm();
/// assert!(x > 0.6 && y < 0.2);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Transmission {
    values: Arc<Grid<Complex<f32>>>,
}

impl Transmission {
    /// Creates a transmission from its amplitude, 0 where the pupil is opaque and 1 where it is
    /// open.
    ///
    /// # Errors
    ///
    /// Returns an error unless all values lie in [0, 1] and one of them is above 0.
    pub fn new(amplitude: &Grid<f32>) -> Result<Self, SpeckleError> {
        if let Some(&bad) = amplitude
            .values()
            .iter()
            .find(|&&t| !(0.0..=1.0).contains(&t))
        {
            return Err(amplifies(bad));
        }
        Self::from_complex(amplitude.map(|&t| Complex::new(t, 0.0)))
    }

    /// Creates a transmission with a phase, as for a lens with aberrations.
    ///
    /// # Errors
    ///
    /// Returns an error unless all magnitudes lie in [0, 1], within the rounding of `f32`, and one
    /// of them is above 0.
    pub fn from_complex(amplitude: Grid<Complex<f32>>) -> Result<Self, SpeckleError> {
        // A phasor of cosine and sine may exceed 1 by its rounding.
        let allowed = 1.0 + 2.0 * f32::EPSILON;
        let magnitude = |t: &Complex<f32>| t.re.hypot(t.im);
        let mut magnitudes = amplitude.values().iter().map(magnitude);
        if let Some(bad) = magnitudes.find(|t| !(0.0..=allowed).contains(t)) {
            return Err(amplifies(bad));
        }
        let is_open = amplitude.values().iter().any(|t| *t != Complex::ZERO);
        check::that(is_open, "amplitude", 0.0, "", "above 0 somewhere")?;
        Ok(Self {
            values: Arc::new(amplitude),
        })
    }

    /// Returns the amplitude transmission on the grid.
    pub fn values(&self) -> &Grid<Complex<f32>> {
        &self.values
    }

    /// The transmission at a point of the bounding square, whose sides are −½ and ½.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> Complex<f32> {
        self.values[(cell(x, self.values.width()), cell(y, self.values.height()))]
    }

    /// |∫ t(p) t*(p − shift)| / ∫ |t|², exactly: cells are constant, so that their overlap is
    /// linear in the shift between consecutive whole numbers of cells.
    pub(crate) fn overlap(&self, [x, y]: [f64; 2]) -> f64 {
        // Beyond the square there is no overlap; the condition is negated so that NaN counts as no
        // overlap, too.
        if !(x.abs() < 1.0 && y.abs() < 1.0) {
            return 0.0;
        }
        let (column, fx) = split(x * self.values.width() as f64);
        let (row, fy) = split(y * self.values.height() as f64);
        let mut sum = Complex::new(0.0, 0.0);
        for (dx, wx) in [(0, 1.0 - fx), (1, fx)] {
            for (dy, wy) in [(0, 1.0 - fy), (1, fy)] {
                if wx * wy > 0.0 {
                    sum += self.product([column + dx, row + dy]) * (wx * wy);
                }
            }
        }
        sum.norm() / self.product([0, 0]).re
    }

    /// Σ t(x, y) t*(x − shift) over the cells.
    fn product(&self, [dx, dy]: [i64; 2]) -> Complex<f64> {
        let (width, height) = (
            to_signed(self.values.width()),
            to_signed(self.values.height()),
        );
        let shared = |d: i64, n: i64| d.max(0)..(n + d).min(n);
        let mut sum = Complex::new(0.0, 0.0);
        for y in shared(dy, height) {
            for x in shared(dx, width) {
                let a = to_c64(*self.values.wrapped(x, y));
                let b = to_c64(*self.values.wrapped(x - dx, y - dy));
                sum += a * b.conj();
            }
        }
        sum
    }
}

fn amplifies(amplitude: f32) -> SpeckleError {
    SpeckleError::refused("amplitude", amplitude as f64, "between 0 and 1")
}

/// The cell of `count` in which x ∈ [−½, ½] lies; the rim belongs to the outermost cell.
fn cell(x: f64, count: usize) -> usize {
    to_usize((x + 0.5) * count as f64).min(count - 1)
}

fn split(x: f64) -> (i64, f64) {
    (to_i64(x.floor()), x - x.floor())
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_absolute;

    use super::*;
    use crate::Pupil;

    fn disc(cells: usize) -> Grid<f32> {
        let centre = 0.5 * cells as f64 - 0.5;
        Grid::from_fn(cells, cells, |x, y| {
            let inside = (x as f64 - centre).hypot(y as f64 - centre) <= 0.5 * cells as f64;
            if inside { 1.0 } else { 0.0 }
        })
    }

    #[test]
    fn a_sampled_disc_overlaps_like_a_disc() {
        let sampled = Transmission::new(&disc(200)).unwrap();
        for shift in [
            [0.0, 0.0],
            [0.3, 0.1],
            [0.003, 0.5],
            [-0.6, 0.33],
            [0.0, -0.97],
        ] {
            // With 200 cells per diameter the rim has errors of half a cell, at random along the
            // rim.
            assert_absolute(sampled.overlap(shift), Pupil::Circle.overlap(shift), 1e-3);
        }
        for beyond in [[1.0, 0.0], [0.0, -3.0], [1e300, 1e300], [f64::NAN, 0.0]] {
            assert!(sampled.overlap(beyond) <= 0.0, "{beyond:?}");
        }
    }

    #[test]
    fn the_overlap_of_cells_is_the_integral() {
        // Two columns, 1 and i/2: shifted by a quarter of the square, half a cell.
        let values = vec![Complex::new(1.0, 0.0), Complex::new(0.0, 0.5)];
        let pupil = Transmission::from_complex(Grid::from_vec(2, 1, values).unwrap()).unwrap();
        // The products of each column with itself give ½ (1 + ¼), of the second with the first ½
        // (i/2).
        let expected = (0.5 * 1.25_f64).hypot(0.5 * 0.5) / 1.25;
        assert_absolute(pupil.overlap([0.25, 0.0]), expected, 1e-15);
        assert_absolute(pupil.overlap([0.5, 0.0]), 0.4, 1e-15);
        assert_absolute(pupil.overlap([0.0, -0.5]), 0.5, 1e-15);
    }

    #[test]
    fn cells_hold_from_their_left_to_their_right() {
        let grid = Grid::from_fn(4, 2, |x, y| (x + 4 * y) as f32 / 8.0);
        let pupil = Transmission::new(&grid).unwrap();
        for (point, index) in [
            ([-0.5, -0.5], 0.0),
            ([-0.26, -0.01], 0.0),
            ([-0.24, 0.01], 5.0),
            ([0.49, -0.2], 3.0),
            ([0.5, 0.5], 7.0),
        ] {
            assert_absolute((8.0 * pupil.at(point).re).into(), index, 1e-6);
        }
    }
}
