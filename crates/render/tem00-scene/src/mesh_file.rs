mod error;
mod faces;
#[cfg(feature = "gltf")]
mod gltf;
mod obj;
mod ply;
mod polygons;
mod stl;

use std::path::Path;

use tem00_config::{FileAccess, MAX_ASSET_BYTES, read_input};
use tem00_geometry::TriangleMesh;
use tem00_numerics::check_memory;

use polygons::Polygons;

pub use error::MeshFileError;

/// A format of files that hold triangle meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeshFormat {
    /// glTF 2.0, text (`.gltf`) or binary (`.glb`), with the feature `gltf`.
    Gltf,
    /// Wavefront OBJ (`.obj`).
    Obj,
    /// PLY, text or binary (`.ply`).
    Ply,
    /// STL, text or binary (`.stl`).
    Stl,
}

impl MeshFormat {
    /// Returns the format that the extension of a file name, in upper or lower case, stands for.
    ///
    /// # Errors
    ///
    /// Returns an error if the extension belongs to none of these formats.
    pub fn from_path(path: &Path) -> Result<Self, MeshFileError> {
        let extension = path.extension().unwrap_or_default();
        let extension = extension.to_string_lossy().to_lowercase();
        match extension.as_str() {
            "gltf" | "glb" => Ok(Self::Gltf),
            "obj" => Ok(Self::Obj),
            "ply" => Ok(Self::Ply),
            "stl" => Ok(Self::Stl),
            "" => Err(MeshFileError::Extension(extension)),
            other => Err(MeshFileError::Extension(format!(".{other}"))),
        }
    }
}

/// Reads a triangle mesh from an OBJ, PLY, STL or glTF file.
///
/// The extension of the file name determines the format, see [`MeshFormat`]. Coordinates are
/// multiplied by `scale`, the length of the file's unit in metres: 1e−3 for a file in millimetres,
/// 1 for glTF, whose unit is the metre. All groups, solids, nodes and instances become one mesh.
///
/// Faces of any number of corners are cut into triangles in the plane that is closest to them,
/// convex or not. Triangle strips and fans are read. Normals of vertices are kept as they are, also
/// where they point to the back of a triangle; a normal that is zero or NaN counts as missing, and
/// STL has no vertex normals. Everything else is ignored: points, lines, colours, materials,
/// textures, skins, animations; for a scene, [`SceneFile::notes`](crate::SceneFile::notes) says
/// what was left out of the shapes. Text may begin with a byte order mark. Files with the data of a
/// glTF file lie below its folder. No file has more than [4 GiB](tem00_config::MAX_ASSET_BYTES).
///
/// # Errors
///
/// Returns an error that names the file if the scale is not positive and finite, the extension
/// belongs to no format, the file cannot be read or breaks its format, or its content is not a mesh
/// (see [`TriangleMesh::new`]). Errors of text files say the line. In glTF, sparse accessors are
/// refused, and so are extensions that the file requires unless they concern only materials,
/// textures, lights or animations.
///
/// # Examples
///
/// ```
/// use std::path::Path;
/// use tem00_scene::read_mesh;
///
/// let error = read_mesh(Path::new("parts/nut.plx"), 1e-3).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     r#"parts/nut.plx: mesh format must be .obj, .ply, .stl, .gltf or .glb, got ".plx""#
/// );
/// ```
pub fn read_mesh(path: &Path, scale: f64) -> Result<TriangleMesh, MeshFileError> {
    read_mesh_with(path, scale, FileAccess::WithinFolder).map(|(mesh, _)| mesh)
}

/// Reads a triangle mesh as [`read_mesh`] does, and says what was left out; the data of a glTF file
/// may lie where `access` allows.
pub(crate) fn read_mesh_with(
    path: &Path,
    scale: f64,
    access: FileAccess,
) -> Result<(TriangleMesh, Vec<String>), MeshFileError> {
    read(path, scale, access).map_err(|source| MeshFileError::File {
        path: path.to_owned(),
        source: Box::new(source),
    })
}

/// Reads a triangle mesh from the content of a file, as [`read_mesh`] does.
///
/// # Errors
///
/// Returns the errors of [`read_mesh`], without the name of a file, and an error if a glTF file
/// keeps its data in other files.
///
/// # Examples
///
/// ```
/// use tem00_scene::{MeshFormat, read_mesh_bytes};
///
/// let obj = b"v 0 0 0\nv 40 0 0\nv 0 30 0\nf 1 2 3\n";
/// let mesh = read_mesh_bytes(obj, MeshFormat::Obj, 1e-3)?;
/// assert_eq!(mesh.bounds().1, glam::DVec3::new(0.04, 0.03, 0.0));
/// # Ok::<(), tem00_scene::MeshFileError>(())
/// ```
pub fn read_mesh_bytes(
    content: &[u8],
    format: MeshFormat,
    scale: f64,
) -> Result<TriangleMesh, MeshFileError> {
    check_scale(scale)?;
    let (mesh, _) = parse(content, format, None)?.into_mesh(scale)?;
    Ok(mesh)
}

/// The memory that a mesh takes for each byte of its file, in bytes: vertices, triangles and the
/// hierarchy of boxes around them.
const BYTES_PER_BYTE: u64 = 8;

fn read(
    path: &Path,
    scale: f64,
    access: FileAccess,
) -> Result<(TriangleMesh, Vec<String>), MeshFileError> {
    check_scale(scale)?;
    let format = MeshFormat::from_path(path)?;
    let content = read_input(path, MAX_ASSET_BYTES)
        .map_err(|error| MeshFileError::Read(error.to_string()))?;
    check_memory(content.len() as u64 * BYTES_PER_BYTE)
        .map_err(|error| MeshFileError::Read(error.to_string()))?;
    let folder = path.parent().map(|folder| (folder, access));
    parse(&content, format, folder)?.into_mesh(scale)
}

fn check_scale(scale: f64) -> Result<(), MeshFileError> {
    if scale > 0.0 && scale.is_finite() {
        return Ok(());
    }
    Err(MeshFileError::Scale(scale))
}

/// Reads a file; others that it refers to are looked for in a folder, or below it.
fn parse(
    content: &[u8],
    format: MeshFormat,
    folder: Option<(&Path, FileAccess)>,
) -> Result<Polygons, MeshFileError> {
    match format {
        #[cfg(feature = "gltf")]
        MeshFormat::Gltf => gltf::parse(content, folder),
        #[cfg(not(feature = "gltf"))]
        MeshFormat::Gltf => {
            let _ = folder;
            Err(MeshFileError::LeftOut)
        }
        MeshFormat::Obj => obj::parse(content),
        MeshFormat::Ply => ply::parse(content),
        MeshFormat::Stl => stl::parse(content),
    }
}

#[cfg(test)]
mod tests;
