use std::fs;
use std::path::Path;

use approx::assert_relative_eq;
use glam::DVec3;
use proptest::prelude::*;
use tem00_beam::LineProfile;
use tempfile::TempDir;

use super::*;
use crate::{BeamShape, Lamp, Material, Metal, RenderSettings, Shape, SpeckleSettings};

const CAMERA: &str = "[camera]\nposition = [0, 0, \"300 mm\"]\n";
const LASER: &str = "[[laser]]\nwavelength = \"650 nm\"\npower = \"5 mW\"\n\
                     position = [0.1, 0, 0.2]\nspot.waist_radius = \"0.5 mm\"\n";
const SURFACE: &str = "[[surface]]\nrectangle.size = [\"40 mm\", \"30 mm\"]\n";

fn minimal() -> String {
    [CAMERA, LASER, SURFACE].concat()
}

fn parse(text: &str) -> Result<Scene, SceneError> {
    parse_scene(text, Path::new("."))
}

/// Asserts that `text` is refused at `line`, with a message that contains all of `words`.
#[track_caller]
fn assert_refused(text: &str, line: usize, words: &[&str]) {
    let error = match parse(text) {
        Err(error) => error,
        Ok(_) => panic!("this scene should not be read:\n{text}"),
    };
    let (got, _) = error.line_column().unwrap_or_default();
    assert_eq!(got, line, "line of: {error}");
    for word in words {
        assert!(
            error.message().contains(word),
            "{word:?} is not in: {error}"
        );
    }
}

/// Asserts that two vectors of length 1 at most are equal but for a few roundings of 1e−16.
#[track_caller]
fn assert_near(got: DVec3, expected: DVec3) {
    assert!(got.distance(expected) < 1e-15, "{got} is not {expected}");
}

/// Returns the minimal scene with one line of it replaced.
#[track_caller]
fn with(line: &str, replacement: &str) -> String {
    let text = minimal();
    assert!(text.contains(line), "{line:?} is not in the scene");
    text.replace(line, replacement)
}

#[test]
fn a_scene_needs_a_camera_a_laser_and_a_surface_and_no_more() {
    let scene = parse(&minimal()).unwrap();
    let camera = scene.camera.description();
    assert_eq!(
        camera.look_at,
        DVec3::ZERO,
        "the camera looks at the origin"
    );
    assert_eq!(camera.resolution, [320, 240], "default resolution");
    assert_relative_eq!(camera.focus_distance, 0.3);
    assert_relative_eq!(camera.pixel_pitch, 3.45e-6);
    assert_eq!(scene.lasers.len(), 1, "lasers");
    assert_eq!(scene.surfaces[0].name, "surface 1", "default name");
    assert_eq!(scene.render, RenderSettings::default(), "settings");
    assert_eq!(scene.speckle, SpeckleSettings::default(), "settings");

    for (section, missing) in [(CAMERA, "camera"), (LASER, "laser"), (SURFACE, "surface")] {
        let error = parse(&minimal().replace(section, "")).unwrap_err();
        assert!(error.message().contains(missing), "{error}");
        assert_eq!(error.span(), None, "nothing to point at: {error}");
    }
}

#[test]
fn a_spot_is_in_focus_where_the_laser_looks() {
    let scene = parse(&minimal()).unwrap();
    let BeamShape::Spot {
        waist_radius,
        waist_distance,
        ..
    } = scene.lasers[0].description().shape
    else {
        panic!("not a spot");
    };
    assert_relative_eq!(waist_radius, 0.5e-3);
    // The laser stands at (0.1, 0, 0.2) and looks at the origin.
    assert_relative_eq!(waist_distance, 0.05_f64.sqrt(), max_relative = 1e-15);
}

