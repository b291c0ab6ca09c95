//! Parameters of a beam from measured data, with their standard errors.

mod caustic;
mod knife_edge;
mod least_squares;
#[cfg(test)]
mod synthetic;

use core::{error, fmt};

pub use caustic::{CausticFit, RadiusErrors};
pub use knife_edge::KnifeEdgeFit;

use crate::BeamError;
use crate::range::check_coordinates;

/// A fitted value and its standard error, in the same unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value that fits best.
    pub value: f64,
    /// The standard deviation of the value over repeated measurements, to first order.
    pub standard_error: f64,
}

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

/// Checks that both lists have one length, and at least `needed` entries.
fn check_count(positions: &[f64], values: &[f64], needed: usize) -> Result<(), FitError> {
    if positions.len() != values.len() {
        return Err(FitError::LengthsDiffer {
            positions: positions.len(),
            values: values.len(),
        });
    }
    if positions.len() < needed {
        return Err(FitError::TooFewPoints {
            got: positions.len(),
            needed,
        });
    }
    Ok(())
}

/// The positions of a measurement, mapped to the interval [−1, 1].
///
/// The fits work on such coordinates, so that the unit of the data makes no difference.
#[derive(Clone, Debug)]
struct Axis {
    middle: f64,
    half_range: f64,
    coordinates: Vec<f64>,
}

impl Axis {
    fn new(positions: &[f64]) -> Result<Self, FitError> {
        check_coordinates("positions", positions)?;
        let first = positions.iter().copied().fold(f64::INFINITY, f64::min);
        let last = positions.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (middle, half_range) = (0.5 * first + 0.5 * last, 0.5 * last - 0.5 * first);
        if half_range < f64::MIN_POSITIVE {
            return Err(FitError::EqualPositions);
        }
        let coordinates = positions.iter().map(|x| (x - middle) / half_range);
        Ok(Self {
            middle,
            half_range,
            coordinates: coordinates.collect(),
        })
    }

    /// The position that an estimated coordinate stands for.
    fn position(&self, coordinate: f64, variance: f64) -> Estimate {
        Estimate {
            value: self.middle + self.half_range * coordinate,
            standard_error: self.half_range * variance.sqrt(),
        }
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
