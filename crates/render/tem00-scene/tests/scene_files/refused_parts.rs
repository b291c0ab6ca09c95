//! Motion, instances, materials and settings that are refused.

use super::refused::{assert_refused, assert_rows_refused};
use super::{minimal, parse, with};

/// The minimal scene has nine lines; what follows stands from line 10 on.
fn surface(keys: &str) -> String {
    format!("{}{keys}\n", minimal())
}

#[test]
fn settings_of_the_image_must_fit_it() {
    let render = |line: &str| format!("[render]\n{line}\n{}", minimal());
    assert_rows_refused(
        2,
        render,
        r#"
        reference_frame = 1 => `reference_frame` | from 0 to 0 | got 1
        reference_frame = -1 => `reference_frame` | got -1
        max_depth = 0 => `max_depth` | from 1 to | got 0
        method = "photon" => `method` | "path", "light"
        method = 1 => `method` | string
        laser_events = "none" => `laser_events` | "beam", "sampled"
        crop = [0, 0, 321, 1] => `crop` | 320 × 240 | [0, 0, 321, 1]
        crop = [320, 0, 1, 1] => `crop` | 320 × 240
        crop = [0, 0, 0, 1] => element 3 of `crop` | from 1 to
        crop = [-1, 0, 1, 1] => element 1 of `crop` | got -1
        crop = [4294967295, 0, 4294967295, 1] => `crop` | 320 × 240
        crop = [1, 2] => `crop` | [x, y, width, height]
        target_error = 0 => `target_error` | from 1e-6 to 1
        target_error = 1.5 => `target_error` | from 1e-6 to 1
        target_error = nan => `target_error` | finite
        adaptive = 1 => `adaptive` | true or false
    "#,
    );
    let both = render("target_error = 0.1\nadaptive = true");
    assert_refused(&both, 3, &["`adaptive`", "`target_error`"]);
}

#[test]
fn cameras_must_be_possible() {
    let camera = |line: &str| with("[camera]\n", &format!("[camera]\n{line}\n"));
    assert_rows_refused(
        2,
        camera,
        r#"
        principal_point = [1] => `principal_point` | two numbers
        principal_point = [inf, 1] => element 1 of `principal_point` | finite
        tilt = 5 => `tilt` | a table
        tilt = {} => [camera.tilt] | `angle`
        tilt = { angle = "91 deg" } => tilt | right angle
        tilt = { angel = 1 } => unknown key `angel` | `angle`?
        distortion = -0.1 => `distortion` | [k1, k2, k3]
        distortion = [-1e9, 0, 0] => distortion
        depth_of_field = 0 => `depth_of_field` | true or false | got 0
    "#,
    );
}

#[test]
fn motion_must_be_one_that_can_be_followed() {
    let cases: [(&str, usize, &[&str]); 12] = [
        (
            "rotation_per_frame = { axis = [0, 0, 0], angle = 1 }",
            10,
            &["`axis`", "not all zero"],
        ),
        (
            "rotation_per_frame = { axis = [0, 0, 1] }",
            10,
            &["needs the key `angle`"],
        ),
        (
            "rotation_per_frame = { angle = 1 }",
            10,
            &["[surface.rotation_per_frame]", "`axis`"],
        ),
        (
            "rotation_per_frame = \"30 deg\"",
            10,
            &["`rotation_per_frame`", "a table"],
        ),
        ("displacement_per_frame = \"1 mm\"", 10, &["three lengths"]),
        ("pivot = [1, 2]", 10, &["`pivot`", "three lengths"]),
        ("keyframe = {}", 10, &["`keyframe`", "[[surface.keyframe]]"]),
        (
            "[[surface.keyframe]]",
            10,
            &["[[surface.keyframe]]", "`frame`"],
        ),
        (
            "[[surface.keyframe]]\nframe = 1\n[[surface.keyframe]]\nframe = 1",
            13,
            &[
                "`frame`",
                "greater than that of the keyframe before, 1",
                "got 1",
            ],
        ),
        (
            "displacement_per_frame = [0, 0, 0]\nkeyframe = [{ frame = 0 }]",
            10,
            &["`displacement_per_frame`", "`keyframe`", "one of the two"],
        ),
        (
            "keyframe = [{ frame = 0 }]\nrotation_per_frame = { axis = [0, 0, 1], angle = 1 }",
            11,
            &["`rotation_per_frame`", "`keyframe`"],
        ),
        (
            "[[surface.keyframe]]\nframe = \"1 s\"",
            11,
            &["`frame`", "a number"],
        ),
    ];
    for (keys, line, words) in cases {
        assert_refused(&surface(keys), line, words);
    }
    let typo = "[[surface.keyframe]]\nfrme = 1\n";
    assert_refused(
        &surface(typo),
        11,
        &["`frme`", "[[surface.keyframe]]", "`frame`?"],
    );
}

