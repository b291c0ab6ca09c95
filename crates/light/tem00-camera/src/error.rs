use core::{error, fmt};

use tem00_decorrelation::DecorrelationError;

/// A reason why a camera cannot be constructed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CameraError {
    /// A quantity is outside its range.
    OutOfRange {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected value.
        value: f64,
        /// The allowed values, with the unit.
        allowed: &'static str,
    },
    /// A vector that must have a direction is zero, not finite or parallel to its partner.
    Direction {
        /// The name of the parameter.
        parameter: &'static str,
        /// The allowed vectors.
        allowed: &'static str,
    },
    /// The image has no pixels or too many.
    Resolution {
        /// The requested number of columns.
        width: usize,
        /// The requested number of rows.
        height: usize,
    },
    /// The imaging geometry is not possible.
    Imaging(DecorrelationError),
}

impl CameraError {
    /// Returns the name of the parameter that was rejected, where there is one.
    pub const fn parameter(&self) -> Option<&'static str> {
        match self {
            Self::OutOfRange { parameter, .. } | Self::Direction { parameter, .. } => {
                Some(parameter)
            }
            Self::Resolution { .. } => Some("resolution"),
            Self::Imaging(_) => None,
        }
    }
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {value}"),
            Self::Direction { parameter, allowed } => write!(f, "{parameter} must be {allowed}"),
            Self::Resolution { width, height } => write!(
                f,
                "resolution must be at least 1 × 1 and at most 2²⁸ pixels in all, got {width} × {height}"
            ),
            Self::Imaging(source) => source.fmt(f),
        }
    }
}

impl error::Error for CameraError {}

impl From<DecorrelationError> for CameraError {
    fn from(source: DecorrelationError) -> Self {
        Self::Imaging(source)
    }
}
