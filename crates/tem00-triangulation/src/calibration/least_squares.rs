use nalgebra::{DMatrix, DVector};

use crate::TriangulationError;

/// A problem of least squares: residuals that depend on a state, which changes by small steps.
///
/// The step of a state is a vector of its own, as a rotation is no vector.
pub(super) trait LeastSquares {
    /// The sought parameters.
    type State: Clone;

    /// Returns the state changed by a step.
    fn stepped(&self, state: &Self::State, step: &DVector<f64>) -> Self::State;

    /// Returns the residuals, or `None` for a state that is not possible.
    fn residuals(&self, state: &Self::State) -> Option<DVector<f64>>;

    /// Returns the steps by which derivatives are taken.
    fn increments(&self, state: &Self::State) -> DVector<f64>;
}

/// The state of least squares.
#[derive(Clone, Debug)]
pub(super) struct Solution<S> {
    pub state: S,
    /// The sum of the squared residuals.
    pub sum: f64,
    /// The covariance of the step from the true state.
    pub covariance: DMatrix<f64>,
}

/// The maximum number of steps that are tried.
const MAX_STEPS: usize = 200;

/// The relative gain of the sum of squares below which the search ends.
const MIN_GAIN: f64 = 1e-12;

/// Finds the state of least squares near `start` by the damped normal equations, scaled by their
/// diagonal.
///
/// # Errors
///
/// Returns an error if the start is not possible, if the search does not end, or if the residuals leave
/// a direction of the state open.
///
/// # References
///
/// - D. W. Marquardt, *An Algorithm for Least-Squares Estimation of Nonlinear Parameters*, 1963.
pub(super) fn minimise<P: LeastSquares>(
    problem: &P,
    start: P::State,
) -> Result<Solution<P::State>, TriangulationError> {
    let mut state = start;
    let mut residuals = problem.residuals(&state).ok_or(UNDETERMINED)?;
    let mut damping = 1e-3;
    let (mut normal, mut slope) = normal_equations(problem, &state, &residuals)?;
    for _ in 0..MAX_STEPS {
        let sum = residuals.norm_squared();
        let tried = damped(&normal, damping)
            .cholesky()
            .map(|factor| problem.stepped(&state, &-factor.solve(&slope)));
        let better = tried.and_then(|tried| {
            let found = problem.residuals(&tried)?;
            (found.norm_squared() <= sum).then_some((tried, found))
        });
        let Some((tried, found)) = better else {
            damping *= 10.0;
            // The step is nothing but rounding: no smaller one helps.
            if damping > 1e12 {
                return solution(state, &residuals, &normal);
            }
            continue;
        };
        let gain = sum - found.norm_squared();
        (state, residuals) = (tried, found);
        (normal, slope) = normal_equations(problem, &state, &residuals)?;
        damping = (damping * 0.1).max(1e-12);
        if gain <= MIN_GAIN * sum {
            return solution(state, &residuals, &normal);
        }
    }
    Err(UNDETERMINED)
}

const UNDETERMINED: TriangulationError = TriangulationError::NotDetermined {
    what: "the camera",
    advice: "take more boards, tilted about different axes",
};

/// Returns `JᵀJ` and `Jᵀr`, the derivatives by central differences.
fn normal_equations<P: LeastSquares>(
    problem: &P,
    state: &P::State,
    residuals: &DVector<f64>,
) -> Result<(DMatrix<f64>, DVector<f64>), TriangulationError> {
    let increments = problem.increments(state);
    let mut jacobian = DMatrix::zeros(residuals.len(), increments.len());
    for (i, &increment) in increments.iter().enumerate() {
        let at = |by: f64| {
            let mut step = DVector::zeros(increments.len());
            step[i] = by;
            problem.residuals(&problem.stepped(state, &step))
        };
        let (more, less) = at(increment).zip(at(-increment)).ok_or(UNDETERMINED)?;
        jacobian.set_column(i, &((more - less) / (2.0 * increment)));
    }
    let slope = jacobian.tr_mul(residuals);
    Ok((jacobian.tr_mul(&jacobian), slope))
}

