use core::{error, fmt};
use std::path::PathBuf;

use glam::DVec3;

/// Why a mesh could not be constructed or read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// No triangle with an area is there.
    Empty {
        /// The number of triangles without area.
        degenerate: usize,
    },
    /// A vertex is not finite.
    Vertex {
        /// The index of the vertex, from 0.
        index: usize,
        /// The rejected position, in metres.
        value: DVec3,
    },
    /// A triangle refers to a vertex that is not there.
    Index {
        /// The index of the triangle, from 0.
        triangle: usize,
        /// The rejected vertex index, from 0.
        index: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// There are not as many vertex normals as vertices.
    Normals {
        /// The number of vertex normals.
        normals: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// A vertex normal is not finite.
    Normal {
        /// The index of the vertex, from 0.
        index: usize,
        /// The rejected normal.
        value: DVec3,
    },
    /// The scale, in metres per unit of the file, is not positive and finite.
    Scale(f64),
    /// The extension of the file name is that of no mesh format known here.
    Extension(String),
    /// The file could not be opened or read; the text is the system's.
    Read(String),
    /// The file does not follow its format.
    Format {
        /// The line of the file, from 1, where the format has lines.
        line: Option<usize>,
        /// What is wrong.
        message: String,
    },
    /// Any of the above, about a file.
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<Self>,
    },
}

impl MeshError {
    /// Returns the error without what stands in the file.
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

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { degenerate: 0 } => write!(f, "the mesh has no triangles"),
            Self::Empty { degenerate } => {
                write!(f, "none of the mesh's {degenerate} triangles has an area")
            }
            Self::Vertex { index, value } => {
                write!(f, "vertex {index} (from 0) must be finite, got {value}")
            }
            Self::Index {
                triangle,
                index,
                vertices,
            } => write!(
                f,
                "triangle {triangle} (from 0) refers to vertex {index}, but the mesh has {vertices}"
            ),
            Self::Normals { normals, vertices } => {
                write!(
                    f,
                    "there must be a normal for each of the {vertices} vertices, got {normals}"
                )
            }
            Self::Normal { index, value } => {
                write!(
                    f,
                    "normal of vertex {index} (from 0) must be finite, got {value}"
                )
            }
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

impl error::Error for MeshError {}
