use proptest::{collection::vec, prelude::*};

use super::*;

fn valid_files() -> [(MeshFormat, Vec<u8>); 7] {
    let nodes = r#"[{ "children": [1, 2] }, { "mesh": 0, "scale": [2, 2, 2] }, { "mesh": 2 }]"#;
    let ply = binary_ply(
        "binary_little_endian",
        f64::to_le_bytes,
        u32::to_le_bytes,
        u16::to_le_bytes,
    );
    [
        (MeshFormat::Obj, OBJ.as_bytes().to_vec()),
        (MeshFormat::Stl, ascii_stl().into_bytes()),
        (MeshFormat::Stl, binary_stl("exported")),
        (MeshFormat::Ply, ascii_ply().into_bytes()),
        (MeshFormat::Ply, ply),
        (MeshFormat::Gltf, gltf::embedded(nodes).into_bytes()),
        (MeshFormat::Gltf, gltf::binary(nodes)),
    ]
}

fn check(content: &[u8], format: MeshFormat) -> Result<(), TestCaseError> {
    match read_mesh_bytes(content, format, 1e-3) {
        Ok(mesh) => {
            let finite = mesh.vertices().iter().all(|vertex| vertex.is_finite());
            prop_assert!(finite, "{mesh:?}");
        }
        Err(error) => prop_assert!(!error.to_string().contains('\n'), "{error}"),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn damaged_files_are_errors_or_meshes_but_never_a_panic(
        kind in 0_usize..7,
        damage in vec((any::<prop::sample::Index>(), any::<u8>()), 0..8),
        patch in (any::<prop::sample::Index>(), 0_usize..8, "[-0-9e/.]{0,12}"),
        length in any::<prop::sample::Index>(),
    ) {
        let (format, mut content) = valid_files()[kind].clone();
        for (place, byte) in damage {
            let place = place.index(content.len());
            content[place] = byte;
        }
        let (start, replaced, patch) = patch;
        let start = start.index(content.len());
        let end = content.len().min(start + replaced);
        content.splice(start..end, patch.bytes());
        if length.index(4) == 0 {
            content.truncate(length.index(content.len()));
        }
        check(&content, format)?;
    }

    #[test]
    fn any_bytes_are_errors_or_meshes_but_never_a_panic(
        kind in 0_usize..7,
        content in vec(any::<u8>(), 0..300),
    ) {
        check(&content, valid_files()[kind].0)?;
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
