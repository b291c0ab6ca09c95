use glam::DVec2;
use tem00::{
    engine::{LaserInspection, LightFate, LightPart, inspect_lasers},
    tracer::Scene,
};

use crate::{
    means::render,
    renders::{options, scene},
};

/// A spot of 1 mm on a plate, in the middle of an image of 48 × 40 pixels that shows 19 × 16 mm.
const SCENE: &str = r#"
    [camera]
    position = [0, 0, 0.3]
    look_at = [0, 0, 0]
    focal_length = "25 mm"
    f_number = 8
    pixel_pitch = "36.363636363636 um"
    resolution = [48, 40]
    [[laser]]
    wavelength = "650 nm"
    power = "2 mW"
    position = [0.1, 0, 0.3]
    look_at = [0, 0, 0]
    spot.waist_radius = "0.5 mm"
    [[surface]]
    name = "plate"
    rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = [0.02, 0.02] }
    "#;

/// Replaces parts of the scene, each the first of its kind.
fn with(changes: &[[&str; 2]]) -> String {
    let change = |text: String, [from, to]: &[&str; 2]| {
        assert!(text.contains(from), "{from} is in the scene");
        text.replacen(from, to, 1)
    };
    changes.iter().fold(SCENE.to_owned(), change)
}

/// Adds sections to the scene.
fn and(sections: &str) -> Scene {
    scene(&format!("{SCENE}\n{sections}"))
}

fn inspected(scene: &Scene) -> LaserInspection {
    inspect_lasers(scene, 0).unwrap().remove(0)
}

/// Returns the greatest radiance of light straight from the laser that a render finds.
fn rendered(scene: &Scene) -> f32 {
    let mut options = options(16, 0);
    options.crop = scene.render.crop;
    let frame = render(scene, &options);
    let pixels = frame.lasers[0].single.values();
    pixels.iter().copied().fold(0.0, f32::max)
}

#[track_caller]
fn assert_fraction(found: f64, expected: f64, tolerance: f64) {
    let is_close = (found - expected).abs() <= tolerance;
    assert!(is_close, "{found} is not {expected} ± {tolerance}");
}

/// Asserts that all the light meets this fate, and that a render finds none of it.
#[track_caller]
fn assert_all(scene: &Scene, fate: LightFate, surface: Option<usize>) -> LightPart {
    let found = inspected(scene);
    assert!(!found.is_seen(), "{found:?}");
    let [part] = found.parts.as_slice() else {
        panic!("more than one part: {:?}", found.parts);
    };
    assert_eq!((part.fate, part.surface), (fate, surface));
    assert_fraction(part.fraction, 1.0, 1e-12);
    assert!(rendered(scene) <= 0.0, "the render finds some");
    part.clone()
}

#[test]
fn a_spot_in_the_image_is_seen_where_it_is() {
    let scene = scene(SCENE);
    let found = inspected(&scene);
    assert!(found.is_seen() && rendered(&scene) > 0.0, "{found:?}");
    assert_fraction(found.fraction_of(LightFate::Seen), 1.0, 1e-12);
    // 4096 points see the spot on some 60 of them, spread evenly.
    assert_fraction(found.fraction_in_image, 1.0, 0.05);
    let pixel = found.parts[0].pixel.unwrap();
    // A thousandth of the spot's 2.7 pixels.
    assert!(pixel.distance(DVec2::new(24.0, 20.0)) < 0.05, "{pixel}");
    assert_eq!(found.ways.len(), 64);
    assert!(found.ways[0][1].z.abs() < 1e-12, "{:?}", found.ways[0]);
}

