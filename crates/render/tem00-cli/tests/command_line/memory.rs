//! Want of memory is an error in words, never the end of the process by the system.

use std::{
    fmt::Write,
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

use super::{SCENE, assert_code, done, folder, hostile::with_mesh, message, text, write};

/// Runs the program with so many kibibytes of addresses.
fn within(kibibytes: u32, folder: &Path, line: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_tem00");
    Command::new("sh")
        .current_dir(folder)
        .args([
            "-c",
            &format!("ulimit -v {kibibytes} && exec {program} {line}"),
        ])
        .stdin(Stdio::null())
        .output()
        .expect("a shell")
}

/// Asserts that the program ends by itself, whatever memory it has, and that much is enough.
#[track_caller]
fn assert_ends(folder: &Path, line: &str, limits: impl Iterator<Item = u32>) {
    let [mut refused, mut ended] = [0, 0];
    for kibibytes in limits {
        let output = within(kibibytes, folder, line);
        let told = text(&output.stderr);
        match output.status.code() {
            Some(0) => ended += 1,
            Some(1 | 2) => {
                refused += 1;
                let words = ["memory", "threads", "listen for Ctrl-C"];
                let named = words.iter().any(|word| told.contains(word));
                assert!(named, "{line} in {kibibytes} KiB: {told}");
            }
            code => panic!("{line} in {kibibytes} KiB: {code:?}, {told}"),
        }
    }
    assert!(refused > 0, "{line} was never refused");
    // More threads than those of two cores need more memory.
    if ended == 0 {
        done(folder, line);
    }
}

#[test]
fn a_large_pattern_in_little_memory_is_refused_in_words() {
    let folder = folder();
    let output = within(300_000, folder.path(), "pattern -o a.png --size 4096");
    assert_code(&output, 2);
    let said = message(&output);
    assert!(said.contains("MiB of memory are needed"), "{said}");
    assert!(said.contains("4096 × 4096"), "{said}");
}

#[test]
fn commands_end_by_themselves_in_any_memory() {
    let folder = folder();
    let path = folder.path();
    for end in ["npy", "png", "exr"] {
        done(path, &format!("pattern -o in.{end} --size 768"));
    }
    let scene = SCENE
        .replace("[48, 40]", "[600, 450]")
        .replace("samples_per_pixel = 4", "samples_per_pixel = 1");
    fs::write(path.join("a.toml"), scene).expect("written");
    let limits = |end: u32| (1..=6).map(move |step| end * step / 6);
    for (line, end) in [
        ("pattern -o a.npy --size 768", 360_000),
        ("pattern -o a.exr --size 768 --amplitude", 360_000),
        ("stats in.npy", 480_000),
        ("stats in.png", 480_000),
        ("stats in.exr", 480_000),
        ("render a.toml", 480_000),
    ] {
        assert_ends(path, line, limits(end));
    }
}

/// A chunk of a PNG file, with the check sum of its annex D.
fn chunk(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let body = [&kind[..], content].concat();
    let sum = body.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            (sum >> 1) ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 }
        })
    });
    let length = u32::try_from(content.len()).expect("short");
    [&length.to_be_bytes()[..], &body, &(!sum).to_be_bytes()].concat()
}

/// An interlaced PNG file of 16384 × 16384 pixels that has but so many bytes of content.
fn bomb(depth: u8, colour: u8, content: usize) -> Vec<u8> {
    let side = (1_u32 << 14).to_be_bytes();
    let header = [&side[..], &side, &[depth, colour, 0, 0, 1]].concat();
    [
        b"\x89PNG\r\n\x1a\n".to_vec(),
        chunk(b"IHDR", &header),
        chunk(b"IDAT", &vec![0; content]),
        chunk(b"IEND", &[]),
    ]
    .concat()
}

#[test]
fn files_that_claim_more_than_they_hold_take_no_memory() {
    let folder = folder();
    let path = folder.path();
    let write = |name: &str, content: &[u8]| fs::write(path.join(name), content).expect("written");
    write("rgba.png", &bomb(16, 6, 1_900));
    // One bit per pixel, which a longer file could hold.
    write("bits.png", &bomb(1, 0, 40_000));
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (16384, 16384), }";
    let length = u16::try_from(header.len()).expect("short");
    let start = [&b"\x93NUMPY\x01\x00"[..], &length.to_le_bytes()].concat();
    write("a.npy", &[&start, header.as_bytes()].concat());
    for (line, part) in [
        ("stats rgba.png", "cannot hold"),
        ("stats bits.png", "MiB of memory are needed"),
        ("stats a.npy", "MiB of memory are needed"),
    ] {
        let output = within(600_000, path, line);
        assert_code(&output, 2);
        let said = message(&output);
        assert!(said.contains(part), "{line}: {said}");
    }
}

#[test]
fn nodes_that_share_their_data_take_no_more_memory_than_there_is() {
    let folder = folder();
    let path = folder.path();
    // 1000 triangles, which 100 000 nodes show: 14 GB of vertices with their normals.
    fs::write(path.join("a.bin"), vec![0; 36_000]).expect("written");
    let (mut nodes, mut indices) = (String::new(), String::new());
    for index in 0..100_000 {
        let comma = if index > 0 { "," } else { "" };
        write!(nodes, "{comma}{{\"mesh\":0}}").expect("memory");
        write!(indices, "{comma}{index}").expect("memory");
    }
    let gltf = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [{indices}]}}],
        "nodes": [{nodes}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3000, "type": "VEC3",
        "min": [0, 0, 0], "max": [0, 0, 0]}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36000}}],
        "buffers": [{{"byteLength": 36000, "uri": "a.bin"}}]}}"#
    );
    fs::write(path.join("a.gltf"), gltf).expect("written");
    write(path, "a.toml", with_mesh("a.gltf"));
    let output = within(2_000_000, path, "render a.toml");
    assert_code(&output, 2);
    let said = message(&output);
    assert!(said.contains("MiB of memory are needed"), "{said}");
}
