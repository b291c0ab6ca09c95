use glam::DVec3;
use nalgebra::{Matrix3, SymmetricEigen};

use tem00_triangulation::TriangulationError;

/// Largest distance of a point from the plane, in robust standard deviations.
const OUTLIER: f64 = 4.0;

/// The minimum ratio of the spread of the points across the line to their scatter off the plane.
const MIN_SPREAD: f64 = 10.0;

/// A plane through points, by the smallest sum of squared distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FittedPlane {
    /// The mean of the points, in metres.
    pub middle: DVec3,
    /// The unit normal.
    pub normal: DVec3,
}

impl FittedPlane {
    /// Fits a plane: its normal is the direction in which the points scatter least.
    ///
    /// # Errors
    ///
    /// Returns an error if there are less than three points, or if they lie on a line within their
    /// scatter.
    pub(super) fn through(points: &[DVec3]) -> Result<Self, TriangulationError> {
        if points.len() < 3 {
            return Err(TriangulationError::TooFew {
                what: "points of the laser line on the boards",
                got: points.len(),
                needed: 3,
            });
        }
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        let scatter = points
            .iter()
            .fold(Matrix3::zeros(), |sum: Matrix3<f64>, point| {
                let offset = (point - middle).to_array();
                sum + Matrix3::from_fn(|i, j| offset[i] * offset[j])
            });
        let eigen = SymmetricEigen::new(scatter);
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        let [min, across, along] = order.map(|i| eigen.eigenvalues[i]);
        let spread = across > MIN_SPREAD * MIN_SPREAD * min && across > 1e-9 * along;
        let normal = eigen.eigenvectors.column(order[0]);
        let normal = DVec3::new(normal[0], normal[1], normal[2]);
        spread.then_some(Self { middle, normal }).ok_or(OPEN)
    }