#[test]
fn materials_must_be_possible() {
    assert_rows_refused(
        10,
        surface,
        r#"
        oren_nayar.roughness = "91 deg" => `roughness` | from 0° to 90°
        oren_nayar.roughness = "0.3 mm" => `roughness` | an angle in
        oren_nayar.reflectance = 1.5 => `reflectance` | from 0 to 1
        plastic.index = 5 => index must be | got 5
        plastic.roughness = 0 => `roughness` | from 0.01 to 1
        plastic.reflectance = -1 => `reflectance` | from 0 to 1
        mirror.reflectance = 2 => `reflectance` | from 0 to 1
        mirror.metal = "tin" => `metal` | "titanium"
        mirror = { metal = "gold", reflectance = 1 } => `reflectance` | `metal` | one of the two
        mirror = { refractive_index = [1, 2], reflectance = 1 } => `reflectance` | `refractive_index`
        mirror = { metal = "gold", refractive_index = [1, 2] } => `refractive_index` | `metal`
        dielectric.index = 0.5 => index must be | got 0.5
        dielectric.index = "1.5" => `index` | a number
        dielectric.roughness = 0.1 => unknown key `roughness`
        one_sided = 1 => `one_sided` | true or false
        rms_height = 0 => `rms_height` | positive
        rms_height = "1 W" => `rms_height` | a length in
        correlation_length = "1 um" => `correlation_length` | relief of a known height
        correlation_length = "-1 um"\nrms_height = 1e-6 => `correlation_length` | zero or positive
    "#,
    );
    let two = "mirror = {}\ndielectric = {}";
    assert_refused(
        &surface(two),
        11,
        &["one material", "`mirror`", "`dielectric`"],
    );
    let far = surface("mirror.metal = \"gold\"").replace("650 nm", "2 um");
    assert!(parse(&far).is_err(), "gold was not measured at 2 µm");
}

#[test]
fn shapes_speckle_and_instances_must_be_possible() {
    assert_rows_refused(
        10,
        surface,
        r#"
        speckle = 2 => `speckle` | [surface.speckle]
        speckle.patterns = 0 => `patterns` | from 1 to 1024
        speckle.patterns = 2000 => `patterns` | from 1 to 1024
        speckle.polarisation = 1.1 => `polarisation` | from 0 to 1
        speckle.pattern = 2 => `pattern` | `patterns`?
        instance = [1] => `instance` | [[surface.instance]]
        instance = [{ position = [0, 0, 0] }] => unknown key `position`
        instance = [{ displacement = 1 }] => three lengths
        instance = [{ rotation = { axis = [1, 0, 0] } }] => `angle`
    "#,
    );
    let tube = |keys: &str| with("rectangle.size = [\"40 mm\", \"30 mm\"]", keys);
    let both = "cylinder = { centre = [0, 0, 0], base = [0, 0, 0], radius = 1, length = 1 }";
    assert_refused(&tube(both), 9, &["`centre`", "`base`", "one of the two"]);
    assert_refused(&tube("cylinder.radius = 1"), 9, &["`length`"]);
    let flat = "cylinder = { radius = 1, length = 0 }";
    assert_refused(&tube(flat), 9, &["`length`", "positive"]);
    let mesh = "mesh = { file = \"a.obj\", shading = \"round\" }";
    assert_refused(&tube(mesh), 9, &["`shading`", "\"smooth\", \"flat\""]);
}

