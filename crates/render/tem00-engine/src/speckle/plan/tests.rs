use glam::DVec3;
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_geometry::{Shape, Sphere};
use tem00_speckle::SlicePath;
use tem00_testkit::assert_absolute;
use tem00_tracer::{
    BeamShape, Keyframe, Laser, LaserDescription, Material, Spectrum, Surface, SurfaceSpeckle,
};

use super::*;
use crate::testing::{self, camera};

/// A slice of 384 × 256 samples of 8 bytes, and 10 pixels of motion behind a pupil of 3.125 mm.
const SLICE: u64 = 3 << 18;
const STEP: DVec3 = DVec3::new(0.3795e-3, 0.0, 0.0);

/// A wide plate in the plane z, moving from frame to frame.
fn plate(z: f64, displacement: DVec3) -> Surface {
    moving(
        testing::plate(z * DVec3::Z, DVec3::Z, [0.1, 0.1]),
        displacement,
    )
}

fn moving(surface: Surface, displacement: DVec3) -> Surface {
    let trajectory = Trajectory::steady(displacement).unwrap();
    Surface {
        trajectory,
        ..surface
    }
}

/// A plate under a collimated spot as wide as the image, in a number of frames.
fn scene(frames: u32, displacement: DVec3) -> Scene {
    let laser = LaserDescription {
        shape: BeamShape::Spot {
            waist_radius: [5e-3; 2],
            waist_distance: [0.2; 2],
            m_squared: [1.0; 2],
        },
        ..testing::spot(0.2 * DVec3::Z, 5e-3)
    };
    let camera = camera(0.3 * DVec3::Z, [300, 200]);
    let mut scene = testing::scene(camera, &[laser], plate(0.0, displacement));
    scene.frames = frames;
    scene
}

/// The scene with the plate at places along x, each in the frame of its number.
fn keyframed(frames: u32, places: &[(f64, DVec3)]) -> Scene {
    let mut scene = scene(frames, DVec3::ZERO);
    let keyframes = places.iter().map(|&(frame, displacement)| Keyframe {
        displacement,
        ..Keyframe::unmoved(frame)
    });
    scene.surfaces[0].trajectory = Trajectory::keyframed(DVec3::ZERO, keyframes).unwrap();
    scene
}

fn with(mut scene: Scene, more: impl IntoIterator<Item = Surface>) -> Scene {
    scene.surfaces.extend(more);
    scene
}

fn try_plan(scene: &Scene) -> Result<PatternPlan, TracerError> {
    Ok(SpecklePlan::new(scene, 0)?.patterns()[0].clone())
}

fn plan(scene: &Scene) -> PatternPlan {
    try_plan(scene).unwrap()
}

/// The plan with patterns of at most `mebibytes` MiB.
fn plan_within(mebibytes: f64, mut scene: Scene) -> Result<PatternPlan, TracerError> {
    scene.speckle.memory = tem00_numerics::cast::to_usize(mebibytes * f64::from(1 << 20)) as u64;
    try_plan(&scene)
}

fn notes(scene: &Scene) -> Vec<CorrelationNote> {
    let plan = SpecklePlan::new(scene, 0).unwrap();
    plan.correlation_notes().cloned().collect()
}

#[track_caller]
fn assert_says(plan: &PatternPlan, text: &str) {
    assert!(plan.to_string().contains(text), "{plan}");
}

#[test]
fn nothing_repeats_within_the_image() {
    let plan = plan(&scene(2, DVec3::ZERO));
    // h = λ (1 + m) F with m = 1/11, in pixels of 3.45 µm.
    let speckle_size = 650e-9 * 12.0 / 11.0 * 8.0 / 3.45e-6;
    assert_absolute(plan.speckle_size_in_pixels() / speckle_size, 1.0, 1e-12);
    // 300 × 200 pixels hold 182.5 × 121.6 speckles: the next sizes are 192 = 2⁶ · 3 and 128.
    assert_eq!(plan.stack().diameter(), [192, 128], "{plan}");
    assert_eq!(plan.stack().size(), [384, 256], "{plan}");
    assert_eq!(plan.stack().path(), SlicePath::Still, "{plan}");
}

