use core::{error, fmt};
use std::path::PathBuf;

use tem00_camera::MAXIMUM_PIXELS;

/// An error of a file with a radiance map.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RadianceMapError {
    /// The file at this path has the error below.
    File {
        /// The path of the file.
        path: PathBuf,
        /// The underlying error.
        source: Box<Self>,
    },
    /// The scale is not positive and finite.
    Scale(f64),
    /// The extension of the file name, with its dot, is of no known format.
    Extension(String),
    /// The file cannot be read, for the reason given by the operating system.
    Read(String),
    /// The content breaks the rules of its format.
    Format(String),
    /// The map has no pixels or more than 2²⁸.
    Size {
        /// The number of columns.
        width: u64,
        /// The number of rows.
        height: u64,
    },
    /// The channels, with these names, are neither R, G and B nor a single one.
    Channels(Vec<String>),
}

impl RadianceMapError {
    /// Returns whether the file could not be read, regardless of its content.
    pub(crate) fn is_unreadable(&self) -> bool {
        match self {
            Self::File { source, .. } => source.is_unreadable(),
            error => matches!(error, Self::Read(_)),
        }
    }
}

impl fmt::Display for RadianceMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { path, source } => write!(f, "{}: {source}", path.display()),
            Self::Scale(scale) => {
                write!(
                    f,
                    "scale of a radiance map must be positive and finite, got {scale}"
                )
            }
            Self::Extension(extension) => write!(
                f,
                "format of a radiance map must be .exr or .pfm, got {extension:?}"
            ),
            Self::Read(reason) => write!(f, "cannot be read: {reason}"),
            Self::Format(reason) => write!(f, "not a valid file: {reason}"),
            Self::Size { width, height } => write!(
                f,
                "a radiance map must have at least 1 × 1 and at most {MAXIMUM_PIXELS} pixels in \
                 all, got {width} × {height}"
            ),
            Self::Channels(names) => write!(
                f,
                "a radiance map must have the channels R, G and B or a single one, got {}",
                names.join(", ")
            ),
        }
    }
}

impl error::Error for RadianceMapError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            Self::File { source, .. } => Some(source),
            _ => None,
        }
    }
}
