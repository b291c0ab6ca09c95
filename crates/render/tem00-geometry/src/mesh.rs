mod error;

use glam::DVec3;

pub use self::error::MeshError;

/// A surface made of flat triangles.
///
/// Corners run counter-clockwise seen from the side to which the normal points. Light meets the
/// flat triangles; where the mesh has vertex normals, it is scattered as by the curved surface that
/// they belong to (see [`Hit::shading_normal`](crate::Hit::shading_normal)).
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_geometry::TriangleMesh;
///
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let corner = TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3], [0, 3, 1]])?;
///
/// assert_eq!(corner.triangles().len(), 3);
/// assert_eq!(corner.bounds(), (DVec3::ZERO, DVec3::ONE));
/// # Ok::<(), tem00_geometry::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    vertices: Vec<DVec3>,
    normals: Vec<DVec3>,
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
    pub fn new(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        Self::with_normals(vertices, Vec::new(), triangles)
    }

    /// Creates a mesh with a normal for each vertex, or with none if `normals` is empty.
    ///
    /// The normals may be of any length. A vertex with a normal of length zero takes no part in the
    /// interpolation.
    ///
    /// # Errors
    ///
    /// Returns an error as [`new`](Self::new) does, or if the numbers of normals and vertices
    /// differ, or if a normal is not finite.
    ///
    /// # Examples
    ///
    /// ```
    /// use glam::DVec3;
    /// use tem00_geometry::{MeshError, TriangleMesh};
    ///
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    /// let result = TriangleMesh::with_normals(corners, vec![DVec3::Z], vec![[0, 1, 2]]);
    /// assert_eq!(result, Err(MeshError::Normals { normals: 1, vertices: 3 }));
    /// ```
    pub fn with_normals(
        vertices: Vec<DVec3>,
        mut normals: Vec<DVec3>,
        mut triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        check_vertices(&vertices)?;
        check_normals(&normals, vertices.len())?;
        check_indices(&triangles, vertices.len())?;
        for normal in &mut normals {
            *normal = unit(*normal).unwrap_or(DVec3::ZERO);
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
            normals,
            triangles,
        })
    }

    /// Returns the vertices, in metres.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Returns the normals of the vertices, of unit length or zero; empty if there are none.
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// Returns the vertex indices of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns the radius of curvature in metres below which a twentieth of the area curves, by the
    /// normals of the vertices; infinite without normals.
    pub(crate) fn radius_of_curvature(&self) -> f64 {
        let curved = self.triangles.iter().filter_map(|triangle| {
            let corners = triangle.map(|corner| self.vertices[corner as usize]);
            let edges = [0, 1, 2].map(|i| corners[(i + 1) % 3] - corners[i]);
            let normal = |i: usize| self.normals.get(triangle[i % 3] as usize);
            let curvature =
                |i: usize| Some((*normal(i + 1)? - *normal(i)?).length() / edges[i].length());
            let curvature = curvature(0)?.max(curvature(1)?).max(curvature(2)?);
            Some((curvature, 0.5 * edges[0].cross(edges[1]).length()))
        });
        let mut curved: Vec<_> = curved.collect();
        curved.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        let mut left = 0.05 * curved.iter().map(|(_, area)| area).sum::<f64>();
        let sharper = |(_, area): &&(f64, f64)| {
            left -= area;
            left < 0.0
        };
        let found = curved.iter().find(sharper);
        found.map_or(f64::INFINITY, |(curvature, _)| 1.0 / curvature)
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

    /// Returns the corners of a triangle, in metres.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle].map(|index| index as usize);
        [self.vertices[a], self.vertices[b], self.vertices[c]]
    }

    /// Returns the sum of the normals of a triangle's corners, each times its weight, or `None` if
    /// the mesh has no normals.
    pub(crate) fn interpolated_normal(&self, triangle: usize, weights: DVec3) -> Option<DVec3> {
        if self.normals.is_empty() {
            return None;
        }
        let [a, b, c] = self.triangles[triangle].map(|index| self.normals[index as usize]);
        Some(weights.x * a + weights.y * b + weights.z * c)
    }
}

/// Returns the unit normal of a triangle, or `None` if it has no area.
pub(crate) fn normal([a, b, c]: &[DVec3; 3]) -> Option<DVec3> {
    // Scaled by its longest extent, a triangle of any size has a cross product without underflow.
    let (u, v) = (b - a, c - a);
    let scale = u.abs().max(v.abs()).max_element();
    (u / scale).cross(v / scale).try_normalize()
}

/// Returns the normal with which a triangle scatters light: the interpolated normal, on the side of
/// the triangle's own normal.
pub(crate) fn shading_normal(normal: DVec3, interpolated: Option<DVec3>) -> DVec3 {
    let interpolated = interpolated.unwrap_or(normal);
    let cosine = interpolated.dot(normal);
    if cosine == 0.0 {
        return normal;
    }
    interpolated * 1.0_f64.copysign(cosine)
}

/// Returns `vector` of any size at unit length, or `None` if it has no direction.
fn unit(vector: DVec3) -> Option<DVec3> {
    (vector / vector.abs().max_element()).try_normalize()
}

fn check_vertices(vertices: &[DVec3]) -> Result<(), MeshError> {
    match vertices.iter().position(|vertex| !vertex.is_finite()) {
        Some(index) => Err(MeshError::Vertex {
            index,
            value: vertices[index],
        }),
        None => Ok(()),
    }
}

