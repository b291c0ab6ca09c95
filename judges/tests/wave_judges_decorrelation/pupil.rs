//! Displacement of the speckle on the pupil, for small translations.

use core::fmt::Write as _;
use std::sync::LazyLock;

use tem00::{
    decorrelation::Motion,
    wave::{DVec2, DVec3},
};

use crate::{
    geometries::{Case, cases, frontal, tilted},
    scene::{States, plane, point_source},
};

/// All cases, with the displacement that the judge finds.
static JUDGED: LazyLock<Vec<(Case, DVec2)>> = LazyLock::new(|| {
    let measured = |case: Case| {
        let shift = case.scene.measured(&case.motion.into(), case.seeds);
        (case, shift.expect("a maximum of the cross-correlation"))
    };
    cases().into_iter().map(measured).collect()
});

/// Asserts that the median and the largest error of a law, in units of its displacement, are below
/// limits.
fn assert_errors_below([median, worst]: [f64; 2], law: impl Fn(&Case) -> Option<DVec2>) {
    let mut report = String::new();
    let mut errors = Vec::new();
    for (case, measured) in JUDGED.iter() {
        let theory = law(case).expect("no grazing view");
        let error = (*measured - theory).length() / theory.length();
        let speckles = theory.length() / case.scene.pupil_speckle();
        let (name, percent) = (case.name, 100.0 * error);
        let line = writeln!(report, "{percent:7.3} % of {speckles:5.2} speckles: {name}");
        line.expect("strings take all");
        errors.push(error);
    }
    errors.sort_by(f64::total_cmp);
    assert!(errors.len() >= 24, "{} geometries", errors.len());
    assert!(errors[errors.len() / 2] < median, "median of\n{report}");
    assert!(errors[errors.len() - 1] < worst, "worst of\n{report}");
}

#[test]
fn speckle_moves_across_the_pupil_as_the_first_order_law_says() {
    // The law neglects the motion over the distance, here up to 0.5 %, and the maximum of the
    // cross-correlation errs by about a hundredth of a speckle, 0.2 % of most displacements and
    // 1.4 % of the shortest.
    assert_errors_below([2e-3, 2e-2], |case| {
        case.scene.point().pupil_displacement(&case.motion)
    });
}

#[test]
fn speckle_moves_across_the_pupil_as_the_finite_law_says() {
    // What remains is the error of the cross-correlation, largest in the beams that the surface
    // moves through.
    assert_errors_below([7e-4, 2e-2], |case| {
        let before = case.scene.configuration();
        let after = States::from(case.motion).after(&before);
        before.pupil_point_after(&after, DVec2::ZERO)
    });
}

#[test]
fn speckle_stays_where_the_laws_say_so() {
    let along_axis = Motion {
        surface: DVec3::new(0.0, 0.0, 0.5e-3),
        ..Motion::default()
    };
    let aside = DVec3::new(0.4e-3, -0.3e-3, 0.2e-3);
    let with_camera = Motion {
        surface: aside,
        camera: aside,
        ..Motion::default()
    };
    let collimated = plane(DVec3::new(1.0, 0.4, 1.0));
    let source = point_source(DVec3::new(-0.12, 0.05, 0.2));
    let level = frontal(DVec3::Z, collimated);
    let all = Motion {
        source: aside,
        ..with_camera
    };
    for (name, scene, motion) in [
        ("along the axis", level, along_axis),
        (
            "along the axis, tilted",
            frontal(tilted(60.0, 20.0), collimated),
            along_axis,
        ),
        (
            "with the camera",
            frontal(tilted(40.0, 0.0), collimated),
            with_camera,
        ),
        ("all", frontal(tilted(40.0, 0.0), source), all),
    ] {
        let theory = scene.point().pupil_displacement(&motion);
        assert_eq!(theory, Some(DVec2::ZERO), "{name}");
        let measured = scene.measured(&motion.into(), 1).expect("a maximum");
        let speckles = measured.length() / scene.pupil_speckle();
        // The error of the cross-correlation of patterns that have stretched a little.
        assert!(speckles < 0.01, "{name}: {speckles:.4} speckles");
    }
}
