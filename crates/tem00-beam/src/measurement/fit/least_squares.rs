//! Nonlinear least squares for a few parameters.
//!
//! Levenberg's and Marquardt's damping of the Gauss–Newton step (D. W. Marquardt, J. Soc. Indust.
//! Appl. Math. 11, 431, 1963): each diagonal element of the normal matrix grows by the same factor,
//! so that the units of the parameters make no difference.

use super::error::FitError;

const MAX_STEPS: usize = 300;
const FIRST_DAMPING: f64 = 1e-3;
const MIN_DAMPING: f64 = 1e-10;

/// The search ends when a full step would lower the sum of squares by less than this fraction,
/// which moves the parameters by less than 1e−6 of their standard errors, …
const NEGLIGIBLE_GAIN: f64 = 1e-14;

/// … or when it would move no parameter, all of order 1, by more than this.
const NEGLIGIBLE_STEP: f64 = 1e-14;

/// A step of this size may remain where rounding hides any gain: data without noise.
const ROUNDING_STEP: f64 = 1e-9;

/// The smallest pivot of the normal matrix, scaled to a unit diagonal, that is no rounding error.
const MIN_PIVOT: f64 = 1e-13;

/// The deviation of one datum from the model, in units of its own error, and the derivatives of
/// that deviation by the parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residual<const N: usize> {
    pub(super) value: f64,
    pub(super) slopes: [f64; N],
}

/// The parameters that fit best.
#[derive(Clone, Copy, Debug)]
pub(super) struct Minimum<const N: usize> {
    pub(super) parameters: [f64; N],
    /// The covariance of the parameters if the residuals have unit variance.
    pub(super) covariance: [[f64; N]; N],
    pub(super) sum_of_squares: f64,
}

/// Finds the minimum of the sum of squares of `count` residuals near `start`.
pub(super) fn minimise<const N: usize>(
    start: [f64; N],
    count: usize,
    residual: impl Fn(&[f64; N], usize) -> Residual<N>,
) -> Result<Minimum<N>, FitError> {
    let system_at = |point: &[f64; N]| {
        let residuals = (0..count).map(|i| residual(point, i));
        residuals.fold(Normal::ZERO, Normal::with)
    };
    let mut damping = FIRST_DAMPING;
    let mut point = start;
    let mut system = system_at(&point);
    for _ in 0..MAX_STEPS {
        let full_step = system.step(0.0);
        if full_step.is_some_and(|step| system.is_negligible(&step)) {
            return system.minimum(point);
        }
        let step = system.step(damping).ok_or(FitError::Undetermined)?;
        let trial = core::array::from_fn(|i| point[i] - step[i]);
        let next = system_at(&trial);
        if next.sum_of_squares <= system.sum_of_squares {
            (point, system) = (trial, next);
            damping = (0.1 * damping).max(MIN_DAMPING);
        } else {
            damping *= 10.0;
        }
    }
    match system.step(0.0) {
        Some(step) if is_within(&step, ROUNDING_STEP) => system.minimum(point),
        Some(_) => Err(FitError::NotConverged),
        None => Err(FitError::Undetermined),
    }
}

/// The normal equations at one point: with the matrix `J` of slopes and the residuals `r`, the
/// matrix `JᵀJ`, the vector `Jᵀr` and the sum `rᵀr`.
#[derive(Clone, Copy, Debug)]
struct Normal<const N: usize> {
    matrix: [[f64; N]; N],
    gradient: [f64; N],
    sum_of_squares: f64,
}

impl<const N: usize> Normal<N> {
    const ZERO: Self = Self {
        matrix: [[0.0; N]; N],
        gradient: [0.0; N],
        sum_of_squares: 0.0,
    };

    fn with(mut self, Residual { value, slopes }: Residual<N>) -> Self {
        for (i, slope) in slopes.iter().enumerate() {
            for (j, other) in slopes.iter().enumerate() {
                self.matrix[i][j] += slope * other;
            }
            self.gradient[i] += slope * value;
        }
        self.sum_of_squares += value * value;
        self
    }

    /// The step that, subtracted from the parameters, leads to the minimum of the damped system.
    fn step(&self, damping: f64) -> Option<[f64; N]> {
        Some(Factor::new(&self.matrix, damping)?.solve(&self.gradient))
    }

    fn is_negligible(&self, step: &[f64; N]) -> bool {
        let gain: f64 = step.iter().zip(&self.gradient).map(|(s, g)| s * g).sum();
        gain <= NEGLIGIBLE_GAIN * self.sum_of_squares || is_within(step, NEGLIGIBLE_STEP)
    }

    fn minimum(&self, parameters: [f64; N]) -> Result<Minimum<N>, FitError> {
        let factor = Factor::new(&self.matrix, 0.0).ok_or(FitError::Undetermined)?;
        let covariance = core::array::from_fn(|i| {
            let unit = core::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
            factor.solve(&unit)
        });
        Ok(Minimum {
            parameters,
            covariance,
            sum_of_squares: self.sum_of_squares,
        })
    }
}

/// Tests that no component exceeds the limit; NaN does.
fn is_within(step: &[f64], limit: f64) -> bool {
    step.iter().all(|s| s.abs() <= limit)
}

/// The Cholesky factor of a normal matrix, scaled to a unit diagonal and damped.
#[derive(Clone, Copy, Debug)]
struct Factor<const N: usize> {
    scale: [f64; N],
    lower: [[f64; N]; N],
}

