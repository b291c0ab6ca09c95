use std::{
    borrow::Cow,
    io::{Cursor, ErrorKind},
};

use glam::DVec3;
use ply_rs_bw::{
    parser::{Parser, Reader},
    ply::{
        ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
        ScalarType,
    },
};
use tem00_config::without_byte_order_mark;

use super::error::{MeshFileError, format_error, wrong};
use super::faces::{Faces, strip};
use super::polygons::{Polygons, note, parse_number};

/// The names of the list of a face's vertices: both are common.
const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads the vertices, faces and triangle strips of a PLY file, text or binary.
pub(super) fn parse(content: &[u8]) -> Result<Polygons, MeshFileError> {
    let mut body = Body::new(without_byte_order_mark(content));
    let header = body.header()?;
    let mut polygons = Polygons::default();
    let (mut faces, mut strips, mut left_out) = (Faces::default(), Vec::new(), 0);
    for element in header.elements.values() {
        check_properties(element)?;
        let has_normals = ["nx", "ny", "nz"]
            .iter()
            .all(|name| is_number(element, name));
        // Elements without properties have no bytes either, however many the header announces.
        let count = if element.properties.is_empty() {
            0
        } else {
            element.count
        };
        for index in 0..count {
            let record = body.record(header.encoding, element, index)?;
            match element.name.as_str() {
                "vertex" => {
                    polygons.vertices.push(record.position);
                    polygons
                        .normals
                        .extend(has_normals.then_some(record.normal));
                }
                "face" => faces.push(corners(&record.indices, element, index)?),
                "tristrips" => {
                    for part in record.indices.split(|&vertex| vertex == -1) {
                        strips.extend(strip(&corners(part, element, index)?));
                    }
                }
                _ => left_out += 1,
            }
        }
    }
    check_corners(&faces, polygons.vertices.len())?;
    let cut = faces.cut(|vertex| polygons.vertices[vertex as usize])?;
    polygons.take(cut, |vertex| vertex);
    polygons.triangles.extend(strips);
    let others = [
        "entry other than vertex, face and triangle strip",
        "entries other than vertices, faces and triangle strips",
    ];
    polygons.notes.extend(note(left_out, others));
    Ok(polygons)
}

fn check_corners(faces: &Faces<u32>, vertices: usize) -> Result<(), MeshFileError> {
    for (index, face) in faces.iter().enumerate() {
        if let Some(vertex) = face.iter().find(|&&vertex| vertex as usize >= vertices) {
            return Err(wrong(format!(
                "face {index} (from 0) refers to vertex {vertex}, but the file has {vertices}"
            )));
        }
    }
    Ok(())
}

fn is_number(element: &ElementDef, name: &str) -> bool {
    let property = element.properties.get(name);
    property.is_some_and(|property| matches!(property.data_type, PropertyType::Scalar(_)))
}

fn is_list_of_whole_numbers(element: &ElementDef, name: &str) -> bool {
    let property = element.properties.get(name);
    property.is_some_and(|property| match &property.data_type {
        PropertyType::List(_, of) => !matches!(of, ScalarType::Float | ScalarType::Double),
        PropertyType::Scalar(_) => false,
    })
}

/// Checks that an element has the properties that are read of it.
fn check_properties(element: &ElementDef) -> Result<(), MeshFileError> {
    let (found, needed) = match element.name.as_str() {
        "vertex" => (
            ["x", "y", "z"].iter().all(|name| is_number(element, name)),
            "the numbers x, y and z",
        ),
        "face" | "tristrips" => (
            INDICES
                .iter()
                .any(|name| is_list_of_whole_numbers(element, name)),
            "a list of whole numbers, vertex_indices or vertex_index",
        ),
        _ => return Ok(()),
    };
    if found || element.count == 0 {
        return Ok(());
    }
    let ElementDef { name, .. } = element;
    let got = names(element);
    Err(wrong(format!(
        "the element {name} needs {needed}, got {got:?}"
    )))
}

fn names(element: &ElementDef) -> String {
    let names: Vec<&str> = element.properties.keys().map(String::as_str).collect();
    names.join(", ")
}

fn cut_off(element: &ElementDef, index: usize) -> MeshFileError {
    let ElementDef { name, count, .. } = element;
    wrong(format!(
        "the file ends within {name} {index} (from 0) of {count}"
    ))
}

/// Returns the corners of a face or a strip, of whose vertices none has a negative number.
fn corners(indices: &[i64], element: &ElementDef, index: usize) -> Result<Vec<u32>, MeshFileError> {
    let corner = |&vertex: &i64| {
        u32::try_from(vertex).map_err(|_| {
            let name = &element.name;
            wrong(format!("{name} {index} (from 0) refers to vertex {vertex}"))
        })
    };
    indices.iter().map(corner).collect()
}

/// Remaining content of a file.
struct Body<'a> {
    rest: &'a [u8],
    /// Line separator: a line feed, or the carriage return of old Macintoshes.
    separator: u8,
    /// The number of lines that were read.
    line: usize,
}

impl<'a> Body<'a> {
    fn new(content: &'a [u8]) -> Self {
        let end = content.iter().position(|byte| b"\r\n".contains(byte));
        let end = &content[end.unwrap_or(content.len())..];
        let is_old = end.starts_with(b"\r") && !end.starts_with(b"\r\n");
        Self {
            rest: content,
            separator: if is_old { b'\r' } else { b'\n' },
            line: 0,
        }
    }

