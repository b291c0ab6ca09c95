//! Motion, instances, materials and settings that are read.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fs;
use std::sync::Arc;

use approx::assert_relative_eq;
use glam::{DVec2, DVec3};
use tem00_camera::{RadialDistortion, SensorTilt};
use tempfile::TempDir;

use tem00_scene::{SceneFile, read_scene};

use super::{CAMERA, LASER, TETRAHEDRON, minimal, parse, parse_with_mesh, with};
use tem00_geometry::{Cylinder, Shape};
use tem00_tracer::{
    Crop, Environment, Filter, Keyframe, LaserEvents, Light, LineShape, Material, Metal, Method,
    Relief, Rotation, Sampling, SpectralLine, Surface, SurfaceSpeckle, Trajectory,
};

/// Reads the minimal scene with further keys of its surface.
#[track_caller]
fn surface(keys: &str) -> Surface {
    let scene = parse(&format!("{}{keys}\n", minimal())).map_err(|error| error.to_string());
    scene.unwrap().surfaces.remove(0)
}

/// Reads the minimal scene with another shape, which `keys` describe.
#[track_caller]
fn shape(keys: &str) -> Surface {
    let text = with("rectangle.size = [\"40 mm\", \"30 mm\"]", keys);
    let scene = parse(&text).map_err(|error| error.to_string());
    scene.unwrap().surfaces.remove(0)
}

#[test]
fn the_image_is_rendered_as_the_file_says() {
    let render = "[render]\nframes = 5\nreference_frame = 4\nmax_depth = 3\nmethod = \"light\"\n\
                  laser_events = \"sampled\"\ncrop = [10, 20, 300, 200]\ntarget_error = 0.02\n";
    let scene = parse(&format!("{render}{}", minimal())).unwrap();
    let settings = scene.render;
    assert_eq!(scene.reference_frame, 4, "reference frame");
    assert_eq!(settings.max_depth, Some(3), "depth");
    assert_eq!(settings.method, Method::Light, "method");
    assert_eq!(settings.laser_events, LaserEvents::Sampled, "events");
    let crop = Crop {
        x: 10,
        y: 20,
        width: 300,
        height: 200,
    };
    assert_eq!(settings.crop, Some(crop), "crop");
    assert_eq!(settings.sampling, Sampling::TargetError(0.02), "error");
    let adaptive = parse(&format!("[render]\nadaptive = true\n{}", minimal())).unwrap();
    assert_eq!(adaptive.render.sampling, Sampling::Adaptive, "adaptive");
}

#[test]
fn the_camera_is_the_real_one() {
    let keys = "principal_point = [100.5, 90]\ntilt = { angle = \"5 deg\", azimuth = \"90 deg\" }\n\
                distortion = [-0.1, 0.02, 0]\ndepth_of_field = false\n";
    let text = with("[camera]\n", &format!("[camera]\n{keys}"));
    let camera = *parse(&text).unwrap().camera.description();
    assert_eq!(
        camera.principal_point,
        Some(DVec2::new(100.5, 90.0)),
        "point"
    );
    let tilt = SensorTilt {
        angle: 5.0 * PI / 180.0,
        azimuth: FRAC_PI_2,
    };
    assert_eq!(camera.tilt, tilt, "tilt");
    let distortion = RadialDistortion {
        k1: -0.1,
        k2: 0.02,
        k3: 0.0,
    };
    assert_eq!(camera.distortion, distortion, "distortion");
    assert!(!camera.depth_of_field, "no blur");
    let plain = parse(&minimal()).unwrap();
    assert!(plain.camera.description().depth_of_field, "blur by default");
}

