//! Displacement and correlation of speckle when plate, camera and laser move and turn.

use core::f64::consts::PI;
use tem00_testkit::on_threads;

use tem00::{
    decorrelation::{DVec2, DVec3, SpeckleMotion, pupil_overlap_correlation},
    statistics::pearson_correlation,
    tracer::{Keyframe, Scene, Trajectory},
    wave::displacement_between,
};

use crate::wave_judges_decorrelation::{
    finite::{camera, source, surface},
    scene::{Body, States},
};

use super::setting::{
    EYE, LENS, SIDE, Setting, assert_correlation, in_speckles, part, speckle, tolerance,
};

/// Slices per pupil diameter.
const SLICES: f64 = 32.0;

struct Case {
    name: &'static str,
    setting: Setting,
    states: States,
}

impl Case {
    /// Plane waves from the front, in focus.
    fn new(name: &'static str, states: States) -> Self {
        Self {
            name,
            setting: Setting {
                lens: LENS,
                to_laser: DVec3::new(0.3, 0.0, 1.0),
                distance: None,
            },
            states,
        }
    }

    fn scene(&self) -> Scene {
        self.setting.moving(&self.states)
    }
}

/// The angle by which a plate in plane waves turns so that its speckle crosses a number of slices:
/// twice as fast as the plate, 0.3 m away.
fn tilt(slices: f64) -> f64 {
    let diameter = LENS.focal_length / LENS.f_number;
    0.5 * slices / SLICES * diameter / EYE.z
}

fn cases() -> Vec<Case> {
    let origin = DVec3::ZERO;
    let focused = |case: Case, focus: f64| Case {
        setting: Setting {
            lens: tem00::decorrelation::LensData {
                surface_to_pupil: focus,
                ..LENS
            },
            ..case.setting
        },
        ..case
    };
    let near = |case: Case| {
        let mut case = focused(case, 0.31);
        case.setting.to_laser = DVec3::new(-0.12, 0.05, 0.2);
        case.setting.distance = Some(0.24);
        case
    };
    let oblique = Body::about(origin, DVec3::new(1.0, 1.0, 0.0), tilt(12.0));
    let all = States {
        surface: Body {
            translation: DVec3::new(2e-4, -3e-4, 2e-4),
            ..Body::about(0.05 * DVec3::Y, DVec3::new(0.3, 1.0, 0.2), 0.6e-3)
        },
        camera: Body::about(EYE, DVec3::new(0.3, -1.0, 0.5), 0.7e-3),
        source: Body::along(DVec3::new(-1e-4, 2e-4, 1e-4)),
        ..States::default()
    };
    vec![
        Case::new(
            "plate tilted in focus",
            surface(Body::about(origin, DVec3::Y, tilt(8.0))),
        ),
        focused(
            Case::new("plate tilted before the focus", surface(oblique)),
            0.33,
        ),
        Case::new(
            "plate turned in its plane, beside the axis",
            surface(Body::about(DVec3::new(0.03, 0.0, 0.0), DVec3::Z, 8e-3)),
        ),
        Case::new(
            "camera turned about its pupil",
            camera(Body::about(EYE, DVec3::new(1.0, 2.0, 0.0), 1e-3)),
        ),
        Case::new(
            "camera turned about the plate",
            camera(Body::about(origin, DVec3::Y, -3e-3)),
        ),
        Case::new(
            "laser turned about the plate",
            source(Body::about(origin, DVec3::Y, 3e-3)),
        ),
        near(Case::new(
            "near laser moved",
            source(Body::along(DVec3::new(4e-4, 3e-4, 0.0))),
        )),
        near(Case::new("all at once, before the focus", all)),
    ]
}

/// The standard error of a displacement found by cross-correlation, in speckles along the way of
/// the pupil, where it is the larger.
///
/// The noise of the correlation of two patterns S speckles wide is 0.765/S high, and as narrow as
/// speckle: it slopes by 0.765 π/S. The peak is γ π²/2 times as curved, or less where the pupils
/// share a lens 1 − s as wide as they are: (1 − s)² times that.
fn displacement_error(law: &SpeckleMotion, pupil_diameter: f64, speckles: f64) -> f64 {
    let shift = law.pupil_displacement.map_or(1.0, DVec2::length) / pupil_diameter;
    let slope = 0.765 * PI / speckles;
    slope / (0.5 * PI * PI * law.correlation * (1.0 - shift).powi(2))
}

#[test]
fn rendered_speckle_goes_where_the_law_of_finite_motions_says() {
    const SEEDS: u64 = 2;
    for case in cases() {
        let geometry = case.setting.geometry();
        let law = case.setting.law(&case.states);
        let scene = case.scene();
        let (mut found, mut left) = (DVec2::ZERO, 0.0);
        for seed in 1..=SEEDS {
            let frames = speckle(&scene, &[0, 1], seed);
            let shift = displacement_between(&frames[0], &frames[1]).expect("a maximum");
            found += in_speckles(shift.offset, &geometry) / SEEDS as f64;
            left += shift.correlation / SEEDS as f64;
        }
        let size = geometry.speckle_size_in_pixels();
        let expected = law.speckle_displacement() / geometry.pixel_pitch() / size;
        let speckles = SIDE as f64 / size;
        let error = (found - expected).length();
        let (name, far) = (case.name, expected.length());
        let one = displacement_error(&law, geometry.pupil_diameter(), speckles);
        let allowed = 4.0 * one / (SEEDS as f64).sqrt();
        assert!(error < allowed, "{name}: {error:.3} of {far:.2} speckles");
        // Both show the same part of the plate but for the displacement.
        let area = (SIDE * SIDE) as f64 * (1.0 - far / speckles).powi(2);
        let allowed = tolerance(area * SEEDS as f64, size);
        let kept = law.correlation;
        assert!((left - kept).abs() < allowed, "{name}: {left} | {kept}");
    }
}

