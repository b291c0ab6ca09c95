mod obj;
mod ply;
mod stl;

use std::{fs, path::Path};

use glam::DVec3;

use crate::{MeshError, TriangleMesh};

/// Reads a triangle mesh from a Wavefront OBJ, PLY or STL file.
///
/// The extension of the file name, in any case, says which. PLY and STL may be text or binary.
/// Coordinates are multiplied by `scale`, the length of the file's unit in metres, 1e−3 for a file
/// in millimetres. Polygons are halved again and again by chords between their corners, which is right
/// for convex ones. Everything but vertices and faces is passed over: normals, colours, materials, textures.
/// Groups and several solids become one mesh.
///
/// # Errors
///
/// Returns an error that names the file if the scale is not positive and finite, the extension is
/// none of the three, the file cannot be read or breaks its format, or its content is no mesh (see
/// [`TriangleMesh::new`]). Errors of text files say the line.
///
/// # Examples
///
/// ```
/// use std::path::Path;
/// use tem00_tracer::read_mesh;
///
/// let error = read_mesh(Path::new("parts/nut.plx"), 1e-3).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     r#"parts/nut.plx: mesh format must be .obj, .ply or .stl, got ".plx""#
/// );
/// ```
pub fn read_mesh(path: &Path, scale: f64) -> Result<TriangleMesh, MeshError> {
    read(path, scale).map_err(|source| MeshError::File {
        path: path.to_owned(),
        source: Box::new(source),
    })
}

fn read(path: &Path, scale: f64) -> Result<TriangleMesh, MeshError> {
    if !(scale > 0.0 && scale.is_finite()) {
        return Err(MeshError::Scale(scale));
    }
    let extension = path
        .extension()
        .map(|extension| extension.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    let parse = match extension.as_str() {
        "obj" => obj::parse,
        "ply" => ply::parse,
        "stl" => stl::parse,
        "" => return Err(MeshError::Extension(String::new())),
        other => return Err(MeshError::Extension(format!(".{other}"))),
    };
    let content = fs::read(path).map_err(|error| MeshError::Read(error.to_string()))?;
    let Polygons {
        mut vertices,
        triangles,
    } = parse(&content)?;
    for vertex in &mut vertices {
        *vertex *= scale;
    }
    TriangleMesh::new(vertices, triangles)
}

/// What a file holds, in its own unit.
#[derive(Debug, Default)]
struct Polygons {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Polygons {
    /// Adds a polygon as triangles.
    ///
    /// Halves of halves keep the triangles as wide as the corners allow. A fan around one corner would
    /// make slivers, which overlap so much that no hierarchy of boxes tells them apart.
    fn push(&mut self, corners: &[u32]) {
        if let [first, .., last] = corners
            && corners.len() > 2
        {
            let middle = corners.len() / 2;
            self.push(&corners[..=middle]);
            self.triangles.push([*first, corners[middle], *last]);
            self.push(&corners[middle..]);
        }
    }
}

/// Returns an error about a line of a text file, counted from 1.
fn format_error(line: usize, message: impl Into<String>) -> MeshError {
    MeshError::Format {
        line: Some(line),
        message: message.into(),
    }
}

/// Returns the point whose three coordinates are the first three words.
fn parse_point<'a>(words: impl Iterator<Item = &'a str>, line: usize) -> Result<DVec3, MeshError> {
    let mut point = DVec3::ZERO;
    let mut words = words.take(3);
    for axis in 0..3 {
        let word = words
            .next()
            .ok_or_else(|| format_error(line, "a vertex needs three coordinates"))?;
        point[axis] = word.parse().map_err(|_| {
            format_error(line, format!("a coordinate must be a number, got {word:?}"))
        })?;
    }
    Ok(point)
}

#[cfg(test)]
mod tests;