#[test]
fn materials_have_the_values_of_the_file_or_usual_ones() {
    let degrees = |angle: f64| angle * PI / 180.0;
    let cases = [
        ("oren_nayar = {}", Material::oren_nayar(0.8, degrees(20.0))),
        (
            "oren_nayar = { reflectance = 0.5, roughness = \"30 deg\" }",
            Material::oren_nayar(0.5, degrees(30.0)),
        ),
        ("plastic = {}", Material::plastic(0.8, 1.5, 0.1)),
        (
            "plastic = { reflectance = 0.3, index = 1.6, roughness = 0.2 }",
            Material::plastic(0.3, 1.6, 0.2),
        ),
        ("mirror = {}", Material::mirror(1.0)),
        ("mirror.reflectance = 0.9", Material::mirror(0.9)),
        (
            "mirror.metal = \"silver\"",
            Material::polished(Metal::Silver),
        ),
        (
            "mirror.refractive_index = [1.4, 7]",
            Material::polished(Metal::Custom { n: 1.4, k: 7.0 }),
        ),
        ("dielectric = {}", Material::dielectric(1.5)),
        ("dielectric.index = 1.7", Material::dielectric(1.7)),
        (
            "conductor.metal = \"stainless_steel\"",
            Material::conductor(Metal::StainlessSteel, 0.3),
        ),
        (
            "one_sided = true",
            Material::lambertian(0.8).map(Material::one_sided),
        ),
        (
            "one_sided = true\nplastic = {}",
            Material::plastic(0.8, 1.5, 0.1).map(Material::one_sided),
        ),
        ("one_sided = false", Material::lambertian(0.8)),
    ];
    for (keys, expected) in cases {
        assert_eq!(surface(keys).material, expected.unwrap(), "{keys}");
    }
}

#[test]
fn a_finish_names_the_metal_and_its_height() {
    let milled = surface("conductor.finish = \"milled steel\"");
    let iron = Material::conductor(Metal::Iron, 0.3);
    assert_eq!(milled.material, iron.unwrap(), "steel");
    // √(π/2) √(0.8 · 6.3) µm.
    let height = milled.relief.rms_height;
    assert!((height - 2.8137e-6).abs() < 1e-10, "{height}");
    let given = "rms_height = \"1 um\"\n\
                 conductor = { finish = \"ground stainless steel\", roughness = 0.1 }";
    let ground = surface(given);
    let steel = Material::conductor(Metal::StainlessSteel, 0.1);
    assert_eq!(ground.material, steel.unwrap(), "stainless steel");
    let given = (ground.relief.rms_height - 1e-6).abs();
    assert!(given < 1e-20, "the one that is given: {given}");
}

#[test]
fn surfaces_tell_what_their_speckle_is_made_of() {
    let plain = surface("");
    assert_eq!(plain.speckle, SurfaceSpeckle::default(), "one pattern");
    assert_eq!(plain.relief, Relief::default(), "the height is not known");
    let paper = surface("rms_height = \"2 um\"\nspeckle = { patterns = 3, polarisation = 0.25 }");
    let expected = SurfaceSpeckle {
        patterns: 3,
        polarisation: 0.25,
    };
    assert_eq!(paper.speckle, expected, "three patterns");
    let relief = Relief {
        rms_height: 2e-6,
        correlation_length: 0.0,
    };
    assert_eq!(paper.relief, relief, "finer than any scatterer");
    let relief = Relief {
        correlation_length: 5e-6,
        ..relief
    };
    let longer = surface("rms_height = \"2 um\"\ncorrelation_length = \"5 um\"");
    assert_eq!(longer.relief, relief, "correlated over 5 µm");
}

