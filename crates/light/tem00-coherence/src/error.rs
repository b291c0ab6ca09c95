use core::{error, fmt};

use glam::DVec3;
use tem00_numerics::Shown;

/// Reasons for which a line, a resolution cell or light of several paths is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CoherenceError {
    /// A quantity is outside its range.
    OutOfRange {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected value.
        value: f64,
        /// The allowed values, with the unit.
        allowed: &'static str,
    },
    /// A direction is not possible.
    Direction {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected vector.
        value: DVec3,
        /// The allowed vectors.
        allowed: &'static str,
    },
}

impl CoherenceError {
    pub(crate) const fn refused(
        parameter: &'static str,
        value: f64,
        allowed: &'static str,
    ) -> Self {
        Self::OutOfRange {
            parameter,
            value,
            allowed,
        }
    }

    /// Returns the error with another name of the parameter, if it is about `own`.
    pub(crate) fn about(mut self, own: &str, other: &'static str) -> Self {
        if let Self::OutOfRange { parameter, .. } = &mut self
            && *parameter == own
        {
            *parameter = other;
        }
        self
    }

    /// Returns the name of the parameter that is refused.
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::OutOfRange { parameter, .. } | Self::Direction { parameter, .. } => parameter,
        }
    }
}

impl fmt::Display for CoherenceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::OutOfRange {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {}", Shown(value)),
            Self::Direction {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {value}"),
        }
    }
}

impl error::Error for CoherenceError {}
