//! `tem00 render` with several frames: exposure, parts and going on after an interruption.

use std::{fs, path::Path};

use serde_json::Value;

use super::{
    SCENE, assert_code, done, files, folder, interrupt, json_of, message, refused,
    render::exposure, start, text, wait_until, write,
};

pub(crate) const FRAMES: u32 = 3;

/// A scene whose surface moves, with a mesh in a file of its own that an included file names.
fn moving(samples_per_pixel: u32, frames: u32) -> String {
    let (head, _) = SCENE.split_once("[render]").expect("the last section");
    format!(
        "include = [\"part.toml\"]\n{head}displacement_per_frame = [\"0.1 mm\", 0, 0]\n\
         [render]\nframes = {frames}\nsamples_per_pixel = {samples_per_pixel}\n"
    )
}

const PART: &str =
    "[[surface]]\nmesh = { file = \"part.obj\", position = [0, \"1 mm\", \"1 mm\"] }\n";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

pub(crate) fn moving_folder(samples_per_pixel: u32, frames: u32) -> tempfile::TempDir {
    let folder = folder();
    write(folder.path(), "a.toml", moving(samples_per_pixel, frames));
    write(folder.path(), "part.toml", PART);
    write(folder.path(), "part.obj", TRIANGLE);
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
    json_of(&folder.join("a.json"))
}

fn numbers(summary: &Value) -> Vec<u64> {
    let frames = summary["frames"].as_array().expect("frames");
    let numbers = frames.iter().filter_map(|frame| frame["number"].as_u64());
    numbers.collect()
}

#[test]
fn frames_are_numbered_and_share_one_exposure() {
    let folder = folder();
    // The laser leaves the image, so that the second frame alone would be exposed differently.
    let moving = SCENE.replace(
        "[render]",
        "displacement_per_frame = [\"10.2 mm\", 0, 0]\n[render]\nframes = 2",
    );
    write(folder.path(), "a.toml", moving);
    done(folder.path(), "render a.toml -o .");
    let names = "a.json a.toml a_0000.exr a_0000.json a_0000.png a_0001.exr a_0001.json a_0001.png";
    assert_eq!(files(folder.path()).join(" "), names);
    let [first, second] =
        ["a_0000.png", "a_0001.png"].map(|name| exposure(&folder.path().join(name)));
    assert!(first.contains("W/(m² sr)"), "{first}");
    assert_eq!(first, second);
}

#[test]
fn frames_are_the_same_however_they_are_shared_out() {
    let folder = moving_folder(4, FRAMES);
    let whole = done(folder.path(), "render a.toml -o whole");
    let told = text(&whole.stdout).lines().count();
    assert_eq!(told, 7, "two files per frame and the summary");
    // The last frame first: its exposure is that of a frame that is not there yet.
    for (part, listed) in [("2", 3), ("0..1", 5)] {
        let output = done(
            folder.path(),
            &format!("render a.toml -o parts --frames {part}"),
        );
        assert_eq!(text(&output.stdout).lines().count(), listed, "{part}");
    }
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    assert!(images(&whole) == images(&parts), "the images differ");
    assert_eq!(numbers(&summary(&parts)), [0, 1, 2], "it covers all");
    let of = |folder| summary(folder)["exposure"].clone();
    assert_eq!(of(&whole), of(&parts));
}

#[test]
fn a_render_that_goes_on_redoes_no_finished_frame() {
    let folder = moving_folder(4, FRAMES);
    done(folder.path(), "render a.toml -o whole");
    let (whole, cut) = (folder.path().join("whole"), folder.path().join("cut"));
    done(folder.path(), "render a.toml -o cut --frames 0");
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

    let output = done(folder.path(), "render a.toml -o cut --resume");
    let after = ["a_0000.png", "a_0000.exr", "a_0000.json"].map(written);
    assert_eq!(before, after, "the finished frame is not touched");
    assert!(images(&whole) == images(&cut), "the images differ");
    assert_eq!(numbers(&summary(&cut)), [0, 1, 2], "all frames");
    assert_eq!(summary(&cut)["samples"], summary(&whole)["samples"]);
    assert_eq!(text(&output.stdout).lines().count(), 7, "all are told");

    let again = done(folder.path(), "render a.toml -o cut --resume");
    assert!(message(&again).contains("nothing to do"), "{again:?}");
    assert_eq!(again.stdout, output.stdout);
}