impl<const N: usize> Factor<N> {
    /// Returns nothing if the matrix is singular, or not finite.
    fn new(matrix: &[[f64; N]; N], damping: f64) -> Option<Self> {
        let scale: [f64; N] = core::array::from_fn(|i| 1.0 / matrix[i][i].sqrt());
        if !scale.iter().all(|s| s.is_finite()) {
            return None;
        }
        let mut lower = [[0.0; N]; N];
        for i in 0..N {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                if i == j {
                    let pivot = 1.0 + damping - known;
                    if pivot <= MIN_PIVOT || pivot.is_nan() {
                        return None;
                    }
                    lower[i][i] = pivot.sqrt();
                } else {
                    lower[i][j] = (matrix[i][j] * scale[i] * scale[j] - known) / lower[j][j];
                }
            }
        }
        Some(Self { scale, lower })
    }

    fn solve(&self, right: &[f64; N]) -> [f64; N] {
        let mut x = [0.0; N];
        for i in 0..N {
            let known: f64 = (0..i).map(|k| self.lower[i][k] * x[k]).sum();
            x[i] = (right[i] * self.scale[i] - known) / self.lower[i][i];
        }
        for i in (0..N).rev() {
            let known: f64 = (i + 1..N).map(|k| self.lower[k][i] * x[k]).sum();
            x[i] = (x[i] - known) / self.lower[i][i];
        }
        core::array::from_fn(|i| x[i] * self.scale[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = p₀ + p₁ x, fitted to (0, 1), (1, 2), (2, 4), (3, 4).
    fn line(p: &[f64; 2], i: usize) -> Residual<2> {
        let (x, y) = ([0.0, 1.0, 2.0, 3.0][i], [1.0, 2.0, 4.0, 4.0][i]);
        Residual {
            value: y - p[0] - p[1] * x,
            slopes: [-1.0, -x],
        }
    }

    #[test]
    fn straight_line_has_its_textbook_solution() {
        let minimum = minimise([100.0, -70.0], 4, line).unwrap();
        // By hand: S_x = 6, S_xx = 14, S_y = 11, S_xy = 22, det = 4 · 14 − 6² = 20.
        let expected = [
            (14.0 * 11.0 - 6.0 * 22.0) / 20.0,
            (4.0 * 22.0 - 6.0 * 11.0) / 20.0,
        ];
        let covariance = [[14.0 / 20.0, -6.0 / 20.0], [-6.0 / 20.0, 4.0 / 20.0]];
        for i in 0..2 {
            let error = minimum.parameters[i] - expected[i];
            // The search stops when the sum may fall by 1e−14 of itself: 1e−7 of √sum.
            assert!(error.abs() < 1e-7, "p{i}: {error:e}");
            for (j, expected) in covariance[i].into_iter().enumerate() {
                let error = minimum.covariance[i][j] - expected;
                assert!(error.abs() < 1e-14, "covariance {i}, {j}: {error:e}");
            }
        }
        // Residuals −0.1, −0.2, 0.7, −0.4.
        let error = minimum.sum_of_squares - 0.7;
        assert!(error.abs() < 1e-13, "sum: {error:e}");
    }

    #[test]
    fn units_of_parameters_and_residuals_do_not_matter() {
        let plain = minimise([100.0, -70.0], 4, line).unwrap();
        let scaled = minimise([100.0 * 1e9, -70.0 * 1e-9], 4, |p, i| {
            let Residual { value, slopes } = line(&[p[0] * 1e-9, p[1] * 1e9], i);
            Residual {
                value: 1e5 * value,
                slopes: [1e5 * slopes[0] * 1e-9, 1e5 * slopes[1] * 1e9],
            }
        })
        .unwrap();
        let ratio = scaled.covariance[0][1] / plain.covariance[0][1] * 1e10;
        assert!((ratio - 1.0).abs() < 1e-13, "{ratio}");
        let ratio = scaled.parameters[0] / plain.parameters[0] / 1e9;
        assert!((ratio - 1.0).abs() < 1e-7, "{ratio}");
    }

    #[test]
    fn curved_valley_is_followed_to_its_end() {
        // H. H. Rosenbrock's function, Computer Journal 3, 175, 1960.
        let minimum = minimise([-1.2, 1.0], 2, |[x, y], i| match i {
            0 => Residual {
                value: 10.0 * (y - x * x),
                slopes: [-20.0 * x, 10.0],
            },
            _ => Residual {
                value: 1.0 - x,
                slopes: [-1.0, 0.0],
            },
        })
        .unwrap();
        for parameter in minimum.parameters {
            assert!((parameter - 1.0).abs() < 1e-12, "{minimum:?}");
        }
    }

    #[test]
    fn steps_that_overshoot_are_taken_back() {
        // Newton's method for the root of the arc tangent diverges from starts beyond 1.39.
        let minimum = minimise([20.0], 1, |&[x], _| Residual {
            value: x.atan(),
            slopes: [1.0 / (1.0 + x * x)],
        });
        let [x] = minimum.unwrap().parameters;
        assert!(x.abs() < 1e-12, "{x}");
    }

    #[test]
    fn parameters_without_influence_are_reported() {
        let same = |p: &[f64; 2], i: usize| Residual {
            value: line(&[p[0] + p[1], 0.0], i).value,
            slopes: [-1.0, -1.0],
        };
        let blind = |p: &[f64; 2], i: usize| Residual {
            value: line(&[p[0], 0.0], i).value,
            slopes: [-1.0, 0.0],
        };
        let results = [minimise([0.0; 2], 4, same), minimise([0.0; 2], 4, blind)];
        for result in results {
            assert!(matches!(result, Err(FitError::Undetermined)), "{result:?}");
        }
    }

    #[test]
    fn residuals_that_are_not_numbers_end_the_search() {
        let result = minimise([0.0], 3, |_, _| Residual {
            value: f64::NAN,
            slopes: [1.0],
        });
        assert!(matches!(result, Err(FitError::NotConverged)), "{result:?}");
    }
}
