//! `tem00 render` with one frame.

use std::{fs, path::Path, process::Stdio};

use serde_json::Value;

use super::*;

#[test]
fn bad_scenes_are_located_and_leave_no_folder() {
    for (good, bad, part) in [
        ("wavelength", "wave_length", "wavelength"),
        ("\"650 nm\"", "\"-650 nm\"", "-650"),
        ("wavelength = \"650 nm\"", "", "wavelength"),
        ("\"0.2 mm\"", "\"0.2 kg\"", "kg"),
        ("[48, 40]", "[1000000, 1000000]", "1000000"),
        (
            "samples_per_pixel = 4",
            "samples_per_pixel = 0",
            "samples_per_pixel",
        ),
        (
            "[render]",
            "[speckle]\nsize = 64\ndiameter = 48\n[render]",
            "48",
        ),
        (
            "rectangle = { centre",
            "mesh = { file = \"no.ply\" }\n#",
            "no.ply",
        ),
        ("[camera]", "[camera", "TOML"),
    ] {
        let folder = folder();
        let scene = SCENE.replacen(good, bad, 1);
        assert_ne!(scene, SCENE, "{good} is replaced");
        fs::write(folder.path().join("a.toml"), scene).expect("written");
        let output = run(folder.path(), "render a.toml");
        assert_code(&output, 2);
        let message = message(&output);
        assert!(
            message.contains("a.toml") && message.contains(part),
            "{bad}: {message}"
        );
        assert_eq!(files(folder.path()), ["a.toml"], "{bad}");
    }
}

