use core::{error, fmt};
use std::path::PathBuf;

use glam::DVec3;

/// A surface made of flat triangles.
///
/// Corners run counter-clockwise seen from the side to which the normal points. Every triangle is
/// flat and is shaded with its geometric normal; vertex normals are not used.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_tracer::TriangleMesh;
///
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let corner = TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3], [0, 3, 1]])?;
///
/// assert_eq!(corner.triangles().len(), 3);
/// assert_eq!(corner.bounds(), (DVec3::ZERO, DVec3::ONE));
/// # Ok::<(), tem00_tracer::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    dropped: usize,
    bounds: (DVec3, DVec3),
}

impl TriangleMesh {
    /// Creates a mesh from its vertices, in metres, and the vertex indices of its triangles.
    ///
    /// Triangles without area reflect no light and have no normal. Files from scanners and
    /// modellers are full of them, so they are left out and counted in
    /// [`dropped_triangles`](Self::dropped_triangles).
    ///
    /// # Errors
    ///
    /// Returns an error that names the first vertex that is not finite or the first triangle with
    /// an index beyond the vertices, or if no triangle with an area is left.
    pub fn new(vertices: Vec<DVec3>, mut triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if let Some(index) = vertices.iter().position(|vertex| !vertex.is_finite()) {
            let value = vertices[index];
            return Err(MeshError::Vertex { index, value });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            for &index in corners {
                if index as usize >= vertices.len() {
                    return Err(MeshError::Index {
                        triangle,
                        index,
                        vertices: vertices.len(),
                    });
                }
            }
        }
        let given = triangles.len();
        triangles.retain(|corners| normal(&corners.map(|i| vertices[i as usize])).is_some());
        if triangles.is_empty() {
            return Err(MeshError::Empty { degenerate: given });
        }
        Ok(Self {
            bounds: bounds(&vertices, &triangles),
            dropped: given - triangles.len(),
            vertices,
            triangles,
        })
    }

    /// Returns the vertices, in metres.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Returns the vertex indices of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns the number of triangles that were left out because they have no area.
    pub const fn dropped_triangles(&self) -> usize {
        self.dropped
    }

    /// Returns the lowest and the highest corner of the axis-parallel box around the triangles, in
    /// metres.
    pub const fn bounds(&self) -> (DVec3, DVec3) {
        self.bounds
    }

    /// Returns the mesh moved by `displacement`, in metres.
    #[must_use]
    pub fn translated(&self, displacement: DVec3) -> Self {
        let (low, high) = self.bounds;
        Self {
            vertices: self.vertices.iter().map(|v| v + displacement).collect(),
            triangles: self.triangles.clone(),
            dropped: self.dropped,
            bounds: (low + displacement, high + displacement),
        }
    }

    /// Returns the corners of the triangles, in metres.
    pub(crate) fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let triangles = self.triangles.iter();
        triangles.map(|corners| corners.map(|index| self.vertices[index as usize]))
    }
}

/// Returns the unit normal of a triangle, or `None` if it has no area.
pub(crate) fn normal([a, b, c]: &[DVec3; 3]) -> Option<DVec3> {
    // Scaled by its longest extent, a triangle of any size has a cross product without underflow.
    let (u, v) = (b - a, c - a);
    let scale = u.abs().max(v.abs()).max_element();
    (u / scale).cross(v / scale).try_normalize()
}

fn bounds(vertices: &[DVec3], triangles: &[[u32; 3]]) -> (DVec3, DVec3) {
    let used = triangles.iter().flatten().map(|&i| vertices[i as usize]);
    used.fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(low, high), vertex| (low.min(vertex), high.max(vertex)),
    )
}

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
            Self::Scale(got) => {
                write!(
                    f,
                    "scale must be positive and finite, in metres per unit, got {got}"
                )
            }
            Self::Extension(got) => {
                write!(f, "mesh format must be .obj, .ply or .stl, got {got:?}")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_bad_vertex_is_named() {
        let vertices = vec![DVec3::ZERO, DVec3::X.with_y(f64::NAN), DVec3::NAN];
        let error = TriangleMesh::new(vertices, vec![[0, 1, 2]]).unwrap_err();
        assert!(
            matches!(error, MeshError::Vertex { index: 1, .. }),
            "{error:?}"
        );
        let text = error.to_string();
        assert_eq!(
            text, "vertex 1 (from 0) must be finite, got [1, NaN, 0]",
            "{text}"
        );
    }

    #[test]
    fn indices_beyond_the_vertices_are_refused() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let error = TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 3, 1]]).unwrap_err();
        let expected = MeshError::Index {
            triangle: 1,
            index: 3,
            vertices: 3,
        };
        assert_eq!(error, expected, "{error}");
    }

    #[test]
    fn a_mesh_without_triangles_is_refused() {
        let error = TriangleMesh::new(vec![DVec3::ZERO], vec![]).unwrap_err();
        assert_eq!(error, MeshError::Empty { degenerate: 0 }, "{error}");

        let line = vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        let error = TriangleMesh::new(line, vec![[0, 1, 2], [0, 0, 1]]).unwrap_err();
        assert_eq!(error, MeshError::Empty { degenerate: 2 }, "{error}");
    }

    #[test]
    fn triangles_without_area_are_left_out_and_counted() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, 2.0 * DVec3::X];
        let mesh = TriangleMesh::new(vertices, vec![[0, 1, 3], [0, 1, 2], [1, 1, 2]]).unwrap();
        assert_eq!(
            mesh.triangles(),
            [[0, 1, 2]],
            "only one triangle has an area"
        );
        assert_eq!(mesh.dropped_triangles(), 2, "two have none");
        // Vertex 3 belongs to no triangle that is left.
        assert_eq!(
            mesh.bounds(),
            (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)),
            "bounds"
        );
    }

    #[test]
    fn a_triangle_has_a_normal_whatever_its_size() {
        for size in [1e-200, 1e-9, 1.0, 1e9, 1e200] {
            let normal = normal(&[DVec3::ZERO, size * DVec3::X, size * DVec3::Y]);
            assert_eq!(normal, Some(DVec3::Z), "size {size:e}");
        }
    }
}
