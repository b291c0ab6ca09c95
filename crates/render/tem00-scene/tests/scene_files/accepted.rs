//! Defaults, meshes, instances and maps, of which more is to be said than what a key changes.

use std::{f64::consts::PI, fs, sync::Arc};

use approx::assert_relative_eq;
use glam::DVec3;
use tem00_beam::{AngularProfile, FanGeometry, LineProfile};
use tem00_geometry::{MeshInstance, Shape};
use tem00_scene::SceneFile;
use tem00_tracer::{
    BeamShape, Environment, Light, Material, Medium, RenderOptions, Rotation, Scene,
    SpeckleSettings, Surface, Trajectory,
};
use tempfile::TempDir;

use super::{CAMERA, LASER, SURFACE, TETRAHEDRON, minimal, parse, parse_with_mesh, with};

#[test]
fn a_scene_needs_a_camera_a_laser_and_a_surface_and_no_more() {
    let scene = parse(&minimal()).unwrap();
    let camera = scene.camera.description();
    assert_eq!(camera.look_at, DVec3::ZERO, "it looks at the origin");
    assert_eq!(camera.resolution, [320, 240], "default resolution");
    assert_relative_eq!(camera.focus_distance, 0.3);
    assert_relative_eq!(camera.pixel_pitch, 3.45e-6);
    assert!(camera.depth_of_field, "blur by default");
    assert_eq!(scene.lasers.len(), 1, "lasers");
    // The laser stands at (0.1, 0, 0.2) and looks at the origin.
    let spot = BeamShape::Spot {
        waist_radius: [0.5e-3; 2],
        waist_distance: [DVec3::new(0.1, 0.0, 0.2).length(); 2],
        m_squared: [1.0; 2],
    };
    assert_eq!(scene.lasers[0].description().shape, spot, "in focus there");
    assert_eq!(scene.surfaces[0].name, "surface 1", "default name");
    assert_eq!(scene.render, RenderOptions::default(), "settings");
    assert_eq!(scene.speckle, SpeckleSettings::default(), "settings");

    for (section, missing) in [(CAMERA, "camera"), (LASER, "laser"), (SURFACE, "surface")] {
        let error = parse(&minimal().replace(section, "")).unwrap_err();
        assert!(error.message().contains(missing), "{error}");
        assert_eq!(error.span(), None, "nothing to point at: {error}");
    }
}

/// Returns the fan and the profile of the minimal scene's laser with a line of 0.2 mm and 30°, and
/// other keys.
fn line(keys: &str) -> (FanGeometry, LineProfile) {
    let line = format!("line = {{ fan_angle = \"30 deg\", thickness = \"0.2 mm\"{keys} }}");
    let scene = parse(&with("spot.waist_radius = \"0.5 mm\"", &line)).unwrap();
    match &scene.lasers[0].description().shape {
        BeamShape::Line { fan, profile, .. } => (*fan, profile.clone()),
        other => panic!("{other:?} is not a line"),
    }
}

#[test]
fn a_line_fans_out_from_where_its_round_beam_would_be_a_point() {
    // w(z) = w₀ √(1 + (z/z_R)²) = 0.473 mm at the lens, over tan 15° = 0.268.
    let z_r = PI * 1e-8 / 650e-9;
    let width = 1e-4 * (1.0 + 0.05 / (z_r * z_r)).sqrt();
    let expected = width / 15_f64.to_radians().tan();
    assert_relative_eq!(line("").0.apex_offset, expected, max_relative = 1e-12);
}

#[test]
fn profiles_may_be_tables() {
    let table = [(-10.0, 0.8), (0.0, 1.0), (12.0, 0.0)].map(|(d, p)| (d * PI / 180.0, p));
    let expected = LineProfile::Tabulated(AngularProfile::from_pairs(&table).unwrap());
    let keys = ", profile = { angles = [\"-10 deg\", 0, \"12 deg\"], powers = [0.8, 1, 0] }";
    assert_eq!(line(keys).1, expected);
}

#[test]
fn materials_are_those_of_their_constructors() {
    let degrees = |angle: f64| angle * PI / 180.0;
    for (keys, expected) in [
        ("oren_nayar = {}", Material::oren_nayar(0.8, degrees(20.0))),
        (
            "oren_nayar = { reflectance = 0.5, roughness = \"30 deg\" }",
            Material::oren_nayar(0.5, degrees(30.0)),
        ),
        ("plastic = {}", Material::plastic(0.8, 1.5, 0.1)),
        (
            "translucent = { transport_length = \"0.5 mm\", absorption = 20, anisotropy = 0.3 }",
            Material::translucent(
                Medium::new(1.5, 2e3, 20.0)
                    .and_then(|medium| medium.with_anisotropy(0.3))
                    .unwrap(),
                0.1,
            ),
        ),
        (
            "translucent = { material = \"marble\", refractive_index = 1.6, roughness = 0.2 }",
            Material::translucent(Medium::new(1.6, 2.19e3, 2.1).unwrap(), 0.2),
        ),
        (
            "plastic = { reflectance = 0.3, index = 1.6, roughness = 0.2 }",
            Material::plastic(0.3, 1.6, 0.2),
        ),
    ] {
        let scene = parse(&format!("{}{keys}\n", minimal())).unwrap();
        assert_eq!(scene.surfaces[0].material, expected.unwrap(), "{keys}");
    }
}

