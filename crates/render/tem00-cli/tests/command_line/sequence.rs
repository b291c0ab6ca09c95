//! `tem00 render` with several frames: exposure, parts and going on after an interruption.

use std::{fs, path::Path, thread::sleep, time::Duration};

use serde_json::Value;

use super::{
    SCENE, assert_code, files, folder, interrupt, message, render::exposure, run, tem00, text,
};

pub(crate) const FRAMES: u32 = 3;

/// A scene whose surface moves, with a mesh in a file of its own that an included file names.
fn moving(samples_per_pixel: u32, frames: u32) -> String {
    let render = format!("[render]\nframes = {frames}");
    let scene = SCENE
        .replace(
            "[render]",
            &format!("displacement_per_frame = [\"0.1 mm\", 0, 0]\n{render}"),
        )
        .replace(
            "samples_per_pixel = 4",
            &format!("samples_per_pixel = {samples_per_pixel}"),
        );
    format!("include = [\"part.toml\"]\n{scene}")
}

const PART: &str =
    "[[surface]]\nmesh = { file = \"part.obj\", position = [0, \"1 mm\", \"1 mm\"] }\n";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

pub(crate) fn moving_folder(samples_per_pixel: u32, frames: u32) -> tempfile::TempDir {
    let folder = folder();
    let write = |name: &str, content: &str| {
        fs::write(folder.path().join(name), content).expect("written");
    };
    write("a.toml", &moving(samples_per_pixel, frames));
    write("part.toml", PART);
    write("part.obj", TRIANGLE);
    folder
}

/// Returns the bytes of the images of all frames in `folder`.
pub(crate) fn images(folder: &Path) -> Vec<Vec<u8>> {
    (0..FRAMES)
        .flat_map(|number| ["png", "exr"].map(|end| format!("a_{number:04}.{end}")))
        .map(|name| fs::read(folder.join(&name)).unwrap_or_else(|error| panic!("{name}: {error}")))
        .collect()
}

fn summary(folder: &Path) -> Value {
    let text = fs::read(folder.join("a.json")).expect("a summary");
    serde_json::from_slice(&text).expect("JSON")
}

fn numbers(summary: &Value) -> Vec<u64> {
    let frames = summary["frames"].as_array().expect("frames");
    frames
        .iter()
        .filter_map(|frame| frame["number"].as_u64())
        .collect()
}

#[test]
fn frames_are_numbered_and_share_one_exposure() {
    let folder = folder();
    // The laser leaves the image, so that the second frame alone would be exposed differently.
    let moving = SCENE.replace(
        "[render]",
        "displacement_per_frame = [\"10.2 mm\", 0, 0]\n[render]\nframes = 2",
    );
    fs::write(folder.path().join("a.toml"), moving).expect("written");
    assert_code(&run(folder.path(), "render a.toml -o ."), 0);
    let names = [
        "a.json",
        "a.toml",
        "a_0000.exr",
        "a_0000.json",
        "a_0000.png",
        "a_0001.exr",
        "a_0001.json",
        "a_0001.png",
    ];
    assert_eq!(files(folder.path()), names);
    let [first, second] =
        ["a_0000.png", "a_0001.png"].map(|name| exposure(&folder.path().join(name)));
    assert!(first.contains("W/(m² sr)"), "{first}");
    assert_eq!(first, second);
}

#[test]
fn frames_are_the_same_however_they_are_shared_out() {
    let folder = moving_folder(4, FRAMES);
    let whole = run(folder.path(), "render a.toml -o whole");
    assert_code(&whole, 0);
    assert_eq!(
        text(&whole.stdout).lines().count(),
        7,
        "two files per frame and the summary"
    );
    // The last frame first: its exposure is that of a frame that is not there yet.
    for (part, listed) in [("2", 3), ("0..1", 5)] {
        let output = run(
            folder.path(),
            &format!("render a.toml -o parts --frames {part}"),
        );
        assert_code(&output, 0);
        assert_eq!(text(&output.stdout).lines().count(), listed, "{part}");
    }
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    assert!(images(&whole) == images(&parts), "the images differ");
    assert_eq!(
        numbers(&summary(&parts)),
        [0, 1, 2],
        "the summary covers all"
    );
    let of = |folder| summary(folder)["exposure"].clone();
    assert_eq!(of(&whole), of(&parts));
}

#[test]
fn a_render_that_goes_on_redoes_no_finished_frame() {
    let folder = moving_folder(4, FRAMES);
    assert_code(&run(folder.path(), "render a.toml -o whole"), 0);
    let (whole, cut) = (folder.path().join("whole"), folder.path().join("cut"));
    assert_code(&run(folder.path(), "render a.toml -o cut --frames 0"), 0);
    // A record without its image is no finished frame; neither is an image without its record.
    for (from, to) in [("a_0001.json", "a_0001.json"), ("a_0002.png", "a_0002.png")] {
        fs::copy(whole.join(from), cut.join(to)).expect("copied");
    }
    fs::write(cut.join("a_0002.json"), "{\"fingerprint\": ").expect("written");
    let written = |name: &str| {
        let metadata = fs::metadata(cut.join(name)).expect("a file");
        metadata.modified().expect("a time")
    };
    let before = ["a_0000.png", "a_0000.exr", "a_0000.json"].map(written);

    let output = run(folder.path(), "render a.toml -o cut --resume");

    assert_code(&output, 0);
    let after = ["a_0000.png", "a_0000.exr", "a_0000.json"].map(written);
    assert_eq!(before, after, "the finished frame is not touched");
    assert!(images(&whole) == images(&cut), "the images differ");
    assert_eq!(numbers(&summary(&cut)), [0, 1, 2], "all frames");
    assert_eq!(summary(&cut)["samples"], summary(&whole)["samples"]);
    assert_eq!(
        text(&output.stdout).lines().count(),
        7,
        "all files are told"
    );

    let again = run(folder.path(), "render a.toml -o cut --resume");
    assert_code(&again, 0);
    assert!(
        message(&again).contains("nothing to do"),
        "{}",
        message(&again)
    );
    assert_eq!(again.stdout, output.stdout);
}

