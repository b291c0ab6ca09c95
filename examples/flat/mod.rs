//! Variation of the light over a picture of speckle: a cubic fit of its local mean.

use tem00::numerics::Grid;

const TERMS: usize = 4;

/// Returns the cubic surface with the smallest squared distance from a picture.
pub(crate) fn cubic_fit(picture: &Grid<f32>) -> Grid<f32> {
    let [across, down] = [picture.width(), picture.height()].map(polynomials);
    let weight = |i: usize, j: usize| -> f64 {
        let row = |(row, q): (&[f32], &f64)| -> f64 {
            q * row
                .iter()
                .zip(&across[i])
                .map(|(&value, p)| f64::from(value) * p)
                .sum::<f64>()
        };
        picture.rows().zip(&down[j]).map(row).sum()
    };
    let orders = (0..TERMS).flat_map(|i| (0..TERMS - i).map(move |j| (i, j)));
    let terms: Vec<_> = orders.map(|(i, j)| (i, j, weight(i, j))).collect();
    Grid::from_fn(picture.width(), picture.height(), |x, y| {
        let term = |&(i, j, weight): &(usize, usize, f64)| weight * across[i][x] * down[j][y];
        terms.iter().map(term).sum::<f64>() as f32
    })
}

/// Polynomials of rising order on `count` points, orthonormal by Gram and Schmidt.
fn polynomials(count: usize) -> Vec<Vec<f64>> {
    let place = |i: usize| (2 * i + 1) as f64 / count as f64 - 1.0;
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut power = vec![1.0; count];
    for _ in 0..TERMS {
        let mut next = power.clone();
        for (i, value) in power.iter_mut().enumerate() {
            *value *= place(i);
        }
        for lower in &basis {
            let share = dot(&next, lower);
            next.iter_mut()
                .zip(lower)
                .for_each(|(value, p)| *value -= share * p);
        }
        let length = dot(&next, &next).sqrt();
        basis.push(next.iter().map(|value| value / length).collect());
    }
    basis
}
