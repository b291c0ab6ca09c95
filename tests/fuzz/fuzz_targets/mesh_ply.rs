//! Any bytes are a mesh of finite vertices or an error of one line.

#![no_main]

use libfuzzer_sys::fuzz_target;
use tem00_scene::{MeshFormat, read_mesh_bytes};

fuzz_target!(|content: &[u8]| {
    match read_mesh_bytes(content, MeshFormat::Ply, 1e-3) {
        Ok(mesh) => assert!(mesh.vertices().iter().all(|vertex| vertex.is_finite())),
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
});
