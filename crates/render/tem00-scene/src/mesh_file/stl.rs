use std::collections::HashMap;

use glam::DVec3;
use tem00_config::without_byte_order_mark;

use super::error::{MeshFileError, format_error, wrong};
use super::polygons::{Polygons, note, parse_point};

/// The header, and the number of triangles.
const PREAMBLE: usize = 84;
/// A normal, three corners and two spare bytes.
const RECORD: usize = 50;

/// The number of first bytes among which a binary file has a zero byte: in its number of triangles,
/// if not before.
const HEAD: usize = 512;

/// Reads an STL file, text or binary.
///
/// Many binary files begin with the word `solid` that marks text, and some end with bytes that
/// their length does not count. Text has no bytes that are zero.
pub(super) fn parse(content: &[u8]) -> Result<Polygons, MeshFileError> {
    let needed = binary_length(content);
    let has_zeros = content[..content.len().min(HEAD)].contains(&0);
    let text = without_byte_order_mark(content).trim_ascii_start();
    let begins_as_text = text
        .get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    if needed != Some(content.len()) && begins_as_text && !has_zeros {
        return parse_text(&String::from_utf8_lossy(without_byte_order_mark(content)));
    }
    match needed {
        Some(needed) if needed <= content.len() => {
            let mut polygons = parse_binary(&content[PREAMBLE..needed]);
            let behind = [
                "byte behind the last triangle",
                "bytes behind the last triangle",
            ];
            polygons.notes.extend(note(content.len() - needed, behind));
            Ok(polygons)
        }
        Some(needed) if has_zeros => Err(wrong(format!(
            "the STL header announces {needed} bytes, but the file has {}",
            content.len()
        ))),
        _ => Err(wrong(
            "an STL file begins with \"solid\" or with a header of 84 bytes",
        )),
    }
}

/// Returns the length that a binary file announces, if it is long enough to announce one.
fn binary_length(content: &[u8]) -> Option<usize> {
    let count = content.get(PREAMBLE - 4..PREAMBLE)?;
    let count = u32::from_le_bytes(count.try_into().ok()?);
    RECORD
        .checked_mul(usize::try_from(count).ok()?)?
        .checked_add(PREAMBLE)
}

fn parse_binary(records: &[u8]) -> Polygons {
    let mut soup = Soup::default();
    for record in records.chunks_exact(RECORD) {
        // The stored normal is passed over: the order of the corners defines it.
        let (words, _) = record.as_chunks::<4>();
        let number = |index: usize| f64::from(f32::from_le_bytes(words[index]));
        let corner = |start: usize| DVec3::new(number(start), number(start + 1), number(start + 2));
        soup.push([corner(3), corner(6), corner(9)]);
    }
    soup.polygons
}

fn parse_text(text: &str) -> Result<Polygons, MeshFileError> {
    let mut soup = Soup::default();
    let mut corners = Vec::new();
    let mut finished = false;
    for (number, line) in text.lines().enumerate() {
        let number = number + 1;
        let mut words = line.split_whitespace();
        let Some(keyword) = words.next() else {
            continue;
        };
        match keyword.to_ascii_lowercase().as_str() {
            "vertex" => corners.push(parse_point(words, "vertex", number)?),
            "endfacet" => {
                let got = corners.len();
                let triangle = <[DVec3; 3]>::try_from(corners.as_slice()).map_err(|_| {
                    format_error(number, format!("a facet needs three vertices, got {got}"))
                })?;
                soup.push(triangle);
                corners.clear();
            }
            "endsolid" => finished = true,
            "solid" => finished = false,
            "facet" | "outer" | "endloop" => {}
            other => {
                let allowed = "solid, facet, outer, vertex, endloop, endfacet or endsolid";
                return Err(format_error(
                    number,
                    format!("expected {allowed}, got {other:?}"),
                ));
            }
        }
    }
    if !finished {
        let last = text.lines().count();
        return Err(format_error(last, "the file ends before \"endsolid\""));
    }
    Ok(soup.polygons)
}

/// Triangles with separate vertices at their corners, made to share vertices again.
#[derive(Debug, Default)]
struct Soup {
    polygons: Polygons,
    indices: HashMap<[u64; 3], u32>,
}

impl Soup {
    fn push(&mut self, corners: [DVec3; 3]) {
        let triangle = corners.map(|corner| {
            let vertices = &mut self.polygons.vertices;
            *self
                .indices
                .entry(corner.to_array().map(f64::to_bits))
                .or_insert_with(|| {
                    vertices.push(corner);
                    // A file of 2³² corners would be longer than 70 GB.
                    u32::try_from(vertices.len() - 1).unwrap_or(u32::MAX)
                })
        });
        self.polygons.triangles.push(triangle);
    }
}
