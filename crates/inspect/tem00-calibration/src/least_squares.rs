use nalgebra::DMatrix;
use tem00_numerics::NormalEquations;
use tem00_triangulation::TriangulationError;

use crate::model::{Bundle, State};

/// The state of least squares.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    pub state: State,
    /// The sum of the squared residuals.
    pub sum: f64,
    /// The covariance of the step from the true state.
    pub covariance: DMatrix<f64>,
}

/// Finds the state near `start` whose sum of squared residuals is least, with the variance of a
/// residual from their scatter.
///
/// # Errors
///
/// Returns an error if the start is not possible, if the search does not end, or if the residuals
/// do not determine a direction of the state.
pub(super) fn minimise(bundle: &Bundle<'_>, start: State) -> Result<Solution, TriangulationError> {
    let count = bundle.residuals(&start).ok_or(UNDETERMINED)?.len();
    let stepped = |state: &State, step: &[f64]| bundle.stepped(state, step);
    let equations = |state: &State| normal_equations(bundle, state);
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
fn normal_equations(bundle: &Bundle<'_>, state: &State) -> Option<NormalEquations> {
    let residuals = bundle.residuals(state)?;
    let increments = bundle.increments(state);
    let derivative = |(i, &increment): (usize, &f64)| {
        let at = |by: f64| {
            let mut step = vec![0.0; increments.len()];
            step[i] = by;
            bundle.residuals(&bundle.stepped(state, &step))
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