#[test]
fn lasers_tell_their_spectra() {
    let line = |keys: &str| {
        let scene = parse(&with("wavelength = \"650 nm\"", keys)).map_err(|e| e.to_string());
        scene.unwrap().lasers[0].spectral_line().clone()
    };
    let middle = 650e-9;
    let single = SpectralLine::monochromatic(middle).unwrap();
    assert_eq!(line("wavelength = \"650 nm\""), single);
    assert_eq!(line("wavelength = \"650 nm\"\nlinewidth = 0"), single);
    for (name, shape) in [
        ("gaussian", LineShape::Gaussian),
        ("lorentzian", LineShape::Lorentzian),
        ("rectangular", LineShape::Rectangular),
    ] {
        let keys = format!("wavelength = \"650 nm\"\nlinewidth = \"8 nm\"\nspectrum = \"{name}\"");
        assert_eq!(line(&keys), SpectralLine::new(middle, 8e-9, shape).unwrap());
    }
    let comb = "wavelength = \"650 nm\"\nlinewidth = \"2 nm\"\nspectrum = \"comb\"\nlines = 5";
    assert_eq!(line(comb), SpectralLine::comb(middle, 2e-9, 5).unwrap());
    let peaks = SpectralLine::from_peaks(&[[448e-9, 1.0], [451e-9, 2.0]]).unwrap();
    let listed = "spectrum = [[\"448 nm\", 1], [\"451 nm\", 2]]";
    assert_eq!(line(listed), peaks);
    let wide = peaks.with_linewidth(1e-9, LineShape::Gaussian).unwrap();
    assert_eq!(line(&format!("{listed}\nlinewidth = \"1 nm\"")), wide);
}

#[test]
fn tubes_are_placed_by_their_middle_or_their_base() {
    let tube = |keys: &str| {
        let keys = format!("cylinder = {{ radius = \"4 mm\", length = \"50 mm\"{keys} }}");
        match shape(&keys).shape {
            Shape::Cylinder(cylinder) => cylinder,
            other => panic!("{other:?} is not a tube"),
        }
    };
    let expected = |centre, axis| Cylinder::new(centre, axis, 4e-3, 50e-3).unwrap();
    assert_eq!(tube(""), expected(DVec3::ZERO, DVec3::Z), "defaults");
    let centre = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(
        tube(", centre = [1, 2, 3], axis = [0, 1, 0]"),
        expected(centre, DVec3::Y),
        "by the middle"
    );
    assert_eq!(
        tube(", base = [1, 2, 3], axis = [-2, 0, 0]"),
        expected(centre - 25e-3 * DVec3::X, -DVec3::X),
        "by the base"
    );
}

#[test]
fn steady_motion_turns_about_the_point_that_places_the_thing() {
    let turn = Rotation {
        axis: DVec3::Z,
        angle: 90.0 * PI / 180.0,
    };
    let steady = "rotation_per_frame = { axis = [0, 0, 3], angle = \"90 deg\" }\n\
                  displacement_per_frame = [0, 0, \"1 mm\"]";
    let expected = |pivot| Trajectory::turning(pivot, turn, 1e-3 * DVec3::Z).unwrap();
    let ball = shape(&format!(
        "{steady}\nsphere = {{ centre = [1, 2, 3], radius = 1 }}"
    ));
    assert_eq!(
        ball.trajectory,
        expected(DVec3::new(1.0, 2.0, 3.0)),
        "sphere"
    );
    let rod = "cylinder = { base = [0, 0, 7], radius = 1, length = 1 }";
    let rod = shape(&format!("{steady}\n{rod}"));
    assert_eq!(rod.trajectory, expected(DVec3::new(0.0, 0.0, 7.0)), "tube");
    let plate = surface(&format!("{steady}\npivot = [0, \"5 mm\", 0]"));
    assert_eq!(plate.trajectory, expected(5e-3 * DVec3::Y), "as asked");

    let camera = with("[camera]\n", &format!("[camera]\n{steady}\n"));
    let camera = parse(&camera).unwrap();
    assert_eq!(camera.camera_trajectory, expected(0.3 * DVec3::Z), "camera");
    let laser = with("[[laser]]\n", &format!("[[laser]]\n{steady}\n"));
    let laser = &parse(&laser).unwrap().lasers[0];
    assert_eq!(
        *laser.trajectory(),
        expected(DVec3::new(0.1, 0.0, 0.2)),
        "laser"
    );
}

