use super::*;

/// A roof with a normal of its own for each side, and a gable without normals. One corner of the
/// right side repeats a pair, and one normal comes after its face.
const ROOF: &str = "\
v 0 0 0
v 1 0 1
v 2 0 0
v 0 3 0
v 1 3 1
v 2 3 0
vn -1 0 1
f 1//1 2//1 5//1 4//1
f 2//-1 3/7/2 6/7/2
f 2//2 6//2 5//2
f 1 3 2
vn 0.5 0 0.5
";

/// The position and the normal of each corner, triangle by triangle.
fn corners(mesh: &TriangleMesh) -> Vec<(DVec3, DVec3)> {
    let corner = |&i: &u32| (mesh.vertices()[i as usize], mesh.normals()[i as usize]);
    mesh.triangles().as_flattened().iter().map(corner).collect()
}

#[test]
fn each_corner_of_an_obj_file_keeps_its_normal() {
    let mesh = read_mesh_bytes(ROOF.as_bytes(), MeshFormat::Obj, 1.0).unwrap();
    let slope = 0.5_f64.sqrt();
    let [left, right] = [-slope, slope].map(|x| DVec3::new(x, 0.0, slope));
    let point = |n: usize| {
        let (column, row) = (n % 3, n / 3);
        DVec3::new(column as f64, 3.0 * row as f64, (column % 2) as f64)
    };
    let expected = [
        [(0, left), (1, left), (4, left)],
        [(0, left), (4, left), (3, left)],
        [(1, left), (2, right), (5, right)],
        [(1, right), (5, right), (4, right)],
        [(0, DVec3::ZERO), (2, DVec3::ZERO), (1, DVec3::ZERO)],
    ];
    let got = corners(&mesh);
    for (got, (index, normal)) in got.iter().zip(expected.as_flattened()) {
        assert_eq!(got.0, point(*index), "vertex {index} of the file");
        // The normals are made unit vectors: a few roundings.
        let got = got.1;
        assert!((got - normal).length() < 4e-16, "{got} is not {normal}");
    }
    assert_eq!(got.len(), 15, "five triangles");
    // The ridge has one vertex for each side; the eaves and the gable share.
    // Two sides and the gable at one end, two sides at the other.
    let ridge = mesh.vertices().iter().filter(|v| v.z > 0.5).count();
    assert_eq!(ridge, 5);
}

#[test]
fn an_independent_reader_sees_the_same_normals() {
    let options = tobj::LoadOptions {
        triangulate: true,
        single_index: true,
        ..tobj::LoadOptions::default()
    };
    // tobj wants normals before faces, and all faces of a group alike; and it cuts no quadrilateral
    // as we do.
    let plain = ROOF
        .replace("f 1 3 2\nvn 0.5 0 0.5\n", "")
        .replace("vn -1 0 1\n", "vn -1 0 1\nvn 0.5 0 0.5\n")
        .replace("//-1", "//1")
        .replace("/7/", "//")
        .replace(
            "f 1//1 2//1 5//1 4//1\n",
            "f 1//1 2//1 5//1\nf 1//1 5//1 4//1\n",
        );
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(&plain), &options, |_| {
        Err(tobj::LoadError::OpenFileFailed)
    })
    .unwrap();
    let tobj = &models[0].mesh;
    let vector = |values: &[f32], i: u32| {
        let axis = |axis: usize| f64::from(values[3 * i as usize + axis]);
        DVec3::new(axis(0), axis(1), axis(2))
    };
    let expected = tobj.indices.iter().map(|&i| {
        let normal = vector(&tobj.normals, i).normalize();
        (vector(&tobj.positions, i), normal)
    });
    let mesh = read_mesh_bytes(plain.as_bytes(), MeshFormat::Obj, 1.0).unwrap();
    let got = corners(&mesh);
    assert_eq!(got.len(), tobj.indices.len(), "as many corners");
    for (got, expected) in got.into_iter().zip(expected) {
        assert_eq!(got.0, expected.0, "position");
        assert!((got.1 - expected.1).length() < 4e-16, "normal");
    }
}

#[test]
fn normals_of_ply_files_are_read() {
    let header = ply_header("binary_big_endian", "float", "uchar int vertex_indices")
        .replace(
            "property uchar red\n",
            "property float nx\nproperty float ny\nproperty float nz\n",
        )
        .replace("element edge 1\nproperty int start\n", "");
    let mut bytes = header.into_bytes();
    let normal = |i: u8| [f32::from(i), 0.0, -2.0];
    for (i, vertex) in (0..).zip(VERTICES) {
        let values = [vertex, normal(i)];
        bytes.extend(values.as_flattened().iter().flat_map(|v| v.to_be_bytes()));
    }
    for face in faces() {
        bytes.push(u8::try_from(face.len()).unwrap());
        bytes.extend(face.iter().flat_map(|i| i.to_be_bytes()));
    }
    let mesh = read_mesh_bytes(&bytes, MeshFormat::Ply, 1e-3).unwrap();
    assert_eq!(triangle_corners(&mesh), pyramid());
    for (i, got) in (0..).zip(mesh.normals()) {
        let [x, y, z] = normal(i).map(f64::from);
        let expected = DVec3::new(x, y, z).normalize();
        assert!((got - expected).length() < 4e-16, "normal {i}");
    }
    assert_eq!(mesh.normals().len(), 5, "one for each vertex");
}

#[test]
fn files_without_normals_give_none() {
    for (content, format) in [
        (OBJ.as_bytes(), MeshFormat::Obj),
        (ascii_ply().as_bytes(), MeshFormat::Ply),
        (&binary_stl("plain"), MeshFormat::Stl),
    ] {
        let mesh = read_mesh_bytes(content, format, 1.0).unwrap();
        assert!(mesh.normals().is_empty(), "flat triangles: {format:?}");
    }
}

#[test]
fn normals_that_point_backwards_are_kept() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -3\nf 1//1 2//1 3//1\n";
    let mesh = read_mesh_bytes(text.as_bytes(), MeshFormat::Obj, 1.0).unwrap();
    assert_eq!(mesh.normals(), [DVec3::NEG_Z; 3], "as in the file");
}

#[test]
fn broken_normals_are_explained() {
    let table = r#"
        v 0 0 0\nvn 0 1\n => line 2: a normal needs three coordinates
        v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//2 3\n => line 5: the face refers to normal 2, but the file has 1
        v 0 0 0\nf 1//x 1 1\n => line 2: a corner must end with a normal number, from 1 up or from -1 down to -0, got "1//x"
    "#;
    for [content, expected] in rows(table) {
        assert_eq!(complaint("broken.obj", &content), expected, "{content:?}");
    }
}