    /// Returns the next line without white space around it.
    fn line(&mut self) -> Option<Cow<'a, str>> {
        if self.rest.is_empty() {
            return None;
        }
        let mut parts = self.rest.splitn(2, |&byte| byte == self.separator);
        let line = parts.next()?;
        self.rest = parts.next().unwrap_or_default();
        self.line += 1;
        Some(String::from_utf8_lossy(line.trim_ascii()))
    }

    /// Reads the header, in which lines may be blank.
    fn header(&mut self) -> Result<Header, MeshFileError> {
        let mut lines = Vec::new();
        while lines.last().is_none_or(|line| line != "end_header") {
            match self.line() {
                Some(line) if self.line == 1 && line != "ply" => break,
                Some(line) if line.is_empty() => lines.push("comment".into()),
                Some(line) => lines.push(line),
                None if lines.is_empty() => break,
                None => {
                    return Err(wrong(
                        "the PLY header has no end: \"end_header\" is missing",
                    ));
                }
            }
        }
        if lines.is_empty() {
            return Err(wrong("a PLY file begins with the line \"ply\""));
        }
        let mut reader = Reader::new(Cursor::new(lines.join("\n")));
        let header = Parser::<Record>::new().read_header(&mut reader);
        header.map_err(|error| match error.line() {
            Some(line) => {
                let got = &lines[line.clamp(1, lines.len()) - 1];
                format_error(
                    line,
                    format!("this does not belong into a PLY header: {got:?}"),
                )
            }
            None => wrong("the PLY header needs a format, such as \"format ascii 1.0\""),
        })
    }

    fn record(
        &mut self,
        encoding: Encoding,
        element: &ElementDef,
        index: usize,
    ) -> Result<Record, MeshFileError> {
        let parser = Parser::new();
        let record = match encoding {
            Encoding::Ascii => return self.text_record(element, index),
            Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut self.rest, element),
            Encoding::BinaryLittleEndian => {
                parser.read_little_endian_element(&mut self.rest, element)
            }
        };
        record.map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => cut_off(element, index),
            _ => {
                let name = &element.name;
                wrong(format!(
                    "{name} {index} (from 0) has a list of negative length"
                ))
            }
        })
    }

    /// Reads a record from the next line that is not blank.
    fn text_record(&mut self, element: &ElementDef, index: usize) -> Result<Record, MeshFileError> {
        let line = loop {
            let line = self.line().ok_or_else(|| cut_off(element, index))?;
            if !line.is_empty() {
                break line;
            }
        };
        record_of(&line, element).ok_or_else(|| {
            let message = format!("{} needs {}, got {line:?}", element.name, names(element));
            format_error(self.line, message)
        })
    }
}

/// Reads a record from its line, if it has all numbers.
fn record_of(line: &str, element: &ElementDef) -> Option<Record> {
    let mut words = line.split_ascii_whitespace();
    let mut record = Record::new();
    for (name, property) in &element.properties {
        let word = words.next()?;
        match &property.data_type {
            PropertyType::Scalar(ScalarType::Float) => {
                record.set_number(name, parse_single(word)?);
            }
            PropertyType::Scalar(_) => record.set_number(name, parse_number(word)?),
            PropertyType::List(..) => {
                let count = word.parse().ok()?;
                let list: Vec<&str> = words.by_ref().take(count).collect();
                if list.len() != count {
                    return None;
                }
                if INDICES.contains(&name.as_str()) {
                    let indices = list.iter().map(|word| word.parse().ok());
                    record.indices = indices.collect::<Option<_>>()?;
                }
            }
        }
    }
    Some(record)
}

/// Reads a number in single precision, as the header says.
fn parse_single(word: &str) -> Option<f64> {
    let number = word.parse::<f32>().map(f64::from);
    number.ok().or_else(|| parse_number(word))
}

/// Record of an entry; a coordinate missing in the file stays NaN.
struct Record {
    position: DVec3,
    normal: DVec3,
    indices: Vec<i64>,
}

impl Record {
    fn set_number(&mut self, name: &str, number: f64) {
        match name {
            "x" => self.position.x = number,
            "y" => self.position.y = number,
            "z" => self.position.z = number,
            "nx" => self.normal.x = number,
            "ny" => self.normal.y = number,
            "nz" => self.normal.z = number,
            _ => {}
        }
    }
}

impl PropertyAccess for Record {
    fn new() -> Self {
        Self {
            position: DVec3::NAN,
            normal: DVec3::ZERO,
            indices: Vec::new(),
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let is_list = INDICES.contains(&name);
        match property {
            Property::Char(value) => self.set_number(name, value.into()),
            Property::UChar(value) => self.set_number(name, value.into()),
            Property::Short(value) => self.set_number(name, value.into()),
            Property::UShort(value) => self.set_number(name, value.into()),
            Property::Int(value) => self.set_number(name, value.into()),
            Property::UInt(value) => self.set_number(name, value.into()),
            Property::Float(value) => self.set_number(name, value.into()),
            Property::Double(value) => self.set_number(name, value),
            Property::ListChar(list) if is_list => self.indices = whole(list),
            Property::ListUChar(list) if is_list => self.indices = whole(list),
            Property::ListShort(list) if is_list => self.indices = whole(list),
            Property::ListUShort(list) if is_list => self.indices = whole(list),
            Property::ListInt(list) if is_list => self.indices = whole(list),
            Property::ListUInt(list) if is_list => self.indices = whole(list),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

fn whole(list: Vec<impl Into<i64>>) -> Vec<i64> {
    list.into_iter().map(Into::into).collect()
}