#[test]
fn a_line_fans_out_from_where_its_round_beam_would_be_a_point() {
    let line = "line = { fan_angle = \"30 deg\", thickness = \"0.2 mm\", profile = \"powell\" }";
    let scene = parse(&with("spot.waist_radius = \"0.5 mm\"", line)).unwrap();
    let BeamShape::Line {
        waist_radius,
        fan,
        profile,
        ..
    } = scene.lasers[0].description().shape
    else {
        panic!("not a line");
    };
    assert_relative_eq!(waist_radius, 0.1e-3);
    assert_eq!(profile, LineProfile::Powell { edge: 0.05 }, "profile");
    // w(z) = w₀ √(1 + (z/z_R)²) = 0.473 mm at the lens, over tan 15° = 0.268.
    let z_r = core::f64::consts::PI * 1e-8 / 650e-9;
    let width = 1e-4 * (1.0 + 0.05 / (z_r * z_r)).sqrt();
    assert_relative_eq!(
        fan.apex_offset,
        width / 15_f64.to_radians().tan(),
        max_relative = 1e-12
    );
}

#[test]
fn rectangles_are_as_wide_and_high_as_they_look_from_the_front() {
    let text = with(
        "rectangle.size",
        "rectangle.normal = [1, 0, 0]\nrectangle.centre = [1, 2, 3]\nrectangle.size",
    );
    let scene = parse(&text).unwrap();
    let Shape::Rectangle(rectangle) = &scene.surfaces[0].shape else {
        panic!("not a rectangle");
    };
    assert_near(rectangle.normal(), DVec3::X);
    assert_near(rectangle.half_v(), 15e-3 * DVec3::Y);
    // Seen from +x, with y up, right is −z.
    assert_near(rectangle.half_u(), -20e-3 * DVec3::Z);
}

#[test]
fn defaults_hold_along_the_axes_that_they_suit_least() {
    let camera = with("[0, 0, \"300 mm\"]", "[0, 0.3, 0]");
    let up = parse(&camera).unwrap().camera.description().up;
    assert_eq!(up, DVec3::Z, "a camera that looks along y");
    let laser = with("[0.1, 0, 0.2]", "[0.1, 0, 0]");
    let direction = parse(&laser).unwrap().lasers[0]
        .description()
        .line_direction;
    assert_eq!(direction, DVec3::Y, "a laser that shines along x");
    let surface = with(
        "rectangle.",
        "rectangle.normal = [0, 1e-200, 0]\nrectangle.",
    );
    let Shape::Rectangle(rectangle) = &parse(&surface).unwrap().surfaces[0].shape else {
        panic!("not a rectangle");
    };
    assert_near(rectangle.half_v(), 15e-3 * DVec3::Z);
}