#[test]
fn a_single_frame_can_be_finished_too() {
    let folder = moving_folder(4, 1);
    done(folder.path(), "render a.toml -o out");
    let image = fs::read(folder.path().join("out/a.exr")).expect("an image");
    let again = done(folder.path(), "render a.toml -o out --resume");
    assert!(message(&again).contains("nothing to do"), "{again:?}");
    fs::remove_file(folder.path().join("out/a.exr")).expect("removed");
    done(folder.path(), "render a.toml -o out --resume");
    let anew = fs::read(folder.path().join("out/a.exr")).expect("an image");
    assert!(image == anew, "the image differs");
}

const ANOTHER: &str = "a_0000.json belongs to another render";

#[test]
fn frames_of_another_render_are_not_mixed_in() {
    let folder = moving_folder(4, FRAMES);
    let path = folder.path();
    done(path, "render a.toml -o out --frames 0..1");
    let before = images_that_exist(&path.join("out"));
    for options in [
        "--seed 1",
        "--spp 5",
        "--no-speckle",
        "--white-level 3",
        "--max-depth 2",
    ] {
        let line = format!("render a.toml -o out --resume {options}");
        refused(path, &line, &[ANOTHER]);
    }
    let changes = [
        ("a.toml", moving(4, FRAMES).replace("5 mW", "6 mW")),
        ("part.toml", PART.replace("1 mm", "2 mm")),
        ("part.obj", TRIANGLE.replace("0 1 0", "0 2 0")),
    ];
    for (name, content) in changes {
        let old = fs::read(path.join(name)).expect("a file");
        write(path, name, content);
        refused(path, "render a.toml -o out --resume", &[ANOTHER]);
        write(path, name, old);
    }
    let after = images_that_exist(&path.join("out"));
    assert!(before == after, "nothing has changed");
    // The number of threads changes nothing, so it is no other render.
    done(path, "render a.toml -o out --resume --threads 1");
    assert_eq!(numbers(&summary(&path.join("out"))), [0, 1, 2]);
}

fn images_that_exist(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let content = |name: String| (name.clone(), fs::read(folder.join(name)).expect("a file"));
    files(folder).into_iter().map(content).collect()
}

#[test]
fn remains_of_another_render_are_replaced_by_the_one_that_goes_on() {
    let folder = moving_folder(4, FRAMES);
    done(folder.path(), "render a.toml -o whole --seed 1");
    done(folder.path(), "render a.toml -o out");
    done(folder.path(), "render a.toml -o out --seed 1 --frames 0");
    done(folder.path(), "render a.toml -o out --seed 1 --resume");
    let [whole, out] = ["whole", "out"].map(|name| folder.path().join(name));
    assert!(images(&whole) == images(&out), "the images differ");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_finished_frames() {
    let folder = moving_folder(200, FRAMES);
    done(folder.path(), "render a.toml -o whole");
    let child = start(folder.path(), "render a.toml -o cut");
    let cut = folder.path().join("cut");
    wait_until("the first frame is finished", || {
        cut.join("a_0000.json").exists()
    });
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

    done(folder.path(), "render a.toml -o cut --resume");
    assert!(
        images(&folder.path().join("whole")) == images(&cut),
        "the images differ"
    );
}

#[test]
fn mistakes_in_included_files_are_shown_there() {
    let folder = moving_folder(4, FRAMES);
    write(
        folder.path(),
        "part.toml",
        PART.replace("position", "positoin"),
    );
    refused(
        folder.path(),
        "render a.toml",
        &["part.toml:2:", "did you mean `position`?"],
    );
}
