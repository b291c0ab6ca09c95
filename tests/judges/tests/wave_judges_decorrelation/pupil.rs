//! Displacement of the speckle on the pupil, for translations.

use core::fmt::Write as _;

use tem00::wave::{DVec2, DVec3};

use super::{
    geometries::{cases, frontal, tilted},
    scene::{Motion, Scene, States, plane, point_source},
};

/// The displacement by the law.
fn law(scene: &Scene, motion: Motion) -> DVec2 {
    let before = scene.configuration();
    let after = States::from(motion).after(&before);
    let law = before.pupil_point_after(&after, DVec2::ZERO);
    law.expect("no grazing view")
}

#[test]
fn speckle_moves_across_the_pupil_as_the_law_says() {
    let mut report = String::new();
    let mut errors = Vec::new();
    for case in cases() {
        let measured = case.scene.measured(&case.motion.into(), case.seeds);
        let measured = measured.expect("a maximum of the cross-correlation");
        let theory = law(&case.scene, case.motion);
        let error = (measured - theory).length() / theory.length();
        let speckles = theory.length() / case.scene.pupil_speckle();
        let (name, percent) = (case.name, 100.0 * error);
        let line = writeln!(report, "{percent:7.3} % of {speckles:5.2} speckles: {name}");
        line.expect("strings take all");
        errors.push(error);
    }
    errors.sort_by(f64::total_cmp);
    assert!(errors.len() >= 24, "{} geometries", errors.len());
    // What remains is the error of the cross-correlation, about a hundredth of a speckle: 1.4 % of
    // the shortest displacements, and largest in the beams that the surface moves through.
    assert!(errors[errors.len() / 2] < 7e-4, "median of\n{report}");
    assert!(errors[errors.len() - 1] < 2e-2, "worst of\n{report}");
}

#[test]
fn speckle_stays_where_the_law_says_so() {
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
        let theory = law(&scene, motion).length();
        assert!(theory < 1e-15, "{name}: {theory:e} m");
        let measured = scene.measured(&motion.into(), 1).expect("a maximum");
        let speckles = measured.length() / scene.pupil_speckle();
        // The error of the cross-correlation of patterns that have stretched a little.
        assert!(speckles < 0.01, "{name}: {speckles:.4} speckles");
    }
}
