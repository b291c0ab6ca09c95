use std::fs;

use tempfile::TempDir;

use super::{CAMERA, LASER, TETRAHEDRON, minimal, parse, parse_with_mesh, with};
use tem00_scene::read_scene;

/// Asserts that `text` is refused at `line`, with a message that contains all of `words`.
#[track_caller]
pub(super) fn assert_refused(text: &str, line: usize, words: &[&str]) {
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

/// Asserts that the keys of each row are refused at `line` of a scene with them, with the words behind `=>`.
#[track_caller]
pub(super) fn assert_rows_refused(line: usize, scene: impl Fn(&str) -> String, rows: &str) {
    for [keys, words] in tem00_testkit::rows(rows) {
        let words: Vec<&str> = words.split(" | ").collect();
        assert_refused(&scene(&keys), line, &words);
    }
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
fn spots_take_one_value_or_one_for_each_of_two_axes() {
    for bad in ["[1]", "[]", "[1, 1, 1]"] {
        let words = ["`waist_radius`", "one value", "[along, across]", bad];
        assert_refused(&with("\"0.5 mm\"", bad), 7, &words);
    }
    assert_rows_refused(
        7,
        |keys| {
            let spot = format!("spot = {{ {keys} }}");
            with("spot.waist_radius = \"0.5 mm\"", &spot)
        },
        r#"
        waist_radius = ["1 mm", "2 deg"] => element 2 of `waist_radius` | a length in
        waist_radius = [0, 1] => element 1 of `waist_radius` | positive
        waist_radius = [[1, 1], 1] => element 1 of `waist_radius` | a length in
        // 100 nm is below the paraxial limit of 2λ/π = 414 nm.
        waist_radius = ["1 mm", "100 nm"] => waist_radius | paraxial
        waist_radius = "1 mm", waist_distance = [0, inf] => element 2 of `waist_distance` | finite
        waist_radius = "1 mm", m_squared = [1.5, 0.9] => element 2 of `m_squared` | 1 or greater
    "#,
    );
    let line = "line = { fan_angle = 1, thickness = \"1 mm\", m_squared = [1, 2] }";
    let line = with("spot.waist_radius = \"0.5 mm\"", line);
    assert_refused(&line, 7, &["`m_squared`", "a number"]);
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
    let light = |line: &str| format!("{}[[light]]\n{line}\n", minimal());
    let point = light("point = { position = [0, 0, 1], power = 0 }");
    assert_refused(&point, 11, &["`power`", "positive", "got 0"]);
    let area = light("rectangle = { size = [1, 1], radiance = \"-1 W/(m² sr)\" }");
    assert_refused(&area, 11, &["`radiance`", "positive", "\"-1 W/(m² sr)\""]);
    assert_refused(&light(""), 10, &["needs a shape", "[light.point] or"]);
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
    assert_refused(&huge, 2, &["resolution", "[1000000, 1000000]", "at most"]);
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
    let text = format!("light = [1, 2]\n{}", minimal());
    assert_refused(&text, 1, &["`light`", "[[light]]", "got 1"]);
}

#[test]
fn old_names_of_keys_are_met_with_the_new_ones() {
    let text = format!("{}[[lamp]]\npoint.power = 1\n", minimal());
    assert_refused(&text, 10, &["`lamp` in the scene is now named `light`"]);
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
    let both = "conductor = { metal = \"gold\", finish = \"milled brass\" }";
    assert_refused(&surface(both), 10, &["`finish`", "`metal`"]);
    let error = parse(&surface("conductor.finish = \"miled steel\"")).unwrap_err();
    assert!(error.message().contains("got \"miled steel\""), "{error}");
    assert_eq!(error.help(), Some("did you mean \"milled steel\"?"));
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
    let curve = line.replace("edge = 0.1", "focus_curve = \"circle\"");
    let curve = with("spot.waist_radius = \"0.5 mm\"", &curve);
    assert_refused(&curve, 7, &["`focus_curve`", "\"distance\", \"plane\""]);
}

#[test]
fn tables_of_a_profile_must_be_tables_of_power() {
    let with_profile = |profile: &str| {
        let line = "line = { fan_angle = 1, thickness = \"1 mm\", profile = ";
        with(
            "spot.waist_radius = \"0.5 mm\"",
            &format!("{line}{profile} }}"),
        )
    };
    assert_rows_refused(
        7,
        with_profile,
        r#"
        { angles = [0, 1] } => needs the key `powers`
        { powers = [0, 1] } => needs the key `angles`
        { angles = 1, powers = [0, 1] } => `angles` | a list of angles | got 1
        { angles = [0, 1], powers = ["x", 1] } => element 1 of `powers`
        { angles = [0, 1], powers = [1] } => [2, 1]
        { angles = [0, 1, 0.5], powers = [1, 1, 1] } => angles | at index 2
        { angles = [0, 1], powers = [1, -1] } => powers | at index 1
        { angles = [0, 1], power = [1, 1] } => unknown key `power` | `powers`
    "#,
    );
    let error = parse(&with_profile(
        "{ angles = [0, 1, 0.5], powers = [1, 1, 1] }",
    ))
    .unwrap_err();
    let text = with_profile("{ angles = [0, 1, 0.5], powers = [1, 1, 1] }");
    let column = text.lines().nth(6).and_then(|line| line.find("0.5]"));
    assert_eq!(
        error.line_column(),
        column.map(|column| (7, column + 1)),
        "{error}"
    );
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
            "fan_axis must be",
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
fn long_values_are_cut_between_characters() {
    let long = format!("\"{}\"", "µ".repeat(100));
    let error = parse(&with("\"0.5 mm\"", &long)).unwrap_err();
    // The quotation mark and 59 characters.
    let cut = format!("got \"{}…", "µ".repeat(59));
    assert!(error.message().ends_with(&cut), "{error}");
}

#[test]
fn errors_point_at_the_bytes_that_are_wrong() {
    let text = with("\"5 mW\"", "\"−5 mW\"");
    let error = parse(&text).unwrap_err();
    let span = error.span().unwrap();
    assert_eq!(&error.source_text()[span], "\"−5 mW\"", "{error}");
    assert!(
        error.to_string().starts_with("text:5:9: `power` must be"),
        "{error}"
    );
}
