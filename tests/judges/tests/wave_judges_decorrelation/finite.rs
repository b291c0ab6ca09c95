//! Displacement of the speckle on the pupil, for motions that turn or go far, and for changes of
//! the light.

use tem00::wave::{DVec2, DVec3};

use super::{
    geometries::{frontal, mm, tilted, v},
    scene::{Body, Scene, States, plane, plane_of, point_source},
};

/// Asserts that the law is right to the error of the cross-correlation, a hundredth of a speckle.
#[track_caller]
fn judge(name: &str, scene: &Scene, states: &States) {
    let before = scene.configuration();
    let law = before.pupil_point_after(&states.after(&before), DVec2::ZERO);
    let law = law.expect("a displacement");
    let measured = scene.measured(states, 1).expect("a maximum");
    let [error, speckles] = [measured - law, law].map(|v| v.length() / scene.pupil_speckle());
    assert!(error < 0.01, "{name}: {error:.4} of {speckles:.2} speckles");
}

pub(crate) fn surface(body: Body) -> States {
    States {
        surface: body,
        ..States::default()
    }
}

pub(crate) fn camera(body: Body) -> States {
    States {
        camera: body,
        ..States::default()
    }
}

pub(crate) fn source(body: Body) -> States {
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
    let oblique = frontal(tilted(30.0, 15.0), near);
    let oblique = oblique.seen(v(0.08, 0.05, 0.28), v(-0.06, 0.04, 0.0));
    let off_pivot = Body::about(v(0.0, 0.05, 0.0), v(0.3, 1.0, 0.2), 1.2e-3);
    let about = |axis, angle| Body::about(ORIGIN, axis, angle);
    let far = Body::about(v(0.1, 0.0, 0.0), DVec3::Z, 5e-3);
    let moved = Body {
        translation: mm(0.2, -0.3, 0.2),
        ..off_pivot
    };
    for (name, scene, body) in [
        ("tilted about y", level, about(DVec3::Y, 1e-3)),
        ("tilted about x", level, about(DVec3::X, -0.8e-3)),
        ("tilted, oblique", oblique, about(v(1.0, 1.0, 0.5), 1e-3)),
        ("in its plane, far off", frontal(DVec3::Z, collimated), far),
        ("turned off its pivot", oblique, off_pivot),
        ("turned and moved", oblique, moved),
    ] {
        judge(name, &scene, &surface(body));
    }
    let lit_near = frontal(tilted(20.0, 0.0), near);
    let around = about(v(0.2, 1.0, 0.0), 1.5e-3);
    judge("camera, about the surface", &lit_near, &camera(around));
    let in_pupil = Body::about(v(0.0, 0.0, 0.3), v(0.2, 1.0, 0.3), 5e-3);
    judge("camera, about its pupil", &lit_near, &camera(in_pupil));
    let around = about(v(1.0, 1.0, 0.0), 1.5e-3);
    judge("source, about the surface", &level, &source(around));
}

#[test]
fn changes_of_light_move_the_speckle_as_the_law_says() {
    let lit = |to_source| frontal(tilted(-20.0, 10.0), plane(to_source));
    let changed = |light| States {
        light: Some(light),
        ..States::default()
    };
    let at_45 = v(1.0, 0.0, 1.0);
    let to = |x, y, z| changed(plane(v(x, y, z)));
    judge("wavelength", &lit(at_45), &changed(plane_of(652e-9, at_45)));
    judge("direction", &lit(at_45), &to(1.0, 0.003, 1.002));
    let both = States {
        surface: Body::about(ORIGIN, DVec3::X, 0.7e-3),
        ..changed(plane_of(651e-9, v(1.0, 0.001, 1.0)))
    };
    judge("both, and a tilt", &lit(at_45), &both);
}

#[test]
fn long_ways_move_the_speckle_as_the_law_says() {
    let source = point_source(v(0.1, 0.05, 0.25));
    let states = States {
        window: DVec2::new(9.5e-3, 0.0),
        ..surface(Body::along(mm(5.0, 0.0, 0.0)))
    };
    let scene = frontal(tilted(20.0, 0.0), source);
    judge("5 mm in the light of a source", &scene, &states);
}