fn damped(normal: &DMatrix<f64>, damping: f64) -> DMatrix<f64> {
    let mut damped = normal.clone();
    for i in 0..damped.nrows() {
        damped[(i, i)] *= 1.0 + damping;
    }
    damped
}

fn solution<S>(
    state: S,
    residuals: &DVector<f64>,
    normal: &DMatrix<f64>,
) -> Result<Solution<S>, TriangulationError> {
    let freedom = residuals.len().saturating_sub(normal.nrows());
    let sum = residuals.norm_squared();
    if freedom == 0 {
        return Err(UNDETERMINED);
    }
    let variance = sum / freedom as f64;
    let covariance = inverse(normal).ok_or(UNDETERMINED)? * variance;
    Ok(Solution {
        state,
        sum,
        covariance,
    })
}

/// Returns the inverse of a positive definite matrix, whose rows are first scaled alike.
fn inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scales = matrix.diagonal().map(|v| 1.0 / v.sqrt());
    if !scales.iter().all(|scale| scale.is_finite()) {
        return None;
    }
    let scaled = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            scales[i] * matrix[(i, j)] * scales[j]
        })
    };
    let inverse = scaled(matrix).cholesky()?.inverse();
    let symmetric = (&inverse + inverse.transpose()) * 0.5;
    Some(scaled(&symmetric))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = a exp(b x), whose state changes by (a, b).
    struct Exponential(Vec<[f64; 2]>);

    impl LeastSquares for Exponential {
        type State = [f64; 2];

        fn stepped(&self, state: &[f64; 2], step: &DVector<f64>) -> [f64; 2] {
            [state[0] + step[0], state[1] + step[1]]
        }

        fn residuals(&self, [a, b]: &[f64; 2]) -> Option<DVector<f64>> {
            let residual = |&[x, y]: &[f64; 2]| a * (b * x).exp() - y;
            let all = self.0.iter().map(residual);
            (*a > 0.0).then(|| DVector::from_iterator(self.0.len(), all))
        }

        fn increments(&self, _: &[f64; 2]) -> DVector<f64> {
            DVector::from_element(2, 1e-6)
        }
    }

    #[test]
    fn exact_data_give_the_parameters_back() {
        let data = (0..20).map(|i| f64::from(i) * 0.1);
        let problem = Exponential(data.map(|x| [x, 2.0 * (-0.7 * x).exp()]).collect());
        let solution = minimise(&problem, [0.1, 3.0]).unwrap();
        let [a, b] = solution.state;
        // Rounding 1e-16 of the residuals; the last step gained less than 1e-12 of their squares.
        assert!((a - 2.0).abs() < 1e-7 && (b + 0.7).abs() < 1e-7, "{a}, {b}");
    }

    #[test]
    fn the_covariance_of_a_mean_is_the_variance_by_the_number() {
        // b is held by nothing but x = 0: two clusters make a and b of a line in the exponent.
        let data = vec![
            [0.0, 1.0],
            [0.0, 1.2],
            [0.0, 0.8],
            [1.0, 1.1],
            [1.0, 0.9],
            [1.0, 1.0],
        ];
        let solution = minimise(&Exponential(data), [1.0, 0.1]).unwrap();
        // a is the mean of the first cluster; the variance of a residual is 0.1 / 4.
        let variance = (0.04 + 0.04 + 0.01 + 0.01) / 4.0;
        assert!((solution.sum / 4.0 - variance).abs() < 1e-9, "{solution:?}");
        assert!((solution.covariance[(0, 0)] - variance / 3.0).abs() < 1e-8);
    }

    #[test]
    fn an_open_direction_is_an_error() {
        let problem = Exponential(vec![[0.0, 1.0], [0.0, 1.1], [0.0, 0.9]]);
        assert!(
            minimise(&problem, [1.0, 0.0]).is_err(),
            "b is not determined"
        );
    }
}