#[test]
fn motion_of_several_frames_widens_the_pattern_and_asks_for_slices() {
    let three = plan(&scene(3, 2e-3 * DVec3::X));
    // 4 mm are 105.4 pixels: 405.4 pixels hold 246.6 speckles. The pupil of 3.125 mm is left
    // behind, so that the path of the slices is three diameters long.
    assert_eq!(three.stack().size(), [512, 256], "{three}");
    assert_absolute(three.largest_shift(), 4.0 / 3.125, 1e-2);
    let (half_period, length) = (48, 3);
    let path = SlicePath::Straight {
        half_period,
        length,
    };
    assert_eq!(three.stack().path(), path, "{three}");
    assert_absolute(three.stack().slices_per_diameter(), 32.0, 1e-12);
    assert_absolute(three.stack().reach(), 2.0, 1e-12);
    // Two frames need no more than two diameters.
    let two = plan(&scene(2, 4e-3 * DVec3::X));
    assert_eq!(two.stack().size(), [512, 256], "{two}");
}

#[test]
fn surfaces_that_move_apart_have_patterns_of_their_own_each_as_wide_as_it_needs() {
    // Two halves that close in by 10 pixels each bring speckle from 10 pixels beyond their side.
    let left = testing::plate(DVec3::new(-0.05, 0.0, 0.001), DVec3::Z, [0.1, 0.1]);
    let mut left = moving(left, STEP);
    left.name = "left half".to_owned();
    let plan = plan(&with(scene(2, -STEP), [left]));
    assert_eq!(plan.allocations.len(), 2, "two motions: {plan}");
    for allocation in &plan.allocations {
        assert_absolute(allocation.needs.region[0], 310.0, 3.0);
    }
    assert_ne!(plan.seed_of(0), plan.seed_of(1), "{plan}");
    let allocations = plan.surface_patterns.iter().map(|p| p.allocation);
    assert!(allocations.eq([0, 1]), "{plan}");
    let text = plan.to_string();
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(lines.len(), 2, "{plan}");
    assert!(lines[1].starts_with("`left half`: speckles of"), "{plan}");
}

/// A plate behind the first one that stands still.
fn rest() -> Surface {
    plate(-0.01, DVec3::ZERO)
}

#[test]
fn what_stands_still_takes_one_slice() {
    let plan = plan(&with(scene(2, STEP), [rest()]));
    let slices = plan.allocations.iter();
    let slices = slices.map(|a| a.stack.path().slice_count());
    assert!(slices.eq([64, 1]), "{plan}");
    assert_eq!(plan.memory_bytes(), 65 * SLICE, "{plan}");
}

#[test]
fn surfaces_that_move_alike_share_a_pattern_wherever_they_turn() {
    // Each turns about its own middle: by nothing.
    let more = |motion: &Trajectory| {
        let plate = testing::plate(DVec3::new(0.01, 0.0, 0.01), DVec3::Z, [0.1, 0.1]);
        let ball = Shape::Sphere(Sphere::new(DVec3::new(0.03, 0.0, 0.01), 0.01).unwrap());
        let ball = Surface::new("ball", ball, Material::lambertian(0.8).unwrap());
        [plate, ball].map(|surface| Surface {
            trajectory: motion.clone(),
            ..surface
        })
    };
    let keyframes = [Keyframe::unmoved(0.0), Keyframe::unmoved(1.0)];
    let keyframed = Trajectory::keyframed(DVec3::ZERO, keyframes).unwrap();
    let standing = [more(&Trajectory::default()), more(&keyframed)].concat();
    let moving = more(&Trajectory::steady(STEP).unwrap()).to_vec();
    for (step, more) in [(DVec3::ZERO, standing), (STEP, moving)] {
        let plan = plan(&with(scene(2, step), more));
        assert_eq!(plan.allocations.len(), 1, "{step}: {plan}");
    }
}

