use core::{error, fmt};

use glam::{DMat3, DVec3};
use tem00_numerics::Shown;

/// Reasons for which a description of camera, light or surface is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum DecorrelationError {
    /// A quantity is outside its range.
    OutOfRange {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected value.
        value: f64,
        /// The allowed values, with the unit.
        allowed: &'static str,
    },
    /// A position or direction is not possible.
    Vector {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected vector.
        value: DVec3,
        /// The allowed vectors, with the unit.
        allowed: &'static str,
    },
    /// The matrix of axes, a rotation or a curvature is not possible.
    Matrix {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected matrix.
        value: DMat3,
        /// The allowed matrices, with the unit.
        allowed: &'static str,
    },
    /// A distance is so short that no real image forms, or a pupil not larger than the wavelength.
    TooShort {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected length, in metres.
        value: f64,
        /// The limit, in words.
        limit: &'static str,
        /// The length that it must exceed, in metres.
        minimum: f64,
    },
    /// The pupil is wider than twice its distance to the surface or, in units of the entrance pupil,
    /// to the sensor, which would be a numerical aperture above one.
    PupilTooWide {
        /// The diameter of the entrance pupil, in metres.
        pupil_diameter: f64,
        /// The shorter of both distances, in metres.
        distance: f64,
    },
}

impl DecorrelationError {
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

    pub(crate) const fn vector(
        parameter: &'static str,
        value: DVec3,
        allowed: &'static str,
    ) -> Self {
        Self::Vector {
            parameter,
            value,
            allowed,
        }
    }

    pub(crate) const fn matrix(
        parameter: &'static str,
        value: DMat3,
        allowed: &'static str,
    ) -> Self {
        Self::Matrix {
            parameter,
            value,
            allowed,
        }
    }

    /// Returns the name of the argument that was refused, as constructors and functions call it.
    ///
    /// A pupil that follows from other arguments is `pupil_diameter` all the same, and a line of sight
    /// from two points `to_pupil`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_decorrelation::{DVec3, DecorrelationError, RigidMotion};
    ///
    /// let name = |error: DecorrelationError| error.parameter();
    /// let turn = RigidMotion::about(DVec3::ZERO, DVec3::ZERO, 1.0);
    /// assert_eq!(turn.map_err(name), Err("axis"));
    /// ```
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::OutOfRange { parameter, .. }
            | Self::Vector { parameter, .. }
            | Self::Matrix { parameter, .. }
            | Self::TooShort { parameter, .. } => parameter,
            Self::PupilTooWide { .. } => "pupil_diameter",
        }
    }
}

impl fmt::Display for DecorrelationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::OutOfRange {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {}", Shown(value)),
            Self::Vector {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {value}"),
            Self::Matrix {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got columns {value}"),
            Self::TooShort {
                parameter,
                value,
                limit,
                minimum,
            } => write!(
                f,
                "{parameter} must be finite and exceed {limit} of {} m, got {} m",
                Shown(minimum),
                Shown(value)
            ),
            Self::PupilTooWide {
                pupil_diameter,
                distance,
            } => write!(
                f,
                "pupil_diameter must be at most twice the distance of {} m to surface or sensor, got \
                 {} m",
                Shown(distance),
                Shown(pupil_diameter)
            ),
        }
    }
}

impl error::Error for DecorrelationError {}