#[test]
fn every_key_reaches_the_scene() {
    let text = r#"
        [render]
        samples_per_pixel = 7
        seed = 18_446_744_073_709_551_615
        frames = 3
        [speckle]
        size = 512
        diameter = 0x80
        half_period = 4
        memory = "100 MiB"
        [camera]
        position = ["1 cm", 0, 1]
        look_at = [0.01, 0, 0]
        up = [2, 0, 0]
        focal_length = "50 mm"
        f_number = 16
        pixel_pitch = "5 µm"
        resolution = [64, 48]
        focus_distance = "0.9 m"
        displacement_per_frame = ["1 um", 0, 0]
        [[laser]]
        wavelength = 532e-9
        power = 1e-3
        position = [0, 0, 1]
        look_at = [0, "1 mm", 0]
        line_direction = [1, 1, 0]
        [laser.line]
        fan_angle = "20 deg"
        thickness = "0.3 mm"
        focus_distance = "250 mm"
        apex_offset = "4 mm"
        profile = "powell"
        edge = 0.1
        m_squared = 1.2
        [[surface]]
        name = "ball"
        displacement_per_frame = ["0.25 mm", 0, 0]
        [surface.sphere]
        centre = [0, 0, "-5 mm"]
        radius = "5 mm"
        [surface.conductor]
        metal = "gold"
        roughness = 0.2
        [[surface]]
        rectangle.size = [1, 1]
        conductor.refractive_index = [1.4, 7]
        [[lamp]]
        point = { position = [0, 0, 2], power = "1 uW" }
        [[lamp]]
        rectangle = { centre = [0, 0, 2], normal = [0, 0, -1], size = [1, 1], radiance = 0.5 }
    "#;
    let scene = parse(text).unwrap();
    assert_eq!(scene.render.samples_per_pixel, 7, "samples");
    assert_eq!(scene.render.seed, u64::MAX, "seed");
    assert_eq!(scene.render.frames, 3, "frames");
    assert_eq!(scene.speckle.size, Some(512), "size");
    assert_eq!(scene.speckle.diameter, Some(128), "diameter");
    assert_eq!(scene.speckle.half_period, Some(4), "half period");
    assert_eq!(scene.speckle.memory, 100 << 20, "memory");
    assert_eq!(
        scene.camera_displacement_per_frame,
        1e-6 * DVec3::X,
        "motion"
    );
    let camera = scene.camera.description();
    assert_eq!(camera.position, DVec3::new(0.01, 0.0, 1.0), "position");
    assert_eq!(camera.up, DVec3::X, "up");
    assert_relative_eq!(camera.focal_length, 0.05);
    assert_relative_eq!(camera.f_number, 16.0);
    assert_relative_eq!(camera.focus_distance, 0.9);
    assert_relative_eq!(camera.pixel_pitch, 5e-6);
    let laser = scene.lasers[0].description();
    assert_relative_eq!(laser.wavelength, 532e-9);
    assert_eq!(laser.look_at, 1e-3 * DVec3::Y, "look_at");
    let diagonal = DVec3::new(1.0, 1.0, 0.0).normalize();
    assert_near(laser.line_direction, diagonal);
    let BeamShape::Line {
        fan,
        m_squared,
        profile,
        ..
    } = laser.shape
    else {
        panic!("not a line");
    };
    assert_relative_eq!(fan.fan_angle, 20_f64.to_radians());
    assert_relative_eq!(fan.focus_distance, 0.25);
    assert_relative_eq!(fan.apex_offset, 4e-3);
    assert_relative_eq!(m_squared, 1.2);
    assert_eq!(profile, LineProfile::Powell { edge: 0.1 }, "profile");
    let ball = &scene.surfaces[0];
    assert_eq!(ball.name, "ball", "name");
    assert_eq!(ball.displacement_per_frame, 0.25e-3 * DVec3::X, "motion");
    assert_eq!(
        ball.material,
        Material::conductor(Metal::Gold, 0.2).unwrap(),
        "gold"
    );
    let custom = Metal::Custom { n: 1.4, k: 7.0 };
    let plate = &scene.surfaces[1];
    assert_eq!(
        plate.material,
        Material::conductor(custom, 0.3).unwrap(),
        "index"
    );
    assert!(
        matches!(scene.lamps[0], Lamp::Point { .. }),
        "{:?}",
        scene.lamps
    );
    let Lamp::Area {
        rectangle,
        radiance,
    } = &scene.lamps[1]
    else {
        panic!("not an area");
    };
    assert_relative_eq!(*radiance, 0.5);
    assert_near(rectangle.normal(), -DVec3::Z);
}

#[test]
fn typos_in_keys_are_answered_with_the_nearest_key() {
    let typo = with("wavelength", "wavelenght");
    assert_refused(&typo, 4, &["`wavelenght`", "[[laser]]", "`wavelength`?"]);
    let typo = with("rectangle", "rectangel");
    assert_refused(&typo, 9, &["`rectangel`", "[[surface]]", "`rectangle`?"]);
    let typo = with("spot.waist_radius", "spot.waist_raduis");
    assert_refused(&typo, 7, &["[laser.spot]", "`waist_radius`?"]);
    let typo = with("[camera]", "[camrea]");
    assert_refused(&typo, 1, &["the scene", "`camera`?"]);

    let error = parse(&with("position = [0, 0", "xyzzy = [0, 0")).unwrap_err();
    assert_eq!(
        error.message(),
        "unknown key `xyzzy` in [camera]",
        "no guess"
    );
    let help = error.help().unwrap();
    assert!(help.contains("focal_length"), "all keys are listed: {help}");
}

#[test]
fn the_first_of_two_mistakes_is_told() {
    let text = with("power = ", "zower = 1\naower = ");
    assert_refused(&text, 5, &["`zower`"]);
}

