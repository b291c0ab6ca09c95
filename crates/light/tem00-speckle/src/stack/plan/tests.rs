use proptest::prelude::*;

use super::*;

fn needs() -> StackNeeds {
    StackNeeds {
        image: [300.0, 200.0],
        region: [300.0, 200.0],
        speckle_size: 1.5,
        motion: None,
        frames: 2,
        memory_limit: 1 << 30,
    }
}

#[test]
fn sizes_have_small_prime_factors() {
    let sizes = [1.0, 33.0, 182.5, 247.0, 385.0, 1e4].map(diameter_for);
    assert_eq!(sizes, [32, 40, 192, 256, 400, 10_000]);
    // The pupil field refuses sizes that no pattern can have.
    assert_eq!(diameter_for(1e9), 1_000_000_000);
}

#[test]
fn each_axis_holds_the_speckles_of_its_own_side() {
    // 200 and 133.3 speckles: the next sizes are 200 = 2³ · 5² and 144 = 2⁴ · 3².
    let plan = StackPlan::new(&needs()).unwrap();
    assert_eq!(plan.diameter(), [200, 144]);
    assert_eq!(plan.size(), [400, 288]);
    assert_eq!(plan.memory_bytes(), 8 * 400 * 288, "one slice");
    let field = plan.field(1).unwrap();
    let off = (0..2).map(|axis| field.diameter()[axis] - plan.diameter()[axis] as f64);
    assert!(off.sum::<f64>().abs() < 1e-12, "{:?}", field.diameter());
}

#[test]
fn the_stack_is_that_of_the_plan() {
    let plan = StackPlan::new(&StackNeeds {
        image: [60.0, 40.0],
        region: [60.0, 40.0],
        motion: Some(0.1),
        ..needs()
    })
    .unwrap()
    .with_half_period(4);
    let stack = plan.stack(3, StackOptions::default()).unwrap();
    assert_eq!(stack.memory_bytes(), plan.memory_bytes());
    assert_eq!((stack.size(), stack.path()), (plan.size(), plan.path()));
    // A motion by a quarter of the diameter leads to the next slice, and leaves the correlation
    // chat(0.25)².
    let u = 0.25 * plan.slices_per_diameter();
    let expected = tem00_numerics::disc_overlap(0.25).powi(2);
    assert!((stack.correlation_at(u) - expected).abs() < 1e-12, "at {u}");
}

#[test]
fn what_motion_brings_in_repeats_before_frames_share_their_speckle() {
    let plan = |memory_limit: u64| {
        let needs = StackNeeds {
            region: [1200.0, 200.0],
            motion: Some(12.8),
            frames: 4,
            memory_limit,
            ..needs()
        };
        let plan = StackPlan::new(&needs).unwrap();
        (plan.holds_region(&needs), plan.holds_motion(&needs))
    };
    let slice = 8 * 1600 * 288;
    assert_eq!(plan(14 * 4 * slice), (true, true));
    assert_eq!(plan(14 * 4 * slice - 1), (false, true));
    assert_eq!(
        plan(14 * slice),
        (false, true),
        "the image takes a quarter of that"
    );
    assert_eq!(plan(14 * slice - 1), (false, false), "a path of 7");
}

#[test]
fn a_region_beyond_every_pattern_leaves_the_image() {
    let needs = StackNeeds {
        region: [300.0, 1e6],
        memory_limit: u64::MAX,
        ..needs()
    };
    let plan = StackPlan::new(&needs).unwrap();
    assert_eq!(plan.diameter(), [200, 144], "that of the image");
    assert!(!plan.holds_region(&needs), "and known to be less");
}

#[test]
fn less_memory_takes_slices_first_and_then_the_path() {
    let paths = |memory_limit: u64| {
        let needs = StackNeeds {
            motion: Some(12.8),
            frames: 4,
            memory_limit,
            ..needs()
        };
        let plan = StackPlan::new(&needs).unwrap();
        (plan.path().slice_count(), plan.holds_motion(&needs))
    };
    let slice = 8 * 400 * 288;
    // 12.8 diameters take a path of 14.
    assert_eq!(paths(14 * 32 * slice), (448, true));
    assert_eq!(paths(14 * 32 * slice - 1), (224, true));
    assert_eq!(paths(14 * 4 * slice), (56, true));
    assert_eq!(paths(14 * 4 * slice - 1), (28, false), "a path of 7");
    assert_eq!(paths(2 * 4 * slice), (8, false));
}

#[test]
fn long_paths_have_as_many_slices_as_a_stack_may() {
    let counts = |motion: f64| {
        let needs = StackNeeds {
            motion: Some(motion),
            frames: 9,
            ..needs()
        };
        let plans = StackPlan::candidates(&needs).unwrap();
        let counts = plans.iter().map(|plan| plan.path().slice_count());
        counts.take(2).collect::<Vec<_>>()
    };
    // 16 and 32 slices per diameter would exceed 2 · 32768.
    assert_eq!(counts(5_000.0), [8 * 5_001, 4 * 5_001]);
    assert_eq!(counts(1e30)[0], 1 << 16, "the longest path of all");
}

#[test]
fn printed_plans_lie_on_the_circle() {
    let straight = StackPlan::new(&StackNeeds {
        motion: Some(4.0),
        frames: 9,
        ..needs()
    })
    .unwrap();
    let circle = straight.on_circle();
    assert_eq!(circle.path(), SlicePath::Circle { half_period: 32 });
    let (a, b) = (straight.slices_per_diameter(), circle.slices_per_diameter());
    assert!((a - b).abs() < 1e-12, "{a} and {b} slices per diameter");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_plan_holds_what_it_is_made_for_within_its_memory(
        image in [1.0..4000.0, 1.0..4000.0_f64],
        wider in [1.0..3.0, 1.0..3.0_f64],
        speckle_size in 0.3..20.0,
        motion in proptest::option::of(0.0..100.0),
        frames in 1_u32..100,
        memory_limit in (1_u64 << 20)..(8 << 30),
    ) {
        let region = [image[0] * wider[0], image[1] * wider[1]];
        let needs = StackNeeds { image, region, speckle_size, motion, frames, memory_limit };
        let best = StackPlan::candidates(&needs).map(|plans| plans[0]);
        prop_assert!(best.clone().is_ok_and(|plan| plan.holds_motion(&needs)), "{best:?}");
        match StackPlan::new(&needs) {
            Ok(plan) => {
                prop_assert!(plan.memory_bytes() <= memory_limit, "too much memory");
                let image_alone = StackNeeds { region: image, ..needs };
                prop_assert!(plan.holds_region(&image_alone), "the image repeats");
                prop_assert!(plan.field(7).is_ok(), "no field");
                // No more than needed: the next smaller smooth multiple of 8 is at most 1/4 below.
                for (side, diameter) in region.into_iter().zip(plan.diameter()) {
                    let speckles = (side / speckle_size).max(32.0);
                    let diameter = diameter as f64;
                    prop_assert!(diameter < 1.25 * speckles + 8.0, "{diameter} for {speckles}");
                }
            }
            Err(SpeckleError::MemoryLimit { needed, limit }) => prop_assert!(needed > limit),
            Err(other) => prop_assert_eq!(other.parameter(), "size", "{}", other),
        }
    }
}
