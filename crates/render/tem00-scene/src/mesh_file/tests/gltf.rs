use base64::{Engine as _, engine::general_purpose::STANDARD};

use glam::DQuat;

use super::{broken::assert_broken, *};

/// A buffer of the pyramid's vertices (offset 0), the corners of its sides (60, bytes) and of its
/// base (72, shorts), and one normal for each vertex (84).
pub(super) fn pyramid_buffer() -> Vec<u8> {
    let mut bytes = VERTICES
        .as_flattened()
        .iter()
        .flat_map(|c| c.to_le_bytes())
        .collect::<Vec<_>>();
    bytes.extend(SIDES.iter().flatten().map(|&c| u8::try_from(c).unwrap()));
    let base: [u16; 6] = [0, 3, 2, 0, 2, 1];
    bytes.extend(base.iter().flat_map(|c| c.to_le_bytes()));
    let normals = [[0.0_f32, 0.6, 0.8]; 5];
    bytes.extend(normals.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
    bytes
}

/// The base and the sides as two meshes of one buffer, in nodes that the caller gives.
fn document(nodes: &str, buffer: &str) -> String {
    format!(
        r#"{{
    "asset": {{ "version": "2.0" }},
    "scene": 0,
    "scenes": [{{ "nodes": [0] }}],
    "nodes": {nodes},
    "meshes": [
        {{ "primitives": [{{ "attributes": {{ "POSITION": 0 }}, "indices": 2 }}] }},
        {{ "primitives": [{{ "attributes": {{ "POSITION": 0 }}, "indices": 1, "mode": 4 }}] }},
        {{ "primitives": [{{ "attributes": {{ "POSITION": 0, "NORMAL": 3 }}, "indices": 1 }}] }}
    ],
    "accessors": [
        {{ "bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3",
           "min": [-1, -1, 0], "max": [1, 1, 1.5] }},
        {{ "bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR" }},
        {{ "bufferView": 1, "byteOffset": 12, "componentType": 5123, "count": 6, "type": "SCALAR" }},
        {{ "bufferView": 2, "byteOffset": 0, "componentType": 5126, "count": 5, "type": "VEC3" }}
    ],
    "bufferViews": [
        {{ "buffer": 0, "byteLength": 60 }},
        {{ "buffer": 0, "byteOffset": 60, "byteLength": 24 }},
        {{ "buffer": 0, "byteOffset": 84, "byteLength": 60 }}
    ],
    "buffers": [{{ {buffer} "byteLength": 144 }}]
}}"#
    )
}

pub(super) const PLAIN: &str = r#"[{ "children": [1, 2] }, { "mesh": 0 }, { "mesh": 1 }]"#;

