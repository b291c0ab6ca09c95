use glam::DVec3;
use tem00_geometry::{MeshError, TriangleMesh};

use super::error::{MeshFileError, format_error, wrong};
use super::faces::Cut;

/// Contents of a file, in its own unit.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    pub(super) vertices: Vec<DVec3>,
    /// The normals of the vertices, zero for none; empty if no vertex has one.
    pub(super) normals: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The number of faces with fewer than three corners.
    pub(super) flat: usize,
    /// Sentences about what else was left out, and what is doubtful.
    pub(super) notes: Vec<String>,
}

impl Polygons {
    /// Makes a mesh, and says what was left out of it.
    ///
    /// Vertices that no triangle uses may have any values; normals that are not finite count as
    /// missing.
    pub(super) fn into_mesh(
        mut self,
        scale: f64,
    ) -> Result<(TriangleMesh, Vec<String>), MeshFileError> {
        for vertex in &mut self.vertices {
            *vertex *= scale;
        }
        self.clear_unused_vertices();
        let no_numbers = self.normals.iter().filter(|n| !n.is_finite()).count();
        for normal in self.normals.iter_mut().filter(|n| !n.is_finite()) {
            *normal = DVec3::ZERO;
        }
        if self.normals.iter().all(|&normal| normal == DVec3::ZERO) {
            self.normals.clear();
        }
        let mesh = TriangleMesh::with_normals(self.vertices, self.normals, self.triangles);
        let mut notes = self.notes;
        let dropped = mesh.as_ref().map_or(0, TriangleMesh::dropped_triangles);
        let flat = ["face without area", "faces without area"];
        notes.extend(note(self.flat + dropped, flat));
        let not_finite = ["normal that is not finite", "normals that are not finite"];
        notes.extend(note(no_numbers, not_finite));
        match mesh {
            Ok(mesh) => Ok((mesh, notes)),
            Err(error @ MeshError::Empty { degenerate: 0 }) if !notes.is_empty() => {
                Err(wrong(format!("{error}; {}", notes.join("; "))))
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Takes the triangles of faces; `corner` returns the index of a corner's vertex.
    pub(super) fn take<T>(&mut self, cut: Cut<T>, mut corner: impl FnMut(T) -> u32) {
        let triangles = cut.triangles.into_iter();
        self.triangles.extend(triangles.map(|t| t.map(&mut corner)));
        self.flat += cut.flat;
        if let [first, ..] = *cut.crossing {
            let count = cut.crossing.len();
            self.notes.push(format!(
                "faces that cross themselves: {count}, the first is face {first} (from 0); what \
                 they enclose is not defined, and they may cover too much or too little"
            ));
        }
    }

    /// Puts vertices that no triangle uses into the origin if they are not finite.
    fn clear_unused_vertices(&mut self) {
        if self.vertices.iter().all(|vertex| vertex.is_finite()) {
            return;
        }
        let mut used = vec![false; self.vertices.len()];
        for &corner in self.triangles.as_flattened() {
            if let Some(used) = used.get_mut(corner as usize) {
                *used = true;
            }
        }
        for (vertex, used) in self.vertices.iter_mut().zip(used) {
            if !used && !vertex.is_finite() {
                *vertex = DVec3::ZERO;
            }
        }
    }
}

/// Says that things, in the singular or the plural, are left out, if there are any.
pub(super) fn note(count: usize, [one, many]: [&str; 2]) -> Option<String> {
    match count {
        0 => None,
        1 => Some(format!("left out: 1 {one}")),
        _ => Some(format!("left out: {count} {many}")),
    }
}

/// Reads a number, which may be NaN in any of the ways that programs write it.
///
/// Programs of Microsoft write `nan(ind)` and `1.#QNAN`.
pub(super) fn parse_number(word: &str) -> Option<f64> {
    let no_number = || {
        let digits = word.trim_start_matches(['-', '+']).to_ascii_lowercase();
        let marks = ["nan(", "1.#ind", "1.#qnan", "1.#snan", "1.#inf"];
        marks
            .iter()
            .any(|mark| digits.starts_with(mark))
            .then_some(f64::NAN)
    };
    word.parse().ok().or_else(no_number)
}

/// Returns the point, or the vector that `of` names, whose three coordinates are the first three
/// words.
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
        point[axis] = parse_number(word).ok_or_else(|| {
            format_error(line, format!("a coordinate must be a number, got {word:?}"))
        })?;
    }
    Ok(point)
}
