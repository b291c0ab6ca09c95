use tem00_speckle::{PupilField, StackOptions, StackPlan};

use super::*;

fn peer(path: tem00_speckle::SlicePath) -> SpeckleStack {
    let field = PupilField::from_speckle_size([64, 48], 3.0, 11).unwrap();
    let options = StackOptions {
        memory_limit: 1 << 20,
    };
    SpeckleStack::generate_with(&field, path, options).unwrap()
}

#[test]
fn every_path_makes_the_stack_of_the_library() {
    use tem00_speckle::SlicePath as P;
    let (half_period, length) = (6, 3);
    let straight = P::Straight {
        half_period,
        length,
    };
    let paths = [
        (SlicePath::Still, P::Still),
        (SlicePath::Circle, P::Circle { half_period }),
        (SlicePath::Straight, straight),
    ];
    for (path, of_library) in paths {
        let stack = Owned::new(&StackDescription {
            path: path as u32,
            ..DESCRIPTION
        });
        assert!(*stack.library() == peer(of_library), "{path:?}");
    }
}

#[test]
fn a_diameter_makes_the_field_of_that_diameter() {
    let made = |height| {
        Owned::new(&StackDescription {
            width: 256,
            height,
            diameter: 49,
            speckle_size: f64::NAN,
            path: SlicePath::Still as u32,
            ..DESCRIPTION
        })
    };
    // 256 / (256 / 49) is not 49 in double precision.
    let square = made(256);
    let expected = PupilField::new(256, 49, 11).unwrap();
    assert!(*square.library().field() == expected, "256 × 256 samples");
    let oblong = made(112);
    let expected = PupilField::from_speckle_size([256, 112], 256.0 / 49.0, 11).unwrap();
    assert!(*oblong.library().field() == expected, "256 × 112 samples");
}

#[test]
fn a_description_from_a_plan_makes_the_stack_of_the_plan() {
    for (memory_limit, changes, side) in [(4 << 20, 1, 60.0), (1 << 30, 0, 80.0)] {
        let needs = StackNeeds {
            image: [side, 40.0],
            memory_limit,
            changes,
            ..NEEDS
        };
        // SAFETY: the pointers are valid.
        let description = answer(DESCRIPTION, |out| unsafe {
            tem00_stack_plan(&raw const needs, out)
        });
        let plan = StackPlan::new(&tem00_speckle::StackNeeds {
            image: [side, 40.0],
            region: [80.0, 40.0],
            speckle_size: 1.5,
            motion: (changes == 1).then_some(0.7),
            frames: 5,
            memory_limit,
        })
        .unwrap();
        let stack = Owned::new(&StackDescription {
            seed: 5,
            ..description
        });
        let expected = plan.stack(5, StackOptions { memory_limit });
        assert!(*stack.library() == expected.unwrap(), "{plan:?}");
    }
}

#[test]
fn a_stack_is_the_same_for_any_number_of_threads() {
    let one = Owned::new(&DESCRIPTION);
    for threads in [0, 2, 5] {
        let other = Owned::new(&StackDescription {
            threads,
            ..DESCRIPTION
        });
        assert!(one.library() == other.library(), "{threads} threads");
    }
}

#[test]
fn a_stack_tells_what_it_is() {
    let stack = Owned::new(&DESCRIPTION);
    let info = StackInfo {
        width: 64,
        height: 48,
        slice_count: 12,
        speckle_size: 3.0,
        path: SlicePath::Straight,
        half_period: 6,
        length: 3,
        memory_bytes: 64 * 48 * 12 * 8,
    };
    let blank = StackInfo {
        width: 0,
        height: 0,
        slice_count: 0,
        ..info
    };
    // SAFETY: the pointers are valid.
    let got = answer(blank, |out| unsafe { tem00_stack_describe(stack.0, out) });
    assert_eq!(got, info, "{DESCRIPTION:?}");
}