fn check_normals(normals: &[DVec3], vertices: usize) -> Result<(), MeshError> {
    if !normals.is_empty() && normals.len() != vertices {
        return Err(MeshError::Normals {
            normals: normals.len(),
            vertices,
        });
    }
    match normals.iter().position(|normal| !normal.is_finite()) {
        Some(index) => Err(MeshError::Normal {
            index,
            value: normals[index],
        }),
        None => Ok(()),
    }
}

fn check_indices(triangles: &[[u32; 3]], vertices: usize) -> Result<(), MeshError> {
    for (triangle, corners) in triangles.iter().enumerate() {
        for &index in corners {
            if index as usize >= vertices {
                return Err(MeshError::Index {
                    triangle,
                    index,
                    vertices,
                });
            }
        }
    }
    Ok(())
}

fn bounds(vertices: &[DVec3], triangles: &[[u32; 3]]) -> (DVec3, DVec3) {
    let used = triangles.iter().flatten().map(|&i| vertices[i as usize]);
    used.fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(low, high), vertex| (low.min(vertex), high.max(vertex)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a tube of flat triangles with the normals of its cylinder, and a flat wing at its edge.
    #[test]
    fn a_mesh_curves_as_a_twentieth_of_its_area_does() {
        let tube = |radius: f64, wing: f64| {
            let edge = |angle: f64| DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0);
            let angles: Vec<_> = (0..=64)
                .map(|i| f64::from(i) / 64.0 * core::f64::consts::PI)
                .collect();
            let mut rim: Vec<_> = angles
                .iter()
                .map(|&a| (edge(a), edge(a) / radius))
                .collect();
            rim.push((edge(angles[64]) - wing * DVec3::Y, -DVec3::X));
            let vertices = rim
                .iter()
                .flat_map(|(at, _)| [*at, *at + DVec3::Z])
                .collect();
            let normals = rim.iter().flat_map(|(_, normal)| [*normal; 2]).collect();
            let strips = (0..65)
                .map(|i| 2 * i)
                .flat_map(|i| [[i, i + 1, i + 2], [i + 1, i + 2, i + 3]]);
            TriangleMesh::with_normals(vertices, normals, strips.collect()).unwrap()
        };
        // The tube is nearly all of the area, then a tenth of it.
        for wing in [0.1, 8.0] {
            let radius = tube(0.3, wing).radius_of_curvature();
            assert!((radius / 0.3 - 1.0).abs() < 1e-3, "{wing}: {radius}");
        }
        assert!(tube(0.3, 50.0).radius_of_curvature() > 1e9);
        let flat = TriangleMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]);
        assert!(flat.unwrap().radius_of_curvature().is_infinite());
    }

    #[test]
    fn impossible_meshes_are_refused() {
        let corners = || vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let line = vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        let bad = vec![DVec3::ZERO, DVec3::X.with_y(f64::NAN), DVec3::NAN];
        let infinite = vec![DVec3::Z, DVec3::Z, DVec3::INFINITY];
        let one = || vec![[0, 1, 2]];
        for (mesh, message) in [
            (
                TriangleMesh::new(bad, one()),
                "vertex 1 (from 0) must be finite, got [1, NaN, 0]",
            ),
            (
                TriangleMesh::with_normals(corners(), infinite, one()),
                "normal of vertex 2 (from 0) must be finite, got [inf, inf, inf]",
            ),
            (
                TriangleMesh::with_normals(corners(), vec![DVec3::Z], one()),
                "there must be a normal for each of the 3 vertices, got 1",
            ),
        ] {
            assert_eq!(mesh.unwrap_err().to_string(), message);
        }
        let (triangle, index, vertices) = (1, 3, 3);
        let beyond = MeshError::Index {
            triangle,
            index,
            vertices,
        };
        for (mesh, expected) in [
            (
                TriangleMesh::new(corners(), vec![[0, 1, 2], [0, 3, 1]]),
                beyond,
            ),
            (
                TriangleMesh::new(corners(), vec![]),
                MeshError::Empty { degenerate: 0 },
            ),
            (
                TriangleMesh::new(line, vec![[0, 1, 2], [0, 0, 1]]),
                MeshError::Empty { degenerate: 2 },
            ),
        ] {
            assert_eq!(mesh.unwrap_err(), expected);
        }
    }

    #[test]
    fn triangles_without_area_are_left_out_and_counted() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, 2.0 * DVec3::X];
        let mesh = TriangleMesh::new(vertices, vec![[0, 1, 3], [0, 1, 2], [1, 1, 2]]).unwrap();
        assert_eq!(mesh.triangles(), [[0, 1, 2]], "the one that has an area");
        assert_eq!(mesh.dropped_triangles(), 2, "two have none");
        // Vertex 3 belongs to no triangle that is left.
        assert_eq!(mesh.bounds(), (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)));
    }

    #[test]
    fn a_triangle_has_a_normal_whatever_its_size() {
        for size in [1e-200, 1e-9, 1.0, 1e9, 1e200] {
            let normal = normal(&[DVec3::ZERO, size * DVec3::X, size * DVec3::Y]);
            assert_eq!(normal, Some(DVec3::Z), "size {size:e}");
        }
    }

    #[test]
    fn vertex_normals_are_brought_to_unit_length() {
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let normals = vec![3e-200 * DVec3::Z, 1e200 * DVec3::X, DVec3::ZERO];
        let mesh = TriangleMesh::with_normals(corners, normals, vec![[0, 1, 2]]).unwrap();
        assert_eq!(mesh.normals(), [DVec3::Z, DVec3::X, DVec3::ZERO]);
    }
}
