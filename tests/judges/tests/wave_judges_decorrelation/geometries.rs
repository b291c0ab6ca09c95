//! The geometries in which displacements are judged.

use tem00::wave::DVec3;

use super::scene::{Beam, Fan, Light, Motion, Scene, beam, fan, plane, point_source};

/// A scene, what moves in it, and on how many surfaces it is measured.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) scene: Scene,
    pub(crate) motion: Motion,
    pub(crate) seeds: u64,
}

pub(crate) const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A vector in millimetres.
pub(crate) fn mm(x: f64, y: f64, z: f64) -> DVec3 {
    v(x, y, z) * 1e-3
}

fn surface(motion: DVec3) -> Motion {
    Motion {
        surface: motion,
        ..Motion::default()
    }
}

fn camera(motion: DVec3) -> Motion {
    Motion {
        camera: motion,
        ..Motion::default()
    }
}

fn source(motion: DVec3) -> Motion {
    Motion {
        source: motion,
        ..Motion::default()
    }
}

/// The normal of a surface turned by angles about y and x, in degrees.
pub(crate) fn tilted(about_y: f64, about_x: f64) -> DVec3 {
    let [y, x] = [about_y, about_x].map(f64::to_radians);
    v(y.sin() * x.cos(), -x.sin(), y.cos() * x.cos())
}

/// A surface seen along z from 0.3 m.
pub(crate) fn frontal(normal: DVec3, light: Light) -> Scene {
    Scene {
        eye: v(0.0, 0.0, 0.3),
        target: DVec3::ZERO,
        normal,
        light,
        size: [2e-3; 2],
    }
}

/// The same with another camera.
pub(crate) fn seen(scene: Scene, eye: DVec3, target: DVec3) -> Scene {
    Scene {
        eye,
        target,
        ..scene
    }
}

fn case(name: &'static str, scene: Scene, motion: Motion) -> Case {
    Case {
        name,
        scene,
        motion,
        seeds: 1,
    }
}

pub(crate) fn cases() -> Vec<Case> {
    let mut all = collimated();
    all.extend(finite_sources());
    all.extend(beams());
    all.extend(fans());
    all.extend(off_axis());
    all.extend(moving_cameras_and_sources());
    all
}

fn collimated() -> Vec<Case> {
    let oblique = plane(v(1.0, 0.4, 1.0));
    vec![
        case(
            "collimated at 47°",
            frontal(DVec3::Z, oblique),
            surface(mm(0.5, 0.3, 0.0)),
        ),
        case(
            "collimated, seen at 40°",
            seen(
                frontal(DVec3::Z, plane(DVec3::Z)),
                v(0.19, 0.0, 0.23),
                DVec3::ZERO,
            ),
            surface(mm(0.6, 0.3, 0.0)),
        ),
        case(
            "collimated, tilted by 60° about y",
            frontal(tilted(60.0, 0.0), oblique),
            surface(mm(0.4, -0.4, 0.3)),
        ),
        case(
            "collimated, tilted by 60° about x, seen at 30°",
            seen(
                frontal(tilted(0.0, 60.0), oblique),
                v(0.15, 0.05, 0.25),
                DVec3::ZERO,
            ),
            surface(mm(-0.5, 0.3, 0.4)),
        ),
    ]
}

fn finite_sources() -> Vec<Case> {
    vec![
        case(
            "source at 0.2 m, 30°",
            frontal(DVec3::Z, point_source(v(0.1, 0.0, 0.173))),
            surface(mm(0.3, 0.2, 0.0)),
        ),
        case(
            "source at 0.5 m, tilted by 30°, all directions",
            frontal(tilted(30.0, 0.0), point_source(v(-0.25, 0.2, 0.38))),
            surface(mm(0.3, -0.2, 0.3)),
        ),
        case(
            "source at 0.15 m, tilted by 45° and 30°",
            frontal(tilted(45.0, 30.0), point_source(v(0.05, 0.03, 0.138))),
            surface(mm(0.2, 0.2, 0.1)),
        ),
        case(
            "source at 0.25 m, tilted by 50°, along the axis",
            frontal(tilted(50.0, 0.0), point_source(v(0.15, 0.05, 0.2))),
            surface(mm(0.0, 0.0, 0.4)),
        ),
        case(
            "source at 0.3 m, tilted by 60° and seen at 35°",
            seen(
                frontal(tilted(60.0, 0.0), point_source(v(0.2, -0.1, 0.2))),
                v(-0.05, 0.17, 0.24),
                DVec3::ZERO,
            ),
            surface(mm(0.25, 0.3, -0.2)),
        ),
    ]
}