#[test]
fn things_move_through_keyframes() {
    let keyframes = "[[surface.keyframe]]\nframe = -1.5\n[[surface.keyframe]]\nframe = 10\n\
                     displacement = [\"1 mm\", 0, 0]\n\
                     rotation = { axis = [0, 1, 0], angle = \"720 deg\" }";
    let turned = Keyframe {
        frame: 10.0,
        displacement: 1e-3 * DVec3::X,
        rotation: Rotation {
            axis: DVec3::Y,
            angle: 720.0 * PI / 180.0,
        },
    };
    let expected = Trajectory::keyframed(DVec3::ZERO, [Keyframe::unmoved(-1.5), turned]).unwrap();
    assert_eq!(surface(keyframes).trajectory, expected, "as sections");
    let inline = "keyframe = [{ frame = -1.5 }, { frame = 10, displacement = [\"1 mm\", 0, 0], \
                  rotation = { axis = [0, 1, 0], angle = \"720 deg\" } }]";
    assert_eq!(surface(inline).trajectory, expected, "in one line");
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
    let about = |pivot| Trajectory::turning(pivot, turn, DVec3::ZERO).unwrap();
    assert_eq!(first.trajectory, about(DVec3::new(2e-3, 0.0, 0.0)), "first");
    assert_eq!(
        second.trajectory,
        about(DVec3::new(2e-3, 5e-3, 0.0)),
        "second"
    );
}

#[test]
fn surfaces_of_one_file_share_its_mesh() {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("parts")).unwrap();
    fs::write(folder.path().join("parts/a.obj"), TETRAHEDRON).unwrap();
    let mesh = |keys: &str| format!("[[surface]]\n[surface.mesh]\n{keys}\n");
    let surfaces = [
        mesh("file = \"parts/a.obj\""),
        mesh("file = \"parts/../parts/a.obj\"\nunit = \"m\"\nscale = 3"),
        mesh("file = \"./parts/a.obj\"\n[[surface.instance]]\n[[surface.instance]]"),
    ];
    let text = [CAMERA, LASER, &surfaces.concat()].concat();
    fs::write(folder.path().join("scene.toml"), text).unwrap();
    let scene = read_scene(&folder.path().join("scene.toml")).unwrap();
    let meshes = scene.surfaces.iter().map(|surface| match &surface.shape {
        Shape::Mesh(instance) => instance,
        other => panic!("{other:?} is not a mesh"),
    });
    let meshes: Vec<_> = meshes.collect();
    assert_eq!(meshes.len(), 4, "two surfaces and two instances of a third");
    for mesh in &meshes {
        assert!(Arc::ptr_eq(meshes[0].mesh(), mesh.mesh()), "not shared");
    }
    // Three metres wide, and a millimetre.
    let (_, high) = scene.surfaces[1].shape.bounds();
    assert!(high.distance(DVec3::splat(3.0)) < 1e-15, "{high}");
    let (_, high) = scene.surfaces[0].shape.bounds();
    assert!(high.distance(DVec3::splat(1e-3)) < 1e-18, "{high}");
}

#[test]
fn vertex_normals_count_unless_the_file_is_flat() {
    let smooth = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 1\nvn 1 0 1\nf 1//1 2//2 3//3\n";
    let has_normals = |keys: &str| {
        let scene = parse_with_mesh("a.obj", smooth, keys).unwrap();
        match &scene.surfaces[0].shape {
            Shape::Mesh(instance) => !instance.mesh().normals().is_empty(),
            other => panic!("{other:?} is not a mesh"),
        }
    };
    assert!(!has_normals("shading = \"flat\""), "flat");
    assert_eq!(
        has_normals(""),
        has_normals("shading = \"smooth\""),
        "default"
    );
}

#[test]
fn filters_have_usual_parameters_or_those_of_the_file() {
    let filter = |value: &str| {
        let text = format!("[render]\nfilter = {value}\n{}", minimal());
        parse(&text)
            .map_err(|error| error.to_string())
            .unwrap()
            .render
            .filter
    };
    let cases = [
        ("\"box\"", Filter::default()),
        (
            "\"gaussian\"",
            Filter::Gaussian {
                radius: 1.5,
                standard_deviation: 0.5,
            },
        ),
        (
            "{ gaussian = { radius = 3 } }",
            Filter::Gaussian {
                radius: 3.0,
                standard_deviation: 0.5,
            },
        ),
        ("{ box.radius = 1 }", Filter::Box { radius: 1.0 }),
        ("{ box = {} }", Filter::default()),
    ];
    for (value, expected) in cases {
        assert_eq!(filter(value), expected, "{value}");
    }
    assert_eq!(parse(&minimal()).unwrap().render.filter, Filter::default());
}

