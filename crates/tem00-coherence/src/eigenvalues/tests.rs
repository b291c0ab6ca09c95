use approx::assert_relative_eq;

use super::*;

#[test]
fn a_small_matrix_has_its_eigenvalues() {
    let c = Complex::new;
    // 2 ± √(0.5² + |1 + 2i|²)
    let matrix = vec![c(2.5, 0.0), c(1.0, 2.0), c(1.0, -2.0), c(1.5, 0.0)];
    let mut found = hermitian_eigenvalues(matrix, 2);
    found.sort_unstable_by(f64::total_cmp);
    let root = 5.25_f64.sqrt();
    assert_relative_eq!(found[0], 2.0 - root, max_relative = 1e-14);
    assert_relative_eq!(found[1], 2.0 + root, max_relative = 1e-14);
}

#[test]
fn a_kernel_of_phases_has_one_eigenvalue() {
    let n = 20;
    let phase = |i: usize| Complex::cis((i * i) as f64);
    let matrix = (0..n * n).map(|at| phase(at / n) * phase(at % n).conj());
    let mut found = hermitian_eigenvalues(matrix.collect(), n);
    found.sort_unstable_by(f64::total_cmp);
    assert_relative_eq!(found[n - 1], 20.0, max_relative = 1e-14);
    assert!(
        found[..n - 1].iter().all(|value| value.abs() < 1e-13),
        "{found:?}"
    );
}