fn beams() -> Vec<Case> {
    let spot = |scene: Scene, size: f64| Scene {
        size: [size; 2],
        ..scene
    };
    let near = |to_source, waist_radius, z| {
        beam(Beam {
            to_source,
            waist_radius,
            z,
            aside: DVec3::ZERO,
        })
    };
    let beside = |to_source, aside| {
        beam(Beam {
            to_source,
            waist_radius: 60e-6,
            z: 0.3,
            aside,
        })
    };
    let far = v(0.0, 0.0, 0.6);
    vec![
        case(
            "beam 0.3 m after its waist",
            spot(frontal(DVec3::Z, near(DVec3::Z, 60e-6, 0.3)), 1.2e-3),
            surface(mm(0.4, 0.2, 0.0)),
        ),
        case(
            "beam 0.3 m after its waist, at 35°, tilted by 20°",
            spot(
                frontal(tilted(-20.0, 0.0), near(v(0.7, 0.1, 1.0), 60e-6, 0.3)),
                1.2e-3,
            ),
            surface(mm(0.3, 0.3, 0.2)),
        ),
        case(
            "beam beside its axis",
            spot(
                frontal(DVec3::Z, beside(v(0.3, 0.0, 1.0), mm(0.4, 0.3, 0.0))),
                1.2e-3,
            ),
            surface(mm(0.3, 0.3, 0.2)),
        ),
        case(
            "beam 0.15 m before its waist",
            spot(
                seen(
                    frontal(DVec3::Z, near(DVec3::Z, 31e-6, -0.15)),
                    far,
                    DVec3::ZERO,
                ),
                1.2e-3,
            ),
            surface(mm(0.4, 0.2, 0.0)),
        ),
        case(
            "beam 0.15 m before its waist, at 30°, tilted by 40°",
            spot(
                seen(
                    frontal(tilted(40.0, 10.0), near(v(-0.5, 0.2, 1.0), 31e-6, -0.15)),
                    far,
                    DVec3::ZERO,
                ),
                1.2e-3,
            ),
            surface(mm(0.3, 0.2, 0.2)),
        ),
        case(
            "beam at its waist",
            spot(
                frontal(DVec3::Z, near(v(0.4, 0.0, 1.0), 1.5e-3, 0.0)),
                2.4e-3,
            ),
            surface(mm(0.4, 0.3, 0.0)),
        ),
        Case {
            seeds: 10,
            ..case(
                "beam one Rayleigh range after its waist",
                spot(
                    seen(
                        frontal(DVec3::Z, near(DVec3::Z, 0.55e-3, 1.462)),
                        v(0.0, 0.0, 1.0),
                        DVec3::ZERO,
                    ),
                    2e-3,
                ),
                surface(mm(0.3, 0.2, 0.0)),
            )
        },
        Case {
            seeds: 10,
            ..case(
                "beam one Rayleigh range before its waist",
                spot(
                    seen(
                        frontal(DVec3::Z, near(DVec3::Z, 0.55e-3, -1.462)),
                        v(0.0, 0.0, 1.0),
                        DVec3::ZERO,
                    ),
                    2e-3,
                ),
                surface(mm(0.3, 0.2, 0.0)),
            )
        },
    ]
}

fn fans() -> Vec<Case> {
    let line = |to_source, z, off_middle| {
        fan(Fan {
            to_source,
            opening: DVec3::X,
            distance: 0.25,
            waist_radius: 0.8e-3,
            z,
            off_middle,
        })
    };
    let thin = |scene: Scene| Scene {
        size: [2e-3, 1.5e-3],
        ..scene
    };
    vec![
        case(
            "fan, along the line",
            thin(frontal(DVec3::Z, line(DVec3::Z, 0.0, 0.0))),
            surface(mm(0.4, 0.0, 0.0)),
        ),
        Case {
            seeds: 2,
            ..case(
                "fan at 30°, all directions, tilted by 30°",
                thin(frontal(
                    tilted(30.0, 0.0),
                    line(v(0.0, 0.5, 0.87), 0.0, 0.0),
                )),
                surface(mm(0.3, 0.3, 0.2)),
            )
        },
        Case {
            seeds: 2,
            ..case(
                "fan 0.5 m after its waist",
                thin(frontal(DVec3::Z, line(v(-0.3, 0.3, 1.0), 0.5, 0.0))),
                surface(mm(0.3, 0.3, 0.0)),
            )
        },
        case(
            "fan, 12° from its middle",
            thin(frontal(tilted(0.0, 20.0), line(v(0.2, 0.0, 1.0), 0.0, 0.2))),
            surface(mm(0.4, 0.1, 0.0)),
        ),
    ]
}