#[test]
fn a_single_frame_can_be_finished_too() {
    let folder = moving_folder(4, 1);
    assert_code(&run(folder.path(), "render a.toml -o out"), 0);
    let image = fs::read(folder.path().join("out/a.exr")).expect("an image");
    let again = run(folder.path(), "render a.toml -o out --resume");
    assert_code(&again, 0);
    assert!(
        message(&again).contains("nothing to do"),
        "{}",
        message(&again)
    );
    fs::remove_file(folder.path().join("out/a.exr")).expect("removed");
    assert_code(&run(folder.path(), "render a.toml -o out --resume"), 0);
    let anew = fs::read(folder.path().join("out/a.exr")).expect("an image");
    assert!(image == anew, "the image differs");
}

#[test]
fn frames_of_another_render_are_not_mixed_in() {
    let folder = moving_folder(4, FRAMES);
    let path = folder.path();
    assert_code(&run(path, "render a.toml -o out --frames 0..1"), 0);
    let before = images_that_exist(&path.join("out"));
    for options in [
        "--seed 1",
        "--spp 5",
        "--no-speckle",
        "--white-level 3",
        "--max-depth 2",
    ] {
        refused(path, &format!("render a.toml -o out --resume {options}"));
    }
    let changes = [
        ("a.toml", moving(4, FRAMES).replace("5 mW", "6 mW")),
        ("part.toml", PART.replace("1 mm", "2 mm")),
        ("part.obj", TRIANGLE.replace("0 1 0", "0 2 0")),
    ];
    for (name, content) in changes {
        let old = fs::read(path.join(name)).expect("a file");
        fs::write(path.join(name), content).expect("written");
        refused(path, "render a.toml -o out --resume");
        fs::write(path.join(name), old).expect("written");
    }
    assert!(
        before == images_that_exist(&path.join("out")),
        "nothing has changed"
    );
    // The number of threads changes nothing, so it is no other render.
    assert_code(&run(path, "render a.toml -o out --resume --threads 1"), 0);
    assert_eq!(numbers(&summary(&path.join("out"))), [0, 1, 2]);
}

#[track_caller]
fn refused(folder: &Path, line: &str) {
    let output = run(folder, line);
    assert_code(&output, 2);
    let said = message(&output);
    assert!(
        said.contains("a_0000.json belongs to another render"),
        "{line}: {said}"
    );
}

fn images_that_exist(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let names = files(folder).into_iter();
    names
        .map(|name| (name.clone(), fs::read(folder.join(name)).expect("a file")))
        .collect()
}

#[test]
fn remains_of_another_render_are_replaced_by_the_one_that_goes_on() {
    let folder = moving_folder(4, FRAMES);
    assert_code(&run(folder.path(), "render a.toml -o whole --seed 1"), 0);
    assert_code(&run(folder.path(), "render a.toml -o out"), 0);
    assert_code(
        &run(folder.path(), "render a.toml -o out --seed 1 --frames 0"),
        0,
    );
    let output = run(folder.path(), "render a.toml -o out --seed 1 --resume");
    assert_code(&output, 0);
    let [whole, out] = ["whole", "out"].map(|name| folder.path().join(name));
    assert!(images(&whole) == images(&out), "the images differ");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_finished_frames() {
    use std::process::Stdio;

    let folder = moving_folder(200, FRAMES);
    assert_code(&run(folder.path(), "render a.toml -o whole"), 0);
    let child = tem00(folder.path(), "render a.toml -o cut")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let cut = folder.path().join("cut");
    let finished = (0..6_000).any(|_| {
        sleep(Duration::from_millis(5));
        cut.join("a_0000.json").exists()
    });
    assert!(finished, "the first frame is finished");
    interrupt(&child);
    let output = child.wait_with_output().expect("the program ends");
    assert_code(&output, 130);
    let said = message(&output);
    assert!(said.contains("of 3 frames are finished"), "{said}");
    assert!(said.contains("--resume"), "{said}");
    assert!(
        !cut.join("a.json").exists(),
        "there is no summary of a part"
    );
    let hidden = files(&cut).into_iter().any(|name| name.starts_with('.'));
    assert!(!hidden, "no temporary file is left");

    assert_code(&run(folder.path(), "render a.toml -o cut --resume"), 0);
    assert!(
        images(&folder.path().join("whole")) == images(&cut),
        "the images differ"
    );
}

#[test]
fn mistakes_in_included_files_are_shown_there() {
    let folder = moving_folder(4, FRAMES);
    let part = PART.replace("position", "positoin");
    fs::write(folder.path().join("part.toml"), part).expect("written");
    let output = run(folder.path(), "render a.toml");
    assert_code(&output, 2);
    let said = message(&output);
    assert!(said.contains("part.toml:2:"), "{said}");
    assert!(said.contains("did you mean `position`?"), "{said}");
}
