use glam::DVec3;

use tem00_numerics::check;
use tem00_triangulation::TriangulationError;

/// The maximum number of corners along a side of a board.
const MAX: usize = 50;

/// A checkerboard, given by its inner corners, where four squares meet.
///
/// The board has one square more than inner corners along each side. Its own frame has its origin
/// at the lower left inner corner, x to the right and y up on the board, z out of it towards the
/// camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    corners: [usize; 2],
    square: f64,
}

impl Checkerboard {
    /// Creates a board from its numbers of inner corners along the rows and along the columns, and
    /// from the side of a square, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if a number is below 3 or above 50, or if the side is not positive and
    /// finite.
    pub fn new(corners: [usize; 2], square: f64) -> Result<Self, TriangulationError> {
        check::positive("square_size", square, "m")?;
        for number in corners {
            let allowed = "from 3 to 50 inner corners per side";
            check::that((3..=MAX).contains(&number), "corners", number, "", allowed)?;
        }
        Ok(Self { corners, square })
    }

    /// Returns the numbers of inner corners along the rows and along the columns.
    pub const fn corners(&self) -> [usize; 2] {
        self.corners
    }

    /// Returns the number of inner corners.
    pub const fn corner_count(&self) -> usize {
        self.corners[0] * self.corners[1]
    }

    /// Returns the side of a square, in metres.
    pub const fn square(&self) -> f64 {
        self.square
    }

    /// Returns the inner corners in the frame of the board, in metres: row by row from the upper
    /// left.
    pub fn points(&self) -> Vec<DVec3> {
        let [columns, rows] = self.corners;
        let point = |row, column| self.corner_at(column as f64, (rows - 1 - row) as f64);
        (0..rows)
            .flat_map(|row| (0..columns).map(move |column| point(row, column)))
            .collect()
    }

    /// Returns the middle of the inner corners in the frame of the board, in metres.
    pub fn middle(&self) -> DVec3 {
        let [columns, rows] = self.corners;
        self.corner_at((columns - 1) as f64 / 2.0, (rows - 1) as f64 / 2.0)
    }

    /// Returns the point of the board `right` squares to the right and `up` squares up.
    pub fn corner_at(&self, right: f64, up: f64) -> DVec3 {
        self.square * DVec3::new(right, up, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::refuses;

    use super::*;

    #[test]
    fn corners_run_by_rows_from_the_upper_left() {
        let board = Checkerboard::new([4, 3], 2e-3).unwrap();
        let points = board.points();
        assert_eq!(points.len(), board.corner_count());
        assert_eq!(points[0], 2e-3 * DVec3::new(0.0, 2.0, 0.0));
        assert_eq!(points[3], 2e-3 * DVec3::new(3.0, 2.0, 0.0));
        assert_eq!(points[11], 2e-3 * DVec3::new(3.0, 0.0, 0.0));
        let mean = points.iter().sum::<DVec3>() / 12.0;
        assert!(mean.distance(board.middle()) < 1e-18, "{mean}");
    }

    #[test]
    fn impossible_boards_are_refused() {
        refuses!(corners = [5, 5], square_size = 1e-3 => Checkerboard::new(corners, square_size);
            corners: [[2, 5], [5, 900]], square_size: [0.0, f64::NAN]);
    }
}