#[test]
fn keys_that_slipped_under_the_wrong_header_are_sent_back() {
    let text = "[[surface]]\n[surface.sphere]\nradius = 1\ndisplacement_per_frame = [0, 0, 0]\n";
    let error = parse(&[CAMERA, LASER, text].concat()).unwrap_err();
    assert_eq!(error.line_column(), Some((11, 1)), "{error}");
    let help = error.help().unwrap();
    assert!(help.contains("belongs to [[surface]]"), "{help}");
    assert!(help.contains("above the line `[surface.sphere]`"), "{help}");
}

#[test]
fn wavelengths_must_be_those_of_light() {
    let wavelength = |value: &str| with("\"650 nm\"", value);
    for bad in ["\"-650 nm\"", "0", "-650e-9", "650", "\"650 mm\""] {
        assert_refused(&wavelength(bad), 4, &["`wavelength`", "10 nm to 1 mm", bad]);
    }
    let missing = with("wavelength = \"650 nm\"\n", "");
    assert_refused(&missing, 3, &["[[laser]]", "`wavelength`"]);
    let help = parse(&missing).unwrap_err().help().unwrap().to_owned();
    assert!(help.contains("wavelength = \"650 nm\""), "{help}");
}

#[test]
fn units_must_be_those_of_the_quantity() {
    let cases = [
        (
            "\"0.5 mm\"",
            "\"0.5 deg\"",
            "a length in nm, um, µm, mm, cm or m",
        ),
        ("\"0.5 mm\"", "\"half a millimetre\"", "a length in"),
        ("\"0.5 mm\"", "\"0.5\"", "a length in"),
        ("\"0.5 mm\"", "true", "a length in"),
        ("\"0.5 mm\"", "[1]", "a length in"),
    ];
    for (good, bad, allowed) in cases {
        assert_refused(&with(good, bad), 7, &["`waist_radius`", allowed, bad]);
    }
    assert_refused(&with("\"5 mW\"", "\"5 mm\""), 5, &["`power`", "a power in"]);
    let power = "power = [0, 0, 1]";
    assert_refused(
        &with("power = \"5 mW\"", power),
        5,
        &["`power`", "[0, 0, 1]"],
    );
    let element = with("300 mm", "300 nm 2");
    assert_refused(&element, 2, &["element 3 of `position`", "\"300 nm 2\""]);
}

#[test]
fn numbers_must_be_finite_and_of_a_size_that_exists() {
    for bad in [
        "nan",
        "inf",
        "-inf",
        "1e400",
        "1e300",
        "99999999999999999999999999",
    ] {
        assert_refused(
            &with("\"0.5 mm\"", bad),
            7,
            &["`waist_radius`", "finite", bad],
        );
    }
    assert_refused(&with("\"0.5 mm\"", "1e-300"), 7, &["positive", "1e-300"]);
    assert_refused(&with("\"0.5 mm\"", "\"1e999 mm\""), 7, &["finite"]);
}

#[test]
fn sizes_and_powers_must_be_positive() {
    let radius = [CAMERA, LASER, "[[surface]]\nsphere.radius = 0\n"].concat();
    assert_refused(&radius, 9, &["`radius`", "positive", "got 0"]);
    let lamp = |line: &str| format!("{}[[lamp]]\n{line}\n", minimal());
    let point = lamp("point = { position = [0, 0, 1], power = 0 }");
    assert_refused(&point, 11, &["`power`", "positive", "got 0"]);
    let area = lamp("rectangle = { size = [1, 1], radiance = \"-1 W/(m² sr)\" }");
    assert_refused(&area, 11, &["`radiance`", "positive", "\"-1 W/(m² sr)\""]);
    assert_refused(&lamp(""), 10, &["needs a shape", "[lamp.point] or"]);
}

#[test]
fn settings_must_be_whole_numbers_in_range() {
    let render = |line: &str| format!("[render]\n{line}\n{}", minimal());
    for bad in ["0", "-1", "1.5", "1000001", "\"16\""] {
        let line = format!("samples_per_pixel = {bad}");
        assert_refused(
            &render(&line),
            2,
            &["`samples_per_pixel`", "from 1 to", bad],
        );
    }
    assert_refused(&render("frames = 0"), 2, &["`frames`", "got 0"]);
    assert_refused(&render("seed = -1"), 2, &["`seed`", "got -1"]);
}

