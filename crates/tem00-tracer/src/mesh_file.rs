mod gltf;
mod obj;
mod ply;
mod stl;

use std::path::Path;

use glam::DVec3;
use tem00_numerics::check_memory;

use crate::{
    MeshError, TriangleMesh,
    input_file::{FileAccess, MAX_ASSET_BYTES, read_input},
};

/// A format of files that hold triangle meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeshFormat {
    /// glTF 2.0, text (`.gltf`) or binary (`.glb`).
    Gltf,
    /// Wavefront OBJ (`.obj`).
    Obj,
    /// PLY, text or binary (`.ply`).
    Ply,
    /// STL, text or binary (`.stl`).
    Stl,
}

impl MeshFormat {
    /// Returns the format that the extension of a file name, in any case, stands for.
    ///
    /// # Errors
    ///
    /// Returns an error if it is none of those above.
    pub fn from_path(path: &Path) -> Result<Self, MeshError> {
        let extension = path.extension().unwrap_or_default();
        let extension = extension.to_string_lossy().to_lowercase();
        match extension.as_str() {
            "gltf" | "glb" => Ok(Self::Gltf),
            "obj" => Ok(Self::Obj),
            "ply" => Ok(Self::Ply),
            "stl" => Ok(Self::Stl),
            "" => Err(MeshError::Extension(extension)),
            other => Err(MeshError::Extension(format!(".{other}"))),
        }
    }
}

/// Reads a triangle mesh from an OBJ, PLY, STL or glTF file.
///
/// The extension of the file name says which, see [`MeshFormat`]. Coordinates are multiplied by
/// `scale`, the length of the file's unit in metres: 1e−3 for a file in millimetres, 1 for glTF,
/// whose unit is the metre. All groups, solids, nodes and instances become one mesh.
///
/// Polygons are halved again and again by chords between their corners, which is right for convex
/// ones. Normals of vertices are kept as they are, also where they point to the back of a triangle;
/// STL has none. Everything else is passed over: colours, materials, textures, skins, animations. Files with
/// the data of a glTF file lie below its folder. No file has more than [4 GiB](crate::document::MAX_ASSET_BYTES).
///
/// # Errors
///
/// Returns an error that names the file if the scale is not positive and finite, the extension is
/// that of no format, the file cannot be read or breaks its format, or its content is no mesh (see
/// [`TriangleMesh::new`]). Errors of text files say the line. Of glTF, primitives other than
/// triangles, sparse accessors and extensions that the file requires are refused.
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
///     r#"parts/nut.plx: mesh format must be .obj, .ply, .stl, .gltf or .glb, got ".plx""#
/// );
/// ```
pub fn read_mesh(path: &Path, scale: f64) -> Result<TriangleMesh, MeshError> {
    read_mesh_with(path, scale, FileAccess::WithinFolder)
}

/// Reads a triangle mesh as [`read_mesh`] does; the data of a glTF file may lie where `access` says.
pub(crate) fn read_mesh_with(
    path: &Path,
    scale: f64,
    access: FileAccess,
) -> Result<TriangleMesh, MeshError> {
    read(path, scale, access).map_err(|source| MeshError::File {
        path: path.to_owned(),
        source: Box::new(source),
    })
}

/// Reads a triangle mesh from the content of a file, as [`read_mesh`] does.
///
/// # Errors
///
/// Returns the errors of [`read_mesh`], without the name of a file, and an error if a glTF file keeps
/// its data in other files.
///
/// # Examples
///
/// ```
/// use tem00_tracer::{MeshFormat, read_mesh_bytes};
///
/// let obj = b"v 0 0 0\nv 40 0 0\nv 0 30 0\nf 1 2 3\n";
/// let mesh = read_mesh_bytes(obj, MeshFormat::Obj, 1e-3)?;
/// assert_eq!(mesh.bounds().1, glam::DVec3::new(0.04, 0.03, 0.0));
/// # Ok::<(), tem00_tracer::MeshError>(())
/// ```
pub fn read_mesh_bytes(
    content: &[u8],
    format: MeshFormat,
    scale: f64,
) -> Result<TriangleMesh, MeshError> {
    check_scale(scale)?;
    parse(content, format, None)?.into_mesh(scale)
}

/// The bytes that a mesh takes for each of its file: vertices, triangles and the hierarchy of boxes around them.
const BYTES_PER_BYTE: u64 = 8;

fn read(path: &Path, scale: f64, access: FileAccess) -> Result<TriangleMesh, MeshError> {
    check_scale(scale)?;
    let format = MeshFormat::from_path(path)?;
    let content =
        read_input(path, MAX_ASSET_BYTES).map_err(|error| MeshError::Read(error.to_string()))?;
    check_memory(content.len() as u64 * BYTES_PER_BYTE)
        .map_err(|error| MeshError::Read(error.to_string()))?;
    let folder = path.parent().map(|folder| (folder, access));
    parse(&content, format, folder)?.into_mesh(scale)
}

fn check_scale(scale: f64) -> Result<(), MeshError> {
    if scale > 0.0 && scale.is_finite() {
        return Ok(());
    }
    Err(MeshError::Scale(scale))
}

/// Reads a file; others that it refers to are looked for in a folder, or below it.
fn parse(
    content: &[u8],
    format: MeshFormat,
    folder: Option<(&Path, FileAccess)>,
) -> Result<Polygons, MeshError> {
    match format {
        MeshFormat::Gltf => gltf::parse(content, folder),
        MeshFormat::Obj => obj::parse(content),
        MeshFormat::Ply => ply::parse(content),
        MeshFormat::Stl => stl::parse(content),
    }
}

/// What a file holds, in its own unit.
#[derive(Debug, Default)]
struct Polygons {
    vertices: Vec<DVec3>,
    /// The normals of the vertices, zero for none; empty if no vertex has one.
    normals: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Polygons {
    fn into_mesh(mut self, scale: f64) -> Result<TriangleMesh, MeshError> {
        for vertex in &mut self.vertices {
            *vertex *= scale;
        }
        if self.normals.iter().all(|&normal| normal == DVec3::ZERO) {
            self.normals.clear();
        }
        TriangleMesh::with_normals(self.vertices, self.normals, self.triangles)
    }
}

/// Cuts a polygon into triangles.
///
/// Halves of halves keep the triangles as wide as the corners allow. A fan around one corner would
/// make slivers, which overlap so much that no hierarchy of boxes tells them apart.
fn triangulate<T: Copy>(corners: &[T], triangles: &mut Vec<[T; 3]>) {
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
fn format_error(line: usize, message: impl Into<String>) -> MeshError {
    MeshError::Format {
        line: Some(line),
        message: message.into(),
    }
}

/// Returns the point, or what else `of` is, whose three coordinates are the first three words.
fn parse_point<'a>(
    words: impl Iterator<Item = &'a str>,
    of: &str,
    line: usize,
) -> Result<DVec3, MeshError> {
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

#[cfg(test)]
mod tests;
