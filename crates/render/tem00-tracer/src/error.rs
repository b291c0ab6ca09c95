use core::{error, fmt, ops::RangeBounds};

use tem00_numerics::Refusal;
use tem00_shading::ShadingError;
use tem00_speckle::SpeckleError;

/// A reason why a part of a scene could not be constructed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TracerError {
    /// A quantity is outside its range.
    OutOfRange {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected value.
        value: f64,
        /// The allowed values, with the unit.
        allowed: &'static str,
    },
    /// A vector that needs a direction is zero, not finite or parallel to its partner.
    Direction {
        /// The name of the parameter.
        parameter: &'static str,
        /// The allowed values.
        allowed: &'static str,
    },
    /// An argument of a shape, the camera, the light or a motion is refused.
    Refused(Refusal),
    /// The speckle pattern is not possible.
    Speckle(SpeckleError),
    /// The light of a laser or its speckle is not possible.
    Shading(ShadingError),
    /// A translucent surface curves too strongly for its light to spread as on a plane.
    Curvature {
        /// The radius of curvature, in metres.
        radius: f64,
        /// The smallest radius that is allowed.
        min: f64,
    },
    /// A translucent surface cannot be rendered like this.
    Translucent {
        /// What it needs.
        needs: &'static str,
    },
    /// The speckle patterns do not fit the memory that the scene allows.
    PatternMemory {
        /// The bytes that one laser's patterns need at least.
        needed: u64,
        /// The bytes that the scene allows for them.
        allowed: u64,
    },
    /// The layers of a frame do not fit into the memory that the system has available.
    FilmMemory {
        /// The bytes that the layers need.
        needed: u64,
        /// The bytes that are available.
        available: u64,
    },
}

impl TracerError {
    pub(crate) const fn out_of_range(
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

    /// Returns the key of a scene file whose value was rejected, where there is one.
    pub fn parameter(&self) -> Option<&'static str> {
        match self {
            Self::OutOfRange { parameter, .. } | Self::Direction { parameter, .. } => {
                Some(parameter)
            }
            Self::Refused(source) => Some(source.parameter),
            Self::Shading(source) => source.parameter(),
            _ => None,
        }
    }
}

/// Checks that a parameter is in the range that `allowed` says in words.
pub(crate) fn check(
    parameter: &'static str,
    value: f64,
    range: impl RangeBounds<f64>,
    allowed: &'static str,
) -> Result<(), TracerError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(TracerError::out_of_range(parameter, value, allowed))
}

/// Checks that a power or a radiance is possible.
pub(crate) fn check_light(parameter: &'static str, value: f64) -> Result<(), TracerError> {
    check(
        parameter,
        value,
        0.0..f64::INFINITY,
        "finite and not negative",
    )
}

impl fmt::Display for TracerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {value}"),
            Self::Direction { parameter, allowed } => write!(f, "{parameter} must be {allowed}"),
            Self::Refused(source) => source.fmt(f),
            Self::Speckle(source) => source.fmt(f),
            Self::Shading(source) => source.fmt(f),
            Self::Curvature { radius, min } => write!(
                f,
                "a translucent surface must curve with a radius of at least ten transport lengths, \
                 {:.3} mm, got {:.3} mm",
                1e3 * min,
                1e3 * radius
            ),
            Self::Translucent { needs } => write!(f, "a translucent surface needs {needs}"),
            Self::PatternMemory { needed, allowed } => write!(
                f,
                "the speckle patterns of a laser need at least {needed} bytes and may take \
                 {allowed}"
            ),
            Self::FilmMemory { needed, available } => write!(
                f,
                "the layers of a frame need {needed} bytes of memory, and {available} are available"
            ),
        }
    }
}

impl error::Error for TracerError {}

impl From<Refusal> for TracerError {
    fn from(source: Refusal) -> Self {
        Self::Refused(source)
    }
}

impl From<ShadingError> for TracerError {
    fn from(source: ShadingError) -> Self {
        Self::Shading(source)
    }
}

impl From<SpeckleError> for TracerError {
    fn from(source: SpeckleError) -> Self {
        Self::Speckle(source)
    }
}