#[test]
fn a_memory_that_does_not_hold_patterns_for_all_holds_places_for_them() {
    let planned = |mebibytes| plan_within(mebibytes, with(scene(2, STEP), [rest()])).unwrap();
    // 32 slices of 3/4 MiB and one; less than 16 slices per diameter are not worth it.
    let own = planned(24.75);
    assert_eq!(own.allocations.len(), 2, "{own}");
    let shared = planned(24.7);
    assert_eq!(shared.allocations.len(), 1, "{shared}");
    assert_eq!(shared.stack().path().slice_count(), 32, "{shared}");
    assert_says(&shared, "2 positions in one pattern");
    let offsets: Vec<_> = shared
        .surface_patterns
        .iter()
        .map(|p| p.parts[0].offset)
        .collect();
    // Far apart on the torus of the pattern.
    for axis in [0, 1] {
        let apart = (offsets[1][axis] - offsets[0][axis]).abs();
        assert!((0.2..0.8).contains(&apart), "{offsets:?}");
    }
    let more = (1..=100).map(|i| plate(-1e-4 * f64::from(i), 1e-6 * f64::from(i) * DVec3::X));
    let many = plan_within(64.0, with(scene(2, STEP), more)).unwrap();
    assert!(many.memory_bytes() <= 64 << 20, "{many}");
    assert_says(&many, "101 positions");
}

#[test]
fn sums_of_patterns_take_a_stack_for_each_part() {
    let mut scene = scene(2, STEP);
    let speckle = |patterns, polarisation| SurfaceSpeckle {
        patterns,
        polarisation,
    };
    scene.surfaces[0].speckle = speckle(3, 0.5);
    let own = plan(&scene);
    assert_eq!(own.memory_bytes(), 6 * 64 * SLICE, "{own}");
    assert_says(&own, "6 patterns that add up");
    for (number, part) in own.surface_patterns[0].parts.iter().enumerate() {
        assert_eq!(part.stack, number, "{part:?}");
        assert_absolute(part.fraction, [0.25, 1.0 / 12.0][number % 2], 1e-15);
    }
    // Less memory than that for six stacks of 32 slices.
    scene.speckle.memory = 143 << 20;
    let shared = plan(&scene);
    assert_eq!(shared.memory_bytes(), 64 * SLICE, "{shared}");
    assert_says(&shared, "6 positions");
    for (patterns, polarisation) in [(0, 1.0), (1, 1.5), (1, f64::NAN), (u32::MAX, 1.0)] {
        scene.surfaces[0].speckle = speckle(patterns, polarisation);
        let plan = SpecklePlan::new(&scene, 0);
        assert!(matches!(plan, Err(TracerError::Speckle(_))), "{plan:?}");
    }
}

#[test]
fn motions_before_and_after_the_reference_frame_add_up() {
    // 1 mm a frame behind a pupil of 3.125 mm: 0.64 diameters before, and 0.96 after.
    let mut scene = scene(6, 1e-3 * DVec3::X);
    scene.reference_frame = 2;
    let plan = plan(&scene);
    let allocation = &plan.allocations[0];
    for (shift, expected) in allocation.shifts.iter().zip([2.0, 3.0]) {
        assert_absolute(*shift, expected / 3.125, 0.01);
    }
    // A path of 1.6 diameters and the pupil's own.
    assert_absolute(allocation.stack.reach(), 2.0, 1e-12);
    let [before, after] = allocation.reaches();
    assert_absolute(before + after, 2.0, 1e-12);
    assert!(before < after, "{plan}");
}

