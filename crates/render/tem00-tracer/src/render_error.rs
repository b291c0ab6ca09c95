use core::{error, fmt};

use tem00_geometry::Refusal;

use crate::TracerError;

/// A reason why a frame was not rendered.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RenderError {
    /// The caller asked to stop.
    Cancelled,
    /// The scene cannot be rendered.
    Scene(TracerError),
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cancelled => write!(f, "the render was cancelled"),
            Self::Scene(source) => source.fmt(f),
        }
    }
}

impl error::Error for RenderError {}

impl From<Refusal> for RenderError {
    fn from(source: Refusal) -> Self {
        Self::Scene(source.into())
    }
}

impl From<TracerError> for RenderError {
    fn from(source: TracerError) -> Self {
        Self::Scene(source)
    }
}
