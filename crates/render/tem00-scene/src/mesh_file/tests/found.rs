//! Files as other programs write them.

use super::gltf::{PLAIN, embedded, with_mode};
use super::*;

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Ends the lines of the header of a binary file otherwise.
fn with_line_ends(file: &[u8], end: &str) -> Vec<u8> {
    let marker = b"end_header\n";
    let at = file.windows(marker.len()).position(|part| part == marker);
    let (header, body) = file.split_at(at.unwrap() + marker.len());
    let header = String::from_utf8(header.to_vec()).unwrap();
    [header.replace('\n', end).as_bytes(), body].concat()
}

#[test]
fn a_byte_order_mark_is_no_part_of_a_text() {
    for (name, content) in [
        ("a.obj", OBJ.as_bytes().to_vec()),
        ("first.obj", OBJ[OBJ.find("v -1").unwrap()..].into()),
        ("a.ply", ascii_ply().into_bytes()),
        ("binary.ply", little_ply()),
        ("a.stl", ascii_stl().into_bytes()),
    ] {
        assert_pyramid(name, [BYTE_ORDER_MARK, &content].concat());
    }
    let text = embedded(PLAIN);
    let mesh = read("a.gltf", [BYTE_ORDER_MARK, text.as_bytes()].concat());
    assert_eq!(triangle_corners(&mesh.0.unwrap()), pyramid());
    let wide: Vec<u8> = OBJ.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let told = complaint("wide.obj", [&b"\xff\xfe"[..], &wide].concat());
    assert_eq!(told, "the text is in UTF-16: save it in UTF-8");
}

#[test]
fn text_and_binary_stl_are_told_apart_by_content_and_length() {
    assert_pyramid("upper.stl", ascii_stl().to_uppercase());
    let mixed = ascii_stl().replace("solid", "Solid");
    assert_pyramid("mixed.stl", mixed.replace("facet", "Facet"));
    assert_pyramid("indented.stl", format!("\r\n  {}", ascii_stl()));
    assert_pyramid("named.stl", ascii_stl().replace("pyramid", "穿山甲"));
    for header in [
        "solid part",
        "SOLID PART",
        "solid\nfacet normal 0 0 1\n",
        "",
    ] {
        let file = binary_stl(header);
        assert_pyramid("binary.stl", &file);
        for tail in [1, 4, 1000] {
            let longer = [&file[..], &vec![7; tail]].concat();
            let (mesh, notes) = mesh_and_notes(&longer, MeshFormat::Stl).unwrap();
            assert_eq!(triangle_corners(&mesh).len(), 6, "{header:?}, {tail}");
            let bytes = if tail == 1 { "byte" } else { "bytes" };
            let expected = format!("left out: {tail} {bytes} behind the last triangle");
            assert_eq!(notes, [expected]);
        }
    }
    let told = complaint("text.stl", "facet\n".repeat(100));
    let expected = "an STL file begins with \"solid\" or with a header of 84 bytes";
    assert_eq!(told, expected, "no number of triangles");
}

#[test]
fn blank_lines_and_line_ends_of_ply_files_do_not_matter() {
    let text = ascii_ply();
    let edits = r"
        element vertex => \n \t\nelement vertex
        end_header\n => end_header\n\n\n
        7\n4 0 => 7\n\n4 0
        3 3 0 4\n => 3 3 0 4\n\n\n
        \n => \r\n
        \n => \r
        element =>   element\t
        255\n => 255  \n
        0.25 -0.125 1.5 => .25 -.125 +1.5E0
    ";
    for [from, to] in rows(edits) {
        let to = to.replace("\\t", "\t").replace("\\r", "\r");
        assert_pyramid("edited.ply", text.replace(&from, &to));
    }
    for end in ["\r\n", "\r"] {
        assert_pyramid("binary.ply", with_line_ends(&little_ply(), end));
    }
    // A first coordinate whose first byte is a line feed, with all three ends of lines.
    let first = f64::from_le_bytes(*b"\n\r\n\r\n\r\xf0\x3f");
    let mut odd = little_ply();
    let at = odd.len() - 5 * 25 - 4 - (2 + 16) - 4 * (2 + 12);
    odd[at..at + 8].copy_from_slice(&first.to_le_bytes());
    for end in ["\n", "\r\n", "\r"] {
        let mesh = read("odd.ply", with_line_ends(&odd, end)).0.unwrap();
        let [x, expected] = [mesh.vertices()[0].x, first * 1e-3].map(f64::to_bits);
        assert_eq!(x, expected, "{end:?}");
    }
}