#[test]
fn environments_are_even_or_mapped() {
    let light = |keys: &str| format!("{}[[light]]\nenvironment = {{ {keys} }}\n", minimal());
    let even = parse(&light("radiance = \"0.5 W/(m² sr)\"")).unwrap();
    let expected = Light::Environment(Environment::constant(0.5).unwrap());
    assert_eq!(even.lights, [expected], "even");

    let folder = TempDir::new().unwrap();
    // Two columns by one row, little endian: what faces away shines with 1, the middle with 3.
    let pixels = [3.0_f32, 1.0].map(f32::to_le_bytes).concat();
    let map = [b"Pf\n2 1\n-1.0\n".to_vec(), pixels].concat();
    fs::write(folder.path().join("sky.pfm"), map).unwrap();
    let read = |keys: &str| {
        let text = light(&format!("file = \"sky.pfm\"{keys}"));
        super::schema::assert_allowed(&text);
        fs::write(folder.path().join("scene.toml"), text).unwrap();
        let file = SceneFile::read(&folder.path().join("scene.toml"));
        let mut file = file.map_err(|error| error.to_string()).unwrap();
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
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("a.gltf"), triangle_in_gltf()).unwrap();
    let text = [CAMERA, LASER, "[[surface]]\nmesh.file = \"a.gltf\"\n"].concat();
    fs::write(folder.path().join("scene.toml"), text).unwrap();
    let scene = read_scene(&folder.path().join("scene.toml"));
    let scene = scene.map_err(|error| error.to_string()).unwrap();
    let (_, high) = scene.surfaces[0].shape.bounds();
    assert_eq!(high, DVec3::new(1.0, 1.0, 0.0), "one metre");
}

/// A triangle with corners at the origin, (1, 0, 0) and (0, 1, 0).
fn triangle_in_gltf() -> String {
    // Nine numbers of 32 bits in base64: all are 0 but the fourth and the eighth, which are 1.
    let data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "buffers": [{{"byteLength": 36, "uri": "data:application/octet-stream;base64,{data}"}}]}}"#
    )
}

#[test]
fn what_no_triangle_uses_moves_no_mesh() {
    let corners = |extra: &str| {
        let content = format!("{TETRAHEDRON}{extra}");
        let scene = parse_with_mesh("part.obj", &content, "centre = [0.1, 0, 0]").unwrap();
        let Shape::Mesh(mesh) = scene.surfaces[0].shape.clone() else {
            panic!("{scene:?}");
        };
        let corners = mesh.mesh().triangles().as_flattened().iter();
        corners
            .map(|&corner| mesh.point(mesh.mesh().vertices()[corner as usize]))
            .collect::<Vec<_>>()
    };
    for extra in ["v 9 9 9\n", "v nan 0 0\n", "v 9 0 0\nv 0 9 0\nf 5 6\n"] {
        assert_eq!(corners(extra), corners(""), "{extra}");
    }
}

#[test]
fn notes_of_meshes_name_their_files() {
    let folder = TempDir::new().unwrap();
    let content = format!("{TETRAHEDRON}f 1 1 2\nl 1 2\n");
    fs::write(folder.path().join("part.obj"), content).unwrap();
    let surface = "[[surface]]\nmesh.file = \"part.obj\"\n";
    let flat = "[[surface]]\nmesh = { file = \"part.obj\", shading = \"flat\" }\n";
    let path = folder.path().join("scene.toml");
    fs::write(&path, [CAMERA, LASER, surface, flat].concat()).unwrap();
    let part = folder.path().join("part.obj");
    let expected = [
        "left out: 1 point, line or curve",
        "left out: 1 face without area",
    ]
    .map(|note| format!("{}: {note}", part.display()));
    assert_eq!(
        SceneFile::read(&path).unwrap().notes,
        expected,
        "once for both"
    );
}
