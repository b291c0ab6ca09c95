//! Nonlinear least squares by damped Gauss–Newton steps.
//!
//! Levenberg's and Marquardt's damping (D. W. Marquardt, J. Soc. Indust. Appl. Math. 11, 431,
//! 1963): each diagonal element of the normal matrix grows by the same factor, so that the units of
//! the parameters make no difference.

use core::{error, fmt};

use crate::lower_factor::{dot, lower_factor};

const MAX_STEPS: usize = 300;
const FIRST_DAMPING: f64 = 1e-3;
const MIN_DAMPING: f64 = 1e-10;

/// Damping above which a step is only rounding: the search has reached the minimum.
const MAX_DAMPING: f64 = 1e12;

/// Number of consecutive steps after which the search ends if none of them lowered the sum of
/// squares by more than its rounding or halved the remaining gain.
const MAX_IDLE_STEPS: u32 = 16;

/// Fraction of the first sum of squares at which the search ends: the remaining residuals are
/// rounding errors.
const NOTHING_LEFT: f64 = 1e-28;

/// The fraction of the sum of squares below which no gain is worth a step: the parameters would
/// move by less than 1e−10 of their standard errors.
const NEGLIGIBLE_GAIN: f64 = 1e-22;

/// The relative change of the sum of squares that its rounding hides: the sum is flat near its
/// minimum, where a step is judged by the remaining gain.
const ROUNDING: f64 = 1e-12;

/// The smallest pivot of the normal matrix, scaled to a unit diagonal, that exceeds rounding
/// errors.
const MIN_PIVOT: f64 = 1e-13;

/// The normal equations at one state: with the residuals `r` and the matrix `J` of their
/// derivatives with respect to the parameters, the matrix `JᵀJ`, the vector `Jᵀr` and the sum
/// `rᵀr`.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalEquations {
    /// Row by row, up to the diagonal.
    rows: Vec<Vec<f64>>,
    gradient: Vec<f64>,
    sum_of_squares: f64,
}

/// Result of a search: the state with the least sum of squares.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum<S> {
    /// The state.
    pub state: S,
    /// The sum of the squared residuals.
    pub sum_of_squares: f64,
    /// The covariance of the step from the true state if the residuals have unit variance.
    pub covariance: Vec<Vec<f64>>,
}

/// Reasons for which no minimum was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeastSquaresError {
    /// The residuals do not determine a direction of the state.
    Undetermined,
    /// The search did not converge, or the start is not a valid state.
    NotConverged,
}

impl fmt::Display for LeastSquaresError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Undetermined => "the residuals do not determine all parameters",
            Self::NotConverged => "the search for the least squares did not converge",
        })
    }
}

impl error::Error for LeastSquaresError {}

/// Finds the state of least squares near `start`.
///
/// `stepped` changes a state by a step, one number per parameter: a state need not be a vector
/// itself, for example a rotation. `equations` returns the normal equations of all residuals, or
/// `None` for an invalid state. The search ends where a full step would move the parameters by less
/// than 1e−10 of their standard errors, or where rounding hides any gain, as with noise-free
/// residuals or finite-difference derivatives.
///
/// # Errors
///
/// Returns an error if the start is invalid, if the search does not converge, or if the residuals
/// do not determine a direction of the state.
///
/// # Examples
///
/// The root of 2 is where `x² − 2` has the smallest square:
///
/// ```
/// use tem00_numerics::{NormalEquations, minimise};
///
/// let equations = |x: &f64| {
///     let mut equations = NormalEquations::new(1);
///     equations.add(x * x - 2.0, &[2.0 * x]);
///     Some(equations)
/// };
/// let minimum = minimise(1.0, |x, step| x + step[0], equations)?;
/// assert!((minimum.state - 2.0_f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), tem00_numerics::LeastSquaresError>(())
/// ```
pub fn minimise<S>(
    start: S,
    stepped: impl Fn(&S, &[f64]) -> S,
    equations: impl Fn(&S) -> Option<NormalEquations>,
) -> Result<Minimum<S>, LeastSquaresError> {
    let mut state = start;
    let mut system = equations(&state)
        .filter(|system| system.sum_of_squares.is_finite())
        .ok_or(LeastSquaresError::NotConverged)?;
    let mut damping = FIRST_DAMPING;
    let mut gain = system.gain();
    let (mut least_gain, mut idle) = (gain, 0);
    let nothing = NOTHING_LEFT * system.sum_of_squares;
    for _ in 0..MAX_STEPS {
        let sum = system.sum_of_squares;
        let is_done = gain <= NEGLIGIBLE_GAIN * sum || sum <= nothing;
        if is_done || damping > MAX_DAMPING || idle == MAX_IDLE_STEPS {
            return system.minimum(state);
        }
        let next = system.step(damping).and_then(|step| {
            let next = stepped(&state, &step);
            equations(&next).map(|found| (next, found.gain(), found))
        });
        match next {
            Some((next, next_gain, found)) if found.is_better(next_gain, sum, gain) => {
                let is_lower = found.sum_of_squares < (1.0 - ROUNDING) * sum;
                (state, system, gain) = (next, found, next_gain);
                if is_lower || gain < 0.5 * least_gain {
                    (least_gain, idle) = (gain, 0);
                } else {
                    idle += 1;
                }
                damping = (0.1 * damping).max(MIN_DAMPING);
            }
            Some((_, _, found)) if found.sum_of_squares <= (1.0 + ROUNDING) * sum => {
                damping *= 10.0;
                idle += 1;
            }
            _ => damping *= 10.0,
        }
    }
    system
        .minimum(state)
        .and(Err(LeastSquaresError::NotConverged))
}

