//! What a moving body uncovers shows speckle of its own.

use tem00::{
    decorrelation::{DVec3, pupil_overlap_correlation},
    geometry::{Rectangle, Shape},
    numerics::Grid,
    statistics::pearson_correlation,
    tracer::{Scene, Surface, SurfaceSpeckle},
};

use crate::wave_judges_decorrelation::scene::Body;

use super::setting::{LENS, SIDE, Setting, part, speckle, tolerance};

/// The width of the body, in pixels.
const WIDTH: usize = 80;

/// How far the body goes from frame to frame, in pixels.
const WAY: usize = 92;

/// One pixel on the plate, in metres.
const PIXEL: f64 = 11.0 * LENS.pixel_pitch;

fn setting() -> Setting {
    let way = WAY as f64 * PIXEL;
    Setting {
        lens: tem00::decorrelation::LensData {
            // The body goes 12 slices of 32.
            f_number: LENS.focal_length * 12.0 / (32.0 * way),
            ..LENS
        },
        to_laser: DVec3::Z,
        distance: None,
    }
}

/// A plate, and before it a body that uncovers it to the right.
fn scene() -> Scene {
    let mut scene = setting().scene();
    let half = 0.5 * WIDTH as f64 * PIXEL;
    let centre = DVec3::new(0.0, 0.0, 1e-9);
    let body = Rectangle::new(centre, half * DVec3::X, 5e-3 * DVec3::Y).expect("a body");
    let body = Surface {
        name: "body".to_owned(),
        shape: Shape::Rectangle(body),
        trajectory: Body::along(WAY as f64 * PIXEL * DVec3::X).trajectory(),
        speckle: SurfaceSpeckle::default(),
        ..scene.surfaces[0].clone()
    };
    scene.surfaces.push(body);
    scene
}

fn correlation(a: &Grid<f32>, b: &Grid<f32>) -> f64 {
    pearson_correlation(a, b).expect("bright images")
}

/// Judges the frames before and after the body has moved; a pixel at each edge is left out.
fn judge(scene: &Scene) {
    let frames = speckle(scene, &[0, 1], 6);
    let size = setting().geometry().speckle_size_in_pixels();
    let first = (SIDE - WIDTH) / 2;
    let seen = |frame: usize, x: usize, width: usize| part(&frames[frame], [x, 0], [width, SIDE]);
    let allowed = |width: usize| tolerance((width * SIDE) as f64, size);

    // Where the body was, the plate shows nothing of what the body showed.
    let width = WIDTH - 2;
    let uncovered = correlation(&seen(0, first + 1, width), &seen(1, first + 1, width));
    assert!(uncovered.abs() < allowed(width), "uncovered: {uncovered}");
    // Nor does it show what the body shows now.
    let width = SIDE - (first + WAY) - 1;
    let beside = correlation(&seen(1, first + 1, width), &seen(1, first + WAY + 1, width));
    assert!(beside.abs() < allowed(width), "beside: {beside}");
    // The body takes its own speckle along.
    let along = correlation(&seen(0, first + 1, width), &seen(1, first + WAY + 1, width));
    let expected = pupil_overlap_correlation(12.0 / 32.0);
    let error = (along - expected).abs();
    assert!(error < allowed(width), "along: {along} | {expected}");
    // The plate keeps its own beside the body.
    let kept = correlation(&seen(0, 0, first - 1), &seen(1, 0, first - 1));
    assert!(kept > 0.99, "kept: {kept}");
}

#[test]
fn what_a_body_uncovers_is_not_the_speckle_it_took_along() {
    judge(&scene());
}

#[test]
fn bodies_that_share_a_pattern_for_the_memory_have_places_of_their_own() {
    let mut scene = scene();
    // 32 slices of 64 × 64 samples of 8 bytes, but not the plate's one beside them.
    scene.speckle.memory = 1 << 20;
    let plan = tem00::engine::SpecklePlan::new(&scene, 6);
    let plan = plan.expect("a pattern").to_string();
    assert!(plan.contains("2 positions in one pattern"), "{plan}");
    judge(&scene);
}

#[test]
fn a_pattern_is_one_over_surfaces_that_stand_still_together() {
    // The plate cut in two shows what the whole plate shows.
    let whole = setting().scene();
    let mut halves = whole.clone();
    for (surface, side) in [(0, -1.0), (1, 1.0)] {
        let centre = DVec3::new(side * 1e-2, 0.0, 0.0);
        let half = Rectangle::new(centre, 1e-2 * DVec3::X, 2e-2 * DVec3::Y).expect("a half");
        let half = Surface {
            shape: Shape::Rectangle(half),
            ..whole.surfaces[0].clone()
        };
        if surface == 0 {
            halves.surfaces[0] = half;
        } else {
            halves.surfaces.push(half);
        }
    }
    let [whole, halves] = [&whole, &halves].map(|scene| speckle(scene, &[0], 1).remove(0));
    assert!(whole == halves, "the cut is seen in the speckle");
}
