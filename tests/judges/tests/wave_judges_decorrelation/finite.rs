//! Displacement of the speckle on the pupil, for motions that turn or go far, and for changes of
//! the light.

use tem00::wave::{DVec2, DVec3};

use super::{
    geometries::{frontal, mm, seen, tilted, v},
    scene::{Body, Scene, States, plane, plane_of, point_source},
};

/// The displacement of the law and, in speckles, how far the measured one is from it.
fn judged(scene: &Scene, states: &States) -> (DVec2, f64) {
    let before = scene.configuration();
    let law = before.pupil_point_after(&states.after(&before), DVec2::ZERO);
    let law = law.expect("a displacement");
    let measured = scene.measured(states, 1).expect("a maximum");
    (law, (measured - law).length() / scene.pupil_speckle())
}

/// Asserts that the law is right to the error of the cross-correlation, a hundredth of a speckle.
fn judge(cases: &[(&str, Scene, States)]) {
    for (name, scene, states) in cases {
        let (law, error) = judged(scene, states);
        let speckles = law.length() / scene.pupil_speckle();
        assert!(error < 0.01, "{name}: {error:.4} of {speckles:.2} speckles");
    }
}

fn surface(body: Body) -> States {
    States {
        surface: body,
        ..States::default()
    }
}

fn camera(body: Body) -> States {
    States {
        camera: body,
        ..States::default()
    }
}

fn source(body: Body) -> States {
    States {
        source: body,
        ..States::default()
    }
}

const ORIGIN: DVec3 = DVec3::ZERO;

#[test]
fn rotations_move_the_speckle_as_the_law_says() {
    let collimated = plane(v(0.5, 0.2, 1.0));
    let near = point_source(v(-0.12, 0.05, 0.2));
    let level = frontal(DVec3::Z, plane(DVec3::Z));
    let oblique = seen(
        frontal(tilted(30.0, 15.0), near),
        v(0.08, 0.05, 0.28),
        v(-0.06, 0.04, 0.0),
    );
    let off_pivot = Body::about(v(0.0, 0.05, 0.0), v(0.3, 1.0, 0.2), 1.2e-3);
    judge(&[
        (
            "tilted about y",
            level,
            surface(Body::about(ORIGIN, DVec3::Y, 1e-3)),
        ),
        (
            "tilted about x",
            level,
            surface(Body::about(ORIGIN, DVec3::X, -0.8e-3)),
        ),
        (
            "tilted, oblique",
            oblique,
            surface(Body::about(ORIGIN, v(1.0, 1.0, 0.5), 1e-3)),
        ),
        (
            "turned in its plane, far from the axis",
            frontal(DVec3::Z, collimated),
            surface(Body::about(v(0.1, 0.0, 0.0), DVec3::Z, 5e-3)),
        ),
        ("turned off its pivot", oblique, surface(off_pivot)),
        (
            "turned and moved",
            oblique,
            surface(Body {
                translation: mm(0.2, -0.3, 0.2),
                ..off_pivot
            }),
        ),
        (
            "camera turned about the surface",
            frontal(tilted(20.0, 0.0), near),
            camera(Body::about(ORIGIN, v(0.2, 1.0, 0.0), 1.5e-3)),
        ),
        (
            "camera turned about its pupil",
            frontal(tilted(20.0, 0.0), near),
            camera(Body::about(v(0.0, 0.0, 0.3), v(0.2, 1.0, 0.3), 5e-3)),
        ),
        (
            "source turned about the surface",
            level,
            source(Body::about(ORIGIN, v(1.0, 1.0, 0.0), 1.5e-3)),
        ),
    ]);
}

#[test]
fn changes_of_light_move_the_speckle_as_the_law_says() {
    let lit = |to_source| frontal(tilted(-20.0, 10.0), plane(to_source));
    let changed = |light| States {
        light: Some(light),
        ..States::default()
    };
    let at_45 = v(1.0, 0.0, 1.0);
    judge(&[
        ("wavelength", lit(at_45), changed(plane_of(652e-9, at_45))),
        (
            "direction",
            lit(at_45),
            changed(plane(v(1.0, 0.003, 1.002))),
        ),
        (
            "both, and a tilt",
            lit(at_45),
            States {
                surface: Body::about(ORIGIN, DVec3::X, 0.7e-3),
                ..changed(plane_of(651e-9, v(1.0, 0.001, 1.0)))
            },
        ),
    ]);
}

#[test]
fn long_ways_move_the_speckle_as_the_law_says() {
    let source = point_source(v(0.1, 0.05, 0.25));
    judge(&[(
        "5 mm in the light of a source",
        frontal(tilted(20.0, 0.0), source),
        States {
            window: DVec2::new(9.5e-3, 0.0),
            ..surface(Body::along(mm(5.0, 0.0, 0.0)))
        },
    )]);
}
