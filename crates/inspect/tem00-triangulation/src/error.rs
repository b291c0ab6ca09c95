use core::{error, fmt};

use tem00_numerics::{Refusal, Shown};
use tem00_speckle::SpeckleError;
use tem00_uncertainty::{Distribution, UncertaintyError};

/// Reason why a part of a triangulation set-up could not be constructed or evaluated.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TriangulationError {
    /// A vector that needs a direction is zero, not finite or parallel to its partner.
    Direction {
        /// The name of the parameter.
        parameter: &'static str,
        /// The allowed values.
        allowed: &'static str,
    },
    /// A counted quantity is too small.
    TooFew {
        /// The counted things, in the plural.
        what: &'static str,
        /// The number of them.
        got: usize,
        /// The minimum number.
        needed: usize,
    },
    /// An image does not show the requested checkerboard.
    NoBoard {
        /// The numbers of inner corners along its rows and its columns.
        corners: [usize; 2],
        /// The number of corners of squares that the image shows.
        found: usize,
    },
    /// Measurements do not determine a quantity that they should determine.
    NotDetermined {
        /// The undetermined quantity.
        what: &'static str,
        /// A measurement or change that would determine it.
        advice: &'static str,
    },
    /// A set-up is possible, but measures nothing.
    NothingMeasured {
        /// The reason.
        why: &'static str,
        /// A change that helps.
        advice: &'static str,
    },
    /// A quantity is outside its range.
    Refused(Refusal),
    /// A speckle pattern is not possible.
    Speckle(SpeckleError),
    /// An uncertainty is not possible.
    Uncertainty(UncertaintyError),
    /// The distribution of an input reaches values that are not possible.
    ImpossibleDraw {
        /// The key of a quantity, as in `camera.angle`, or the name of a term of the budget.
        input: String,
        /// Its distribution.
        distribution: Distribution,
        /// The drawn value, in SI units.
        value: f64,
    },
    /// The caller asked to stop.
    Cancelled,
}

impl TriangulationError {
    /// Returns the name of the parameter that was rejected, where there is one.
    pub fn parameter(&self) -> Option<&'static str> {
        match self {
            Self::Direction { parameter, .. } => Some(parameter),
            Self::Refused(source) => Some(source.parameter),
            Self::Uncertainty(source) => Some(source.parameter()),
            _ => None,
        }
    }
}

impl fmt::Display for TriangulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Direction { parameter, allowed } => write!(f, "{parameter} must be {allowed}"),
            Self::TooFew { what, got, needed } => {
                write!(f, "there must be at least {needed} {what}, got {got}")
            }
            Self::NoBoard {
                corners: [columns, rows],
                found,
            } => write!(
                f,
                "there must be a whole checkerboard with {columns} × {rows} inner corners, but \
                 only {found} corners of squares that fit together are seen"
            ),
            Self::NotDetermined { what, advice } => {
                write!(f, "{what} is not determined by what was measured: {advice}")
            }
            Self::NothingMeasured { why, advice } => {
                write!(f, "nothing can be measured: {why}; {advice}")
            }
            Self::Refused(source) => source.fmt(f),
            Self::Speckle(source) => source.fmt(f),
            Self::Uncertainty(source) => source.fmt(f),
            Self::ImpossibleDraw {
                input,
                distribution,
                value,
            } => write!(
                f,
                "the distribution of `{input}` must reach possible values only: it is \
                 {distribution} and draws {} (in SI units), with which nothing is measured",
                Shown(*value)
            ),
            Self::Cancelled => write!(f, "the work was cancelled"),
        }
    }
}

impl error::Error for TriangulationError {}

impl From<Refusal> for TriangulationError {
    fn from(source: Refusal) -> Self {
        Self::Refused(source)
    }
}

impl From<SpeckleError> for TriangulationError {
    fn from(source: SpeckleError) -> Self {
        Self::Speckle(source)
    }
}

impl From<UncertaintyError> for TriangulationError {
    fn from(source: UncertaintyError) -> Self {
        Self::Uncertainty(source)
    }
}