#[test]
fn a_motion_between_two_sampled_frames_is_found_by_its_keyframes() {
    let away = 2e-3 * DVec3::X;
    let places = [(500.0, DVec3::ZERO), (501.0, away), (502.0, DVec3::ZERO)];
    let plan = plan(&keyframed(1001, &places));
    assert_absolute(plan.largest_shift(), 2.0 / 3.125, 0.01);
}

#[test]
fn memory_bounds_the_number_of_slices() {
    let slices = |mebibytes: f64| {
        let plan = plan_within(mebibytes, scene(2, 0.2e-3 * DVec3::X));
        plan.map(|plan| plan.stack().path().slice_count())
    };
    // 3/4 MiB a slice.
    for (mebibytes, count) in [(48.0, 64), (47.0, 32), (6.0, 8)] {
        assert_eq!(slices(mebibytes), Ok(count), "{mebibytes} MiB");
    }
    let (needed, allowed) = (6 << 20, 5 << 20);
    assert_eq!(
        slices(5.0),
        Err(TracerError::PatternMemory { needed, allowed })
    );
}

#[test]
fn slices_that_do_not_fit_the_memory_are_those_of_one_frame_at_a_time() {
    let moving = || scene(4, 20e-3 * DVec3::X);
    // 12.8 diameters take a path of 14; what a frame sees takes one of 3, of 3/4 MiB a slice.
    for (memory, slices) in [(72.0, 96), (71.0, 48), (9.0, 12)] {
        let plan = plan_within(memory, moving()).unwrap();
        assert_eq!(plan.stack().path().slice_count(), slices, "{plan}");
        assert_says(&plan, "slices at a time");
        // 6.4 diameters a frame, until the plate has left the image.
        let middles = [0, 6, 13, 13].map(|diameters| [192 * diameters, 0]);
        assert_eq!(plan.allocations[0].middles, middles, "{plan}");
    }
    let (needed, allowed) = (9 << 20, 8 << 20);
    let refused = TracerError::PatternMemory { needed, allowed };
    assert_eq!(plan_within(8.0, moving()), Err(refused));
}

#[test]
fn frames_share_no_speckle_while_a_smaller_field_fits_the_memory() {
    // 1.28 diameters take a path of 3, of 12 slices or more: 12 MiB of 512 × 256 samples for the
    // image and where it came from, 9 MiB of 384 × 256 for the image alone.
    let plan = |mebibytes| plan_within(mebibytes, scene(3, 2e-3 * DVec3::X));
    for (memory, width) in [(12.0, 512), (11.0, 384), (9.0, 384)] {
        let plan = plan(memory).unwrap();
        assert_eq!(plan.stack().size(), [width, 256], "{memory}: {plan}");
        assert_eq!(plan.stack().path().slice_count(), 12, "{memory}: {plan}");
    }
    assert!(matches!(plan(8.0), Err(TracerError::PatternMemory { .. })));
}

#[test]
fn every_frame_of_a_long_sequence_is_sampled() {
    // A plate of 0.1 m leaves the field after `seen` frames; 16 that are spread evenly would see it
    // in the first.
    for (frames, step, seen) in [(65, 2e-3, 27.0), (1000, 6.25e-3, 8.0), (1000, 12.5e-3, 4.0)] {
        let plan = plan_within(8192.0, scene(frames, step * DVec3::X)).unwrap();
        assert_absolute(plan.largest_shift(), step / 3.125e-3 * seen, 0.02);
    }
}

#[test]
fn frames_that_slices_cannot_follow_are_noted() {
    // Along two edges of a square, of 0.48 pupil diameters, each as far from where the plate began.
    let square = [
        (0.0, DVec3::ZERO),
        (1.0, 1.5e-3 * DVec3::X),
        (2.0, 1.5e-3 * DVec3::Y),
    ];
    let mut scene = keyframed(3, &square);
    assert_eq!(notes(&scene), []);
    // Bodies that share a stack for lack of memory have one line.
    scene.surfaces.push(rest());
    assert_eq!(notes(&scene), []);
    scene.speckle.memory = 24 << 20;
    let notes = notes(&scene);
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert_eq!(notes[0].frames, [1, 2], "{notes:?}");
    assert_absolute(notes[0].rendered, 1.0, 1e-3);
    let law = pupil_overlap_correlation(0.48 * core::f64::consts::SQRT_2);
    assert_absolute(notes[0].law, law, 1e-3);
}

