/// Returns the rows, up to the diagonal, of the lower triangular L with L Lᵀ = R (Cholesky), or the
/// index of the first row at which R is not positive semi-definite.
///
/// The matrix is scaled to a diagonal of about 1, and given by its rows, of which only the part up
/// to the diagonal is used. A pivot up to `rounding` counts as 0, and its column is left out: in a
/// semi-definite matrix the elements of that column are at most the root of `rounding`.
///
/// # Errors
///
/// Returns the index of the row that contradicts the rows above it.
///
/// # Examples
///
/// ```
/// use tem00_numerics::lower_factor;
///
/// let factor = lower_factor(&[vec![1.0], vec![0.6, 1.0]], 1e-12);
/// assert_eq!(factor, Ok(vec![vec![1.0], vec![0.6, 0.8]]));
/// assert_eq!(lower_factor(&[vec![1.0], vec![1.1, 1.0]], 1e-12), Err(1));
/// ```
pub fn lower_factor(rows: &[Vec<f64>], rounding: f64) -> Result<Vec<Vec<f64>>, usize> {
    let mut factor: Vec<Vec<f64>> = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        let mut lower: Vec<f64> = Vec::with_capacity(i + 1);
        for (above, x) in factor.iter().zip(row) {
            let rest = x - dot(&lower, above);
            let pivot = above[lower.len()];
            if pivot == 0.0 && rest.abs() > rounding.sqrt() {
                return Err(i);
            }
            lower.push(if pivot > 0.0 { rest / pivot } else { 0.0 });
        }
        let pivot = row[i] - dot(&lower, &lower);
        if pivot < -rounding || pivot.is_nan() {
            return Err(i);
        }
        lower.push(if pivot > rounding { pivot.sqrt() } else { 0.0 });
        factor.push(lower);
    }
    Ok(factor)
}

/// Returns the sum of the products over the length of the shorter list.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_of_the_factor_is_the_matrix() {
        // The third variable is the sum of the others, so the matrix is singular.
        let (c, s) = (0.3, (2.0_f64 + 2.0 * 0.3).sqrt().recip());
        let rows = [
            vec![1.0],
            vec![c, 1.0],
            vec![(1.0 + c) * s, (1.0 + c) * s, 1.0],
        ];
        let factor = lower_factor(&rows, 1e-12).unwrap();
        assert!(factor[2][2] == 0.0, "{factor:?}");
        for (i, row) in rows.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                assert!((dot(&factor[i], &factor[j]) - x).abs() < 1e-12, "{i}, {j}");
            }
        }
        for bad in [f64::NAN, 2.0, -1.5] {
            assert_eq!(
                lower_factor(&[vec![1.0], vec![bad, 1.0]], 1e-12),
                Err(1),
                "{bad}"
            );
        }
        assert_eq!(
            lower_factor(&[vec![0.0], vec![0.1, 1.0]], 1e-12),
            Err(1),
            "no variance"
        );
    }
}
