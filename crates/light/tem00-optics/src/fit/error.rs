use core::{error, fmt};

use tem00_beam::Refusal;
use tem00_numerics::LeastSquaresError;

/// Reasons for which measured data have no fit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// The lists of measured values differ in length.
    LengthsDiffer {
        /// The number of positions.
        positions: usize,
        /// The number of values at these positions.
        values: usize,
    },
    /// There are fewer points than the parameters and one error estimate need.
    TooFewPoints {
        /// The number of points.
        got: usize,
        /// The smallest number accepted.
        needed: usize,
    },
    /// An argument, or an entry of one, is outside its range.
    Argument(Refusal),
    /// The positions are all equal.
    EqualPositions,
    /// The power does not change along the trace, or only a beam of negative power fits it.
    NoEdge,
    /// The data do not determine a parameter: they show no divergence, or no waist, or an edge
    /// falls between two positions.
    Undetermined,
    /// The search for the best parameters did not converge, as for radii on a straight line, whose
    /// fit improves with ever smaller waists.
    NotConverged,
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LengthsDiffer { positions, values } => write!(
                f,
                "each position needs one value, got {positions} positions and {values} values"
            ),
            Self::TooFewPoints { got, needed } => {
                write!(f, "the fit needs at least {needed} points, got {got}")
            }
            Self::Argument(error) => error.fmt(f),
            Self::EqualPositions => write!(f, "positions must differ, but all are the same"),
            Self::NoEdge => write!(
                f,
                "the power does not change along the trace as it would across a beam"
            ),
            Self::Undetermined => write!(f, "the data do not determine all parameters"),
            Self::NotConverged => write!(
                f,
                "the search for the best fit did not converge: \
                 the data may not determine all parameters"
            ),
        }
    }
}

impl error::Error for FitError {}

impl From<Refusal> for FitError {
    fn from(error: Refusal) -> Self {
        Self::Argument(error)
    }
}

impl From<LeastSquaresError> for FitError {
    fn from(error: LeastSquaresError) -> Self {
        match error {
            LeastSquaresError::Undetermined => Self::Undetermined,
            LeastSquaresError::NotConverged => Self::NotConverged,
        }
    }
}