#[test]
fn images_must_have_pixels_and_fit_into_memory() {
    let resolution = |value: &str| with("[camera]\n", &format!("[camera]\nresolution = {value}\n"));
    let huge = resolution("[1_000_000, 1_000_000]");
    assert_refused(&huge, 2, &["resolution", "1000000 × 1000000", "at most"]);
    assert_refused(
        &resolution("[0, 240]"),
        2,
        &["element 1 of `resolution`", "got 0"],
    );
    assert_refused(&resolution("[320]"), 2, &["`resolution`", "two numbers"]);
    assert_refused(&resolution("\"320x240\""), 2, &["`resolution`", "320x240"]);
}

#[test]
fn random_fields_wider_than_half_the_pattern_are_refused() {
    let text = format!("{}[speckle]\nsize = 512\ndiameter = 257\n", minimal());
    assert_refused(&text, 12, &["`diameter`", "half of `size`", "256", "257"]);
    let text = format!("{}[speckle]\nmemory = \"1 mm\"\n", minimal());
    assert_refused(&text, 11, &["`memory`", "MiB"]);
}

#[test]
fn toml_errors_keep_their_place() {
    assert_refused("[camera\n", 1, &["not valid TOML"]);
    assert_refused("a = 1\nb = \n", 2, &["not valid TOML"]);
    assert_refused(
        "[camera]\nup = [0, 1, 0]\nup = [0, 0, 1]\n",
        3,
        &["duplicate key"],
    );
    assert_refused("[camera]\n[camera]\n", 2, &["duplicate key"]);
}

#[test]
fn sections_must_be_tables_of_the_right_kind() {
    assert_refused("camera = 5\n", 1, &["`camera`", "[camera]", "got 5"]);
    let single = with("[[laser]]", "[laser]");
    assert_refused(&single, 3, &["`laser`", "[[laser]]"]);
    let text = format!("lamp = [1, 2]\n{}", minimal());
    assert_refused(&text, 1, &["`lamp`", "[[lamp]]", "got 1"]);
}

#[test]
fn each_surface_has_one_shape_and_at_most_one_material() {
    let two = format!("{}sphere.radius = 1\n", minimal());
    assert_refused(
        &two,
        10,
        &["[[surface]]", "one shape", "`rectangle`", "`sphere`"],
    );
    let two = format!(
        "{}lambertian = {{}}\nconductor.metal = \"gold\"\n",
        minimal()
    );
    assert_refused(&two, 11, &["one material", "`lambertian`", "`conductor`"]);
    let none = [CAMERA, LASER, "[[surface]]\n"].concat();
    assert_refused(
        &none,
        8,
        &["needs a shape", "[surface.rectangle]", "[surface.mesh]"],
    );
    let two = with("spot.", "line.fan_angle = 1\nspot.");
    assert_refused(&two, 8, &["[[laser]]", "one shape", "`line` and `spot`"]);
    let none = with("spot.waist_radius = \"0.5 mm\"\n", "");
    assert_refused(&none, 3, &["needs a shape", "[laser.spot] or [laser.line]"]);
}