fn off_axis() -> Vec<Case> {
    let to_the_side = v(0.1, 0.03, 0.0);
    vec![
        Case {
            seeds: 2,
            ..case(
                "seen 19° off the axis, along z",
                seen(
                    frontal(DVec3::Z, plane(DVec3::Z)),
                    v(0.0, 0.0, 0.3),
                    to_the_side,
                ),
                surface(mm(0.1, 0.1, 1.5)),
            )
        },
        case(
            "seen 19° off the axis, source at 0.2 m, tilted by 30°",
            seen(
                frontal(tilted(30.0, 15.0), point_source(v(-0.1, 0.0, 0.173))),
                v(0.0, 0.0, 0.3),
                to_the_side,
            ),
            surface(mm(0.25, -0.2, 0.3)),
        ),
        case(
            "pupil tilted by 35°, beam after its waist",
            Scene {
                size: [1.2e-3; 2],
                ..seen(
                    frontal(
                        DVec3::Z,
                        beam(Beam {
                            to_source: v(0.3, 0.3, 1.0),
                            waist_radius: 60e-6,
                            z: 0.3,
                            aside: DVec3::ZERO,
                        }),
                    ),
                    v(0.05, -0.1, 0.28),
                    v(-0.15, 0.05, 0.0),
                )
            },
            surface(mm(0.3, 0.2, 0.3)),
        ),
        case(
            "pupil tilted by 35°, surface by 50°, fan",
            Scene {
                size: [2e-3, 1.5e-3],
                ..seen(
                    frontal(
                        tilted(-50.0, 0.0),
                        fan(Fan {
                            to_source: v(-0.4, 0.2, 1.0),
                            opening: DVec3::X,
                            distance: 0.25,
                            waist_radius: 0.8e-3,
                            z: 0.0,
                            off_middle: 0.0,
                        }),
                    ),
                    v(0.05, -0.1, 0.28),
                    v(-0.15, 0.05, 0.0),
                )
            },
            surface(mm(0.3, 0.15, 0.1)),
        ),
    ]
}

fn moving_cameras_and_sources() -> Vec<Case> {
    let near = point_source(v(-0.12, 0.05, 0.2));
    let off_axis = |light| {
        seen(
            frontal(tilted(25.0, 0.0), light),
            v(0.05, 0.0, 0.3),
            v(-0.06, 0.04, 0.0),
        )
    };
    vec![
        case(
            "camera moves, collimated",
            frontal(tilted(40.0, 0.0), plane(v(1.0, 0.4, 1.0))),
            camera(mm(0.4, 0.4, -0.3)),
        ),
        case(
            "camera moves off its axis, source at 0.24 m",
            off_axis(near),
            camera(mm(-0.5, 0.3, 0.6)),
        ),
        case(
            "camera moves with the surface, source at 0.24 m",
            frontal(tilted(20.0, 0.0), near),
            Motion {
                surface: mm(0.4, 0.3, 0.1),
                camera: mm(0.4, 0.3, 0.1),
                ..Motion::default()
            },
        ),
        case(
            "source at 0.24 m moves",
            frontal(tilted(20.0, 0.0), near),
            source(mm(0.3, 0.4, 0.2)),
        ),
        case(
            "source moves with the camera, off the axis",
            off_axis(near),
            Motion {
                source: mm(0.3, 0.2, 0.0),
                camera: mm(0.3, 0.2, 0.0),
                ..Motion::default()
            },
        ),
        case(
            "surface, camera and source move",
            off_axis(near),
            Motion {
                surface: mm(0.3, -0.2, 0.2),
                camera: mm(-0.2, -0.3, 0.1),
                source: mm(0.2, 0.3, -0.2),
            },
        ),
    ]
}