/// The deviation of a datum from a model with `N` parameters, in units of its own error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual<const N: usize> {
    /// The deviation.
    pub value: f64,
    /// The derivatives of the deviation with respect to the parameters.
    pub slopes: [f64; N],
}

/// Finds the parameters of least squares near `start`, given each of `count` residuals.
///
/// # Errors
///
/// Returns the errors of [`minimise`].
pub fn minimise_residuals<const N: usize>(
    start: [f64; N],
    count: usize,
    residual: impl Fn(&[f64; N], usize) -> Residual<N>,
) -> Result<Minimum<[f64; N]>, LeastSquaresError> {
    let stepped = |p: &[f64; N], step: &[f64]| core::array::from_fn(|i| p[i] + step[i]);
    let equations = |p: &[f64; N]| {
        let mut equations = NormalEquations::new(N);
        for i in 0..count {
            let Residual { value, slopes } = residual(p, i);
            equations.add(value, &slopes);
        }
        Some(equations)
    };
    minimise(start, stepped, equations)
}

impl NormalEquations {
    /// Creates the equations of a number of parameters, without residuals.
    pub fn new(parameters: usize) -> Self {
        Self {
            rows: (1..=parameters).map(|length| vec![0.0; length]).collect(),
            gradient: vec![0.0; parameters],
            sum_of_squares: 0.0,
        }
    }

    /// Adds a residual with its derivatives with respect to the parameters.
    pub fn add(&mut self, residual: f64, slopes: &[f64]) {
        for (row, slope) in self.rows.iter_mut().zip(slopes) {
            for (element, other) in row.iter_mut().zip(slopes) {
                *element += slope * other;
            }
        }
        for (element, slope) in self.gradient.iter_mut().zip(slopes) {
            *element += slope * residual;
        }
        self.sum_of_squares += residual * residual;
    }

    /// Returns the step to the minimum of the damped system.
    fn step(&self, damping: f64) -> Option<Vec<f64>> {
        let mut step = Factor::new(&self.rows, damping)?.solve(&self.gradient);
        step.iter_mut().for_each(|by| *by = -*by);
        Some(step)
    }

    /// Returns the decrease of the sum of squares by a full step if the residuals were linear; NaN
    /// without such a step.
    fn gain(&self) -> f64 {
        self.step(0.0).map_or(f64::NAN, |step| {
            let gains = step.iter().zip(&self.gradient);
            -gains.map(|(by, slope)| by * slope).sum::<f64>()
        })
    }

    /// Returns whether these equations are closer to a minimum than those with the sum of squares
    /// `sum` and the gain `gain`.
    fn is_better(&self, own_gain: f64, sum: f64, gain: f64) -> bool {
        let is_lower = self.sum_of_squares < (1.0 - ROUNDING) * sum;
        is_lower || self.sum_of_squares <= (1.0 + ROUNDING) * sum && own_gain < gain
    }

    fn minimum<S>(&self, state: S) -> Result<Minimum<S>, LeastSquaresError> {
        let factor = Factor::new(&self.rows, 0.0).ok_or(LeastSquaresError::Undetermined)?;
        let count = self.gradient.len();
        let column = |i: usize| {
            let mut unit = vec![0.0; count];
            unit[i] = 1.0;
            factor.solve(&unit)
        };
        Ok(Minimum {
            state,
            sum_of_squares: self.sum_of_squares,
            covariance: (0..count).map(column).collect(),
        })
    }
}

/// The Cholesky factor of a normal matrix, scaled to a unit diagonal and damped.
struct Factor {
    scale: Vec<f64>,
    lower: Vec<Vec<f64>>,
}

impl Factor {
    /// Returns `None` if the matrix is singular or not finite.
    fn new(rows: &[Vec<f64>], damping: f64) -> Option<Self> {
        let diagonal = rows.iter().filter_map(|row| row.last());
        let scale: Vec<f64> = diagonal.map(|element| 1.0 / element.sqrt()).collect();
        if !scale.iter().all(|s| s.is_finite()) {
            return None;
        }
        let scaled = |(i, row): (usize, &Vec<f64>)| {
            let elements = row.iter().zip(&scale);
            let mut scaled: Vec<f64> = elements.map(|(x, other)| x * scale[i] * other).collect();
            scaled[i] = 1.0 + damping;
            scaled
        };
        let scaled: Vec<Vec<f64>> = rows.iter().enumerate().map(scaled).collect();
        let lower = lower_factor(&scaled, MIN_PIVOT).ok()?;
        let is_regular = lower.iter().enumerate().all(|(i, row)| row[i] > 0.0);
        is_regular.then_some(Self { scale, lower })
    }

    fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = Vec::with_capacity(right.len());
        for (i, row) in self.lower.iter().enumerate() {
            x.push((right[i] * self.scale[i] - dot(&x, row)) / row[i]);
        }
        for i in (0..x.len()).rev() {
            let below = self.lower.iter().zip(&x).skip(i + 1);
            let known: f64 = below.map(|(row, x)| row[i] * x).sum();
            x[i] = (x[i] - known) / self.lower[i][i];
        }
        let scaled = x.iter().zip(&self.scale);
        scaled.map(|(x, scale)| x * scale).collect()
    }
}

#[cfg(test)]
mod tests;