#[test]
fn light_that_the_camera_does_not_see_has_its_fate() {
    use LightFate::{BehindCamera, Hidden, LightsFarSide, MeetsBack, Misses, OutsideImage};
    let back = ["normal = [0, 0, 1]", "normal = [0, 0, -1]"];
    assert!(
        inspected(&scene(&with(&[back]))).is_seen(),
        "both sides scatter"
    );
    let one_sided = format!("{}\none_sided = true", with(&[back]));
    let mask = "[[surface]]\nrectangle = { centre = [0, 0, 0.1], size = [0.02, 0.02] }";
    let away = [
        "look_at = [0, 0, 0]\n    focal",
        "look_at = [0, 0, 0.6]\n    focal",
    ];
    for (text, fate, surface) in [
        (
            with(&[["centre = [0, 0, 0]", "centre = [0.07, 0, 0]"]]),
            Misses,
            None,
        ),
        (one_sided, MeetsBack, Some(0)),
        (
            with(&[["[0.1, 0, 0.3]", "[0.1, 0, -0.3]"]]),
            LightsFarSide,
            Some(0),
        ),
        (
            format!("{SCENE}\n[render]\ncrop = [0, 0, 10, 10]"),
            OutsideImage,
            Some(0),
        ),
        (format!("{SCENE}\n{mask}"), Hidden { by: 1 }, Some(0)),
    ] {
        assert_all(&scene(&text), fate, surface);
    }
    let behind = assert_all(&scene(&with(&[away])), BehindCamera, Some(0));
    assert_eq!(behind.pixel, None, "no image");
    let aside = [
        "look_at = [0, 0, 0]\n    spot",
        "look_at = [0.04, 0.03, 0]\n    spot",
    ];
    let beside = with(&[["[0.02, 0.02]", "[0.2, 0.2]"], aside]);
    let part = assert_all(&scene(&beside), OutsideImage, Some(0));
    // 0.4 mm of the plate per pixel: m = 25/275.
    let pixel = part.pixel.unwrap();
    let expected = DVec2::new(24.0 + 100.0, 20.0 - 75.0);
    assert!(pixel.distance(expected) < 0.2, "{pixel} is not {expected}");
}

#[test]
fn half_a_mask_hides_half_of_the_light() {
    // Its edge lies on the axis of the camera: by symmetry it hides as much as it leaves.
    let mask = and("[[surface]]\nrectangle = { centre = [0, -0.01, 0.1], size = [0.02, 0.02] }");
    let found = inspected(&mask);
    assert_fraction(found.fraction_of(LightFate::Seen), 0.5, 0.02);
    assert_fraction(found.fraction_of(LightFate::Hidden { by: 1 }), 0.5, 0.02);
    // Some 60 points of the image see the spot, half of them behind the mask.
    assert_fraction(found.fraction_in_image, 0.5, 0.2);
}

#[test]
fn light_over_a_mirror_counts_as_seen() {
    // A mirror at 45° turns the beam, which comes along −x, down onto the plate.
    let text = with(&[
        ["position = [0.1, 0, 0.3]", "position = [0.2, 0.007, 0.1]"],
        [
            "look_at = [0, 0, 0]\n    spot",
            "look_at = [0, 0.007, 0.1]\n    spot",
        ],
    ]);
    let mirror = "[[surface]]\nrectangle = { centre = [0, 0.007, 0.1], normal = [1, 0, -1], \
                  up = [0, 1, 0], size = [0.003, 0.003] }\nmirror = { reflectance = 0.5 }";
    let found = inspected(&scene(&format!("{text}\n{mirror}")));
    assert!(found.is_seen(), "{found:?}");
    // The mirror, 7 mm beside the axis, hides next to nothing of the spot below it.
    assert_fraction(found.fraction_of(LightFate::Seen), 0.5, 0.01);
    assert_fraction(found.fraction_in_image, 0.0, 1e-12);
    assert_eq!(found.ways[0].len(), 3, "{:?}", found.ways[0]);
}

#[test]
fn a_spot_behind_glass_counts_as_seen() {
    let window = "[[surface]]\nname = \"window\"\n\
                  rectangle = { centre = [0, 0, 0.2], size = [0.05, 0.05] }\ndielectric = {}";
    let found = inspected(&and(window));
    assert!(found.is_seen(), "{found:?}");
    assert_fraction(found.fraction_of(LightFate::Seen), 0.0, 1e-12);
    // One face of glass, through which 96 % of the camera's rays go on.
    assert!(found.fraction_in_image > 0.5, "{}", found.fraction_in_image);
}
