use core::{error, fmt};

use glam::{DMat3, DVec3};
use tem00_numerics::Shown;

/// Reasons for which a description of surface, light or camera is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WaveError {
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
    /// The columns of the matrix are not right-handed orthonormal axes within 10⁻⁶.
    Axes(DMat3),
    /// The waist is tighter than the paraxial model allows. Often the two arguments were swapped.
    NotParaxial {
        /// The rejected waist radius, in metres.
        waist_radius: f64,
        /// The smallest waist radius the model accepts at this wavelength, in metres.
        minimum: f64,
    },
    /// The step between samples of an image is not below the speckle size.
    ImageStep {
        /// The rejected step, in metres.
        step: f64,
        /// The speckle size λ · `pupil_to_image` / D, in metres.
        speckle_size: f64,
    },
}

impl WaveError {
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
}

impl fmt::Display for WaveError {
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
            Self::Axes(value) => write!(
                f,
                "axes must be right-handed and orthonormal within 1e-6, got columns {value}"
            ),
            Self::NotParaxial {
                waist_radius,
                minimum,
            } => write!(
                f,
                "waist_radius must be at least the paraxial limit of {} m, got {} m",
                Shown(minimum),
                Shown(waist_radius)
            ),
            Self::ImageStep { step, speckle_size } => write!(
                f,
                "step must be below the speckle size of {} m, got {} m",
                Shown(speckle_size),
                Shown(step)
            ),
        }
    }
}

impl error::Error for WaveError {}
