mod any_bytes;
mod broken;
mod faces;
mod found;
mod gltf;
mod normals;

use std::{fs, io::Cursor, path::PathBuf};

use glam::DVec3;
use tem00_testkit::rows;
use tempfile::TempDir;

use tem00_geometry::{Intersector, Shape, TriangleMesh};

use super::{MeshFileError, MeshFormat, parse, read_mesh, read_mesh_bytes};

/// A pyramid: its base is a quadrilateral. Coordinates are exact in single precision.
const VERTICES: [[f32; 3]; 5] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.25, -0.125, 1.5],
];
const BASE: [u32; 4] = [0, 3, 2, 1];
const SIDES: [[u32; 3]; 4] = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];

/// The pyramid in metres, from a file in millimetres.
fn pyramid() -> Vec<[DVec3; 3]> {
    let corner = |index: u32| {
        let [x, y, z] = VERTICES[index as usize].map(f64::from);
        DVec3::new(x, y, z) * 1e-3
    };
    let base = [[0, 3, 2], [0, 2, 1]];
    base.iter().chain(&SIDES).map(|t| t.map(corner)).collect()
}

/// Writes a file into its own folder and reads it as millimetres.
fn read(name: &str, content: impl AsRef<[u8]>) -> (Result<TriangleMesh, MeshFileError>, PathBuf) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    (read_mesh(&path, 1e-3), path)
}

/// Returns the mesh of a file and what was left out of it.
fn mesh_and_notes(
    content: &[u8],
    format: MeshFormat,
) -> Result<(TriangleMesh, Vec<String>), MeshFileError> {
    parse(content, format, None)?.into_mesh(1.0)
}

fn triangle_corners(mesh: &TriangleMesh) -> Vec<[DVec3; 3]> {
    let triangles = mesh.triangles().iter();
    triangles
        .map(|triangle| triangle.map(|index| mesh.vertices()[index as usize]))
        .collect()
}

fn assert_pyramid(name: &str, content: impl AsRef<[u8]>) {
    let mesh = read(name, content).0.unwrap();
    assert_eq!(triangle_corners(&mesh), pyramid(), "{name}");
    assert_eq!(mesh.vertices().len(), 5, "{name}: vertices are shared");
}

/// Returns the text of the error after the name of the file.
fn complaint(name: &str, content: impl AsRef<[u8]>) -> String {
    let (result, path) = read(name, content);
    let text = result.unwrap_err().to_string();
    let about = format!("{}: ", path.display());
    text.strip_prefix(&about)
        .unwrap_or_else(|| panic!("{text} does not begin with {about}"))
        .to_owned()
}

fn ply_header(format: &str, coordinate: &str, list: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment a pyramid\nelement vertex 5\nproperty {coordinate} x\n\
         property {coordinate} y\nproperty {coordinate} z\nproperty uchar red\nelement edge 1\n\
         property int start\nelement face 5\nproperty list {list}\nend_header\n"
    )
}

fn ascii_ply() -> String {
    let mut text = ply_header("ascii", "float", "uchar int vertex_indices");
    for [x, y, z] in VERTICES {
        text += &format!("{x} {y} {z} 255\n");
    }
    text + "7\n4 0 3 2 1\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n"
}

/// A binary PLY file with coordinates in double precision, which are changed.
fn binary_ply(order: &str, changed: impl Fn(f64) -> f64) -> Vec<u8> {
    let is_big = order == "binary_big_endian";
    let mut bytes = ply_header(order, "double", "ushort uint vertex_index").into_bytes();
    let mut add = |mut number: Vec<u8>| {
        if is_big {
            number.reverse();
        }
        bytes.extend(number);
    };
    for vertex in VERTICES {
        let doubles = vertex.map(|c| changed(c.into()).to_le_bytes().to_vec());
        doubles.into_iter().for_each(&mut add);
        add(vec![255]);
    }
    add(7_u32.to_le_bytes().into());
    for face in faces() {
        add(u16::try_from(face.len()).unwrap().to_le_bytes().into());
        face.iter()
            .for_each(|index| add(index.to_le_bytes().into()));
    }
    bytes
}

fn little_ply() -> Vec<u8> {
    binary_ply("binary_little_endian", |coordinate| coordinate)
}

/// The base and the sides of the pyramid.
fn faces() -> impl Iterator<Item = &'static [u32]> {
    let sides = SIDES.iter().map(|side| side.as_slice());
    std::iter::once(BASE.as_slice()).chain(sides)
}

fn triangles() -> Vec<[[f32; 3]; 3]> {
    let base = [[0, 3, 2], [0, 2, 1]];
    let indices = base.iter().chain(&SIDES);
    indices
        .map(|t: &[u32; 3]| t.map(|i| VERTICES[i as usize]))
        .collect()
}

