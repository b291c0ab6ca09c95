use std::{borrow::Cow, collections::HashMap};

use glam::DVec3;
use tem00_config::without_byte_order_mark;

use super::error::{MeshFileError, format_error, wrong};
use super::faces::Faces;
use super::polygons::{Polygons, note, parse_point};

/// Reads the vertices, their normals and the faces of a Wavefront OBJ file.
pub(super) fn parse(content: &[u8]) -> Result<Polygons, MeshFileError> {
    if content.starts_with(b"\xff\xfe") || content.starts_with(b"\xfe\xff") {
        return Err(wrong("the text is in UTF-16: save it in UTF-8"));
    }
    let text = String::from_utf8_lossy(without_byte_order_mark(content));
    let mut file = ObjFile::default();
    let mut corners = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let number = number + 1;
        let mut line = Cow::Borrowed(strip_comment(line));
        while line.ends_with('\\') {
            let line = line.to_mut();
            line.pop();
            *line += lines.next().map_or("", |(_, next)| strip_comment(next));
        }
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => file.vertices.push(parse_point(words, "vertex", number)?),
            Some("vn") => file.normals.push(parse_point(words, "normal", number)?),
            Some("f") => {
                corners.clear();
                for word in words {
                    corners.push(file.corner(word, number)?);
                }
                file.add_face(&corners, number);
            }
            Some("p" | "l" | "curv" | "curv2" | "surf") => file.left_out += 1,
            _ => {}
        }
    }
    file.check()?;
    file.into_polygons()
}

fn strip_comment(line: &str) -> &str {
    // `1.#QNAN` is how some programs write NaN.
    let mut marks = line.match_indices('#');
    let comment = marks.find(|&(start, _)| !line[..start].ends_with("1."));
    let end = comment.map_or(line.len(), |(start, _)| start);
    line[..end].trim_ascii_end()
}

/// The indices, from 0, of a corner's vertex and of its normal if it has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Corner {
    vertex: u32,
    normal: Option<u32>,
}

#[derive(Debug, Default)]
struct ObjFile {
    vertices: Vec<DVec3>,
    normals: Vec<DVec3>,
    faces: Faces<Corner>,
    /// The number of points, lines, curves and curved surfaces.
    left_out: usize,
    /// The highest vertex and normal that a face refers to, counted from 1, and its line. Faces may
    /// refer to later vertices and normals, so these indices are judged at the end.
    highest_vertex: (u64, usize),
    highest_normal: (u64, usize),
}

impl ObjFile {
    /// Returns the corner that reads `v`, `v/t`, `v//n` or `v/t/n`.
    fn corner(&self, word: &str, line: usize) -> Result<Corner, MeshFileError> {
        let mut parts = word.split('/');
        let count = self.vertices.len();
        let Some(vertex) = parts.next().and_then(|text| index(text, count)) else {
            let allowed = format!("a vertex number, from 1 up or from -1 down to -{count}");
            let message = format!("a corner must start with {allowed}, got {word:?}");
            return Err(format_error(line, message));
        };
        let normal = match parts.nth(1) {
            // Some programs write 0 for none.
            None | Some("" | "0") => None,
            Some(text) => Some(index(text, self.normals.len()).ok_or_else(|| {
                let count = self.normals.len();
                let allowed = format!("a normal number, from 1 up or from -1 down to -{count}");
                format_error(
                    line,
                    format!("a corner must end with {allowed}, got {word:?}"),
                )
            })?),
        };
        Ok(Corner { vertex, normal })
    }

    fn add_face(&mut self, corners: &[Corner], line: usize) {
        for corner in corners {
            let vertex = u64::from(corner.vertex) + 1;
            self.highest_vertex = self.highest_vertex.max((vertex, line));
            if let Some(normal) = corner.normal {
                self.highest_normal = self.highest_normal.max((u64::from(normal) + 1, line));
            }
        }
        self.faces.push(corners.iter().copied());
    }

    fn check(&self) -> Result<(), MeshFileError> {
        for (what, (highest, line), count) in [
            ("vertex", self.highest_vertex, self.vertices.len()),
            ("normal", self.highest_normal, self.normals.len()),
        ] {
            if highest > count as u64 {
                let message =
                    format!("the face refers to {what} {highest}, but the file has {count}");
                return Err(format_error(line, message));
            }
        }
        Ok(())
    }

    /// Makes a vertex of each pair of a vertex and a normal.
    ///
    /// The first normal of a vertex stays with it; for every other one the vertex is repeated at
    /// the end. So the order of the file is kept, and nothing is looked up in the common case of
    /// one normal to each vertex.
    fn into_polygons(self) -> Result<Polygons, MeshFileError> {
        let vertices = self.vertices;
        let cut = self.faces.cut(|corner| vertices[corner.vertex as usize])?;
        let points = ["point, line or curve", "points, lines and curves"];
        let mut polygons = Polygons {
            notes: note(self.left_out, points).into_iter().collect(),
            vertices,
            ..Polygons::default()
        };
        if self.highest_normal.0 == 0 {
            polygons.take(cut, |corner| corner.vertex);
            return Ok(polygons);
        }
        let mut first: Vec<Option<Corner>> = vec![None; polygons.vertices.len()];
        let mut more: HashMap<Corner, u32> = HashMap::new();
        let mut repeated: Vec<Corner> = Vec::new();
        let given = first.len();
        polygons.take(cut, |corner| {
            if *first[corner.vertex as usize].get_or_insert(corner) == corner {
                return corner.vertex;
            }
            *more.entry(corner).or_insert_with(|| {
                repeated.push(corner);
                // A file of 2³² corners would be longer than 8 GB.
                u32::try_from(given + repeated.len() - 1).unwrap_or(u32::MAX)
            })
        });
        let vertices = &mut polygons.vertices;
        for corner in &repeated {
            vertices.push(vertices[corner.vertex as usize]);
        }
        let corners = first.into_iter().chain(repeated.into_iter().map(Some));
        let normals = corners.map(|corner| {
            let normal = corner.and_then(|corner| corner.normal);
            normal.map_or(DVec3::ZERO, |normal| self.normals[normal as usize])
        });
        polygons.normals = normals.collect();
        Ok(polygons)
    }
}

/// Returns the index from 0 of a number that counts from 1, or backwards from −1, the last of the
/// `count` so far.
fn index(text: &str, count: usize) -> Option<u32> {
    let number: i64 = text.parse().ok()?;
    let from_zero = match number {
        0 => return None,
        1.. => number - 1,
        _ => i64::try_from(count).ok()?.checked_add(number)?,
    };
    u32::try_from(from_zero).ok()
}