#[test]
fn triangle_strips_are_triangles() {
    // The sides of the pyramid and a half of its base, in strips.
    let strips = [
        0, 1, 4, 2, -1, 3, 4, 2, -1, -1, 3, 0, 4, -1, 0, 3, 2, -1, 1, 2,
    ];
    let expected = [[0, 1, 4], [1, 2, 4], [3, 4, 2], [3, 0, 4], [0, 3, 2]];
    for format in ["ascii", "binary_little_endian"] {
        let mut file = format!(
            "ply\nformat {format} 1.0\nelement vertex 5\nproperty float x\nproperty float y\n\
             property float z\nelement tristrips 1\nproperty list int int vertex_indices\n\
             end_header\n"
        )
        .into_bytes();
        let list: Vec<i32> = core::iter::once(20).chain(strips).collect();
        if format == "ascii" {
            for [x, y, z] in VERTICES {
                file.extend(format!("{x} {y} {z}\n").bytes());
            }
            let words: Vec<String> = list.iter().map(i32::to_string).collect();
            file.extend(words.join(" ").bytes());
        } else {
            file.extend(VERTICES.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
            file.extend(list.iter().flat_map(|i| i.to_le_bytes()));
        }
        let mesh = read_mesh_bytes(&file, MeshFormat::Ply, 1.0).unwrap();
        for (&[a, b, c], expected) in mesh.triangles().iter().zip(expected) {
            let turned = [[a, b, c], [b, c, a], [c, a, b]];
            assert!(turned.contains(&expected), "{format}: {expected:?}");
        }
        assert_eq!(mesh.triangles().len(), 5, "{format}");
    }
    let broken = ascii_ply()
        .replace("element face", "element tristrips")
        .replace("3 1 2 4", "3 1 -2 4");
    let expected = "tristrips 2 (from 0) refers to vertex -2";
    assert_eq!(complaint("broken.ply", broken), expected);
}

#[test]
fn strips_and_fans_of_gltf_are_triangles() {
    // As text_and_binary_files_give_the_same_triangles, but for the first and the last corners of
    // twelve.
    let corners = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
    let triangle = |[a, b, c]: [usize; 3]| [corners[a], corners[b], corners[c]];
    let strip = |i: usize| {
        triangle(if i.is_multiple_of(2) {
            [i, i + 1, i + 2]
        } else {
            [i, i + 2, i + 1]
        })
    };
    let fan = |i: usize| triangle([i + 1, i + 2, 0]);
    for (mode, expected) in [
        (5, (0..10).map(strip).collect::<Vec<[u32; 3]>>()),
        (6, (0..10).map(fan).collect()),
    ] {
        let mesh = read_mesh_bytes(with_mode(mode).as_bytes(), MeshFormat::Gltf, 1.0).unwrap();
        // Triangles with a corner twice have no area.
        let has_area = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        let expected: Vec<_> = expected.into_iter().filter(has_area).collect();
        assert_eq!(mesh.triangles(), expected, "mode {mode}");
    }
}

#[test]
fn what_is_left_out_is_said() {
    let plate = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    for (faces, expected) in [
        ("f 1 2 3 4\nl 1 2 3\np 1 2\n", "2 points, lines and curves"),
        ("f 1 2 3 4\nf 1 2\nf 3\nf\n", "3 faces without area"),
        ("f 1 2 3 4\nf 1 1 2\nf 4 2 4 2 4\n", "2 faces without area"),
        (
            "vn nan 0 0\nvn 0 0 1\nf 1//1 2//2 3//2 4//0\n",
            "1 normal that is not finite",
        ),
        ("f 1 2 3 4\n", ""),
    ] {
        let content = format!("{plate}{faces}");
        let (mesh, notes) = mesh_and_notes(content.as_bytes(), MeshFormat::Obj).unwrap();
        let expected = (!expected.is_empty()).then(|| format!("left out: {expected}"));
        assert_eq!(notes, Vec::from_iter(expected), "{content}");
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]], "{content}");
    }
    let primitive = |mode| format!(r#"{{ "attributes": {{ "POSITION": 0 }}, "mode": {mode} }}"#);
    let with_others = format!("\"indices\": 1 }}, {}, {}", primitive(0), primitive(3));
    let two_corners = ascii_ply().replace("element edge 1\nproperty int start\n", "");
    let two_corners = two_corners.replace("7\n", "").replace("3 3 0 4", "2 3 0");
    let flat = ascii_stl().replacen("2.5e-1 -1.25e-1 1.5e0", "-1e0 -1e0 0e0", 1);
    let lines = embedded(PLAIN).replace("\"indices\": 1, \"mode\": 4 }", &with_others);
    let (entry, face) = (
        "left out: 1 entry other than vertex, face and triangle strip",
        "left out: 1 face without area",
    );
    for (format, content, expected) in [
        (MeshFormat::Ply, ascii_ply(), entry),
        (MeshFormat::Ply, two_corners, face),
        (MeshFormat::Stl, flat, face),
        (
            MeshFormat::Gltf,
            lines,
            "left out: 2 primitives of points or lines",
        ),
    ] {
        let (_, notes) = mesh_and_notes(content.as_bytes(), format).unwrap();
        assert_eq!(notes, [expected], "{format:?}");
    }
    let lines = "the mesh has no triangles; left out: 1 point, line or curve";
    assert_eq!(complaint("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), lines);
    let primitives = "the mesh has no triangles; left out: 1 primitive of points or lines";
    assert_eq!(complaint("lines.gltf", with_mode(2)), primitives);
}

#[test]
fn a_normal_that_is_no_number_or_zero_is_none() {
    let none = "nan nan nan|0 0 0|nan(ind) 0 1|-nan(ind) 0 1|-1.#IND 0 0|1.#QNAN0 0 0|0 inf 0";
    for bad in none.split('|') {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn {bad}\nvn 0 0 1\nf 1//1 2//2 3//2\n");
        let mesh = read_mesh_bytes(text.as_bytes(), MeshFormat::Obj, 1.0).unwrap();
        assert_eq!(mesh.normals(), [DVec3::ZERO, DVec3::Z, DVec3::Z], "{bad}");
        let none = read_mesh_bytes(text.replace("//2", "//1").as_bytes(), MeshFormat::Obj, 1.0);
        assert_eq!(none.unwrap().normals(), [DVec3::ZERO; 0], "{bad}: all flat");
    }
    let header = ply_header("ascii", "float", "uchar int vertex_indices");
    let header = header.replace(
        "property uchar red",
        "property float nx\nproperty float ny\nproperty float nz",
    );
    let normals =
        "0 0 1 nan nan nan\n1 0 1 0 0 0\n0 1 1 0 0 2\n1 1 1 -nan 0 0\nnan nan nan 0 0 1\n";
    let content = format!("{header}{normals}0\n").replace("face 5", "face 1") + "4 0 1 3 2\n";
    let mesh = read_mesh_bytes(content.as_bytes(), MeshFormat::Ply, 1.0).unwrap();
    let zero = DVec3::ZERO;
    assert_eq!(mesh.normals(), [zero, zero, DVec3::Z, zero, DVec3::Z]);
}

#[test]
fn vertices_that_no_face_uses_may_be_anything() {
    let plate = "v 0 0 1\nv 1 0 1\nv 0 1 1\nv nan inf 7\nv 1e999 0 0\nf 1 2 3\n";
    let mesh = read_mesh_bytes(plate.as_bytes(), MeshFormat::Obj, 1e100).unwrap();
    assert_eq!(mesh.triangles(), [[0, 1, 2]]);
    assert!(
        mesh.vertices().iter().all(|vertex| vertex.is_finite()),
        "{mesh:?}"
    );
    let used = plate.replace("f 1 2 3", "f 1 2 4");
    let error = read_mesh_bytes(used.as_bytes(), MeshFormat::Obj, 1.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "vertex 3 (from 0) must be finite, got [NaN, inf, 7]"
    );
    let nan = |c: f64| if c > 1.2 { f64::NAN } else { c };
    let mut file = binary_ply("binary_little_endian", nan);
    // The base alone.
    file.truncate(file.len() - 4 * 14);
    let header = file.windows(6).position(|part| part == b"face 5").unwrap();
    file[header + 5] = b'1';
    assert_eq!(read("base.ply", file).0.unwrap().triangles().len(), 2);
}

#[test]
fn extensions_of_what_is_not_read_do_not_matter() {
    let text = embedded(
        r#"[{ "children": [1, 2], "camera": 7 }, { "mesh": 0 }, { "mesh": 1, "skin": 9 }]"#,
    );
    let passed_over = "KHR_materials_ior KHR_materials_variants KHR_texture_basisu \
                       EXT_texture_webp KHR_lights_punctual KHR_xmp_json_ld \
                       ADOBE_materials_clearcoat_specular KHR_animation_pointer";
    for extension in passed_over.split(' ') {
        let required = format!(
            r#""scene": 0, "extensionsUsed": ["{extension}"], "extensionsRequired": ["{extension}"],
               "textures": [{{ "extensions": {{ "{extension}": {{ "source": 0 }} }} }}],
               "materials": [{{ "alphaMode": "SHINY", "extensions": {{ "{extension}": 5 }} }}],"#
        );
        let content = text
            .replacen("\"scene\": 0,", &required, 1)
            .replace("\"indices\": 2 }", "\"indices\": 2, \"material\": 3 }");
        let mesh = read_mesh_bytes(content.as_bytes(), MeshFormat::Gltf, 1e-3).unwrap();
        assert_eq!(triangle_corners(&mesh), pyramid(), "{extension}");
    }
    let of_shapes =
        "KHR_draco_mesh_compression KHR_mesh_quantization EXT_meshopt_compression materials";
    for extension in of_shapes.split(' ') {
        let required =
            format!(r#""scene": 0, "extensionsRequired": ["KHR_materials_ior", "{extension}"],"#);
        let content = text.replacen("\"scene\": 0,", &required, 1);
        let expected = format!(
            "the file requires \"{extension}\", an extension that is not read: export it without"
        );
        assert_eq!(complaint("required.gltf", content), expected);
    }
}
