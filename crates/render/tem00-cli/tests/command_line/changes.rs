//! `--set`: values that take the place of those in the file.

use std::fs;

use serde_json::Value;

use super::{budget::SETUP, *};

/// Returns what a command prints on standard output, in a folder with the scene and the set-up.
#[track_caller]
fn told(scene: &str, setup: &str, arguments: &[&str]) -> String {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), scene).expect("written");
    fs::write(folder.path().join("b.toml"), setup).expect("written");
    let output = tem00(folder.path(), "").args(arguments).output();
    let output = output.expect("the program starts");
    assert_code(&output, 0);
    text(&output.stdout)
}

fn replaced(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is in the file");
    text.replacen(from, to, 1)
}

#[test]
fn a_changed_scene_is_rendered_as_if_its_file_said_so() {
    let pixels = |scene: &str, changes: &[&str]| {
        let folder = folder();
        fs::write(folder.path().join("a.toml"), scene).expect("written");
        let mut command = tem00(folder.path(), "render a.toml -o . --spp 1");
        for change in changes {
            command.args(["--set", change]);
        }
        assert_code(&command.output().expect("the program starts"), 0);
        fs::read(folder.path().join("a.exr")).expect("the layers")
    };
    let changes = [
        "camera.f_number=16",
        "laser[0].power=2 mW",
        "surface[0].lambertian.reflectance=0.3",
        "render.seed=5",
    ];
    let edited = replaced(SCENE, "f_number = 8", "f_number = 16");
    let edited = replaced(&edited, "\"5 mW\"", "\"2 mW\"");
    let edited = replaced(
        &edited,
        "rectangle",
        "lambertian.reflectance = 0.3\nrectangle",
    );
    let edited = replaced(&edited, "[render]", "[render]\nseed = 5");
    let by_option = pixels(SCENE, &changes);
    assert!(by_option == pixels(&edited, &[]), "the option is the file");
    assert!(
        by_option != pixels(SCENE, &changes[1..]),
        "each change counts"
    );
}

#[test]
fn a_changed_set_up_has_the_budget_of_an_edited_one() {
    let budget = |setup: &str, changes: &[&str]| {
        let line = ["budget", "b.toml", "--json", "--trials", "0"];
        let mut found: Value =
            serde_json::from_str(&told(SCENE, setup, &[&line, changes].concat())).expect("JSON");
        // The file of the one has another text than that of the other.
        found["setup"].take();
        found
    };
    let changed = budget(SETUP, &["--set", "camera.f_number=11"]);
    let edited = budget(&replaced(SETUP, "f_number = 8", "f_number = 11"), &[]);
    assert_eq!(changed, edited);
    assert_ne!(changed, budget(SETUP, &[]), "the change counts");
}

#[test]
fn changes_that_cannot_be_are_told() {
    let folder = scene_folder();
    fs::write(folder.path().join("b.toml"), SETUP).expect("written");
    for (command, change, part) in [
        (
            "render a.toml",
            "camera.f_nmber=8",
            "did you mean `f_number`?",
        ),
        ("render a.toml", "camera.f_number=0.1", "at least 0.5"),
        (
            "render a.toml",
            "laser[1].power=1",
            "there is no `laser[1]`",
        ),
        ("render a.toml", "laser.power=1", "`laser` has no keys"),
        (
            "render a.toml",
            "camera.focal_length=0 mm",
            "at least 1e-9 mm, got \"0 mm\"",
        ),
        ("render a.toml", "f_number", "camera.f_number=8"),
        ("render a.toml", "include=[]", "`include` cannot be changed"),
        (
            "triangulate a.toml",
            "sensor.exposur=1",
            "did you mean `exposure`?",
        ),
        ("budget b.toml", "lasr.power=1", "did you mean `laser`?"),
        (
            "design b.toml",
            "design.vary.f_numbr=[8]",
            "did you mean `f_number`?",
        ),
    ] {
        let mut command = tem00(folder.path(), command);
        let output = command.args(["--set", change]).output().expect("it starts");
        assert_code(&output, 2);
        assert!(
            message(&output).contains(part),
            "{change}: {}",
            message(&output)
        );
    }
}

#[test]
fn a_render_of_other_values_is_another_render() {
    let folder = folder();
    fs::write(folder.path().join("a.toml"), format!("{SCENE}frames = 2\n")).expect("written");
    let with = |change: &str, more: &str| {
        let line = format!("render a.toml -o . --spp 1 --set {change} {more}");
        run(folder.path(), &line)
    };
    assert_code(&with("render.seed=1", "--frames 0"), 0);
    let other = with("render.seed=2", "--resume");
    assert_code(&other, 2);
    assert!(
        message(&other).contains("belongs to another render"),
        "{}",
        message(&other)
    );
    assert_code(&with("render.seed=1", "--resume"), 0);
}
