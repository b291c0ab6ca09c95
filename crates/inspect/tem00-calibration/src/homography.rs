use glam::{DMat3, DVec2, DVec3};
use nalgebra::{DMatrix, SymmetricEigen};

/// Returns the projective map of the plane that takes `from` to `to` best, or `None` if the points
/// do not determine it.
///
/// The direct linear transform on points that are first moved to their mean and scaled to a mean
/// distance of √2 from it.
///
/// # References
///
/// - R. I. Hartley, *In Defense of the Eight-Point Algorithm*, 1997.
pub(super) fn homography(from: &[DVec2], to: &[DVec2]) -> Option<DMat3> {
    let (before, after) = (normalisation(from)?, normalisation(to)?);
    let mut rows = DMatrix::zeros(2 * from.len(), 9);
    for (i, (from, to)) in from.iter().zip(to).enumerate() {
        let p = (before * from.extend(1.0)).to_array();
        let q = after * to.extend(1.0);
        for (j, p) in p.into_iter().enumerate() {
            rows[(2 * i, j)] = p;
            rows[(2 * i, 6 + j)] = -q.x * p;
            rows[(2 * i + 1, 3 + j)] = p;
            rows[(2 * i + 1, 6 + j)] = -q.y * p;
        }
    }
    let eigen = SymmetricEigen::new(rows.tr_mul(&rows));
    let smallest = eigen.eigenvalues.imin();
    let h = eigen.eigenvectors.column(smallest);
    let row = |i: usize| DVec3::new(h[3 * i], h[3 * i + 1], h[3 * i + 2]);
    let normalised = DMat3::from_cols(row(0), row(1), row(2)).transpose();
    let map = after.inverse() * normalised * before;
    (map.is_finite() && map.determinant() != 0.0).then_some(map)
}

/// Returns the image of a point by a projective map.
#[cfg(test)]
fn mapped(map: DMat3, point: DVec2) -> DVec2 {
    let image = map * point.extend(1.0);
    image.truncate() / image.z
}

fn normalisation(points: &[DVec2]) -> Option<DMat3> {
    let number = points.len() as f64;
    let mean = points.iter().sum::<DVec2>() / number;
    let spread = points.iter().map(|p| p.distance(mean)).sum::<f64>() / number;
    let scale = core::f64::consts::SQRT_2 / spread;
    (points.len() >= 4 && scale.is_finite())
        .then(|| DMat3::from_scale(DVec2::splat(scale)) * DMat3::from_translation(-mean))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_projective_map_comes_back_from_its_points() {
        let map =
            DMat3::from_cols_array(&[900.0, 50.0, 0.3, -80.0, 700.0, -0.2, 300.0, 200.0, 1.0]);
        let from: Vec<_> = (0..12_u32)
            .map(|i| 0.05 * DVec2::new(f64::from(i % 4), f64::from(i / 4)))
            .collect();
        let to: Vec<_> = from.iter().map(|&p| mapped(map, p)).collect();
        let found = homography(&from, &to).unwrap();
        for (from, to) in from.iter().zip(to) {
            // The eigenvector of a squared matrix: roots of rounding, 1e-8, of a spread of 100
            // pixels.
            assert!(mapped(found, *from).distance(to) < 1e-5, "{from}");
        }
        assert!(homography(&from[..3], &from[..3]).is_none(), "three points");
        let one = homography(&[DVec2::ONE; 5], &from[..5]);
        assert!(one.is_none(), "one point");
    }
}
