use core::{error, fmt};

use tem00_numerics::Refusal;
use tem00_speckle::SpeckleError;
use tem00_tracer::{RenderError, TracerError};
use tem00_triangulation::TriangulationError;

/// A reason why a scene is not measured.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ScanError {
    /// Sensor, detector, calibration or settings of the scan are not possible.
    Triangulation(TriangulationError),
    /// The scene cannot be rendered.
    Tracer(TracerError),
    /// The scene cannot be measured, for this reason.
    Scene(String),
    /// The caller asked to stop.
    Cancelled,
}

impl fmt::Display for ScanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Triangulation(source) => source.fmt(f),
            Self::Tracer(source) => source.fmt(f),
            Self::Scene(why) => f.write_str(why),
            Self::Cancelled => write!(f, "the work was cancelled"),
        }
    }
}

impl error::Error for ScanError {}

impl From<TriangulationError> for ScanError {
    fn from(source: TriangulationError) -> Self {
        match source {
            TriangulationError::Cancelled => Self::Cancelled,
            source => Self::Triangulation(source),
        }
    }
}

impl From<TracerError> for ScanError {
    fn from(source: TracerError) -> Self {
        Self::Tracer(source)
    }
}

impl From<Refusal> for ScanError {
    fn from(source: Refusal) -> Self {
        Self::Tracer(source.into())
    }
}

impl From<SpeckleError> for ScanError {
    fn from(source: SpeckleError) -> Self {
        Self::Tracer(source.into())
    }
}

impl From<RenderError> for ScanError {
    fn from(source: RenderError) -> Self {
        match source {
            RenderError::Scene(source) => Self::Tracer(source),
            // Whatever else there may be one day, the render did not end.
            _ => Self::Cancelled,
        }
    }
}