fn ascii_stl() -> String {
    let mut text = "solid pyramid\n".to_owned();
    for corners in triangles() {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for [x, y, z] in corners {
            text += &format!("      vertex {x:e} {y:e} {z:e}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    text + "endsolid pyramid\n"
}

fn binary_stl(header: &str) -> Vec<u8> {
    let mut bytes = format!("{header:80}").into_bytes();
    let triangles = triangles();
    bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flatten().flat_map(|c| c.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// With comments, normals, texture coordinates, backward indices and a continued line.
const OBJ: &str = "\
# a pyramid
mtllib none.mtl
o pyramid
v -1 -1 0
v 1 -1 0 1.0
v 1.0 1.0 0.0 0.5 0.5 0.5
v -1 1 0 # the last of the base
vn 0 0 1
vt 0.5 0.5
f 1/1 4/1 \\
  3/1 2/1
v 0.25 -.125 1.5e0
usemtl none
s off
f 1 2 5
f -4/1 -3/1 -1/1
f 3/1 4/1 5/1
g another group
f -2 -5 -1
";

#[test]
fn every_format_gives_the_same_triangles() {
    assert_pyramid("pyramid.obj", OBJ);
    assert_pyramid("windows.OBJ", OBJ.replace('\n', "\r\n"));
    assert_pyramid("ascii.ply", ascii_ply());
    assert_pyramid("little.Ply", little_ply());
    assert_pyramid("big.PLY", binary_ply("binary_big_endian", |c| c));
    assert_pyramid("ascii.stl", ascii_stl());
    assert_pyramid("binary.STL", binary_stl("exported"));
}

#[test]
fn stl_files_that_only_look_like_the_other_kind_are_read() {
    assert_pyramid("solid-binary.stl", binary_stl("solid exported\n"));
    assert_pyramid("unnamed.stl", ascii_stl().replace(" pyramid", ""));
    assert_pyramid("capitals.stl", ascii_stl().replace("vertex", "VERTEX"));
    // Two solids in one file are one mesh.
    let facet = "  facet normal 0 0 0\n";
    let halves = format!("{facet}endsolid\nsolid more\n");
    assert_pyramid("solids.stl", ascii_stl().replacen(facet, &halves, 1));
    let mut padded = binary_stl("padded");
    padded.extend([0; 7]);
    assert_pyramid("padded.stl", padded);
}

#[test]
fn independent_readers_see_the_same_triangles() {
    let options = tobj::LoadOptions {
        triangulate: true,
        ..tobj::LoadOptions::default()
    };
    // Content that tobj does not read: comments after a vertex, continued lines, weights, and
    // colours of some vertices only.
    let plain = OBJ
        .replace(" # the last of the base", "")
        .replace("\\\n", "")
        .replace("-1 0 1.0", "-1 0")
        .replace(" 0.5 0.5 0.5", "");
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(plain), &options, |_| {
        Err(tobj::LoadError::OpenFileFailed)
    })
    .unwrap();
    let corners = models.iter().flat_map(|model| {
        let (points, _) = model.mesh.positions.as_chunks::<3>();
        let corners = model.mesh.indices.iter();
        corners.map(|&corner| points[corner as usize])
    });
    let obj: Vec<[f32; 3]> = corners.collect();
    assert_eq!(obj, triangles().concat(), "tobj reads the OBJ file");

    for bytes in [ascii_stl().into_bytes(), binary_stl("exported")] {
        let mesh = stl_io::read_stl(&mut Cursor::new(bytes)).unwrap();
        let corners = mesh.faces.iter().flat_map(|face| face.vertices);
        let stl: Vec<[f32; 3]> = corners.map(|corner| mesh.vertices[corner].into()).collect();
        assert_eq!(stl, triangles().concat(), "stl_io reads the STL file");
    }
}

#[test]
fn text_keeps_double_precision() {
    let x = 123.456_789_012_345;
    let obj = format!("v {x} 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
    let stl = format!(
        "solid\nfacet normal 0 0 0\nouter loop\nvertex {x} 0 0\nvertex 0 1 0\nvertex 0 0 1\n\
         endloop\nendfacet\nendsolid\n"
    );
    for (name, text) in [("a.obj", obj), ("a.stl", stl)] {
        let mesh = read(name, text).0.unwrap();
        assert_eq!(mesh.vertices()[0], DVec3::new(x * 1e-3, 0.0, 0.0), "{name}");
    }
}

#[test]
fn scale_is_the_length_of_the_unit() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("inches.obj");
    fs::write(&path, OBJ).unwrap();
    for scale in [0.0254, 1.0, 1e-6] {
        let mesh = read_mesh(&path, scale).unwrap();
        let (low, high) = (DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 1.5));
        assert_eq!(mesh.bounds(), (scale * low, scale * high), "scale {scale}");
    }
}

#[test]
fn a_polygon_of_many_corners_can_be_met() {
    const CORNERS: u32 = 5_000;
    let angle = |i: u32| f64::from(i) / f64::from(CORNERS) * core::f64::consts::TAU;
    let vertex = |i| format!("v {} {} 0\n", angle(i).cos(), angle(i).sin());
    let vertices: String = (0..CORNERS).map(vertex).collect();
    let face: String = (1..=CORNERS).map(|corner| format!(" {corner}")).collect();
    let text = format!("{vertices}f{face}\n");
    let mesh = read_mesh_bytes(text.as_bytes(), MeshFormat::Obj, 1.0).unwrap();
    assert_eq!(mesh.triangles().len(), 4_998);
    let intersector = Intersector::build(&[Shape::from(mesh)]).unwrap();
    for i in 0..200_u32 {
        let radius = f64::from(i) / 200.0;
        let (sin, cos) = angle(37 * i).sin_cos();
        let origin = DVec3::new(radius * cos, radius * sin, 1.0);
        let ray = tem00_camera::Ray {
            origin,
            direction: DVec3::NEG_Z,
        };
        assert!(intersector.intersect(&ray).is_some(), "missed at {origin}");
    }
}
