use std::{borrow::Cow, path::Path};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf::{
    Accessor, Document, Gltf, Node, Primitive, Semantic,
    accessor::{DataType, Dimensions},
    buffer::Source,
    json::{Root, validation::Checked},
    mesh::Mode,
    scene::Transform,
};
use tem00_config::{FileAccess, Folder, MAX_ASSET_BYTES, read_input, without_byte_order_mark};
use tem00_numerics::check_memory;

use super::error::{MeshFileError, wrong};
use super::faces::strip;
use super::polygons::{Polygons, note};

/// Reads all triangles of the scene of a glTF 2.0 file, text or binary, each where its nodes put
/// it.
///
/// Buffers in separate files are looked for in a folder.
pub(super) fn parse(
    content: &[u8],
    folder: Option<(&Path, FileAccess)>,
) -> Result<Polygons, MeshFileError> {
    let content = without_byte_order_mark(content);
    // The parser subtracts the length of the header from the length that a binary file announces.
    if content.starts_with(b"glTF") && announced_length(content) < 12 {
        return Err(wrong("the glTF header is cut off"));
    }
    let Gltf { document, blob } = Gltf::from_slice_without_validation(content).map_err(describe)?;
    let mut root = document.into_json();
    check_positions(&root)?;
    leave_out_appearance(&mut root)?;
    let document = Document::from_json(root).map_err(describe)?;
    let mut reader = Reader {
        buffers: read_buffers(&document, blob.as_deref(), folder)?,
        room: 0,
        left_out: 0,
        polygons: Polygons::default(),
    };
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    let scene = scene.ok_or_else(|| wrong("the file has no scene"))?;
    let mut seen = vec![false; document.nodes().count()];
    let mut waiting: Vec<_> = scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect();
    waiting.reverse();
    while let Some((node, parent)) = waiting.pop() {
        if core::mem::replace(&mut seen[node.index()], true) {
            let index = node.index();
            return Err(wrong(format!("node {index} (from 0) has two parents")));
        }
        let placement = parent * local_placement(&node);
        reader.add_node(&node, &placement)?;
        let first = waiting.len();
        waiting.extend(node.children().map(|child| (child, placement)));
        waiting[first..].reverse();
    }
    let mut polygons = reader.polygons;
    let others = [
        "primitive of points or lines",
        "primitives of points or lines",
    ];
    polygons.notes.extend(note(reader.left_out, others));
    Ok(polygons)
}

/// Takes out everything but geometry, so that it need not be valid.
///
/// # Errors
///
/// Returns an error if the file requires an extension of the geometry.
fn leave_out_appearance(root: &mut Root) -> Result<(), MeshFileError> {
    let mut required = root.extensions_required.drain(..);
    if let Some(extension) = required.find(|name| !concerns_appearance(name)) {
        return Err(wrong(format!(
            "the file requires {extension:?}, an extension that is not read: export it without"
        )));
    }
    drop(required);
    root.animations.clear();
    root.cameras.clear();
    root.images.clear();
    root.materials.clear();
    root.samplers.clear();
    root.skins.clear();
    root.textures.clear();
    for node in &mut root.nodes {
        (node.camera, node.skin) = (None, None);
    }
    for primitive in root.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        primitive.material = None;
    }
    Ok(())
}

/// Returns whether an extension is one of materials, textures, lights, animations or remarks, as
/// its name says after the prefix of its maker: `KHR_materials_ior`, `EXT_texture_webp`.
fn concerns_appearance(extension: &str) -> bool {
    const WORDS: [&str; 6] = [
        "animation",
        "lights",
        "materials",
        "techniques",
        "texture",
        "xmp",
    ];
    let word = extension.split('_').nth(1);
    word.is_some_and(|word| WORDS.contains(&word))
}

fn announced_length(content: &[u8]) -> u32 {
    let length = content.get(8..12).and_then(|bytes| bytes.try_into().ok());
    length.map_or(0, u32::from_le_bytes)
}

/// Puts an error of the parser on one line.
fn describe(error: gltf::Error) -> MeshFileError {
    wrong(match &error {
        gltf::Error::Validation(errors) => errors.first().map_or_else(
            || error.to_string(),
            |(path, error)| format!("{path}: {}", error.to_string().to_lowercase()),
        ),
        _ => error.to_string(),
    })
}

/// Checks the indices that the validation takes for granted.
fn check_positions(root: &Root) -> Result<(), MeshFileError> {
    let key = Checked::Valid(Semantic::Positions);
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut accessors = primitives.filter_map(|primitive| primitive.attributes.get(&key));
    match accessors.find(|index| index.value() >= root.accessors.len()) {
        Some(index) => Err(wrong(format!(
            "positions are in accessor {index} (from 0), but the file has {}",
            root.accessors.len()
        ))),
        None => Ok(()),
    }
}

