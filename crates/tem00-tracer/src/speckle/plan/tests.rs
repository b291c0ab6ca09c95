use std::path::Path;

use super::*;
use crate::parse_scene;

/// A plate under a collimated spot as wide as the image, in a number of frames; `more` is appended.
fn scene(frames: u32, displacement: &str, more: &str) -> Scene {
    let text = format!(
        r#"
        [render]
        frames = {frames}
        [camera]
        position = [0, 0, 0.3]
        resolution = [300, 200]
        [[laser]]
        wavelength = "650 nm"
        power = "1 mW"
        position = [0, 0, 0.2]
        spot = {{ waist_radius = "5 mm" }}
        [[surface]]
        displacement_per_frame = {displacement}
        rectangle = {{ size = [0.1, 0.1] }}
        {more}
        "#
    );
    parse_scene(&text, Path::new(".")).unwrap()
}

fn plan(frames: u32, displacement: &str, more: &str) -> Result<PatternPlan, TracerError> {
    let plan = SpecklePlan::new(&scene(frames, displacement, more), Formulas::Derived, 0)?;
    Ok(plan.patterns()[0].clone())
}

#[test]
fn nothing_repeats_within_the_image() {
    let plan = plan(2, "[0, 0, 0]", "").unwrap();
    // h = λ (1 + m) F with m = 1/11, in pixels of 3.45 µm.
    let speckle_size = 650e-9 * 12.0 / 11.0 * 8.0 / 3.45e-6;
    let error = plan.speckle_size_in_pixels() / speckle_size - 1.0;
    assert!(error.abs() < 1e-12, "{plan}");
    // 300 × 200 pixels hold 182.5 × 121.6 speckles: the next sizes are 192 = 2⁶ · 3 and 128.
    assert_eq!(plan.stack().diameter(), [192, 128], "{plan}");
    assert_eq!(plan.stack().size(), [384, 256], "{plan}");
    assert_eq!(plan.stack().path(), SlicePath::Still, "{plan}");
}

#[test]
fn motion_of_several_frames_widens_the_pattern_and_asks_for_slices() {
    let plan = plan(3, "[\"2 mm\", 0, 0]", "").unwrap();
    // 4 mm are 105.4 pixels: 405.4 pixels hold 246.6 speckles. The pupil of 3.125 mm is left behind,
    // so that the path of the slices is three diameters long.
    assert_eq!(plan.stack().size(), [512, 256], "{plan}");
    assert!((plan.largest_shift() - 4.0 / 3.125).abs() < 1e-2, "{plan}");
    let path = SlicePath::Straight {
        half_period: 48,
        length: 3,
    };
    assert_eq!(plan.stack().path(), path, "{plan}");
    assert!(
        (plan.stack().slices_per_diameter() - 32.0).abs() < 1e-12,
        "{plan}"
    );
    assert!((plan.stack().reach() - 2.0).abs() < 1e-12, "{plan}");
}

#[test]
fn two_frames_need_no_more_than_two_diameters() {
    let plan = plan(2, "[\"4 mm\", 0, 0]", "").unwrap();
    assert_eq!(plan.stack().size(), [512, 256], "{plan}");
    assert!(!plan.to_string().contains("MORE"), "{plan}");
}

#[test]
fn opposite_motions_widen_the_pattern_twice() {
    // Two halves that close in by 10 pixels each bring speckle from 10 pixels beyond both sides.
    let more = "[[surface]]\ndisplacement_per_frame = [0.3795e-3, 0, 0]\n\
                rectangle = { centre = [-0.05, 0, 0.001], size = [0.1, 0.1] }";
    let plan = plan(2, "[-0.3795e-3, 0, 0]", more).unwrap();
    assert!((plan.needs.region[0] - 320.0).abs() < 3.0, "{plan}");
}

#[test]
fn memory_bounds_the_number_of_slices() {
    let motion = "[\"0.2 mm\", 0, 0]";
    let slices = |memory: &str| {
        let more = format!("[speckle]\nmemory = \"{memory}\"");
        plan(2, motion, &more).map(|plan| plan.stack().path().slice_count())
    };
    // 384 × 256 complex samples are 3/4 MiB a slice.
    assert_eq!(slices("48 MiB"), Ok(64));
    assert_eq!(slices("47 MiB"), Ok(32));
    assert_eq!(slices("6 MiB"), Ok(8));
    assert_eq!(
        slices("5 MiB"),
        Err(TracerError::PatternMemory {
            needed: 6 << 20,
            allowed: 5 << 20
        })
    );
}