#[test]
fn filters_must_be_possible() {
    let render = |value: &str| format!("[render]\nfilter = {value}\n{}", minimal());
    assert_rows_refused(
        2,
        render,
        r#"
        "gauss" => `filter` | "gaussian"
        1 => `filter` | string
        {} => needs a kernel | [render.filter.box]
        { gauss = {} } => unknown key `gauss` | `gaussian`?
        { box = {}, gaussian = {} } => one kernel | `box` | `gaussian`
        { box.radius = 17 } => radius must be | 16 | got 17
        "lanczos" => `filter` | "box", "gaussian"
        { gaussian.standard_deviation = 0 } => standard_deviation must be | got 0
    "#,
    );
}

#[test]
fn environments_must_be_possible() {
    let light = |keys: &str| format!("{}[[light]]\nenvironment = {{ {keys} }}\n", minimal());
    assert_rows_refused(
        11,
        light,
        r#"
         => [light.environment] | `radiance`
        radiance = -1 => `radiance` | positive
        radiance = 1, up = [0, 0, 1] => `up` | belongs to a map
        radiance = 1, file = "a.exr" => `radiance` | `scale`
        file = "no.exr" => `file` | no.exr | cannot be read
        file = "no.jpg" => `file` | .exr or .pfm
        file = "a.exr", scale = 0 => `scale` | positive
    "#,
    );
}

#[test]
fn spectra_must_be_possible() {
    let laser = |keys: &str| with("wavelength = \"650 nm\"", keys);
    let cases: [(&str, usize, &[&str]); 13] = [
        ("linewidth = 1e-9", 3, &["`wavelength`"]),
        (
            "wavelength = 650e-9\nlinewidth = -1e-9",
            5,
            &["`linewidth`", "zero or positive"],
        ),
        (
            "wavelength = 650e-9\nlinewidth = \"100 nm\"",
            5,
            &["linewidth", "a tenth of the wavelength", "100 nm"],
        ),
        (
            "wavelength = 650e-9\nspectrum = \"comb\"",
            5,
            &["`spectrum`", "`linewidth`"],
        ),
        (
            "wavelength = 650e-9\nlinewidth = 1e-9\nspectrum = \"gausian\"",
            6,
            &["`spectrum`", "\"gaussian\""],
        ),
        (
            "wavelength = 650e-9\nlinewidth = 1e-9\nspectrum = 3",
            6,
            &["`spectrum`", "[wavelength, power]"],
        ),
        (
            "wavelength = 650e-9\nlinewidth = 1e-9\nspectrum = \"comb\"",
            3,
            &["`lines`"],
        ),
        (
            "wavelength = 650e-9\nlinewidth = 1e-9\nspectrum = \"comb\"\nlines = 0",
            7,
            &["`lines`", "from 1 to 256"],
        ),
        (
            "wavelength = 650e-9\nlinewidth = 1e-9\nlines = 5",
            6,
            &["`lines`", "\"comb\""],
        ),
        (
            "wavelength = 650e-9\nspectrum = [[650e-9, 1]]",
            4,
            &["`wavelength`", "`spectrum`", "one of the two"],
        ),
        ("spectrum = []", 4, &["peaks", "from 1 to 256"]),
        (
            "spectrum = [[650e-9, 1], [450e-9, 1]]",
            4,
            &["wavelength", "within a tenth of the mean"],
        ),
        ("spectrum = [[650e-9, 0]]", 4, &["element 2", "positive"]),
    ];
    for (keys, line, words) in cases {
        assert_refused(&laser(keys), line, words);
    }
}
