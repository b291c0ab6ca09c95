use core::{error, fmt};

use glam::DVec3;

/// A reason why a mesh cannot be constructed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// The mesh has no triangle with an area.
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
    /// A triangle refers to a vertex that does not exist.
    Index {
        /// The index of the triangle, from 0.
        triangle: usize,
        /// The rejected vertex index, from 0.
        index: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// The numbers of vertex normals and vertices differ.
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
        }
    }
}

impl error::Error for MeshError {}
