use core::{error, fmt};

use crate::BeamError;

/// Reasons why measured data have no fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// The lists of measured values differ in length.
    LengthsDiffer {
        /// The number of positions.
        positions: usize,
        /// The number of values that belong to them.
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
    Argument(BeamError),
    /// All positions are the same.
    EqualPositions,
    /// The power does not change along the trace, or only a beam of negative power would fit it.
    NoEdge,
    /// The data leave a parameter open: no divergence is to be seen, or no waist, or an edge falls
    /// between two positions.
    Undetermined,
    /// The search for the best parameters did not come to an end, as for radii on a straight line,
    /// which fit the better the smaller the waist.
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

impl From<BeamError> for FitError {
    fn from(error: BeamError) -> Self {
        Self::Argument(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_the_value_that_is_wrong() {
        let cases = [
            (
                FitError::LengthsDiffer {
                    positions: 5,
                    values: 4,
                },
                "5 positions",
                "4 values",
            ),
            (
                FitError::TooFewPoints { got: 3, needed: 4 },
                "4 points",
                "3",
            ),
            (
                BeamError::out_of_range("radius", -1.5, "m", "long").into(),
                "radius",
                "-1.5e0 m",
            ),
            (FitError::EqualPositions, "positions", "same"),
            (FitError::NoEdge, "power", "change"),
            (FitError::Undetermined, "data", "parameters"),
            (FitError::NotConverged, "converge", "data may not"),
        ];
        for (error, name, detail) in cases {
            let text = error.to_string();
            assert!(text.contains(name), "{text:?} does not name {name:?}");
            assert!(text.contains(detail), "{text:?} does not show {detail:?}");
        }
    }
}
