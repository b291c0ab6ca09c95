use nalgebra::{DMatrix, DVector};
use tem00_numerics::NormalEquations;

use tem00_triangulation::TriangulationError;

/// Residuals that depend on a state, which changes by small steps.
///
/// The step of a state is a vector, while a state may hold a rotation, which is no vector.
pub(super) trait Residuals {
    /// The sought parameters.
    type State;

    /// Returns the state changed by a step.
    fn stepped(&self, state: &Self::State, step: &[f64]) -> Self::State;

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

/// Finds the state of least squares near `start`, with the variance of a residual from their
/// scatter.
///
/// # Errors
///
/// Returns an error if the start is not possible, if the search does not end, or if the residuals
/// do not determine a direction of the state.
pub(super) fn minimise<R: Residuals>(
    problem: &R,
    start: R::State,
) -> Result<Solution<R::State>, TriangulationError> {
    let count = problem.residuals(&start).ok_or(UNDETERMINED)?.len();
    let stepped = |state: &_, step: &[f64]| problem.stepped(state, step);
    let equations = |state: &_| normal_equations(problem, state);
    let found = tem00_numerics::minimise(start, stepped, equations).map_err(|_| UNDETERMINED)?;
    let parameters = found.covariance.len();
    let freedom = count.saturating_sub(parameters);
    if freedom == 0 {
        return Err(UNDETERMINED);
    }
    let variance = found.sum_of_squares / freedom as f64;
    let unit = |i: usize, j: usize| found.covariance[i][j];
    Ok(Solution {
        covariance: DMatrix::from_fn(parameters, parameters, |i, j| variance * unit(i, j)),
        state: found.state,
        sum: found.sum_of_squares,
    })
}

const UNDETERMINED: TriangulationError = TriangulationError::NotDetermined {
    what: "the camera",
    advice: "take more boards, tilted about different axes",
};

/// Returns the normal equations, the derivatives by central differences.
fn normal_equations<R: Residuals>(problem: &R, state: &R::State) -> Option<NormalEquations> {
    let residuals = problem.residuals(state)?;
    let increments = problem.increments(state);
    let derivative = |(i, &increment): (usize, &f64)| {
        let at = |by: f64| {
            let mut step = vec![0.0; increments.len()];
            step[i] = by;
            problem.residuals(&problem.stepped(state, &step))
        };
        Some((at(increment)? - at(-increment)?) / (2.0 * increment))
    };
    let columns = increments.iter().enumerate().map(derivative);
    let columns: Vec<_> = columns.collect::<Option<_>>()?;
    let mut equations = NormalEquations::new(columns.len());
    for (i, &residual) in residuals.iter().enumerate() {
        let slopes: Vec<f64> = columns.iter().map(|column| column[i]).collect();
        equations.add(residual, &slopes);
    }
    Some(equations)
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_absolute;

    use super::*;

    /// y = a exp(b x), whose state changes by (a, b).
    struct Exponential(Vec<[f64; 2]>);

    impl Residuals for Exponential {
        type State = [f64; 2];

        fn stepped(&self, state: &[f64; 2], step: &[f64]) -> [f64; 2] {
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
        assert_absolute(a, 2.0, 1e-7);
        assert_absolute(b, -0.7, 1e-7);
    }

    #[test]
    fn the_covariance_of_a_mean_is_the_variance_by_the_number() {
        // b is held by nothing but x = 0: two clusters make a and b of a line in the exponent.
        let of = |x: f64, values: [f64; 3]| values.map(|y| [x, y]);
        let data = [of(0.0, [1.0, 1.2, 0.8]), of(1.0, [1.1, 0.9, 1.0])].concat();
        let solution = minimise(&Exponential(data), [1.0, 0.1]).unwrap();
        // a is the mean of the first cluster; the variance of a residual is 0.1 / 4.
        let variance = (0.04 + 0.04 + 0.01 + 0.01) / 4.0;
        assert_absolute(solution.sum / 4.0, variance, 1e-9);
        assert_absolute(solution.covariance[(0, 0)], variance / 3.0, 1e-8);
    }

    #[test]
    fn an_open_direction_is_an_error() {
        let problem = Exponential(vec![[0.0, 1.0], [0.0, 1.1], [0.0, 0.9]]);
        let open = minimise(&problem, [1.0, 0.0]);
        assert!(open.is_err(), "b is not determined");
    }
}
