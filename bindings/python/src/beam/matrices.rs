//! 2 × 2 matrices as rows.

use tem00_beam::DMat2;

/// The rows of a 2 × 2 matrix.
pub(super) type Rows = [[f64; 2]; 2];

/// A matrix from its rows.
pub(super) fn matrix_of(rows: Rows) -> DMat2 {
    DMat2::from_cols_array_2d(&rows).transpose()
}

/// The rows of a matrix.
pub(super) fn rows_of(matrix: DMat2) -> Rows {
    matrix.transpose().to_cols_array_2d()
}