#[test]
fn names_of_metals_and_profiles_must_be_known() {
    let surface = |line: &str| format!("{}{line}\n", minimal());
    let error = parse(&surface("conductor.metal = \"aluminum\"")).unwrap_err();
    assert_eq!(error.line_column(), Some((10, 19)), "{error}");
    assert!(
        error.message().contains("\"aluminium\", \"silver\""),
        "{error}"
    );
    assert_eq!(error.help(), Some("did you mean \"aluminium\"?"), "{error}");
    let both = "conductor = { metal = \"gold\", refractive_index = [1, 2] }";
    assert_refused(&surface(both), 10, &["`refractive_index`", "`metal`"]);
    assert_refused(
        &surface("conductor.roughness = 0.2"),
        10,
        &["needs the key `metal`"],
    );
    let rough = "conductor = { metal = \"gold\", roughness = 2 }";
    assert_refused(
        &surface(rough),
        10,
        &["`roughness`", "from 0.01 to 1", "got 2"],
    );
    assert_refused(
        &surface("lambertian.reflectance = 1.1"),
        10,
        &["`reflectance`"],
    );
    let line = "line = { fan_angle = 1, thickness = \"1 mm\", profile = \"gauss\" }";
    let error = parse(&with("spot.waist_radius = \"0.5 mm\"", line)).unwrap_err();
    assert_eq!(error.help(), Some("did you mean \"gaussian\"?"), "{error}");
    let line = line.replace("profile = \"gauss\"", "edge = 0.1");
    let edge = with("spot.waist_radius = \"0.5 mm\"", &line);
    assert_refused(&edge, 7, &["`edge`", "powell"]);
}

#[test]
fn metals_must_have_been_measured_at_the_wavelength() {
    let text = format!("{}conductor.metal = \"gold\"\n", minimal());
    let infrared = text.replace("650 nm", "1550 nm");
    assert_refused(&infrared, 10, &["wavelength", "1088e-9 m"]);
}