#[test]
fn a_render_writes_preview_layers_and_summary() {
    let folder = scene_folder();
    let output = run(folder.path(), "render a.toml --seed 5");
    assert_code(&output, 0);
    let out = folder.path().join("out").join("a");
    assert_eq!(files(&out), ["a.exr", "a.json", "a.png"]);
    assert_eq!(
        text(&output.stdout).lines().count(),
        3,
        "the names of the files are the data"
    );

    let summary = fs::read(out.join("a.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    assert_eq!(summary["seed"], 5);
    assert_eq!(summary["samples"], 48 * 40 * 4);
    // h = λ d / D = 650 nm · 27.27 mm / 3.125 mm = 5.67 µm, 1.64 pixels of 3.45 µm.
    let size = summary["lasers"][0]["pattern"]["speckle_size_pixels"].as_f64();
    assert!((size.expect("a size") - 1.644).abs() < 0.005, "{size:?}");
    assert!(
        summary["exposure"]["white_level"].as_f64() > Some(0.0),
        "{summary}"
    );
}

#[test]
fn files_do_not_depend_on_the_number_of_threads() {
    let folder = scene_folder();
    for threads in [1, 3] {
        let line = format!("render a.toml -o {threads} --threads {threads}");
        assert_code(&run(folder.path(), &line), 0);
    }
    for name in ["a.png", "a.exr"] {
        let file = |threads: &str| fs::read(folder.path().join(threads).join(name));
        let (one, three) = (file("1").expect("written"), file("3").expect("written"));
        assert!(one == three, "{name} differs");
    }
}

#[test]
fn without_speckle_the_factor_is_one() {
    let folder = scene_folder();
    assert_code(&run(folder.path(), "render a.toml -o . --no-speckle"), 0);
    // The factor is even, which is no speckle to measure.
    let output = run(folder.path(), "stats a.exr --channel laser_0.speckle");
    assert_code(&output, 2);
    assert!(
        message(&output).contains("more than one value, got 1"),
        "{}",
        message(&output)
    );
}

/// Returns what a preview says about its exposure.
pub(crate) fn exposure(preview: &Path) -> String {
    let file = fs::File::open(preview).expect("a preview");
    let reader = png::Decoder::new(std::io::BufReader::new(file)).read_info();
    let reader = reader.expect("a PNG");
    let mut texts = reader.info().utf8_text.iter();
    let chunk = texts.find(|chunk| chunk.keyword == "Exposure");
    chunk
        .expect("the exposure is stated")
        .get_text()
        .expect("UTF-8")
}

#[test]
fn what_was_asked_for_is_in_the_summary() {
    let folder = scene_folder();
    let line = "render a.toml -o . --white-level 1e3 --spp 2 --seed 9 --threads 1";
    assert_code(&run(folder.path(), line), 0);
    assert!(
        exposure(&folder.path().join("a.png")).contains("1e3 W"),
        "the exposure is stated"
    );
    let summary = fs::read(folder.path().join("a.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    assert_eq!(summary["exposure"]["white_level"], 1e3);
    assert_eq!(summary["samples_per_pixel"], 2);
    assert_eq!(summary["seed"], 9);
    assert_eq!(summary["threads"], 1);
}

#[test]
fn the_reference_renders_files_of_its_own_with_the_same_power() {
    let folder = scene_folder();
    let [engine, reference] = ["", "--reference"].map(|option| {
        let line = format!("render a.toml -o . --spp 4 {option}");
        assert_code(&run(folder.path(), &line), 0);
        let summary = fs::read(folder.path().join("a.json")).expect("a summary");
        let summary: Value = serde_json::from_slice(&summary).expect("JSON");
        let layers = fs::read(folder.path().join("a.exr")).expect("layers");
        assert_eq!(summary["reference"], !option.is_empty());
        (
            summary["frames"][0]["lasers"][0]["power_on_target"].clone(),
            layers,
        )
    });
    assert_ne!(engine.1, reference.1, "random numbers of their own");
    let [engine, reference] = [engine.0, reference.0].map(|power| power.as_f64().expect("a power"));
    assert!(
        (reference / engine - 1.0).abs() < 0.1,
        "{engine} | {reference}"
    );
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_render_cleanly() {
    use std::{thread::sleep, time::Duration};

    let folder = scene_folder();
    let child = tem00(folder.path(), "render a.toml -o out --spp 10000")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // The folder appears when the render is about to start, within seconds on a busy machine.
    let started = (0..6_000).any(|_| {
        sleep(Duration::from_millis(5));
        folder.path().join("out").exists()
    });
    assert!(started, "the render starts");
    sleep(Duration::from_millis(100));
    interrupt(&child);

    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 130);
    assert!(output.stdout.is_empty(), "nothing was written");
    assert!(
        files(&folder.path().join("out")).is_empty(),
        "nothing is left"
    );
}

#[test]
fn too_little_memory_for_speckle_is_told_with_what_helps() {
    let folder = folder();
    let scene = format!("{SCENE}\n[speckle]\nmemory = \"2 KiB\"\n");
    fs::write(folder.path().join("a.toml"), scene).expect("written");
    let output = run(folder.path(), "render a.toml");
    assert_code(&output, 2);
    let told = message(&output);
    assert!(told.contains("KiB needed, 2 KiB allowed"), "{told}");
    assert_code(&run(folder.path(), "render a.toml --no-speckle"), 0);
}

/// Returns the channel of an image file as `tem00 stats` sees it.
fn mean_of(folder: &Path, file: &str, channel: &str) -> f64 {
    let output = run(folder, &format!("stats {file} --channel {channel} --json"));
    assert_code(&output, 0);
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    found["rows"][0]["measured"].as_f64().expect("a number")
}

#[test]
fn a_crop_is_a_part_of_the_image() {
    let folder = scene_folder();
    assert_code(&run(folder.path(), "render a.toml -o whole"), 0);
    assert_code(
        &run(folder.path(), "render a.toml -o part --crop 8,6,24,20"),
        0,
    );
    let whole = channel(&folder.path().join("whole/a.exr"));
    let part = channel(&folder.path().join("part/a.exr"));
    assert_eq!((part.0, part.1), ([8, 6], [24, 20]), "the data window");
    let [x0, y0] = part.0;
    for y in 0..20 {
        for x in 0..24 {
            let (here, there) = (part.2[y * 24 + x], whole.2[(y + y0) * 48 + x + x0]);
            assert_eq!(here.to_bits(), there.to_bits(), "pixel ({x}, {y})");
        }
    }
    let summary = fs::read(folder.path().join("part/a.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    assert_eq!(summary["crop"], serde_json::json!([8, 6, 24, 20]));
    assert_eq!(summary["samples"], 24 * 20 * 4);
}

/// Returns origin, size and values of the first laser's layer `radiance`.
fn channel(path: &Path) -> ([usize; 2], [usize; 2], Vec<f32>) {
    use exr::prelude::*;
    let image = read_all_flat_layers_from_file(path).expect("an OpenEXR file");
    let layer = &image.layer_data[1];
    let channel = layer.channel_data.list.iter();
    let channel = channel
        .clone()
        .find(|channel| channel.name.to_string() == "radiance");
    let position = layer.attributes.layer_position;
    let origin = [position.x(), position.y()].map(|p| usize::try_from(p).expect("inside"));
    let values = channel.expect("the channel").sample_data.values_as_f32();
    (origin, [layer.size.x(), layer.size.y()], values.collect())
}

#[test]
fn options_overrule_the_scene() {
    let folder = scene_folder();
    let line = "render a.toml -o . --method light --max-depth 1 --no-speckle";
    assert_code(&run(folder.path(), line), 0);
    // The light tracer finds what the path tracer finds.
    let light = mean_of(folder.path(), "a.exr", "laser_0.single");
    assert_code(
        &run(folder.path(), "render a.toml -o . --no-speckle --spp 64"),
        0,
    );
    let path = mean_of(folder.path(), "a.exr", "laser_0.single");
    // 7680 photons of which nearly all reach the image: 1.2 % of noise in the mean.
    assert!((light / path - 1.0).abs() < 0.06, "{light} is not {path}");
    let summary = fs::read(folder.path().join("a.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    assert_eq!(summary["method"], "path");
    assert_eq!(summary["max_depth"], Value::Null);
}

#[test]
fn light_that_no_method_finds_is_told() {
    let folder = scene_folder();
    let mirror = format!(
        "{SCENE}\n[[surface]]\nrectangle = {{ centre = [0, 1, 0], size = [0.1, 0.1] }}\nmirror = {{}}\n"
    );
    fs::write(folder.path().join("a.toml"), mirror).expect("written");
    let output = run(folder.path(), "render a.toml");
    assert_code(&output, 0);
    let said = message(&output);
    assert!(said.contains("before and behind a rough surface"), "{said}");
}

#[test]
fn surfaces_too_smooth_for_speckle_are_told() {
    let folder = scene_folder();
    let smooth = format!(
        "{SCENE}\n[[surface]]\nname = \"gauge\"\nsphere.radius = \"1 mm\"\n\
                          conductor = {{ metal = \"iron\", roughness = 0.01 }}\n"
    );
    fs::write(folder.path().join("a.toml"), smooth).expect("written");
    let output = run(folder.path(), "render a.toml --spp 1");
    assert_code(&output, 0);
    let said = message(&output);
    assert!(said.contains("surface `gauge` is too smooth"), "{said}");
    // Without speckle there is nothing to be too smooth for.
    let output = run(folder.path(), "render a.toml --spp 1 --no-speckle");
    assert!(
        !message(&output).contains("too smooth"),
        "{}",
        message(&output)
    );
}

#[test]
fn a_fast_lens_shows_the_contrast_that_its_samples_leave() {
    let folder = scene_folder();
    let wide = SCENE
        .replace("[48, 40]", "[120, 100]")
        .replace("0.2 mm", "2 mm");
    fs::write(folder.path().join("a.toml"), wide).expect("written");
    // Speckles of 0.1 and 0.41 pixels, from the law of pixels that few samples miss to that of one sample.
    for (f_number, samples) in [("0.5", 1), ("0.5", 16), ("0.5", 64), ("2", 2), ("2", 8)] {
        let options = format!("--set camera.f_number={f_number} --spp {samples}");
        assert_code(
            &run(folder.path(), &format!("render a.toml -o . {options}")),
            0,
        );
        let summary = fs::read(folder.path().join("a.json")).expect("a summary");
        let summary: Value = serde_json::from_slice(&summary).expect("JSON");
        let contrast = &summary["frames"][0]["lasers"][0]["contrast"];
        let [measured, expected, error] = ["measured", "expected", "standard_error"]
            .map(|key| contrast[key].as_f64().expect("a number"));
        assert!(
            (measured - expected).abs() < 4.0 * error && error < 0.01 * (1.0 + expected),
            "f/{f_number}, {samples}: {measured} ± {error}, {expected}"
        );
    }
}

#[test]
fn contrast_is_told_only_where_it_is_known() {
    let folder = scene_folder();
    let contrast = |scene: &str, options: &str| {
        fs::write(folder.path().join("a.toml"), scene).expect("written");
        assert_code(
            &run(folder.path(), &format!("render a.toml -o . {options}")),
            0,
        );
        let summary = fs::read(folder.path().join("a.json")).expect("a summary");
        let summary: Value = serde_json::from_slice(&summary).expect("JSON");
        summary["frames"][0]["lasers"][0]["contrast"].clone()
    };
    assert!(
        contrast(SCENE, "").is_object(),
        "one sharp polarised pattern"
    );
    // The expectation is that of box-shaped pixels, seen by a fixed number of camera samples.
    let gaussian = SCENE.replace("[render]", "[render]\nfilter = \"gaussian\"");
    assert!(contrast(&gaussian, "").is_null(), "another filter");
    assert!(contrast(SCENE, "--method light").is_null(), "splats");
    assert!(
        contrast(SCENE, "--target-error 0.5").is_null(),
        "any number"
    );
    let paper = SCENE.replace("[render]", "speckle.polarisation = 0\n[render]");
    assert!(contrast(&paper, "").is_null(), "two patterns");
}
