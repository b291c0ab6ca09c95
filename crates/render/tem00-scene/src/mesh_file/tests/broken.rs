//! Files that break the rules of their format, and what is said about them.

use super::*;

#[test]
fn broken_obj_files_are_explained() {
    let table = r#"
        => the mesh has no triangles
        v 0 0 0\nv 1 0 0\nv 0 1 0\n => the mesh has no triangles
        v 0 0 0\nv 1 zero 0\n => line 2: a coordinate must be a number, got "zero"
        v 0 0\n => line 1: a vertex needs three coordinates
        v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n => vertex 0 (from 0) must be finite, got [0, 0, NaN]
        v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n => line 5: the face refers to vertex 4, but the file has 3
        v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n => line 4: a corner must start with a vertex number, from 1 up or from -1 down to -3, got "-4"
        v 0 0 0\nf 0 1 1\n => line 2: a corner must start with a vertex number, from 1 up or from -1 down to -1, got "0"
        f 99999999999 1 1\n => line 1: a corner must start with a vertex number, from 1 up or from -1 down to -0, got "99999999999"
        v 0 0 0\nv 1 0 0\nf 1 2\n => the mesh has no triangles; left out: 1 face without area
        v 0 0 0\nv 1 0 0\nf 1 2 1\n => none of the mesh's 1 triangles has an area
    "#;
    for [content, expected] in rows(table) {
        assert_eq!(complaint("broken.obj", &content), expected, "{content:?}");
    }
}

/// Asserts what is said about a file in which one thing is replaced: each row has that, the
/// replacement and how the message begins.
#[track_caller]
pub(super) fn assert_broken(name: &str, text: &str, table: &str) {
    for [from, to, expected] in rows(table) {
        assert!(text.contains(&from), "{from} is there to be replaced");
        let got = complaint(name, text.replacen(&from, &to, 1));
        assert!(got.starts_with(&expected), "{got:?} is not {expected:?}");
        assert!(!got.contains('\n'), "one line: {got:?}");
    }
}

#[test]
fn broken_stl_files_are_explained() {
    let table = r#"
        vertex -1e0 => vertex one => line 4: a coordinate must be a number, got "one"
        outer => inner => line 3: expected solid, facet, outer, vertex, endloop, endfacet or endsolid, got "inner"
        endsolid pyramid => endsolid pyramid\nsolid more => line 45: the file ends before "endsolid"
        endsolid pyramid =>  => line 44: the file ends before "endsolid"
        vertex -1e0 -1e0 0e0\n =>  => line 7: a facet needs three vertices, got 2
    "#;
    assert_broken("broken.stl", &ascii_stl(), table);
    let mut cut = binary_stl("cut");
    cut.truncate(200);
    let mut nan = binary_stl("nan");
    nan[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    for (content, expected) in [
        (
            Vec::new(),
            "an STL file begins with \"solid\" or with a header of 84 bytes",
        ),
        (b"solid\nendsolid\n".into(), "the mesh has no triangles"),
        (
            cut,
            "the STL header announces 384 bytes, but the file has 200",
        ),
        (
            nan,
            "vertex 0 (from 0) must be finite, got [NaN, -0.001, 0]",
        ),
    ] {
        assert_eq!(complaint("broken.stl", content), expected);
    }
}

#[test]
fn broken_ply_files_are_explained() {
    let table = r#"
        ply => plough => a PLY file begins with the line "ply"
        end_header => end => the PLY header has no end: "end_header" is missing
        format ascii 1.0\n =>  => the PLY header needs a format, such as "format ascii 1.0"
        float x => floating x => line 5: this does not belong into a PLY header: "property floating x"
        0.25 => 0,25 => line 18: vertex needs x, y, z, red, got "0,25 -0.125 1.5 255"
        4 0 3 2 1 => 4 0 3 2 => line 20: face needs vertex_indices, got "4 0 3 2"
        3 3 0 4\n =>  => the file ends within face 4 (from 0) of 5
        3 3 0 4 => 3 3 0 5 => face 4 (from 0) refers to vertex 5, but the file has 5
        3 3 0 4 => 3 3 0 -1 => face 4 (from 0) refers to vertex -1
        float z => float w => the element vertex needs the numbers x, y and z, got "x, y, w, red"
        0.25 => nan => vertex 4 (from 0) must be finite, got [NaN, -0.000125, 0.0015]
        int vertex_indices => int polygon => the element face needs a list of whole numbers, vertex_indices or vertex_index, got "polygon"
        int vertex_indices => float vertex_indices => the element face needs a list of whole numbers, vertex_indices or vertex_index, got "vertex_indices"
    "#;
    assert_broken("broken.ply", &ascii_ply(), table);
    let empty = "a PLY file begins with the line \"ply\"";
    assert_eq!(complaint("empty.ply", ""), empty);
}

#[test]
fn not_a_number_in_a_binary_ply_file_is_found() {
    let content = binary_ply(
        "binary_little_endian",
        |c| if c > 1.2 { f64::NAN } else { c },
    );
    let expected = "vertex 4 (from 0) must be finite, got [0.00025, -0.000125, NaN]";
    assert_eq!(complaint("nan.ply", &content), expected, "NaN");
    let cut = &content[..content.len() - 3];
    let expected = "the file ends within face 4 (from 0) of 5";
    assert_eq!(complaint("cut.ply", cut), expected);
}

#[test]
fn other_errors_are_explained() {
    for scale in [0.0, -1e-3, f64::NAN] {
        let error = read_mesh("pyramid.obj".as_ref(), scale).unwrap_err();
        let expected = "pyramid.obj: scale must be positive and finite, in metres per unit, got ";
        assert!(error.to_string().starts_with(expected), "{error}");
    }
    for (name, extension) in [("pyramid.3MF", ".3mf"), ("pyramid", "")] {
        let expected =
            format!("mesh format must be .obj, .ply, .stl, .gltf or .glb, got {extension:?}");
        assert_eq!(complaint(name, ""), expected, "{name}");
    }
    let missing = read_mesh("no/such/mesh.ply".as_ref(), 1.0).unwrap_err();
    assert!(missing.is_unreadable(), "{missing:?}");
    assert!(
        missing.to_string().starts_with("no/such/mesh.ply: "),
        "{missing}"
    );
}