#[test]
fn what_constructors_refuse_is_placed_at_its_key() {
    let cases = [
        // A waist of 100 nm is below the paraxial limit of 2λ/π = 414 nm.
        (with("\"0.5 mm\"", "\"100 nm\""), 7, "paraxial"),
        (
            with("position = [0.1, 0, 0.2]", "position = [0, 0, 0]"),
            6,
            "`look_at`",
        ),
        (with("[camera]\n", "[camera]\nup = [0, 0, 1]\n"), 2, "up"),
        (
            with("[camera]\n", "\n[camera]\nfocal_length = 1\n"),
            2,
            "focus_distance",
        ),
        (
            with("spot.", "spot.m_squared = 0.9\nspot."),
            7,
            "must be 1 or greater",
        ),
        (
            with("spot.", "line_direction = [1, 0, 2]\nspot."),
            7,
            "fan axis",
        ),
        (
            with("rectangle.size", "rectangle.up = [0, 0, 3]\nrectangle.size"),
            9,
            "`up`",
        ),
    ];
    for (text, line, word) in cases {
        assert_refused(&text, line, &[word]);
    }
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n\
                           f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// Writes a mesh file and reads a scene that uses it with further keys.
fn parse_with_mesh(name: &str, content: &str, keys: &str) -> Result<Scene, SceneError> {
    let directory = TempDir::new().unwrap();
    fs::write(directory.path().join(name), content).unwrap();
    let surface = format!("[[surface]]\n[surface.mesh]\nfile = \"{name}\"\n{keys}\n");
    let text = [CAMERA, LASER, &surface].concat();
    fs::write(directory.path().join("scene.toml"), text).unwrap();
    read_scene(&directory.path().join("scene.toml"))
}

#[test]
fn meshes_are_scaled_then_turned_then_moved() {
    let keys = "unit = \"cm\"\nscale = 2\nposition = [\"3 mm\", 0, \"1 mm\"]\n\
                rotation = { axis = [0, 0, 7], angle = \"90 deg\" }";
    let scene = parse_with_mesh("a.obj", TETRAHEDRON, keys).unwrap();
    // 0 ≤ x, y, z ≤ 20 mm; the turn takes +x to +y and +y to −x.
    let (low, high) = scene.surfaces[0].shape.bounds();
    assert!(
        low.distance(DVec3::new(-0.017, 0.0, 0.001)) < 1e-15,
        "{low}"
    );
    assert!(
        high.distance(DVec3::new(0.003, 0.02, 0.021)) < 1e-15,
        "{high}"
    );

    let scene = parse_with_mesh("a.obj", TETRAHEDRON, "").unwrap();
    let (_, high) = scene.surfaces[0].shape.bounds();
    assert!(
        high.distance(DVec3::splat(1e-3)) < 1e-15,
        "millimetres: {high}"
    );
    let scene = parse_with_mesh("a.obj", TETRAHEDRON, "unit = \"25.4 mm\"").unwrap();
    let (_, high) = scene.surfaces[0].shape.bounds();
    assert!(
        high.distance(DVec3::splat(25.4e-3)) < 1e-15,
        "inches: {high}"
    );
}

#[test]
fn bad_meshes_are_placed_at_their_file() {
    let cases = [
        ("a.obj", "v 0 0 0\n", "no triangles"),
        (
            "a.obj",
            "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            "vertex 0",
        ),
        ("a.step", TETRAHEDRON, ".ply"),
    ];
    for (name, content, word) in cases {
        let error = parse_with_mesh(name, content, "").unwrap_err();
        assert_eq!(error.line_column(), Some((10, 8)), "{error}");
        assert!(
            error.message().contains(word),
            "{word:?} is not in: {error}"
        );
    }
    let missing = parse_with_mesh("a.obj", TETRAHEDRON, "").map(|_| ());
    assert!(missing.is_ok(), "the mesh is beside the scene: {missing:?}");
    let elsewhere = "[[surface]]\nmesh.file = \"no/such.ply\"\n";
    assert_refused(&[CAMERA, LASER, elsewhere].concat(), 9, &["such.ply"]);
    let unit = parse_with_mesh("a.obj", TETRAHEDRON, "unit = \"deg\"").unwrap_err();
    assert!(unit.message().contains("a length in"), "{unit}");
}

#[test]
fn unreadable_files_are_refused_by_name() {
    let directory = TempDir::new().unwrap();
    let missing = directory.path().join("missing.toml");
    let error = read_scene(&missing).unwrap_err();
    assert_eq!(error.path(), Some(missing.as_path()), "{error}");
    assert!(
        error
            .to_string()
            .contains("missing.toml: the scene file cannot be read"),
        "{error}"
    );

    let error = read_scene(directory.path()).unwrap_err();
    assert!(error.message().ends_with(": it is a directory"), "{error}");

    let binary = directory.path().join("binary.toml");
    fs::write(&binary, b"[camera]\nup = \xff\n").unwrap();
    let error = read_scene(&binary).unwrap_err();
    assert!(error.message().contains("UTF-8"), "{error}");
    assert_eq!(error.line_column(), Some((2, 6)), "{error}");
}

#[test]
fn errors_point_at_the_bytes_that_are_wrong() {
    let text = with("\"5 mW\"", "\"−5 mW\"");
    let error = parse(&text).unwrap_err();
    let span = error.span().unwrap();
    assert_eq!(&error.source_text()[span], "\"−5 mW\"", "{error}");
    assert!(
        error.to_string().starts_with("scene:5:9: `power` must be"),
        "{error}"
    );
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in ".{0,200}") {
        // The message is made, too: it slices the text.
        let _ = parse(&text).map_err(|error| error.to_string());
    }

    #[test]
    fn any_damage_to_a_scene_is_read_or_refused(
        start in 0_usize..400,
        length in 0_usize..12,
        patch in "[-0-9a-z.\"'\\[\\]{}=, \nµ]{0,12}",
    ) {
        let text: Vec<char> = minimal().chars().collect();
        let start = start.min(text.len());
        let end = (start + length).min(text.len());
        let damaged: String = text[..start].iter().copied()
            .chain(patch.chars())
            .chain(text[end..].iter().copied())
            .collect();
        if let Err(error) = parse(&damaged) {
            let span = error.span().unwrap_or(0..0);
            prop_assert!(error.source_text().get(span).is_some(), "{error}");
        }
    }

    #[test]
    fn any_number_in_any_place_is_read_or_refused(
        place in 0_usize..6,
        number in prop_oneof![any::<f64>(), Just(0.0), Just(1e308), Just(5e-324)],
    ) {
        let places = ["\"300 mm\"", "\"650 nm\"", "\"5 mW\"", "0.1", "\"0.5 mm\"", "\"40 mm\""];
        let text = with(places[place], &toml_float(number));
        let _ = parse(&text).map_err(|error| error.to_string());
    }
}

/// Spells a number as TOML does.
fn toml_float(number: f64) -> String {
    format!("{number:e}").replace("NaN", "nan")
}