/// Asserts that the box of the first surface has these corners, but for a few roundings of 1e−16.
#[track_caller]
fn assert_box(scene: &Scene, low: DVec3, high: DVec3) {
    let found = scene.surfaces[0].shape.bounds();
    let is_near = found.0.distance(low) < 1e-15 && found.1.distance(high) < 1e-15;
    assert!(is_near, "{found:?}, not from {low} to {high}");
}

#[test]
fn meshes_are_scaled_then_turned_then_moved() {
    let read = |keys| parse_with_mesh("a.obj", TETRAHEDRON, keys);
    let keys = "unit = \"cm\"\nscale = 2\nposition = [\"3 mm\", 0, \"1 mm\"]\n\
                rotation = { axis = [0, 0, 7], angle = \"90 deg\" }";
    // 0 ≤ x, y, z ≤ 20 mm; the turn takes +x to +y and +y to −x.
    let (low, high) = (
        DVec3::new(-0.017, 0.0, 0.001),
        DVec3::new(0.003, 0.02, 0.021),
    );
    assert_box(&read(keys).unwrap(), low, high);
    for (keys, size) in [("", 1e-3), ("unit = \"25.4 mm\"", 25.4e-3)] {
        assert_box(&read(keys).unwrap(), DVec3::ZERO, DVec3::splat(size));
    }
    // By the middle of its box; the turned tetrahedron is 1 mm wide along every axis.
    let keys = "centre = [0, \"5 mm\", 0]\nrotation = { axis = [0, 0, 1], angle = \"90 deg\" }";
    let centre = DVec3::new(0.0, 5e-3, 0.0);
    assert_box(&read(keys).unwrap(), centre - 0.5e-3, centre + 0.5e-3);
    let error = read("centre = [0, 0, 0]\nposition = [0, 0, 0]").unwrap_err();
    assert!(error.message().contains("give one of the two"), "{error}");
}

#[test]
fn instances_are_surfaces_at_their_own_places() {
    let keys = "name = \"nut\"\nrotation_per_frame = { axis = [0, 0, 1], angle = 1 }\n\
                pivot = [\"2 mm\", 0, 0]\nplastic = {}\n[[surface.instance]]\n\
                [[surface.instance]]\ndisplacement = [0, \"5 mm\", 0]\n\
                rotation = { axis = [0, 0, 1], angle = \"180 deg\" }";
    let scene = parse(&format!("{}{keys}\n", minimal())).unwrap();
    let [first, second] = &scene.surfaces[..] else {
        panic!("{} surfaces", scene.surfaces.len());
    };
    assert_eq!([&*first.name, &*second.name], ["nut 1", "nut 2"]);
    assert_eq!(first.material, second.material, "one material");
    let centre = |surface: &Surface| match &surface.shape {
        Shape::Rectangle(rectangle) => rectangle.centre(),
        other => panic!("{other:?} is not a rectangle"),
    };
    assert!(centre(first).length() < 1e-18, "in place: {first:?}");
    // Half a turn takes the origin to the other side of the pivot, at 4 mm.
    let expected = DVec3::new(4e-3, 5e-3, 0.0);
    assert!(centre(second).distance(expected) < 1e-17, "{second:?}");
    let turn = Rotation {
        axis: DVec3::Z,
        angle: 1.0,
    };
    for (surface, y) in [(first, 0.0), (second, 5e-3)] {
        let pivot = DVec3::new(2e-3, y, 0.0);
        let expected = Trajectory::turning(pivot, turn, DVec3::ZERO).unwrap();
        assert_eq!(surface.trajectory, expected, "{}", surface.name);
    }
}

fn mesh(surface: &Surface) -> &MeshInstance {
    match &surface.shape {
        Shape::Mesh(instance) => instance,
        other => panic!("{other:?} is not a mesh"),
    }
}

/// Writes files, and a scene with further sections, and reads it.
fn read_beside(files: &[(&str, &[u8])], sections: &str) -> SceneFile {
    let folder = TempDir::new().unwrap();
    for (name, content) in files {
        fs::create_dir_all(folder.path().join(name).parent().unwrap()).unwrap();
        fs::write(folder.path().join(name), content).unwrap();
    }
    let path = folder.path().join("scene.toml");
    let text = [CAMERA, LASER, sections].concat();
    fs::write(&path, &text).unwrap();
    super::schema::assert_allowed(&text);
    SceneFile::read(&path)
        .map_err(|error| error.to_string())
        .unwrap()
}

