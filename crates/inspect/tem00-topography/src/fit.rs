use glam::DVec3;
use tem00_numerics::{NormalEquations, minimise};

/// Sphere through measured points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FittedSphere {
    pub(crate) centre: DVec3,
    pub(crate) radius: f64,
}

impl FittedSphere {
    /// Fits by least squares of radial distances, from a sphere near it.
    pub(crate) fn new(points: &[DVec3], start: Self) -> Option<Self> {
        if points.len() < 4 {
            return None;
        }
        let stepped = |sphere: &Self, by: &[f64]| Self {
            centre: sphere.centre + DVec3::new(by[0], by[1], by[2]),
            radius: sphere.radius + by[3],
        };
        let equations = |sphere: &Self| {
            let mut system = NormalEquations::new(4);
            for point in points {
                let from = *point - sphere.centre;
                let along = from.try_normalize()?;
                let slopes = [-along.x, -along.y, -along.z, -1.0];
                system.add(from.length() - sphere.radius, &slopes);
            }
            Some(system)
        };
        let found = minimise(start, stepped, equations).ok()?;
        Some(found.state)
    }

    /// Returns the distance of a point from the surface, in metres: positive outside.
    pub(crate) fn residual(&self, point: DVec3) -> f64 {
        point.distance(self.centre) - self.radius
    }
}

/// Plane through measured points: the distances of the points from it, in metres.
///
/// The distances are least in squares along z, then measured across the plane.
pub(crate) fn plane_residuals(points: &[DVec3]) -> Option<Vec<f64>> {
    let [a, b, c] = linear_fit(points, |point| ([point.x, point.y, 1.0], point.z))?;
    let across = a.hypot(b).hypot(1.0);
    let residual = |point: &DVec3| (point.z - a * point.x - b * point.y - c) / across;
    Some(points.iter().map(residual).collect())
}

/// Returns the coefficients of least squares of `Σ aᵢ basisᵢ = value`.
pub(crate) fn linear_fit<T, const N: usize>(
    points: &[T],
    row: impl Fn(&T) -> ([f64; N], f64),
) -> Option<[f64; N]> {
    if points.len() < N {
        return None;
    }
    let stepped = |state: &[f64; N], by: &[f64]| core::array::from_fn(|i| state[i] + by[i]);
    let equations = |state: &[f64; N]| {
        let mut system = NormalEquations::new(N);
        for point in points {
            let (basis, value) = row(point);
            let fitted: f64 = basis.iter().zip(state).map(|(b, a)| b * a).sum();
            system.add(fitted - value, &basis);
        }
        Some(system)
    };
    minimise([0.0; N], stepped, equations)
        .ok()
        .map(|found| found.state)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_and_a_plane_come_back() {
        let truth = FittedSphere {
            centre: DVec3::new(1e-3, -2e-3, 0.5e-3),
            radius: 5e-3,
        };
        let on = |i: u32| {
            let (u, v) = (0.7 * f64::from(i), 0.03 * f64::from(i));
            let direction = DVec3::new(u.cos() * v.sin(), u.sin() * v.sin(), v.cos());
            truth.centre + truth.radius * direction
        };
        let points: Vec<DVec3> = (0..30).map(on).collect();
        let start = FittedSphere {
            centre: DVec3::ZERO,
            radius: 4e-3,
        };
        let found = FittedSphere::new(&points, start).unwrap();
        assert!((found.radius - truth.radius).abs() < 1e-12, "{found:?}");
        assert!(found.residual(truth.centre) + truth.radius < 1e-12);

        let tilted: Vec<DVec3> = points
            .iter()
            .map(|p| DVec3::new(p.x, p.y, 0.75 * p.x + 2.0))
            .collect();
        let residuals = plane_residuals(&tilted).unwrap();
        assert!(residuals.iter().all(|r| r.abs() < 1e-12));
        // Across a plane of slope 3/4 a height counts 4/5.
        let mut lifted = tilted;
        for point in lifted.iter_mut().skip(1).step_by(2) {
            point.z += 0.01;
        }
        let moved = plane_residuals(&lifted).unwrap();
        let range = moved[1] - moved[0];
        assert!((range / 0.008 - 1.0).abs() < 0.2, "{range}");
    }
}
