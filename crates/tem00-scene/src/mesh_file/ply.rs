use std::io::Cursor;

use glam::DVec3;
use ply_rs_bw::{
    parser::{ParseError, Parser, Reader},
    ply::{Encoding, Property, PropertyAccess, PropertyAccessResult},
};

use super::error::MeshFileError;
use super::polygons::{Polygons, triangulate};

/// Reads the vertices and faces of a PLY file, text or binary.
pub(super) fn parse(content: &[u8]) -> Result<Polygons, MeshFileError> {
    let mut reader = Reader::new(Cursor::new(content));
    let header = Parser::<Skipped>::new()
        .read_header(&mut reader)
        .map_err(|error| format_error(&error))?;
    let mut polygons = Polygons::default();
    let is_text = header.encoding == Encoding::Ascii;
    for element in header.elements.values() {
        // What has no properties has no bytes either, however many the header announces.
        if element.properties.is_empty() && !is_text {
            continue;
        }
        match element.name.as_str() {
            "vertex" => {
                let vertices = Parser::<Vertex>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(|error| format_error(&error))?;
                polygons.vertices = vertices.iter().map(|vertex| vertex.position).collect();
                if ["nx", "ny", "nz"].map(|name| element.properties.contains_key(name)) == [true; 3]
                {
                    polygons.normals = vertices.iter().map(|vertex| vertex.normal).collect();
                }
            }
            "face" => {
                let faces = Parser::<Face>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(|error| format_error(&error))?;
                add_faces(&mut polygons, &faces)?;
            }
            _ => {
                Parser::<Skipped>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(|error| format_error(&error))?;
            }
        }
    }
    Ok(polygons)
}

fn add_faces(polygons: &mut Polygons, faces: &[Face]) -> Result<(), MeshFileError> {
    for (index, face) in faces.iter().enumerate() {
        if face.0.len() < 3 {
            let got = face.0.len();
            return Err(MeshFileError::Format {
                line: None,
                message: format!("face {index} (from 0) needs three corners, got {got}"),
            });
        }
        triangulate(&face.0, &mut polygons.triangles);
    }
    Ok(())
}

/// Puts an error of the parser on one line, without the grammar that did not match.
fn format_error(error: &ParseError) -> MeshFileError {
    let text = error.to_string();
    let prefix = error.line().map(|line| format!("Line {line}: "));
    let message = prefix
        .and_then(|prefix| text.strip_prefix(&prefix))
        .unwrap_or(&text);
    let message = message
        .split_once("\n\tError: Couldn't parse")
        .map_or(message, |(what, _)| what);
    let words: Vec<&str> = message.split_whitespace().collect();
    MeshFileError::Format {
        line: error.line(),
        message: words.join(" "),
    }
}

/// A vertex, whose position stays NaN in each coordinate that the file does not give.
struct Vertex {
    position: DVec3,
    normal: DVec3,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self {
            position: DVec3::NAN,
            normal: DVec3::ZERO,
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let coordinate = match name {
            "x" => &mut self.position.x,
            "y" => &mut self.position.y,
            "z" => &mut self.position.z,
            "nx" => &mut self.normal.x,
            "ny" => &mut self.normal.y,
            "nz" => &mut self.normal.z,
            _ => return PropertyAccessResult::Ignored,
        };
        *coordinate = match property {
            Property::Char(value) => value.into(),
            Property::UChar(value) => value.into(),
            Property::Short(value) => value.into(),
            Property::UShort(value) => value.into(),
            Property::Int(value) => value.into(),
            Property::UInt(value) => value.into(),
            Property::Float(value) => value.into(),
            Property::Double(value) => value,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// The vertex indices of a face.
struct Face(Vec<u32>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        // Both names are common.
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        match property.to_u32_list() {
            Some(indices) => {
                self.0 = indices;
                PropertyAccessResult::Set
            }
            None => PropertyAccessResult::UnsupportedType,
        }
    }
}

/// An element that is read past.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
