use core::{error, fmt};

use tem00_numerics::Refusal;
use tem00_speckle::SpeckleError;

/// Reason for which a laser, a motion or a speckle prescription is refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ShadingError {
    /// An argument of the camera, the laser, a motion or the speckle is not allowed.
    Refused(Refusal),
    /// A required input is missing.
    Missing(&'static str),
    /// A frame has moved farther than the poses for which the speckle was prepared.
    BeyondPoses {
        /// The shift of the pupil over the speckle in the frame, in pupil diameters.
        shift: f64,
        /// The largest shift that the speckle holds on the same side of the reference.
        held: f64,
    },
    /// The speckle pattern cannot be generated.
    Speckle(SpeckleError),
}

impl ShadingError {
    /// Returns the name of the parameter whose value was rejected, if there is one.
    pub fn parameter(&self) -> Option<&'static str> {
        match self {
            Self::Refused(refusal) => Some(refusal.parameter),
            _ => None,
        }
    }
}

impl fmt::Display for ShadingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refusal) => refusal.fmt(f),
            Self::Missing(what) => write!(f, "there must be {what}"),
            Self::BeyondPoses { shift, held } => write!(
                f,
                "this frame moves the pupil over the speckle by {shift:.3} of its diameters, and \
                 the speckle holds {held:.3}: prepare it for this motion, too"
            ),
            Self::Speckle(SpeckleError::MemoryLimit { needed, limit }) => write!(
                f,
                "the patterns need {:.0} MiB, and the memory limit is {:.0} MiB: raise the limit, \
                 or lower the resolution of the camera",
                mebibytes(*needed).ceil(),
                mebibytes(*limit)
            ),
            Self::Speckle(source) => source.fmt(f),
        }
    }
}

fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

impl error::Error for ShadingError {}

impl From<Refusal> for ShadingError {
    fn from(source: Refusal) -> Self {
        Self::Refused(source)
    }
}

impl From<SpeckleError> for ShadingError {
    fn from(source: SpeckleError) -> Self {
        Self::Speckle(source)
    }
}
