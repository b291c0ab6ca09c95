//! `tem00 render` with one frame.

use std::{fs, path::Path};

use serde_json::{Value, json};

use super::*;

/// Renders `a.toml` into the folder itself, and returns the summary.
#[track_caller]
fn rendered(folder: &Path, options: &str) -> Value {
    done(folder, &format!("render a.toml -o . {options}"));
    json_of(&folder.join("a.json"))
}

#[test]
fn a_render_writes_preview_layers_and_summary() {
    let folder = scene_folder();
    let output = done(folder.path(), "render a.toml --seed 5");
    let out = folder.path().join("out/a");
    assert_eq!(files(&out), ["a.exr", "a.json", "a.png"]);
    let named = text(&output.stdout).lines().count();
    assert_eq!(named, 3, "the names of the files are the data");

    let summary = json_of(&out.join("a.json"));
    assert_eq!(summary["seed"], 5);
    assert_eq!(summary["samples"], 48 * 40 * 4);
    // h = λ d / D = 650 nm · 27.27 mm / 3.125 mm = 5.67 µm, 1.64 pixels of 3.45 µm.
    let size = summary["lasers"][0]["pattern"]["speckle_size_pixels"].as_f64();
    assert!((size.expect("a size") - 1.644).abs() < 0.005, "{size:?}");
    let white = summary["exposure"]["white_level"].as_f64();
    assert!(white > Some(0.0), "{summary}");
}