#[test]
fn frames_far_from_a_reference_frame_without_a_law_are_noted() {
    // Light from the side: at 0.7 m the camera would see it come along the plate.
    let away = [(0.0, -0.7), (1.0, 0.0), (2.0, 0.5e-3)].map(|(frame, x)| (frame, x * DVec3::X));
    let mut scene = keyframed(3, &away);
    scene.lasers[0] = Laser::new(testing::spot(DVec3::new(0.1, 0.0, 0.173), 0.5e-3)).unwrap();
    let notes = notes(&scene);
    assert_eq!(notes.len(), 1, "{notes:?}");
    // 0.16 pupil diameters, of frames that have their own speckle.
    assert_eq!(
        (notes[0].frames, notes[0].rendered),
        ([1, 2], 0.0),
        "{notes:?}"
    );
    assert_absolute(notes[0].law, pupil_overlap_correlation(0.5 / 3.125), 1e-3);
}

#[test]
fn a_small_part_is_followed_where_the_rays_miss_it() {
    // Rays of a thousand frames are 1/32 of the image apart, the part 1/50 wide.
    let part = testing::plate(DVec3::new(-5e-3, 2.3e-4, 1e-3), DVec3::Z, [0.2e-3; 2]);
    let part = moving(part, 0.02e-3 * DVec3::X);
    let plan = plan(&with(scene(1000, DVec3::ZERO), [part]));
    // It is seen until its left edge has left the image, 5.674 mm from the middle.
    let [before, after] = plan.allocations[1].shifts;
    assert_absolute(before, 0.0, 0.0);
    assert_absolute(after, (5e-3 + 0.1e-3 + 5.674e-3) / 3.125e-3, 0.01);
}

#[test]
fn points_without_light_ask_for_nothing() {
    // The plate behind the laser passes the apex of its beam, but no light meets it.
    let behind = testing::plate(DVec3::new(0.001, 0.0, 0.21), DVec3::Z, [0.0005, 0.2]);
    let behind = moving(behind, 50e-3 * DVec3::Y);
    let plan = plan(&with(scene(3, DVec3::ZERO), [behind]));
    assert!(plan.largest_shift() < 1e-9, "{plan}");
}

#[test]
fn what_the_scene_asks_for_is_kept_and_said() {
    let mut scene = scene(2, DVec3::ZERO);
    scene.speckle.size = Some(300);
    scene.speckle.diameter = Some(100);
    let plan = plan(&scene);
    assert_eq!(plan.stack().size(), [300, 300], "{plan}");
    assert_eq!(plan.stack().diameter(), [100, 100], "{plan}");
    assert_says(&plan, "C = 100, LESS than the 182.5 × 121.6 speckles");
    assert_says(&plan, "as the scene asks");
}

#[test]
fn lasers_have_seeds_of_their_own() {
    let second = LaserDescription {
        spectrum: Spectrum::monochromatic(532e-9).unwrap(),
        ..testing::spot(DVec3::new(0.1, 0.0, 0.2), 1e-3)
    };
    let mut scene = scene(2, DVec3::ZERO);
    scene.lasers.push(Laser::new(second).unwrap());
    let plan = SpecklePlan::new(&scene, 0).unwrap();
    let [first, second] = plan.patterns() else {
        panic!("two lasers have two patterns");
    };
    assert_ne!(first.seed_of(0), second.seed_of(0));
    assert!(second.speckle_size_in_pixels() < first.speckle_size_in_pixels());
}
