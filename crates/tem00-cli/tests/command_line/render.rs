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
        summary["exposure"]["white_level_w_per_m2_sr"].as_f64() > Some(0.0),
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
        message(&output).contains("all of them are 1"),
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
    let line = "render a.toml -o . --white-level 1e3 --paper --spp 2 --seed 9 --threads 1";
    assert_code(&run(folder.path(), line), 0);
    assert!(
        exposure(&folder.path().join("a.png")).contains("1e3 W"),
        "the exposure is stated"
    );
    let summary = fs::read(folder.path().join("a.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    assert_eq!(summary["exposure"]["white_level_w_per_m2_sr"], 1e3);
    assert_eq!(summary["formulas"], "as printed in Bergmann et al. 2016");
    assert_eq!(summary["samples_per_pixel"], 2);
    assert_eq!(summary["seed"], 9);
    assert_eq!(summary["threads"], 1);
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
fn a_picture_without_laser_light_says_where_things_stand() {
    let folder = folder();
    let away = SCENE.replace("centre = [0, 0, 0]", "centre = [\"70 mm\", 0, 0]");
    fs::write(folder.path().join("a.toml"), away).expect("written");
    let output = run(folder.path(), "render a.toml --spp 1");
    assert_code(&output, 0);
    let notes = text(&output.stderr);
    assert!(notes.contains("sees no light of a laser"), "{notes}");
    assert!(notes.contains("surface 1: x 60.0 … 80.0 mm"), "{notes}");
}
