use super::*;

#[test]
fn circulant_matrices_have_the_transform_of_a_row() {
    for n in [3_u32, 16, 61, 200] {
        let c = [
            Complex::from(2.0),
            Complex::new(0.3, 0.7),
            Complex::new(-0.2, 0.1),
        ];
        let size = n as usize;
        let element = |at: usize| {
            let apart = |i: usize, j: usize| (j + size - i) % size;
            let (i, j) = (at / size, at % size);
            let of = |d: usize| if d < 3 { c[d] } else { Complex::ZERO };
            match (apart(i, j), apart(j, i)) {
                (0, _) => c[0],
                (up, down) => of(up) + of(down).conj(),
            }
        };
        let mut found = hermitian_eigenvalues((0..size * size).map(element).collect(), size);
        let angle = |j: u32| core::f64::consts::TAU * f64::from(j) / f64::from(n);
        let wave = |c: Complex<f64>, angle: f64| 2.0 * (c * Complex::cis(angle)).re;
        let mut expected: Vec<f64> = (0..n)
            .map(|j| 2.0 + wave(c[1], angle(j)) + wave(c[2], 2.0 * angle(j)))
            .collect();
        found.sort_unstable_by(f64::total_cmp);
        expected.sort_unstable_by(f64::total_cmp);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-13, "{n}: {found} {expected}");
        }
    }
}
