//! Transcripts of what the reader makes of scenes, and what it says about those that cannot be.

use std::{env, fs, path::Path};

use tem00_tracer::Scene;

use super::{minimal, parse, with};

/// Plays the transcript `NAME.txt`, which tells at its top how it is written.
#[track_caller]
fn play(name: &str, outcome: impl Fn(&str) -> Vec<String>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/scene_files")
        .join(name);
    let script = fs::read_to_string(&path).unwrap().replace('\r', "");
    let (mut found, mut edit) = (String::new(), ("", ""));
    for line in script.lines().filter(|line| !line.starts_with("  ")) {
        found += &format!("{line}\n");
        if let Some(rule) = line.strip_prefix("@ ") {
            edit = rule.split_once(" -> ").unwrap();
        } else if let Some(case) = line.strip_prefix("> ") {
            let text = edit.1.replace('?', case).replace("\\n", "\n");
            let text = if edit.0 == "*" {
                text
            } else {
                with(edit.0, &text)
            };
            let told = outcome(&text).into_iter();
            found.extend(told.map(|line| format!("  {line}\n")));
        }
    }
    if env::var("SNAPSHOTS").is_ok_and(|action| action == "overwrite") {
        return fs::write(path, &found).unwrap();
    }
    for (found, expected) in found.lines().zip(script.lines()) {
        assert_eq!(found, expected, "{name}");
    }
    assert_eq!(found.len(), script.len(), "{name}");
}

#[test]
fn what_cannot_be_is_refused_at_its_place_in_words() {
    play("refused.txt", |text| {
        let error = parse(text).expect_err(text);
        let help = error.help().map(|help| format!("help: {help}"));
        let message = error.to_string().replacen("text:", "", 1);
        [message].into_iter().chain(help).collect()
    });
}

#[test]
fn every_key_reaches_the_scene() {
    let before = shown(&parse(&minimal()).unwrap());
    play("accepted.txt", |text| {
        let scene = parse(text)
            .map_err(|error| format!("{error}\n{text}"))
            .unwrap();
        let mut lines = shown(&scene);
        lines.retain(|line| !before.contains(line));
        lines
    });
}

/// Returns the fields of all parts of a scene, one a line.
fn shown(scene: &Scene) -> Vec<String> {
    let mut lines = Vec::new();
    let mut add = |part: &str, debug: String| {
        lines.extend(
            fields(&debug)
                .into_iter()
                .map(|field| format!("{part} {field}")),
        );
    };
    add("camera", format!("{:?}", scene.camera.description()));
    add("camera", format!("{{ {:?} }}", scene.camera_trajectory));
    for laser in &scene.lasers {
        add("laser", format!("{:?}", laser.description()));
        add(
            "laser",
            format!(
                "{{ {:?}, {:?} }}",
                laser.source_extent(),
                laser.trajectory()
            ),
        );
    }
    for surface in &scene.surfaces {
        add("surface", format!("{surface:?}"));
    }
    for light in &scene.lights {
        add("light", format!("{{ {light:?} }}"));
    }
    add("render", format!("{:?}", scene.render));
    let frames = (scene.frames, scene.reference_frame);
    add(
        "render",
        format!("{{ frames: {}, reference_frame: {} }}", frames.0, frames.1),
    );
    add("speckle", format!("{:?}", scene.speckle));
    lines
}

/// Returns the fields of a struct as it is shown for debugging.
fn fields(debug: &str) -> Vec<String> {
    let body = debug.split_once("{ ").map_or(debug, |(_, body)| body);
    let body = body.strip_suffix(" }").unwrap_or(body);
    let (mut depth, mut fields) = (0, vec![String::new()]);
    for c in body.chars() {
        depth += i32::from("([{".contains(c)) - i32::from(")]}".contains(c));
        match c {
            ',' if depth == 0 => fields.push(String::new()),
            c => fields.last_mut().unwrap().push(c),
        }
    }
    fields.iter().map(|field| field.trim().to_owned()).collect()
}
