use glam::DVec3;
use tem00_tracer::TriangleMesh;

use super::error::MeshFileError;

/// Contents of a file, in its own unit.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    pub(super) vertices: Vec<DVec3>,
    /// The normals of the vertices, zero for none; empty if no vertex has one.
    pub(super) normals: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Polygons {
    pub(super) fn into_mesh(mut self, scale: f64) -> Result<TriangleMesh, MeshFileError> {
        for vertex in &mut self.vertices {
            *vertex *= scale;
        }
        if self.normals.iter().all(|&normal| normal == DVec3::ZERO) {
            self.normals.clear();
        }
        let mesh = TriangleMesh::with_normals(self.vertices, self.normals, self.triangles)?;
        Ok(mesh)
    }
}

/// Cuts a polygon into triangles.
///
/// Halves of halves keep the triangles as wide as the corners allow. A fan around one corner would
/// make slivers, which overlap so much that no hierarchy of boxes tells them apart.
pub(super) fn triangulate<T: Copy>(corners: &[T], triangles: &mut Vec<[T; 3]>) {
    if let [first, .., last] = corners
        && corners.len() > 2
    {
        let middle = corners.len() / 2;
        triangulate(&corners[..=middle], triangles);
        triangles.push([*first, corners[middle], *last]);
        triangulate(&corners[middle..], triangles);
    }
}

/// Returns an error about a line of a text file, counted from 1.
pub(super) fn format_error(line: usize, message: impl Into<String>) -> MeshFileError {
    MeshFileError::Format {
        line: Some(line),
        message: message.into(),
    }
}

/// Returns the point, or what else `of` is, whose three coordinates are the first three words.
pub(super) fn parse_point<'a>(
    words: impl Iterator<Item = &'a str>,
    of: &str,
    line: usize,
) -> Result<DVec3, MeshFileError> {
    let mut point = DVec3::ZERO;
    let mut words = words.take(3);
    for axis in 0..3 {
        let word = words
            .next()
            .ok_or_else(|| format_error(line, format!("a {of} needs three coordinates")))?;
        point[axis] = word.parse().map_err(|_| {
            format_error(line, format!("a coordinate must be a number, got {word:?}"))
        })?;
    }
    Ok(point)
}
