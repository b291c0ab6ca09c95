use num_complex::Complex;

/// Sweeps after which the elements off the diagonal are rounding errors.
const MAX_SWEEPS: usize = 40;

/// Returns the eigenvalues of a Hermitian matrix, row by row, by Jacobi's rotations: slow, and good to rounding.
///
/// # References
///
/// - G. H. Golub, C. F. Van Loan, *Matrix Computations*, 1996, §8.4.
pub(crate) fn hermitian_eigenvalues(mut a: Vec<Complex<f64>>, n: usize) -> Vec<f64> {
    for _ in 0..MAX_SWEEPS {
        let mut off = 0.0;
        for p in 0..n {
            for q in p + 1..n {
                off += a[p * n + q].norm_sqr();
                rotate(&mut a, n, [p, q]);
            }
        }
        let trace: f64 = (0..n).map(|i| a[i * n + i].norm_sqr()).sum();
        if off <= 1e-30 * trace {
            break;
        }
    }
    (0..n).map(|i| a[i * n + i].re).collect()
}

/// Turns the rows and columns p and q so that their element becomes zero.
fn rotate(a: &mut [Complex<f64>], n: usize, [p, q]: [usize; 2]) {
    let element = a[p * n + q];
    let size = element.norm();
    if size < 1e-300 {
        return;
    }
    let phase = element / size;
    let theta = (a[q * n + q].re - a[p * n + p].re) / (2.0 * size);
    let t = theta.signum() / (theta.abs() + 1.0_f64.hypot(theta));
    let c = 1.0_f64.hypot(t).recip();
    let s = phase * (t * c);
    for i in 0..n {
        let (x, y) = (a[i * n + p], a[i * n + q]);
        a[i * n + p] = x * c - y * s.conj();
        a[i * n + q] = x * s + y * c;
    }
    for i in 0..n {
        let (x, y) = (a[p * n + i], a[q * n + i]);
        a[p * n + i] = x * c - y * s;
        a[q * n + i] = x * s.conj() + y * c;
    }
}

#[cfg(test)]
mod tests;
