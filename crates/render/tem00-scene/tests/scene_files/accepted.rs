use approx::assert_relative_eq;
use glam::DVec3;
use tem00_beam::{AngularProfile, FocusCurve, LineProfile};

use super::{CAMERA, LASER, SURFACE, TETRAHEDRON, minimal, parse, parse_with_mesh, with};
use tem00_geometry::Shape;
use tem00_tracer::{BeamShape, Light, Material, Metal, RenderOptions, SpeckleSettings};

/// Asserts that two vectors of length 1 at most are equal but for a few roundings of 1e−16.
#[track_caller]
fn assert_near(got: DVec3, expected: DVec3) {
    assert!(got.distance(expected) < 1e-15, "{got} is not {expected}");
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
    assert_eq!(scene.render, RenderOptions::default(), "settings");
    assert_eq!(scene.speckle, SpeckleSettings::default(), "settings");

    for (section, missing) in [(CAMERA, "camera"), (LASER, "laser"), (SURFACE, "surface")] {
        let error = parse(&minimal().replace(section, "")).unwrap_err();
        assert!(error.message().contains(missing), "{error}");
        assert_eq!(error.span(), None, "nothing to point at: {error}");
    }
}

/// Returns the waist radii, the waist distances and the factors M² of the minimal scene's spot with
/// other keys.
fn spot(keys: &str) -> [[f64; 2]; 3] {
    let spot = format!("spot = {{ {keys} }}");
    let scene = parse(&with("spot.waist_radius = \"0.5 mm\"", &spot)).unwrap();
    let BeamShape::Spot {
        waist_radius,
        waist_distance,
        m_squared,
    } = scene.lasers[0].description().shape
    else {
        panic!("not a spot");
    };
    [waist_radius, waist_distance, m_squared]
}

#[test]
fn a_spot_is_round_and_in_focus_where_the_laser_looks() {
    // The laser stands at (0.1, 0, 0.2) and looks at the origin.
    let distance = DVec3::new(0.1, 0.0, 0.2).length();
    assert_eq!(
        spot("waist_radius = \"0.5 mm\""),
        [[0.5e-3; 2], [distance; 2], [1.0; 2]],
        "defaults"
    );
}

#[test]
fn a_spot_has_one_value_for_both_axes_or_one_for_each() {
    let keys =
        "waist_radius = [\"0.5 mm\", 2e-3], waist_distance = \"0.1 m\", m_squared = [1.5, 3]";
    assert_eq!(
        spot(keys),
        [[0.5e-3, 2e-3], [0.1; 2], [1.5, 3.0]],
        "waists at one place"
    );
    let keys = "waist_radius = \"0.5 mm\", waist_distance = [\"-10 um\", 0], m_squared = 2";
    assert_eq!(
        spot(keys),
        [[0.5e-3; 2], [-10e-6, 0.0], [2.0; 2]],
        "waists of one radius"
    );
}