#[test]
fn a_motion_that_does_not_fit_the_memory_is_cut_and_said() {
    let motion = "[\"20 mm\", 0, 0]";
    // 12.8 diameters take a path of 14, of 56 slices of 3/4 MiB with four to a diameter.
    let whole = plan(4, motion, "[speckle]\nmemory = \"42 MiB\"").unwrap();
    assert_eq!(whole.stack().path().slice_count(), 56, "{whole}");
    assert!(!whole.to_string().contains("MORE"), "{whole}");
    let plan = plan(4, motion, "[speckle]\nmemory = \"41 MiB\"").unwrap();
    assert!(plan.stack().memory_bytes() <= 41 << 20, "{plan}");
    assert!(
        plan.to_string().contains("MORE than the slices hold"),
        "{plan}"
    );
}

#[test]
fn frames_share_no_speckle_while_a_smaller_field_fits_the_memory() {
    // 1.28 diameters take a path of 3, of 12 slices or more: 12 MiB of 512 × 256 samples for the image
    // and where it came from, 9 MiB of 384 × 256 for the image alone.
    let plan = |memory: &str| {
        let more = format!("[speckle]\nmemory = \"{memory}\"");
        plan(3, "[\"2 mm\", 0, 0]", &more).unwrap()
    };
    for (memory, width, slices, shares) in [
        ("12 MiB", 512, 12, false),
        ("11 MiB", 384, 12, false),
        ("9 MiB", 384, 12, false),
        ("8 MiB", 512, 8, true),
    ] {
        let plan = plan(memory);
        assert_eq!(plan.stack().size(), [width, 256], "{memory}: {plan}");
        assert_eq!(
            plan.stack().path().slice_count(),
            slices,
            "{memory}: {plan}"
        );
        assert_eq!(plan.to_string().contains("MORE"), shares, "{plan}");
    }
}

#[test]
fn points_without_light_ask_for_nothing() {
    // The plate behind the laser passes the apex of its beam, but no light meets it.
    let more = "[[surface]]\ndisplacement_per_frame = [0, \"50 mm\", 0]\n\
                rectangle = { centre = [0.001, 0, 0.21], size = [0.0005, 0.2] }";
    let plan = plan(3, "[0, 0, 0]", more).unwrap();
    assert!(plan.largest_shift() < 1e-9, "{plan}");
}

#[test]
fn what_the_scene_asks_for_is_kept_and_said() {
    let plan = plan(2, "[0, 0, 0]", "[speckle]\nsize = 300\ndiameter = 100").unwrap();
    assert_eq!(plan.stack().size(), [300, 300], "{plan}");
    assert_eq!(plan.stack().diameter(), [100, 100], "{plan}");
    let text = plan.to_string();
    assert!(
        text.contains("C = 100, LESS than the 182.5 × 121.6 speckles"),
        "{text}"
    );
    assert!(text.contains("as the scene asks"), "{text}");
}

#[test]
fn printed_formulas_get_the_circle_of_the_paper() {
    let scene = scene(2, "[\"0.2 mm\", 0, 0]", "");
    let plan = SpecklePlan::new(&scene, Formulas::AsPrinted, 0).unwrap();
    let path = plan.patterns()[0].stack().path();
    assert_eq!(path, SlicePath::Circle { half_period: 32 }, "{plan}");
    // No memory gives the circle more than one diameter.
    let scene = self::scene(3, "[\"2 mm\", 0, 0]", "");
    let plan = SpecklePlan::new(&scene, Formulas::AsPrinted, 0).unwrap();
    assert!(plan.patterns()[0].largest_shift() > 1.0, "{plan}");
    assert!(!plan.to_string().contains("MORE"), "{plan}");
}

#[test]
fn lasers_have_seeds_of_their_own() {
    let second = r#"
        [[laser]]
        wavelength = "532 nm"
        power = "1 mW"
        position = [0.1, 0, 0.2]
        spot = { waist_radius = "1 mm" }
    "#;
    let scene = scene(2, "[0, 0, 0]", second);
    let plan = SpecklePlan::new(&scene, Formulas::Derived, 0).unwrap();
    let [first, second] = plan.patterns() else {
        panic!("two lasers have two patterns");
    };
    assert_ne!(first.seed(), second.seed());
    assert!(second.speckle_size_in_pixels() < first.speckle_size_in_pixels());
}