#[test]
fn surfaces_of_one_file_share_its_mesh() {
    let sections = "[[surface]]\nmesh.file = \"parts/a.obj\"\n\
        [[surface]]\nmesh = { file = \"parts/../parts/a.obj\", unit = \"m\", scale = 3 }\n\
        [[surface]]\nmesh.file = \"./parts/a.obj\"\n[[surface.instance]]\n[[surface.instance]]\n";
    let scene = read_beside(&[("parts/a.obj", TETRAHEDRON.as_bytes())], sections).scene;
    let meshes: Vec<_> = scene.surfaces.iter().map(mesh).collect();
    assert_eq!(meshes.len(), 4, "two surfaces and two instances of a third");
    for mesh in &meshes {
        assert!(Arc::ptr_eq(meshes[0].mesh(), mesh.mesh()), "not shared");
    }
    // A millimetre wide, and three metres.
    for (surface, size) in scene.surfaces.iter().zip([1e-3, 3.0]) {
        let (_, high) = surface.shape.bounds();
        assert!(high.distance(DVec3::splat(size)) < 1e-15, "{high}");
    }
}

#[test]
fn vertex_normals_count_unless_the_file_is_flat() {
    let smooth = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 1\nvn 1 0 1\nf 1//1 2//2 3//3\n";
    for (keys, is_smooth) in [
        ("shading = \"flat\"", false),
        ("shading = \"smooth\"", true),
        ("", true),
    ] {
        let scene = parse_with_mesh("a.obj", smooth, keys).unwrap();
        let normals = mesh(&scene.surfaces[0]).mesh().normals().len();
        assert_eq!(normals > 0, is_smooth, "{keys}");
    }
}

#[test]
fn environments_may_be_mapped() {
    // Two columns by one row, little endian: the left half shines with 3, the right one with 1.
    let pixels = [3.0_f32, 1.0].map(f32::to_le_bytes).concat();
    let map = [b"Pf\n2 1\n-1.0\n".to_vec(), pixels].concat();
    let read = |keys: &str| -> Environment {
        let light = format!("[[light]]\nenvironment = {{ file = \"sky.pfm\"{keys} }}\n{SURFACE}");
        let mut file = read_beside(&[("sky.pfm", &map)], &light);
        assert!(file.files[1].ends_with("sky.pfm"), "{:?}", file.files);
        match file.scene.lights.remove(0) {
            Light::Environment(environment) => environment,
            other => panic!("{other:?} is no environment"),
        }
    };
    // Seen from inside with y up and −z ahead, the left half of the map is at −x.
    let usual = read("");
    assert_relative_eq!(usual.radiance_along(DVec3::NEG_X), 3.0);
    assert_relative_eq!(usual.radiance_along(DVec3::X), 1.0);
    let turned = read(", up = [0, 0, 1], middle = [1, 0, 0], scale = 2");
    // With x ahead and z up, the left is at +y.
    assert_relative_eq!(turned.radiance_along(DVec3::Y), 6.0);
    assert_relative_eq!(turned.radiance_along(DVec3::NEG_Y), 2.0);
}

#[test]
fn meshes_in_gltf_are_in_metres() {
    let sections = "[[surface]]\nmesh.file = \"a.gltf\"\n";
    let scene = read_beside(&[("a.gltf", TRIANGLE_IN_GLTF)], sections).scene;
    assert_box(&scene, DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0));
}

/// A triangle with corners at the origin, (1, 0, 0) and (0, 1, 0).
///
/// Nine numbers of 32 bits in base64: all are 0 but the fourth and the eighth, which are 1.
const TRIANGLE_IN_GLTF: &[u8] = br#"{"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

#[test]
fn what_no_triangle_uses_moves_no_mesh() {
    let corners = |extra: &str| {
        let content = format!("{TETRAHEDRON}{extra}");
        let scene = parse_with_mesh("part.obj", &content, "centre = [0.1, 0, 0]").unwrap();
        let mesh = mesh(&scene.surfaces[0]).clone();
        let corners = mesh.mesh().triangles().as_flattened().iter();
        let point = |&corner: &u32| mesh.point(mesh.mesh().vertices()[corner as usize]);
        corners.map(point).collect::<Vec<_>>()
    };
    for extra in ["v 9 9 9\n", "v nan 0 0\n", "v 9 0 0\nv 0 9 0\nf 5 6\n"] {
        assert_eq!(corners(extra), corners(""), "{extra}");
    }
}

#[test]
fn notes_of_meshes_name_their_files() {
    let content = format!("{TETRAHEDRON}f 1 1 2\nl 1 2\n");
    let sections = "[[surface]]\nmesh.file = \"part.obj\"\n\
                    [[surface]]\nmesh = { file = \"part.obj\", shading = \"flat\" }\n";
    let file = read_beside(&[("part.obj", content.as_bytes())], sections);
    let notes = ["1 point, line or curve", "1 face without area"];
    let expected = notes.map(|note| format!("{}: left out: {note}", file.files[1].display()));
    assert_eq!(file.notes, expected, "once for both");
}
