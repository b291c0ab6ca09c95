use tem00_testkit::robust;

use super::*;

fn valid_files() -> [(MeshFormat, Vec<u8>); 7] {
    let nodes = r#"[{ "children": [1, 2] }, { "mesh": 0, "scale": [2, 2, 2] }, { "mesh": 2 }]"#;
    [
        (MeshFormat::Obj, OBJ.as_bytes().to_vec()),
        (MeshFormat::Stl, ascii_stl().into_bytes()),
        (MeshFormat::Stl, binary_stl("exported")),
        (MeshFormat::Ply, ascii_ply().into_bytes()),
        (MeshFormat::Ply, little_ply()),
        (MeshFormat::Gltf, gltf::embedded(nodes).into_bytes()),
        (MeshFormat::Gltf, gltf::binary(nodes)),
    ]
}

#[test]
fn no_bytes_make_a_reader_panic() {
    for (format, content) in valid_files() {
        let read = |bytes: &[u8]| match read_mesh_bytes(bytes, format, 1e-3) {
            Ok(mesh) => {
                let finite = mesh.vertices().iter().all(|vertex| vertex.is_finite());
                assert!(finite, "{mesh:?}");
            }
            Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
        };
        robust(read, &[&content]);
    }
}

#[test]
fn headers_that_promise_more_than_there_is_are_soon_refused() {
    let ply =
        |elements: &str| format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n");
    let many = u64::MAX / 2;
    for (format, content) in [
        (MeshFormat::Ply, ply(&format!("element nothing {many}\n"))),
        (
            MeshFormat::Ply,
            ply(&format!("element vertex {many}\nproperty float x\n")),
        ),
        (
            MeshFormat::Ply,
            ply("element face 1\nproperty list uint int vertex_indices\n") + "\x7f\x7f\x7f\x7f",
        ),
        (MeshFormat::Stl, " ".repeat(80) + "\x7f\x7f\x7f\x7f"),
        (
            MeshFormat::Gltf,
            "glTF\x02\0\0\0\x7f\x7f\x7f\x7f".to_owned(),
        ),
    ] {
        let error = read_mesh_bytes(content.as_bytes(), format, 1.0).unwrap_err();
        assert!(!error.to_string().is_empty(), "{content:?}");
    }
}