#[test]
fn a_camera_that_turns_with_its_scene_sees_the_same_picture() {
    let step = Body {
        translation: DVec3::new(1e-2, 2e-2, -3e-2),
        ..Body::about(DVec3::new(0.1, 0.0, 0.2), DVec3::new(0.2, -1.0, 0.4), 0.3)
    };
    let (surface, camera, source) = (step, step, step);
    let states = States {
        surface,
        camera,
        source,
        ..States::default()
    };
    let case = Case::new("", states);
    let frames = speckle(&case.scene(), &[0, 1], 3);
    let seen = pearson_correlation(&frames[0], &frames[1]).expect("bright frames");
    // The samples of the pixels differ, of speckles 6.6 pixels wide.
    assert!(seen > 0.99, "correlation {seen}");
}

/// A plate that moves by half a pupil diameter, 40 pixels, from frame to frame.
fn steady(frames: u32, reference: u32) -> (Scene, f64) {
    let pixel = 11.0 * LENS.pixel_pitch;
    let way = DVec3::new(40.0 * pixel, 0.0, 0.0);
    let mut case = Case::new("", surface(Body::along(way)));
    case.setting.lens.f_number = LENS.focal_length * 0.5 / way.x;
    let mut scene = case.scene();
    scene.frames = frames;
    scene.reference_frame = reference;
    (scene, case.setting.geometry().speckle_size_in_pixels())
}

#[test]
fn any_two_frames_correlate_by_their_distance_on_both_sides_of_the_reference() {
    let (scene, size) = steady(5, 2);
    let frames = speckle(&scene, &[0, 1, 2, 3, 4], 9);
    for (i, later) in [(0, 1_u8), (1, 1), (2, 1), (3, 1), (1, 2), (0, 2), (0, 4)] {
        let pair = [&frames[i], &frames[i + usize::from(later)]];
        let law = pupil_overlap_correlation(0.5 * f64::from(later));
        let name = format!("frame {i} and {later} later");
        assert_correlation(&name, pair, [40 * i32::from(later), 0], (law, size));
    }
}

#[test]
fn a_plate_that_swings_through_its_place_has_other_speckle_on_either_side() {
    let (mut scene, size) = steady(3, 0);
    let way = DVec3::new(20.0 * 11.0 * LENS.pixel_pitch, 0.0, 0.0);
    let at = |frame, displacement| Keyframe {
        displacement,
        ..Keyframe::unmoved(frame)
    };
    let keyframes = [at(0.0, DVec3::ZERO), at(1.0, way), at(2.0, -way)];
    let swing = Trajectory::keyframed(DVec3::ZERO, keyframes).expect("a motion");
    scene.surfaces[0].trajectory = swing;
    let frames = speckle(&scene, &[0, 1, 2], 12);
    // A quarter of the pupil to either side, and 20 pixels.
    for (one, other, pixels, distance) in [(0, 1, 20, 0.25), (2, 0, 20, 0.25), (2, 1, 40, 0.5)] {
        let law = pupil_overlap_correlation(distance);
        let name = format!("frames {one} and {other}");
        assert_correlation(
            &name,
            [&frames[one], &frames[other]],
            [pixels, 0],
            (law, size),
        );
    }
}

#[test]
fn moving_scenes_have_the_same_bits_for_any_number_of_threads() {
    let scene = cases().pop().expect("a case").scene();
    let with = |threads| on_threads(threads, || speckle(&scene, &[1], 2).remove(0));
    let one = with(1);
    for threads in [2, 7] {
        assert!(with(threads) == one, "{threads} threads");
    }
}

#[test]
fn the_displacement_across_a_plate_that_turns_in_its_plane_is_that_of_each_point() {
    let mut case = Case::new("", surface(Body::about(DVec3::ZERO, DVec3::Z, 0.02)));
    case.setting.to_laser = DVec3::Z;
    let frames = speckle(&case.scene(), &[0, 1], 4);
    let size = case.setting.geometry().speckle_size_in_pixels();
    for [x, y] in [[0, 96], [96, 0], [192, 96], [96, 192], [96, 96]] {
        let windows = [0, 1].map(|frame: usize| part(&frames[frame], [x, y], [64, 64]));
        let found = displacement_between(&windows[0], &windows[1]).expect("a maximum");
        let [x, y] = [x, y].map(|first| first as f64 + 32.0 - 0.5 * SIDE as f64);
        // To the left is up, where rows count downwards: (x, −y) turned by 90° is (y, x).
        let expected = 0.02 * DVec2::new(y, -x);
        let error = (found.offset - expected).length() / size;
        // 10 × 10 speckles; those at the edge of the window go 0.1 speckles elsewhere.
        assert!(error < 0.1, "{} | {expected}", found.offset);
    }
}