#[test]
fn a_line_fans_out_from_where_its_round_beam_would_be_a_point() {
    let line = "line = { fan_angle = \"30 deg\", thickness = \"0.2 mm\", profile = \"powell\" }";
    let scene = parse(&with("spot.waist_radius = \"0.5 mm\"", line)).unwrap();
    let BeamShape::Line {
        waist_radius,
        fan,
        ref profile,
        ..
    } = scene.lasers[0].description().shape
    else {
        panic!("not a line");
    };
    assert_relative_eq!(waist_radius, 0.1e-3);
    assert_eq!(*profile, LineProfile::Powell { edge: 0.05 }, "profile");
    assert_eq!(fan.focus_curve, FocusCurve::EqualDistance, "focus curve");
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
fn lines_have_named_and_tabulated_profiles() {
    let table = [(-10_f64, 0.8), (0.0, 1.0), (12.0, 0.0)]
        .map(|(d, p)| (d * core::f64::consts::PI / 180.0, p));
    let cases = [
        ("\"gaussian\"", LineProfile::GaussianTan),
        ("\"gaussian_angle\"", LineProfile::GaussianAngle),
        ("\"gaussian_sin\"", LineProfile::GaussianSin),
        ("\"uniform\"", LineProfile::UniformTan),
        ("\"uniform_angle\"", LineProfile::UniformAngle),
        (
            "{ angles = [\"-10 deg\", 0, \"12 deg\"], powers = [0.8, 1, 0] }",
            LineProfile::Tabulated(AngularProfile::from_pairs(&table).unwrap()),
        ),
    ];
    for (text, expected) in cases {
        let line = "line = { fan_angle = \"20 deg\", thickness = \"0.2 mm\", profile = ";
        let scene = parse(&with(
            "spot.waist_radius = \"0.5 mm\"",
            &format!("{line}{text} }}"),
        ));
        let scene = scene.unwrap();
        let BeamShape::Line { ref profile, .. } = scene.lasers[0].description().shape else {
            panic!("not a line");
        };
        assert_eq!(*profile, expected, "{text}");
    }
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
        focus_curve = "plane"
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
        [[light]]
        point = { position = [0, 0, 2], power = "1 uW" }
        [[light]]
        rectangle = { centre = [0, 0, 2], normal = [0, 0, -1], size = [1, 1], radiance = 0.5 }
    "#;
    let scene = parse(text).unwrap();
    assert_eq!(scene.render.samples_per_pixel, 7, "samples");
    assert_eq!(scene.render.seed, u64::MAX, "seed");
    assert_eq!(scene.frames, 3, "frames");
    assert_eq!(scene.speckle.size, Some(512), "size");
    assert_eq!(scene.speckle.diameter, Some(128), "diameter");
    assert_eq!(scene.speckle.half_period, Some(4), "half period");
    assert_eq!(scene.speckle.memory, 100 << 20, "memory");
    assert_eq!(
        scene.camera_trajectory.pose_at(1).translation(),
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
    assert_relative_eq!(laser.line.wavelength(), 532e-9);
    assert_eq!(laser.look_at, 1e-3 * DVec3::Y, "look_at");
    let diagonal = DVec3::new(1.0, 1.0, 0.0).normalize();
    assert_near(laser.line_direction, diagonal);
    let BeamShape::Line {
        fan,
        m_squared,
        ref profile,
        ..
    } = laser.shape
    else {
        panic!("not a line");
    };
    assert_relative_eq!(fan.fan_angle, 20_f64.to_radians());
    assert_relative_eq!(fan.focus_distance, 0.25);
    assert_relative_eq!(fan.apex_offset, 4e-3);
    assert_relative_eq!(m_squared, 1.2);
    assert_eq!(*profile, LineProfile::Powell { edge: 0.1 }, "profile");
    assert_eq!(fan.focus_curve, FocusCurve::EqualPlane, "focus curve");
    let ball = &scene.surfaces[0];
    assert_eq!(ball.name, "ball", "name");
    assert_eq!(
        ball.trajectory.pose_at(1).translation(),
        0.25e-3 * DVec3::X,
        "motion"
    );
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
        matches!(scene.lights[0], Light::Point { .. }),
        "{:?}",
        scene.lights
    );
    let Light::Area {
        rectangle,
        radiance,
    } = &scene.lights[1]
    else {
        panic!("not an area");
    };
    assert_relative_eq!(*radiance, 0.5);
    assert_near(rectangle.normal(), -DVec3::Z);
}

#[test]
fn a_mesh_can_be_placed_by_the_middle_of_its_box() {
    let keys = "centre = [0, \"5 mm\", 0]\nrotation = { axis = [0, 0, 1], angle = \"90 deg\" }";
    let scene = parse_with_mesh("a.obj", TETRAHEDRON, keys).unwrap();
    // The turned tetrahedron is 1 mm wide along every axis.
    let (low, high) = scene.surfaces[0].shape.bounds();
    let centre = DVec3::new(0.0, 5e-3, 0.0);
    assert!(low.distance(centre - 0.5e-3) < 1e-15, "{low}");
    assert!(high.distance(centre + 0.5e-3) < 1e-15, "{high}");

    let both = "centre = [0, 0, 0]\nposition = [0, 0, 0]";
    let error = parse_with_mesh("a.obj", TETRAHEDRON, both).unwrap_err();
    assert!(error.message().contains("give one of the two"), "{error}");
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
