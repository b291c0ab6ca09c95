//! `tem00 render --check`: why the camera sees no light of a laser.

use std::fs;

use super::*;

/// Returns the scene with a part replaced, and sections added.
fn scene(from: &str, to: &str, sections: &str) -> String {
    assert!(SCENE.contains(from), "{from} is in the scene");
    format!("{}\n{sections}", SCENE.replacen(from, to, 1))
}

/// Returns a scene that names its surface.
fn plate(from: &str, to: &str, sections: &str) -> String {
    scene(from, to, sections).replacen("[[surface]]", "[[surface]]\nname = \"plate\"", 1)
}

const TO_PLATE: &str = "look_at = [\"0 mm\", \"0 mm\", \"0 mm\"]\nspot";

/// The scenes of six mistakes, and what is said of them.
fn mistakes() -> [(String, &'static [&'static str]); 6] {
    [
        (
            plate("centre = [0, 0, 0]", "centre = [\"70 mm\", 0, 0]", ""),
            &["misses every surface", "plate: x 60.0 … 80.0 mm"],
        ),
        (
            plate("normal = [0, 0, 1]", "normal = [0, 0, -1]", "")
                .replace("rectangle", "one_sided = true\nrectangle"),
            &[
                "meets the back of `plate` at (0.0, 0.0, 0.0) mm",
                "one-sided",
            ],
        ),
        (
            plate(
                "\"100 mm\", \"0 mm\", \"300 mm\"",
                "\"100 mm\", \"0 mm\", \"-300 mm\"",
                "",
            ),
            &["lights `plate`", "on the side away from the camera"],
        ),
        (
            // A pixel shows 3.45 µm · 11 of the plate: 4 mm to the right are 105 pixels.
            plate(
                TO_PLATE,
                "look_at = [\"4 mm\", \"0 mm\", \"0 mm\"]\nspot",
                "",
            ),
            &[
                "`plate` at (4.0, 0.0, 0.0) mm, outside the image: on pixel (129, 20)",
                "the image has 48 × 40",
                "at a distance of 300.0 mm the image shows 1.8 × 1.5 mm about (0.0, 0.0, 0.0) mm",
            ],
        ),
        (
            plate(
                "look_at = [\"0 mm\", \"0 mm\", \"0 mm\"]\nfocal",
                "look_at = [\"0 mm\", \"0 mm\", \"600 mm\"]\nfocal",
                "",
            ),
            &["lights `plate` at (0.0, 0.0, 0.0) mm, behind the camera"],
        ),
        (
            plate(
                "[render]",
                "[render]",
                "[[surface]]\nname = \"mask\"\n\
                 rectangle = { centre = [0, 0, \"100 mm\"], size = [\"20 mm\", \"20 mm\"] }",
            ),
            &["lights `plate` at (0.0, 0.0, 0.0) mm, which `mask` hides from the camera"],
        ),
    ]
}

#[test]
fn six_mistakes_are_told_before_anything_is_rendered() {
    for (scene, parts) in mistakes() {
        let folder = folder();
        fs::write(folder.path().join("a.toml"), &scene).expect("written");
        let output = run(folder.path(), "render a.toml --check");
        assert_code(&output, 3);
        let said = text(&output.stdout);
        for part in [&["laser 0: the camera sees no light of it"], parts].concat() {
            assert!(said.contains(part), "{part} is not in\n{said}\n{scene}");
        }
        assert_eq!(
            files(&folder.path().join("out/a")),
            ["a_overview.png", "a_overview.svg"],
            "nothing is rendered"
        );
    }
}

#[test]
fn a_render_warns_of_a_dark_image_first_and_goes_on() {
    let folder = folder();
    let [(scene, parts), ..] = mistakes();
    fs::write(folder.path().join("a.toml"), scene).expect("written");
    let output = run(folder.path(), "render a.toml --spp 1");
    assert_code(&output, 0);
    let said = text(&output.stderr);
    let warned = said.find(parts[0]).expect("the reason");
    let rendered = said.find("a.png: laser 0").expect("the result");
    assert!(warned < rendered, "{said}");
    let written = files(&folder.path().join("out/a"));
    assert!(
        written.contains(&"a_overview.svg".to_owned()),
        "{written:?}"
    );
    assert!(written.contains(&"a.png".to_owned()), "{written:?}");
}

#[test]
fn what_is_seen_is_told_and_drawn() {
    let folder = scene_folder();
    let output = run(folder.path(), "render a.toml --check -o drawn");
    assert_code(&output, 0);
    let said = text(&output.stdout);
    assert!(
        said.contains("laser 0: the camera sees 100 % of its light, on `surface 1`"),
        "{said}"
    );
    let path = said.lines().last().expect("the name of the drawing");
    let drawing = fs::read_to_string(folder.path().join(path)).expect("the drawing");
    let views = ["from +z", "from −x", "from +y"];
    for name in ["camera", "laser 0", "surface 1", "mm"]
        .into_iter()
        .chain(views)
    {
        assert!(drawing.contains(name), "{name} is not drawn");
    }
}

#[test]
fn a_laser_that_is_seen_in_some_frames_is_no_mistake() {
    let folder = folder();
    // The plate leaves the spot after the first frame.
    let moved = SCENE.replace(
        "[[surface]]",
        "[[surface]]\ndisplacement_per_frame = [\"20 mm\", 0, 0]",
    ) + "frames = 3\n";
    fs::write(folder.path().join("a.toml"), moved).expect("written");
    let output = run(folder.path(), "render a.toml --check");
    assert_code(&output, 0);
    let said = text(&output.stdout);
    assert!(said.contains("the camera sees 100 %"), "{said}");
    assert!(said.contains("no light of it in frame 1"), "{said}");
    assert_code(
        &run(folder.path(), "render a.toml --check --frames 1..2"),
        3,
    );
}
