use std::collections::HashMap;
use std::path::{Path, PathBuf};

use tem00_config::Folder;
use tem00_geometry::{MeshInstance, TriangleMesh};
use tem00_numerics::Grid;

use crate::mesh_file::{MeshFileError, read_mesh_with};
use crate::radiance_map::{RadianceMapError, read_radiance_map};

/// The normals by which light is scattered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Shading {
    /// Normals of the vertices, where the file has them.
    Smooth,
    /// Normals of the triangles.
    Flat,
}

/// The files other than text that a scene is made of.
#[derive(Debug)]
pub(crate) struct Assets {
    folder: Folder,
    files: Vec<PathBuf>,
    /// Sentences about what was left out of them.
    notes: Vec<String>,
    /// The meshes by canonical path, in the unit of their files.
    meshes: HashMap<(PathBuf, Shading), MeshInstance>,
}

impl Assets {
    /// Begins without files, for a scene in a folder.
    pub(crate) fn new(folder: &Folder) -> Self {
        Self {
            folder: folder.clone(),
            files: Vec::new(),
            notes: Vec::new(),
            meshes: HashMap::new(),
        }
    }

    /// Reads a mesh in the unit of its file, once for all surfaces that are made of it.
    pub(crate) fn mesh(
        &mut self,
        path: &Path,
        shading: Shading,
    ) -> Result<MeshInstance, MeshFileError> {
        let canonical = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if let Some(mesh) = self.meshes.get(&(canonical.clone(), shading)) {
            return Ok(mesh.clone());
        }
        let (mesh, notes) = read_mesh_with(path, 1.0, self.folder.access).map_err(|error| {
            if self.folder.holds(&canonical) {
                error
            } else {
                error.unquoted()
            }
        })?;
        let mesh = match shading {
            Shading::Flat if !mesh.normals().is_empty() => {
                TriangleMesh::new(mesh.vertices().to_vec(), mesh.triangles().to_vec())?
            }
            _ => mesh,
        };
        let mesh = MeshInstance::from(mesh);
        self.note(path);
        for note in notes {
            let note = format!("{}: {note}", path.display());
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
        self.meshes.insert((canonical, shading), mesh.clone());
        Ok(mesh)
    }

    /// Reads a radiance map, whose values are multiplied by `scale`.
    pub(crate) fn radiance_map(
        &mut self,
        path: &Path,
        scale: f64,
    ) -> Result<Grid<f32>, RadianceMapError> {
        let map = read_radiance_map(path, scale)?;
        self.note(path);
        Ok(map)
    }

    /// Notes that a file was read.
    fn note(&mut self, path: &Path) {
        if !self.files.iter().any(|known| known == path) {
            self.files.push(path.to_path_buf());
        }
    }

    /// Returns the files in the order in which they were first read, and what was left out of them.
    pub(crate) fn into_files_and_notes(self) -> (Vec<PathBuf>, Vec<String>) {
        (self.files, self.notes)
    }
}
