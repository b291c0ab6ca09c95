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

/// Motions of surface, camera and source in millimetres.
pub(crate) fn moved(surface: [f64; 3], camera: [f64; 3], source: [f64; 3]) -> Motion {
    let [surface, camera, source] = [surface, camera, source].map(|v| DVec3::from(v) * 1e-3);
    Motion {
        surface,
        camera,
        source,
    }
}

/// A motion of the surface in millimetres.
pub(crate) fn slid(x: f64, y: f64, z: f64) -> Motion {
    moved([x, y, z], [0.0; 3], [0.0; 3])
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

impl Scene {
    /// The scene seen by another camera.
    pub(crate) fn seen(self, eye: DVec3, target: DVec3) -> Self {
        Self {
            eye,
            target,
            ..self
        }
    }

    fn sized(self, along: f64, across: f64) -> Self {
        let size = [along, across];
        Self { size, ..self }
    }

    pub(crate) fn case(self, name: &'static str, motion: Motion) -> Case {
        let scene = self;
        Case {
            name,
            scene,
            motion,
            seeds: 1,
        }
    }
}

impl Case {
    fn on(self, seeds: u64) -> Self {
        Self { seeds, ..self }
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
    let along_y = frontal(tilted(60.0, 0.0), oblique);
    let along_x = frontal(tilted(0.0, 60.0), oblique).seen(v(0.15, 0.05, 0.25), DVec3::ZERO);
    let from_above = frontal(DVec3::Z, plane(DVec3::Z)).seen(v(0.19, 0.0, 0.23), DVec3::ZERO);
    vec![
        frontal(DVec3::Z, oblique).case("collimated at 47°", slid(0.5, 0.3, 0.0)),
        from_above.case("collimated, seen at 40°", slid(0.6, 0.3, 0.0)),
        along_y.case("collimated, tilted by 60° about y", slid(0.4, -0.4, 0.3)),
        along_x.case(
            "collimated, tilted by 60° about x, seen at 30°",
            slid(-0.5, 0.3, 0.4),
        ),
    ]
}

fn finite_sources() -> Vec<Case> {
    let lit =
        |about_y, about_x, x, y, z| frontal(tilted(about_y, about_x), point_source(v(x, y, z)));
    let aside = lit(60.0, 0.0, 0.2, -0.1, 0.2).seen(v(-0.05, 0.17, 0.24), DVec3::ZERO);
    vec![
        lit(0.0, 0.0, 0.1, 0.0, 0.173).case("source at 0.2 m, 30°", slid(0.3, 0.2, 0.0)),
        lit(30.0, 0.0, -0.25, 0.2, 0.38).case(
            "source at 0.5 m, tilted by 30°, all directions",
            slid(0.3, -0.2, 0.3),
        ),
        lit(45.0, 30.0, 0.05, 0.03, 0.138).case(
            "source at 0.15 m, tilted by 45° and 30°",
            slid(0.2, 0.2, 0.1),
        ),
        lit(50.0, 0.0, 0.15, 0.05, 0.2).case(
            "source at 0.25 m, tilted by 50°, along the axis",
            slid(0.0, 0.0, 0.4),
        ),
        aside.case(
            "source at 0.3 m, tilted by 60° and seen at 35°",
            slid(0.25, 0.3, -0.2),
        ),
    ]
}

/// A beam that meets the origin beside its axis.
fn beside(to_source: DVec3, [waist_radius, z]: [f64; 2], aside: DVec3) -> Light {
    beam(Beam {
        to_source,
        waist_radius,
        z,
        aside,
    })
}

fn beams() -> Vec<Case> {
    let near = |to_source, waist_radius, z| beside(to_source, [waist_radius, z], DVec3::ZERO);
    let spot = |normal, light| frontal(normal, light).sized(1.2e-3, 1.2e-3);
    let far = |scene: Scene, z| scene.seen(v(0.0, 0.0, z), DVec3::ZERO);
    let after = |light| spot(DVec3::Z, light);
    let rayleigh = |z| far(frontal(DVec3::Z, near(DVec3::Z, 0.55e-3, z)), 1.0);
    let before = near(DVec3::Z, 31e-6, -0.15);
    let before_aside = spot(tilted(40.0, 10.0), near(v(-0.5, 0.2, 1.0), 31e-6, -0.15));
    let at_waist = frontal(DVec3::Z, near(v(0.4, 0.0, 1.0), 1.5e-3, 0.0));
    let after_aside = spot(tilted(-20.0, 0.0), near(v(0.7, 0.1, 1.0), 60e-6, 0.3));
    let off_axis = beside(v(0.3, 0.0, 1.0), [60e-6, 0.3], mm(0.4, 0.3, 0.0));
    vec![
        after(near(DVec3::Z, 60e-6, 0.3)).case("beam 0.3 m after its waist", slid(0.4, 0.2, 0.0)),
        after_aside.case(
            "beam 0.3 m after its waist, at 35°, tilted by 20°",
            slid(0.3, 0.3, 0.2),
        ),
        after(off_axis).case("beam beside its axis", slid(0.3, 0.3, 0.2)),
        far(after(before), 0.6).case("beam 0.15 m before its waist", slid(0.4, 0.2, 0.0)),
        far(before_aside, 0.6).case(
            "beam 0.15 m before its waist, at 30°, tilted by 40°",
            slid(0.3, 0.2, 0.2),
        ),
        at_waist
            .sized(2.4e-3, 2.4e-3)
            .case("beam at its waist", slid(0.4, 0.3, 0.0)),
        rayleigh(1.462)
            .case(
                "beam one Rayleigh range after its waist",
                slid(0.3, 0.2, 0.0),
            )
            .on(10),
        rayleigh(-1.462)
            .case(
                "beam one Rayleigh range before its waist",
                slid(0.3, 0.2, 0.0),
            )
            .on(10),
    ]
}

/// A fan that opens along x from 0.25 m.
fn line(to_source: DVec3, z: f64, off_middle: f64) -> Light {
    fan(Fan {
        to_source,
        opening: DVec3::X,
        distance: 0.25,
        waist_radius: 0.8e-3,
        z,
        off_middle,
    })
}

fn fans() -> Vec<Case> {
    let thin = |normal, light| frontal(normal, light).sized(2e-3, 1.5e-3);
    vec![
        thin(DVec3::Z, line(DVec3::Z, 0.0, 0.0)).case("fan, along the line", slid(0.4, 0.0, 0.0)),
        thin(tilted(30.0, 0.0), line(v(0.0, 0.5, 0.87), 0.0, 0.0))
            .case(
                "fan at 30°, all directions, tilted by 30°",
                slid(0.3, 0.3, 0.2),
            )
            .on(2),
        thin(DVec3::Z, line(v(-0.3, 0.3, 1.0), 0.5, 0.0))
            .case("fan 0.5 m after its waist", slid(0.3, 0.3, 0.0))
            .on(2),
        thin(tilted(0.0, 20.0), line(v(0.2, 0.0, 1.0), 0.0, 0.2))
            .case("fan, 12° from its middle", slid(0.4, 0.1, 0.0)),
    ]
}

fn off_axis() -> Vec<Case> {
    let aside = |scene: Scene| scene.seen(v(0.0, 0.0, 0.3), v(0.1, 0.03, 0.0));
    let turned = |scene: Scene| scene.seen(v(0.05, -0.1, 0.28), v(-0.15, 0.05, 0.0));
    let source = point_source(v(-0.1, 0.0, 0.173));
    let after = beside(v(0.3, 0.3, 1.0), [60e-6, 0.3], DVec3::ZERO);
    let fan = frontal(tilted(-50.0, 0.0), line(v(-0.4, 0.2, 1.0), 0.0, 0.0));
    vec![
        aside(frontal(DVec3::Z, plane(DVec3::Z)))
            .case("seen 19° off the axis, along z", slid(0.1, 0.1, 1.5))
            .on(2),
        aside(frontal(tilted(30.0, 15.0), source)).case(
            "seen 19° off the axis, source at 0.2 m, tilted by 30°",
            slid(0.25, -0.2, 0.3),
        ),
        turned(frontal(DVec3::Z, after).sized(1.2e-3, 1.2e-3)).case(
            "pupil tilted by 35°, beam after its waist",
            slid(0.3, 0.2, 0.3),
        ),
        turned(fan.sized(2e-3, 1.5e-3)).case(
            "pupil tilted by 35°, surface by 50°, fan",
            slid(0.3, 0.15, 0.1),
        ),
    ]
}

fn moving_cameras_and_sources() -> Vec<Case> {
    const STILL: [f64; 3] = [0.0; 3];
    let near = point_source(v(-0.12, 0.05, 0.2));
    let oblique = frontal(tilted(40.0, 0.0), plane(v(1.0, 0.4, 1.0)));
    let level = frontal(tilted(20.0, 0.0), near);
    let off_axis = frontal(tilted(25.0, 0.0), near);
    let off_axis = off_axis.seen(v(0.05, 0.0, 0.3), v(-0.06, 0.04, 0.0));
    let (with_surface, with_camera) = ([0.4, 0.3, 0.1], [0.3, 0.2, 0.0]);
    vec![
        oblique.case(
            "camera moves, collimated",
            moved(STILL, [0.4, 0.4, -0.3], STILL),
        ),
        off_axis.case(
            "camera moves off its axis, source at 0.24 m",
            moved(STILL, [-0.5, 0.3, 0.6], STILL),
        ),
        level.case(
            "camera moves with the surface, source at 0.24 m",
            moved(with_surface, with_surface, STILL),
        ),
        level.case(
            "source at 0.24 m moves",
            moved(STILL, STILL, [0.3, 0.4, 0.2]),
        ),
        off_axis.case(
            "source moves with the camera, off the axis",
            moved(STILL, with_camera, with_camera),
        ),
        off_axis.case(
            "surface, camera and source move",
            moved([0.3, -0.2, 0.2], [-0.2, -0.3, 0.1], [0.2, 0.3, -0.2]),
        ),
    ]
}