pub(super) fn embedded(nodes: &str) -> String {
    let data = STANDARD.encode(pyramid_buffer());
    let uri = format!(r#""uri": "data:application/octet-stream;base64,{data}","#);
    document(nodes, &uri)
}

pub(super) fn binary(nodes: &str) -> Vec<u8> {
    let mut json = document(nodes, "").into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let buffer = pyramid_buffer();
    let word = |length: usize| u32::try_from(length).unwrap().to_le_bytes();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(word(12 + 8 + json.len() + 8 + buffer.len()));
    bytes.extend(word(json.len()));
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend(word(buffer.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(buffer);
    bytes
}

/// The sides of the pyramid, their corners taken otherwise than three by three.
pub(super) fn with_mode(mode: u8) -> String {
    embedded(r#"[{ "mesh": 1 }]"#).replace("\"mode\": 4", &format!("\"mode\": {mode}"))
}

fn triangles_of(nodes: &str) -> Vec<[DVec3; 3]> {
    triangle_corners(&read("nodes.gltf", embedded(nodes)).0.unwrap())
}

#[test]
fn text_and_binary_files_give_the_same_triangles() {
    for (name, content) in [
        ("embedded.gltf", embedded(PLAIN).into_bytes()),
        ("binary.GLB", binary(PLAIN)),
    ] {
        let mesh = read(name, content).0.unwrap();
        assert_eq!(triangle_corners(&mesh), pyramid(), "{name}");
        assert!(mesh.normals().is_empty(), "{name} has no normals");
    }
}

#[test]
fn data_in_another_file_is_found_beside_the_first() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("the data.bin"), pyramid_buffer()).unwrap();
    let text = document(PLAIN, r#""uri": "the%20data.bin","#);
    let path = folder.path().join("split.gltf");
    fs::write(&path, &text).unwrap();
    let mesh = read_mesh(&path, 1e-3).unwrap();
    assert_eq!(triangle_corners(&mesh), pyramid(), "two files");

    let error = read_mesh_bytes(text.as_bytes(), MeshFormat::Gltf, 1e-3).unwrap_err();
    let expected = "buffer 0 (from 0): \"the%20data.bin\" is another file";
    assert_eq!(error.to_string(), expected, "bytes have no folder");
}

#[test]
fn nodes_move_what_they_hold() {
    // Powers of two and a quarter turn by matrix are exact in every precision.
    let nodes = r#"[
        { "translation": [4, 0, 0], "children": [1] },
        { "scale": [2, 2, 2], "children": [2, 3] },
        { "mesh": 0 },
        { "mesh": 1, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 8, 1] }
    ]"#;
    let upright = |v: DVec3| 2.0 * v + DVec3::new(4e-3, 0.0, 0.0);
    let turned = |v: DVec3| upright(DVec3::new(-v.y, v.x, v.z + 8e-3));
    let [base, sides] = [&pyramid()[..2], &pyramid()[2..]].map(<[_]>::to_vec);
    let base = base.into_iter().map(|t| t.map(upright));
    let expected: Vec<_> = base
        .chain(sides.into_iter().map(|t| t.map(turned)))
        .collect();
    let got = triangles_of(nodes);
    for (got, expected) in got.as_flattened().iter().zip(expected.as_flattened()) {
        // Two roundings of numbers below 0.03.
        assert!((got - expected).length() < 1e-17, "{got} is not {expected}");
    }
    assert_eq!(got.len(), expected.len(), "all triangles");
}

#[test]
fn rotations_are_kept_in_double_precision() {
    let nodes = r#"[{ "mesh": 1, "rotation": [0, 0, 0.25881904, 0.96592582] }]"#;
    let got = triangles_of(nodes);
    // Thirty degrees about z. Single precision of the quaternion is what remains: 6e-8 of 1.8e-3 m,
    // and its length counts for nothing.
    for (got, original) in got.as_flattened().iter().zip(pyramid()[2..].as_flattened()) {
        let farther = got.length() - original.length();
        assert!(farther.abs() < 1e-18, "{got} is as far away as {original}");
        let expected = DQuat::from_rotation_z(30_f64.to_radians()) * *original;
        assert!((got - expected).length() < 1e-10, "{got} is not {expected}");
    }
}

#[test]
fn what_a_mirror_image_has_outside_stays_outside() {
    let nodes = r#"[{ "scale": [-1, 1, 1], "children": [1, 2] }, { "mesh": 0 }, { "mesh": 1 }]"#;
    for [a, b, c] in triangles_of(nodes) {
        let outwards = (b - a).cross(c - a);
        let inside = DVec3::new(0.0, 0.0, 0.5e-3);
        assert!(outwards.dot(a - inside) > 0.0, "{a} {b} {c} faces outwards");
    }
}

#[test]
fn normals_turn_with_their_surface() {
    // A normal (0, 0.6, 0.8) belongs to the tangents (1, 0, 0) and (0, 0.8, −0.6).
    let shear = r#""matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"#;
    for (node, tangent) in [
        (r#""scale": [1, 2, 4]"#, DVec3::new(0.0, 1.6, -2.4)),
        (r#""scale": [1, 2, -4]"#, DVec3::new(0.0, 1.6, 2.4)),
        (shear, DVec3::new(0.4, 0.8, -0.6)),
    ] {
        let text = embedded(&format!("[{{ \"mesh\": 2, {node} }}]"));
        let mesh = read("normals.gltf", text).0.unwrap();
        assert_eq!(mesh.normals().len(), 5, "{node}: one for each vertex");
        for normal in mesh.normals() {
            // 0.6 and 0.8 are in single precision in the file.
            assert!(normal.x.abs() < 1e-7, "{node}: {normal}");
            assert!(normal.dot(tangent).abs() < 1e-6, "{node}: {normal}");
            let upwards = if node.contains('-') { -1.0 } else { 1.0 };
            assert!(normal.z * upwards > 0.0, "{node}: {normal}");
        }
    }
}

#[test]
fn meshes_without_normals_share_a_file_with_others() {
    let text = embedded(r#"[{ "children": [1, 2] }, { "mesh": 0 }, { "mesh": 2 }]"#);
    let mesh = read("both.gltf", text).0.unwrap();
    assert_eq!(mesh.normals()[..5], [DVec3::ZERO; 5], "none");
    assert!(mesh.normals()[5..].iter().all(|n| n.z > 0.7), "given");
}

#[test]
fn broken_gltf_files_are_explained() {
    let table = r#"
        "scene": 0,\n => "extensionsRequired": ["KHR_draco_mesh_compression"], => the file requires "KHR_draco_mesh_compression", an extension that is not read
        "count": 12 => "count": 11 => mesh 1 (from 0): triangles need three corners each, got 11
        "count": 12 => "count": 60 => mesh 1 (from 0): accessor 1 (from 0) reaches beyond its buffer
        "count": 12 => "count": 18446744073709551615 => mesh 1 (from 0): accessor 1 (from 0) reaches beyond its buffer
        "count": 12 => "count": 0 => mesh 1 (from 0): accessor 1 (from 0) reaches beyond its buffer
        5121 => 5126 => mesh 1 (from 0): indices must be unsigned numbers, got (F32, Scalar)
        [1, 2] => [1, 1] => node 1 (from 0) has two parents
        { "mesh": 1 } => { "mesh": 1, "children": [0] } => node 0 (from 0) has two parents
        "POSITION": 0 => "POSITION": 4 => positions are in accessor 4 (from 0), but the file has 4
        "scenes": [{ "nodes": [0] }], =>  => scene: index out of bounds
        data:application/octet-stream;base64, => https://example.org/ => buffer 0 (from 0): the URI must be a relative path, got "https://example.org/
        base64,AACAvw => base64,A => buffer 0 (from 0): Invalid padding
    "#;
    assert_broken("broken.gltf", &embedded(PLAIN), table);
    // A length that is shorter than the header.
    let told = complaint("cut.glb", b"glTF\x02\0\0\0\x04\0\0\0");
    assert_eq!(told, "the glTF header is cut off");
    for content in [&b"glTF\x02\0\0\0\xff\xff\0\0"[..], b"", b"{}", b"[["] {
        let got = complaint("cut.gltf", content);
        assert!(!got.is_empty() && !got.contains('\n'), "{got:?}");
    }
}

#[test]
fn a_long_chain_of_nodes_is_followed() {
    const NODES: usize = 100_000;
    let node = |child| format!("{{ \"children\": [{child}] }}, ");
    let chain: String = (1..NODES).map(node).collect();
    let nodes = format!("[{chain}{{ \"mesh\": 1 }}]");
    assert_eq!(triangles_of(&nodes), pyramid()[2..], "the end of the chain");
}