#[test]
fn files_do_not_depend_on_the_number_of_threads() {
    let folder = scene_folder();
    for threads in [1, 3] {
        let line = format!("render a.toml -o {threads} --threads {threads}");
        done(folder.path(), &line);
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
    rendered(folder.path(), "--no-speckle");
    // The factor is even, which is no speckle to measure.
    let line = "stats a.exr --channel laser_0.speckle";
    refused(folder.path(), line, &["more than one value, got 1"]);
}

/// Returns what a preview says about its exposure.
pub(crate) fn exposure(preview: &Path) -> String {
    let file = fs::File::open(preview).expect("a preview");
    let reader = png::Decoder::new(std::io::BufReader::new(file)).read_info();
    let reader = reader.expect("a PNG");
    let mut texts = reader.info().utf8_text.iter();
    let chunk = texts.find(|chunk| chunk.keyword == "Exposure");
    let chunk = chunk.expect("the exposure is stated");
    chunk.get_text().expect("UTF-8")
}

#[test]
fn what_was_asked_for_is_in_the_summary() {
    let folder = scene_folder();
    let options = "--white-level 1e3 --spp 2 --seed 9 --threads 1";
    let summary = rendered(folder.path(), options);
    let stated = exposure(&folder.path().join("a.png"));
    assert!(stated.contains("1e3 W"), "{stated}");
    assert_eq!(summary["exposure"]["white_level"], 1e3);
    assert_eq!(summary["samples_per_pixel"], 2);
    assert_eq!(summary["seed"], 9);
    assert_eq!(summary["threads"], 1);
}

#[test]
fn the_reference_renders_files_of_its_own_with_the_same_power() {
    let folder = scene_folder();
    let [engine, reference] = ["", "--reference"].map(|option| {
        let summary = rendered(folder.path(), option);
        assert_eq!(summary["reference"], !option.is_empty());
        let power = summary["frames"][0]["lasers"][0]["power_on_target"].as_f64();
        let layers = fs::read(folder.path().join("a.exr")).expect("layers");
        (power.expect("a power"), layers)
    });
    assert_ne!(engine.1, reference.1, "random numbers of their own");
    let ratio = reference.0 / engine.0;
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_render_cleanly() {
    let folder = scene_folder();
    let out = folder.path().join("out");
    let child = start(folder.path(), "render a.toml -o out --spp 10000");
    // The folder appears when the render is about to start.
    wait_until("the render starts", || out.exists());
    std::thread::sleep(std::time::Duration::from_millis(100));
    interrupt(&child);

    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 130);
    assert!(output.stdout.is_empty(), "nothing was written");
    assert!(files(&out).is_empty(), "nothing is left");
}

/// Returns the mean of a channel of an image file as `tem00 stats` sees it.
fn mean_of(folder: &Path, file: &str, channel: &str) -> f64 {
    let found = json(folder, &format!("stats {file} --channel {channel} --json"));
    found["rows"][0]["measured"].as_f64().expect("a number")
}

#[test]
fn a_crop_is_a_part_of_the_image() {
    let folder = scene_folder();
    done(folder.path(), "render a.toml -o whole");
    let summary = rendered(folder.path(), "--crop 8,6,24,20");
    let whole = channel(&folder.path().join("whole/a.exr"));
    let part = channel(&folder.path().join("a.exr"));
    assert_eq!((part.0, part.1), ([8, 6], [24, 20]), "the data window");
    let [x0, y0] = part.0;
    for (x, y) in (0..20).flat_map(|y| (0..24).map(move |x| (x, y))) {
        let (here, there) = (part.2[y * 24 + x], whole.2[(y + y0) * 48 + x + x0]);
        assert_eq!(here.to_bits(), there.to_bits(), "pixel ({x}, {y})");
    }
    assert_eq!(summary["crop"], json!([8, 6, 24, 20]));
    assert_eq!(summary["samples"], 24 * 20 * 4);
}

/// Returns origin, size and values of the first laser's layer `radiance`.
fn channel(path: &Path) -> ([usize; 2], [usize; 2], Vec<f32>) {
    let image = exr::prelude::read_all_flat_layers_from_file(path).expect("an OpenEXR file");
    let layer = &image.layer_data[1];
    let mut channels = layer.channel_data.list.iter();
    let channel = channels.find(|channel| channel.name.to_string() == "radiance");
    let position = layer.attributes.layer_position;
    let origin = [position.x(), position.y()].map(|p| usize::try_from(p).expect("inside"));
    let values = channel.expect("the channel").sample_data.values_as_f32();
    (origin, [layer.size.x(), layer.size.y()], values.collect())
}

#[test]
fn options_overrule_the_scene() {
    let folder = scene_folder();
    let summary = rendered(folder.path(), "--method light --max-depth 1 --no-speckle");
    assert_eq!(summary["method"], "light");
    assert_eq!(summary["max_depth"], 1);
    // The light tracer finds what the path tracer finds.
    let light = mean_of(folder.path(), "a.exr", "laser_0.single");
    let summary = rendered(folder.path(), "--no-speckle --spp 64");
    assert_eq!(summary["method"], "path");
    assert_eq!(summary["max_depth"], Value::Null);
    let path = mean_of(folder.path(), "a.exr", "laser_0.single");
    // 7680 photons of which nearly all reach the image: 1.2 % of noise in the mean.
    assert!((light / path - 1.0).abs() < 0.06, "{light} is not {path}");
}

#[test]
fn doubtful_light_and_speckle_are_told() {
    let folder = scene_folder();
    let mirror =
        "[[surface]]\nrectangle = { centre = [0, 1, 0], size = [0.1, 0.1] }\nmirror = {}\n";
    let smooth = "[[surface]]\nname = \"gauge\"\nsphere.radius = \"1 mm\"\n\
                  conductor = { metal = \"iron\", roughness = 0.01 }\n";
    for (surface, options, told) in [
        (mirror, "", "before and behind a rough surface"),
        (smooth, "", "surface `gauge` is too smooth"),
        // Without speckle there is nothing to be too smooth for.
        (smooth, "--no-speckle", "disabled"),
    ] {
        write(folder.path(), "a.toml", format!("{SCENE}\n{surface}"));
        let said = message(&done(
            folder.path(),
            &format!("render a.toml --spp 1 {options}"),
        ));
        assert!(said.contains(told), "{said}");
        let is_smooth = surface == smooth && options.is_empty();
        assert_eq!(said.contains("too smooth"), is_smooth, "{said}");
    }
}

#[test]
fn a_fast_lens_shows_the_contrast_that_its_samples_leave() {
    let folder = folder();
    let wide = SCENE.replace("[48, 40]", "[120, 100]");
    write(folder.path(), "a.toml", wide.replace("0.2 mm", "2 mm"));
    // Speckles of 0.1 and 0.41 pixels, from the law of pixels that few samples miss to that of one
    // sample.
    for (f_number, samples) in [("0.5", 1), ("0.5", 16), ("0.5", 64), ("2", 2), ("2", 8)] {
        let options = format!("--set camera.f_number={f_number} --spp {samples}");
        let summary = rendered(folder.path(), &options);
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
    for (options, is_known) in [
        ("", true),
        // The expectation is that of box-shaped pixels, seen by a fixed number of camera samples.
        ("--set render.filter=gaussian", false),
        ("--method light", false),
        ("--target-error 0.5", false),
        // Two patterns.
        ("--set surface[0].speckle.polarisation=0", false),
    ] {
        let summary = rendered(folder.path(), options);
        let contrast = &summary["frames"][0]["lasers"][0]["contrast"];
        assert_eq!(contrast.is_object(), is_known, "{options}: {contrast}");
    }
}
