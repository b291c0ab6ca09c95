use num_complex::Complex;

/// The largest number of steps towards an eigenvalue; two or three are usual.
const MAX_STEPS: usize = 100;

/// Returns the eigenvalues of a Hermitian matrix, which is given row by row, to the rounding error
/// of the largest one: by Householder reflections to tridiagonal form and QL steps with implicit
/// shifts.
///
/// # References
///
/// - G. H. Golub, C. F. Van Loan, *Matrix Computations*, 1996, §8.3.
pub(crate) fn hermitian_eigenvalues(mut a: Vec<Complex<f64>>, n: usize) -> Vec<f64> {
    let mut beside: Vec<f64> = (1..n).map(|k| reflect(&mut a, n, k - 1)).collect();
    beside.resize(n, 0.0);
    let mut diagonal: Vec<f64> = (0..n).map(|i| a[i * n + i].re).collect();
    for first in 0..n {
        for _ in 0..MAX_STEPS {
            let is_apart = |&i: &usize| {
                i + 1 == n
                    || beside[i].abs() <= f64::EPSILON * (diagonal[i].abs() + diagonal[i + 1].abs())
            };
            let last = (first..n).find(is_apart).unwrap_or(first);
            if last == first {
                break;
            }
            step(&mut diagonal, &mut beside, [first, last]);
        }
    }
    diagonal
}

/// Reflects the column k below the diagonal onto its first element, whose magnitude is returned.
fn reflect(a: &mut [Complex<f64>], n: usize, k: usize) -> f64 {
    let mut v: Vec<Complex<f64>> = (k + 1..n).map(|i| a[i * n + k]).collect();
    let size = v.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
    let norm = v[0].norm();
    if v[1..].iter().all(|x| x.norm_sqr() == 0.0) {
        return size;
    }
    let phase = if norm > 0.0 {
        v[0] / norm
    } else {
        Complex::ONE
    };
    v[0] += phase * size;
    let length = v.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
    v.iter_mut().for_each(|x| *x /= length);
    // A − 2 (v w* + w v*) of w = A v − (v* A v) v.
    let row = |i: usize| (k + 1 + i) * n + k + 1;
    let product = |i: usize| {
        a[row(i)..]
            .iter()
            .zip(&v)
            .map(|(a, v)| a * v)
            .sum::<Complex<f64>>()
    };
    let mut w: Vec<Complex<f64>> = (0..v.len()).map(product).collect();
    let middle = v
        .iter()
        .zip(&w)
        .map(|(v, w)| (v.conj() * w).re)
        .sum::<f64>();
    w.iter_mut().zip(&v).for_each(|(w, v)| *w -= v * middle);
    for (i, (&vi, &wi)) in v.iter().zip(&w).enumerate() {
        for (element, (vj, wj)) in a[row(i)..].iter_mut().zip(v.iter().zip(&w)) {
            *element -= 2.0 * (vi * wj.conj() + wi * vj.conj());
        }
    }
    size
}

/// Applies a QL step to a tridiagonal matrix between two rows, by plane rotations from the last row
/// to the first.
fn step(diagonal: &mut [f64], beside: &mut [f64], [first, last]: [usize; 2]) {
    let half = (diagonal[first + 1] - diagonal[first]) / (2.0 * beside[first]);
    let root = half.hypot(1.0).copysign(half);
    let mut g = diagonal[last] - diagonal[first] + beside[first] / (half + root);
    let (mut sine, mut cosine, mut change) = (1.0, 1.0, 0.0);
    for i in (first..last).rev() {
        let (f, b) = (sine * beside[i], cosine * beside[i]);
        let size = f.hypot(g);
        beside[i + 1] = size;
        if size == 0.0 {
            diagonal[i + 1] -= change;
            beside[last] = 0.0;
            return;
        }
        (sine, cosine) = (f / size, g / size);
        g = diagonal[i + 1] - change;
        let turn = (diagonal[i] - g) * sine + 2.0 * cosine * b;
        change = sine * turn;
        diagonal[i + 1] = g + change;
        g = cosine * turn - b;
    }
    diagonal[first] -= change;
    beside[first] = g;
    beside[last] = 0.0;
}

#[cfg(test)]
mod tests;