fn read_buffers(
    document: &Document,
    blob: Option<&[u8]>,
    folder: Option<(&Path, FileAccess)>,
) -> Result<Vec<Vec<u8>>, MeshFileError> {
    document
        .buffers()
        .map(|buffer| match buffer.source() {
            Source::Bin => {
                let bytes = blob.ok_or_else(|| wrong("the binary part is missing"))?;
                Ok(bytes.to_vec())
            }
            Source::Uri(uri) => read_uri(uri, folder)
                .map_err(|why| wrong(format!("buffer {} (from 0): {why}", buffer.index()))),
        })
        .collect()
}

fn read_uri(uri: &str, folder: Option<(&Path, FileAccess)>) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, encoded) = data
            .split_once(";base64,")
            .ok_or("data in a URI must be in base64")?;
        return STANDARD.decode(encoded).map_err(|error| error.to_string());
    }
    if uri.contains(':') {
        return Err(format!("the URI must be a relative path, got {uri:?}"));
    }
    let (folder, access) = folder.ok_or_else(|| format!("{uri:?} is another file"))?;
    let path = folder.join(decode_percent(uri));
    let named = |why: &dyn core::fmt::Display| format!("{}: {why}", path.display());
    let canonical = path.canonicalize().map_err(|error| named(&error))?;
    let own = Folder::new(folder, access);
    if access == FileAccess::WithinFolder && !own.holds(&canonical) {
        let why = "it lies outside of the folder of the glTF file; --allow-outside allows it";
        return Err(named(&why));
    }
    read_input(&canonical, MAX_ASSET_BYTES).map_err(|error| named(&error))
}

