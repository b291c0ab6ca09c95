use super::{Polygons, format_error, parse_point};
use crate::MeshError;

/// Reads the vertices and faces of a Wavefront OBJ file.
pub(super) fn parse(content: &[u8]) -> Result<Polygons, MeshError> {
    let text = String::from_utf8_lossy(content);
    let mut polygons = Polygons::default();
    // Faces may refer to vertices that come later, so indices are judged at the end.
    let mut highest = (0, 0);
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let number = number + 1;
        let mut line = strip_comment(line).to_owned();
        while line.ends_with('\\') {
            line.pop();
            line += lines.next().map_or("", |(_, next)| strip_comment(next));
        }
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => polygons.vertices.push(parse_point(words, number)?),
            Some("f") => {
                let corners = parse_face(words, polygons.vertices.len(), number)?;
                for &corner in &corners {
                    highest = highest.max((corner, number));
                }
                polygons.push(&corners);
            }
            _ => {}
        }
    }
    let (corner, number) = highest;
    if number > 0 && corner as usize >= polygons.vertices.len() {
        let count = polygons.vertices.len();
        return Err(format_error(
            number,
            format!(
                "the face refers to vertex {}, but the file has {count}",
                u64::from(corner) + 1
            ),
        ));
    }
    Ok(polygons)
}

fn strip_comment(line: &str) -> &str {
    line.split_once('#')
        .map_or(line, |(before, _)| before)
        .trim_end()
}

/// Returns the vertex indices, from 0, of a face whose corners read `v`, `v/t`, `v//n` or `v/t/n`.
///
/// Indices count from 1, or backwards from −1, the last of the `count` vertices so far.
fn parse_face<'a>(
    words: impl Iterator<Item = &'a str>,
    count: usize,
    line: usize,
) -> Result<Vec<u32>, MeshError> {
    let mut corners = Vec::new();
    for word in words {
        let index = word.split('/').next().unwrap_or(word);
        let wrong = || {
            let allowed = format!("a vertex number, from 1 up or from -1 down to -{count}");
            format_error(
                line,
                format!("a corner must start with {allowed}, got {word:?}"),
            )
        };
        let index: i64 = index.parse().map_err(|_| wrong())?;
        let from_zero = match index {
            0 => return Err(wrong()),
            1.. => index - 1,
            _ => i64::try_from(count).map_err(|_| wrong())? + index,
        };
        corners.push(u32::try_from(from_zero).map_err(|_| wrong())?);
    }
    if corners.len() < 3 {
        let got = corners.len();
        return Err(format_error(
            line,
            format!("a face needs three corners, got {got}"),
        ));
    }
    Ok(corners)
}