    /// Returns the distance of a point, in metres, positive on the side of the normal.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.middle)
    }

    /// Returns the same plane with the normal on the side of another.
    pub(super) fn towards(self, normal: DVec3) -> Self {
        Self {
            normal: self.normal * self.normal.dot(normal).signum(),
            ..self
        }
    }

    /// Returns the covariance of the change of the normal and of the offset along it, for points
    /// with this variance of their distances, in m².
    pub(super) fn covariance(&self, points: &[DVec3], variance: f64) -> Option<[[f64; 4]; 4]> {
        let (u, v) = self.normal.any_orthonormal_pair();
        let normal_matrix = points
            .iter()
            .fold(Matrix3::zeros(), |sum: Matrix3<f64>, point| {
                let offset = point - self.middle;
                let row = [u.dot(offset), v.dot(offset), -1.0];
                sum + Matrix3::from_fn(|i, j| row[i] * row[j])
            });
        let inverse = normal_matrix.try_inverse()? * variance;
        // The normal changes by a u + b v.
        let rows = [
            [u.x, v.x, 0.0],
            [u.y, v.y, 0.0],
            [u.z, v.z, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let sum = |i: usize, j: usize| {
            let terms = (0..9).map(|k| rows[i][k / 3] * inverse[(k / 3, k % 3)] * rows[j][k % 3]);
            terms.sum::<f64>()
        };
        Some(core::array::from_fn(|i| {
            core::array::from_fn(|j| sum(i, j))
        }))
    }
}

const OPEN: TriangulationError = TriangulationError::NotDetermined {
    what: "the laser plane",
    advice: "take the line on boards at different heights",
};

/// Fits a plane and leaves out points far from it, twice. Returns the plane and whether each point
/// counts.
///
/// # Errors
///
/// Returns the errors of [`FittedPlane::through`].
pub(super) fn without_outliers(
    points: &[DVec3],
) -> Result<(FittedPlane, Vec<bool>), TriangulationError> {
    let mut plane = FittedPlane::through(points)?;
    let mut counts = vec![true; points.len()];
    for _ in 0..2 {
        let distances: Vec<_> = points.iter().map(|&p| plane.distance(p).abs()).collect();
        let limit = OUTLIER * robust_deviation(distances.clone());
        counts = distances
            .iter()
            .map(|&distance| distance <= limit)
            .collect();
        plane = FittedPlane::through(&kept(points, &counts))?;
    }
    Ok((plane, counts))
}

/// Returns the points that count.
pub(super) fn kept(points: &[DVec3], counts: &[bool]) -> Vec<DVec3> {
    let kept = points.iter().zip(counts).filter(|(_, counts)| **counts);
    kept.map(|(point, _)| *point).collect()
}

/// Returns the standard deviation of normal values with this median of absolute values.
fn robust_deviation(mut distances: Vec<f64>) -> f64 {
    let middle = distances.len() / 2;
    let (_, median, _) = distances.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of |x| for a standard normal x is 0.67449.
    *median / 0.674_489_750_196_081_7
}

/// Returns by how much the variance of a mean of neighbouring distances exceeds its value for
/// independent distances: 1 plus twice the sum of their correlations, up to the first that is not
/// positive.
///
/// Each run is the points of one line in order. The straight line through a run is subtracted
/// first: it belongs to the pose of its board.
pub(super) fn correlation_factor(runs: &[Vec<f64>]) -> f64 {
    let runs: Vec<_> = runs
        .iter()
        .filter(|run| run.len() > 8)
        .map(|run| straightened(run))
        .collect();
    let covariance = |lag: usize| {
        let products = runs
            .iter()
            .flat_map(|run| run.iter().zip(&run[lag.min(run.len())..]));
        let (sum, number) = products.fold((0.0, 0.0), |(sum, n), (a, b)| (sum + a * b, n + 1.0));
        sum / f64::max(number, 1.0)
    };
    let variance = covariance(0);
    let longest = runs.iter().map(Vec::len).max().unwrap_or(0);
    if variance <= 0.0 {
        return 1.0;
    }
    let correlations = (1..longest / 4).map(|lag| covariance(lag) / variance);
    1.0 + 2.0
        * correlations
            .take_while(|&correlation| correlation > 0.0)
            .sum::<f64>()
}

/// Returns the values minus the straight line that fits them best.
fn straightened(values: &[f64]) -> Vec<f64> {
    let number = values.len() as f64;
    let position = |i: usize| i as f64 - (number - 1.0) / 2.0;
    let mean = values.iter().sum::<f64>() / number;
    let weighted = values
        .iter()
        .enumerate()
        .map(|(i, value)| position(i) * value);
    let slope = 12.0 * weighted.sum::<f64>() / (number * (number * number - 1.0));
    let rest = |(i, value): (usize, &f64)| value - mean - slope * position(i);
    values.iter().enumerate().map(rest).collect()
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    fn points() -> Vec<DVec3> {
        let position = |i: u32| 1e-3 * DVec3::new((i % 10).into(), 0.0, (i / 10).into());
        let points = (0..100).map(|i| position(i) + DVec3::new(0.1, 0.2, 0.3));
        points.collect()
    }

    #[test]
    fn far_points_are_left_out() {
        let mut points = points();
        for (i, point) in points.iter_mut().enumerate() {
            point.y += if i % 2 == 0 { 1e-6 } else { -1e-6 };
        }
        points[7].y += 1e-4;
        points[50].y -= 3e-4;
        let (plane, counts) = without_outliers(&points).unwrap();
        assert_eq!(counts.iter().filter(|counts| !**counts).count(), 2);
        assert!(plane.normal.dot(DVec3::Y).abs() > 1.0 - 1e-6, "{plane:?}");
        assert!((plane.middle.y - 0.2).abs() < 1e-7, "{plane:?}");
    }

    #[test]
    fn points_on_a_line_make_no_plane() {
        let points: Vec<_> = (0..50).map(|i| 1e-3 * f64::from(i) * DVec3::X).collect();
        assert_eq!(FittedPlane::through(&points), Err(OPEN));
        assert!(FittedPlane::through(&points[..2]).is_err(), "two points");
    }

    #[test]
    fn the_offset_is_as_certain_as_a_mean() {
        let plane = FittedPlane::through(&points()).unwrap();
        let covariance = plane.covariance(&points(), 4e-12).unwrap();
        assert_relative(covariance[3][3], 4e-14, 1e-9);
        // A slope over x: σ² / Σ x², with Σ x² = 100 · 8.25 mm². The normal tilts by it, not along
        // itself.
        assert_relative(covariance[0][0], 4e-12 / 825e-6, 1e-9);
        assert_absolute(covariance[1][1], 0.0, 1e-20);
    }

    #[test]
    fn doubled_values_count_half() {
        // A fixed sequence without order: the fractions of multiples of an irrational number's
        // square.
        let value = |i: u32| (f64::from(i * i) * 0.618_033_988_749_894_9).fract() - 0.5;
        let single: Vec<_> = (0..400).map(value).collect();
        let double: Vec<_> = (0..800).map(|i| value(i / 2)).collect();
        // Pairs of equal values correlate by 1/2 with the next; the estimate scatters by a few
        // 1/√400.
        assert_absolute(correlation_factor(&[single]), 1.0, 0.3);
        assert_absolute(correlation_factor(&[double]), 2.0, 0.4);
        assert_eq!(correlation_factor(&[]).to_bits(), 1.0_f64.to_bits());
    }
}
