use core::{error, fmt};
use std::path::PathBuf;

use tem00_geometry::MeshError;

/// An error of a file with a triangle mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshFileError {
    /// The content is not a mesh.
    Mesh(MeshError),
    /// The scale, in metres per unit of the file, is not positive and finite.
    Scale(f64),
    /// The extension of the file name belongs to no mesh format known here.
    Extension(String),
    /// The file is in glTF, which the crate reads with its feature `gltf`.
    LeftOut,
    /// The file could not be opened or read; the text is the system's.
    Read(String),
    /// The file does not follow its format.
    Format {
        /// The line of the file, from 1, where the format has lines.
        line: Option<usize>,
        /// The underlying error.
        message: String,
    },
    /// Any of the above, about a file.
    File {
        /// The file.
        path: PathBuf,
        /// The underlying error.
        source: Box<Self>,
    },
}

impl MeshFileError {
    /// Returns whether the file could not be read, regardless of its content.
    pub(crate) fn is_unreadable(&self) -> bool {
        match self {
            Self::File { source, .. } => source.is_unreadable(),
            error => matches!(error, Self::Read(_)),
        }
    }

    /// Returns the error without quotations from the file.
    pub(crate) fn unquoted(self) -> Self {
        match self {
            Self::Format { line, .. } => Self::Format {
                line,
                message: "it breaks the rules of its format".to_owned(),
            },
            Self::File { path, source } => Self::File {
                path,
                source: Box::new(source.unquoted()),
            },
            error => error,
        }
    }
}

impl fmt::Display for MeshFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mesh(source) => source.fmt(f),
            Self::Scale(got) => {
                write!(
                    f,
                    "scale must be positive and finite, in metres per unit, got {got}"
                )
            }
            Self::Extension(got) => {
                write!(
                    f,
                    "mesh format must be .obj, .ply, .stl, .gltf or .glb, got {got:?}"
                )
            }
            Self::LeftOut => f.write_str(
                "this build reads no glTF: build it with the feature `gltf` (the program without \
                 `--no-default-features`), or use .obj, .ply or .stl",
            ),
            Self::Read(message) => write!(f, "{message}"),
            Self::Format {
                line: Some(line),
                message,
            } => write!(f, "line {line}: {message}"),
            Self::Format {
                line: None,
                message,
            } => write!(f, "{message}"),
            Self::File { path, source } => write!(f, "{}: {source}", path.display()),
        }
    }
}

impl error::Error for MeshFileError {}

impl From<MeshError> for MeshFileError {
    fn from(source: MeshError) -> Self {
        Self::Mesh(source)
    }
}

/// Returns an error about a line of a text file, counted from 1.
pub(super) fn format_error(line: usize, message: impl Into<String>) -> MeshFileError {
    MeshFileError::Format {
        line: Some(line),
        message: message.into(),
    }
}

/// Returns an error about a file as a whole.
pub(super) fn wrong(message: impl Into<String>) -> MeshFileError {
    MeshFileError::Format {
        line: None,
        message: message.into(),
    }
}