/// Replaces `%20` by a space, and so on; other text stays unchanged.
fn decode_percent(uri: &str) -> String {
    let mut parts = uri.split('%');
    let mut bytes = parts.next().unwrap_or_default().as_bytes().to_vec();
    for part in parts {
        let code = part.get(..2).map(|digits| u8::from_str_radix(digits, 16));
        if let Some(Ok(byte)) = code {
            bytes.push(byte);
            bytes.extend(&part.as_bytes()[2..]);
        } else {
            bytes.push(b'%');
            bytes.extend(part.as_bytes());
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Returns where a node stands with respect to its parent, composed in double precision.
fn local_placement(node: &Node<'_>) -> DMat4 {
    match node.transform() {
        Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => DMat4::from_scale_rotation_translation(
            DVec3::from_array(scale.map(f64::from)),
            DQuat::from_array(rotation.map(f64::from)).normalize(),
            DVec3::from_array(translation.map(f64::from)),
        ),
    }
}

/// The bytes that a vertex takes with its normal, in the file's data and in the mesh: more than the
/// corners of a triangle.
const BYTES_PER_ELEMENT: u64 = 2 * 2 * size_of::<DVec3>() as u64;

struct Reader {
    buffers: Vec<Vec<u8>>,
    /// The vertices and triangles for which memory is available.
    room: u64,
    /// The number of primitives without triangles.
    left_out: usize,
    polygons: Polygons,
}

impl Reader {
    fn add_node(&mut self, node: &Node<'_>, placement: &DMat4) -> Result<(), MeshFileError> {
        for primitive in node.mesh().into_iter().flat_map(|mesh| mesh.primitives()) {
            self.add_primitive(&primitive, placement)
                .map_err(|why| match node.mesh() {
                    Some(mesh) => wrong(format!("mesh {} (from 0): {why}", mesh.index())),
                    None => wrong(why),
                })?;
        }
        Ok(())
    }

    fn add_primitive(
        &mut self,
        primitive: &Primitive<'_>,
        placement: &DMat4,
    ) -> Result<(), String> {
        let mode = primitive.mode();
        if !matches!(
            mode,
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            self.left_out += 1;
            return Ok(());
        }
        let positions = primitive.get(&Semantic::Positions);
        let positions = self.vectors(&positions.ok_or("it has no positions")?)?;
        let normals = match primitive.get(&Semantic::Normals) {
            Some(normals) => self.vectors(&normals)?,
            None => vec![DVec3::ZERO; positions.len()],
        };
        if normals.len() != positions.len() {
            let (got, count) = (normals.len(), positions.len());
            return Err(format!("it has {got} normals for {count} vertices"));
        }
        let corners = match primitive.indices() {
            Some(indices) => self.indices(&indices, positions.len())?,
            None => (0_u32..).take(positions.len()).collect(),
        };
        // Most corners of a strip or a fan belong to three triangles.
        let uses = if mode == Mode::Triangles { 1 } else { 3 };
        self.check_room(positions.len(), corners.len().saturating_mul(uses))?;
        self.add_triangles(&triangles(mode, &corners)?, placement)?;
        self.add_vertices(&positions, &normals, placement);
        Ok(())
    }

    /// Checks that memory is available for `vertices` more vertices and `corners` more corners. A
    /// short file can ask for many, since nodes and primitives may share their data.
    fn check_room(&mut self, vertices: usize, corners: usize) -> Result<(), String> {
        let held = self.polygons.vertices.len() + self.polygons.triangles.len();
        let needed = held.saturating_add(vertices).saturating_add(corners) as u64;
        if needed > self.room {
            let room = needed.checked_next_power_of_two().unwrap_or(u64::MAX);
            check_memory(room.saturating_mul(BYTES_PER_ELEMENT))
                .map_err(|error| error.to_string())?;
            self.room = room;
        }
        Ok(())
    }

    /// Adds triangles of vertices that are added next.
    fn add_triangles(&mut self, triangles: &[[u32; 3]], placement: &DMat4) -> Result<(), String> {
        let first = u32::try_from(self.polygons.vertices.len()).map_err(|_| "it is too large")?;
        // A reflection turns triangles inside out; their corners are to run the other way.
        let reflected = placement.determinant() < 0.0;
        self.polygons.triangles.extend(triangles.iter().map(|&t| {
            let [a, b, c] = t.map(|corner| first.saturating_add(corner));
            if reflected { [a, c, b] } else { [a, b, c] }
        }));
        Ok(())
    }

    fn add_vertices(&mut self, positions: &[DVec3], normals: &[DVec3], placement: &DMat4) {
        let placed = positions.iter().map(|&v| placement.transform_point3(v));
        self.polygons.vertices.extend(placed);
        // Normals go with the inverse transpose: the cofactors, by the sign of the determinant.
        let [a, b, c] =
            [placement.x_axis, placement.y_axis, placement.z_axis].map(|v| v.truncate());
        let sign = if placement.determinant() < 0.0 {
            -1.0
        } else {
            1.0
        };
        let cofactors = sign * DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
        let placed = normals.iter().map(|&n| cofactors * n);
        self.polygons.normals.extend(placed);
    }

    fn vectors(&self, accessor: &Accessor<'_>) -> Result<Vec<DVec3>, String> {
        let kind = (accessor.data_type(), accessor.dimensions());
        if kind != (DataType::F32, Dimensions::Vec3) {
            return Err(format!("vectors must be of three floats, got {kind:?}"));
        }
        let elements = self.elements(accessor)?;
        Ok(elements
            .map(|bytes| {
                let (words, _) = bytes.as_chunks::<4>();
                let number = |axis: usize| f64::from(f32::from_le_bytes(words[axis]));
                DVec3::new(number(0), number(1), number(2))
            })
            .collect())
    }

    fn indices(&self, accessor: &Accessor<'_>, vertices: usize) -> Result<Vec<u32>, String> {
        let kind = (accessor.data_type(), accessor.dimensions());
        if !matches!(
            kind,
            (
                DataType::U8 | DataType::U16 | DataType::U32,
                Dimensions::Scalar
            )
        ) {
            return Err(format!("indices must be unsigned numbers, got {kind:?}"));
        }
        let indices = self.elements(accessor)?.map(|bytes| {
            let index = bytes
                .iter()
                .rev()
                .fold(0, |sum, &byte| sum << 8 | u32::from(byte));
            if (index as usize) < vertices {
                Ok(index)
            } else {
                Err(format!(
                    "vertex {index} is referred to, but it has {vertices}"
                ))
            }
        });
        indices.collect()
    }

    /// Returns the bytes of each element.
    fn elements(&self, accessor: &Accessor<'_>) -> Result<impl Iterator<Item = &[u8]>, String> {
        let index = accessor.index();
        if accessor.sparse().is_some() {
            return Err(format!("accessor {index} (from 0) must not be sparse"));
        }
        let bytes = accessor.view().and_then(|view| {
            let start = view.offset();
            let buffer = self.buffers.get(view.buffer().index())?;
            let bytes = buffer.get(start..start.checked_add(view.length())?)?;
            let stride = view.stride().unwrap_or(accessor.size());
            let (gaps, size) = (accessor.count().checked_sub(1)?, accessor.size());
            let length = gaps.checked_mul(stride)?.checked_add(size)?;
            let bytes = bytes.get(accessor.offset()..)?.get(..length)?;
            (stride >= size).then(|| bytes.chunks(stride).map(move |chunk| &chunk[..size]))
        });
        bytes.ok_or_else(|| format!("accessor {index} (from 0) reaches beyond its buffer"))
    }
}

/// Returns the triangles of a primitive from its corners.
fn triangles(mode: Mode, corners: &[u32]) -> Result<Cow<'_, [[u32; 3]]>, String> {
    match (mode, corners) {
        (Mode::TriangleStrip, _) => Ok(strip(corners).collect()),
        (Mode::TriangleFan, [centre, rim @ ..]) => {
            let edges = rim.windows(2);
            Ok(edges.map(|edge| [edge[0], edge[1], *centre]).collect())
        }
        _ => match corners.as_chunks::<3>() {
            (triangles, []) => Ok(triangles.into()),
            _ => {
                let got = corners.len();
                Err(format!("triangles need three corners each, got {got}"))
            }
        },
    }
}
