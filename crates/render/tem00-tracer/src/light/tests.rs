use proptest::prelude::*;
use tem00_testkit::assert_relative;

use super::*;

fn panel() -> Rectangle {
    // Inclined, so that no axis is special; the normal is about −z.
    Rectangle::new(
        DVec3::new(0.1, 0.2, 1.0),
        0.4 * DVec3::new(0.8, 0.0, 0.6),
        -0.25 * DVec3::Y,
    )
    .unwrap()
}

fn small_panel() -> Rectangle {
    let (centre, scale) = (panel().centre(), 0.005);
    Rectangle::new(centre, scale * panel().half_u(), scale * panel().half_v()).unwrap()
}

fn corners(rectangle: &Rectangle, from: DVec3) -> [DVec3; 4] {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|[u, v]| (rectangle.point(u, v) - from).normalize())
}

/// The solid angle of two triangles, by the formula of van Oosterom and Strackee (1983).
fn solid_angle(rectangle: &Rectangle, from: DVec3) -> f64 {
    let [a, b, c, d] = corners(rectangle, from);
    let triangle = |a: DVec3, b: DVec3, c: DVec3| {
        let volume = a.dot(b.cross(c)).abs();
        2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    triangle(a, b, c) + triangle(a, c, d)
}

/// A point in front of the panel.
fn points() -> impl Strategy<Value = DVec3> {
    [-1.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..0.6]
        .prop_map(DVec3::from_array)
        .prop_filter("in front of the panel", |p| {
            (*p - panel().centre()).dot(panel().normal()) > 0.01
        })
}

proptest! {
    #[test]
    fn near_rectangles_are_drawn_over_their_solid_angle(
        from in points(), u in [0.0_f64..1.0, 0.0_f64..1.0],
    ) {
        // The diagonal is 0.94 m long.
        let from = panel().centre() + (from - panel().centre()).clamp_length_max(0.94);
        let light = Light::area(panel(), 2.0).unwrap();
        let sample = light.sample(from, u).unwrap();
        let covered = solid_angle(&panel(), from);
        // Both formulas err by some 1e−15 sr.
        prop_assert!((sample.radiance_over_pdf / 2.0 - covered).abs() < 1e-14, "{covered}");
        prop_assert!((sample.pdf.unwrap() * covered - 1.0).abs() < 1e-14 / covered);
    }

    #[test]
    fn the_density_is_that_of_the_drawn_directions(
        from in points(),
        u in [0.01_f64..0.99, 0.01_f64..0.99],
        small in any::<bool>(),
    ) {
        let panel = if small { small_panel() } else { panel() };
        let light = Light::area(panel, 1.0).unwrap();
        let h = 1e-5;
        let at = |du: f64, dv: f64| light.sample(from, [u[0] + du, u[1] + dv]).unwrap();
        let by_u = (at(h, 0.0).direction - at(-h, 0.0).direction) / (2.0 * h);
        let by_v = (at(0.0, h).direction - at(0.0, -h).direction) / (2.0 * h);
        // Solid angle per unit of the square. Differences err by ε/h of the length 1 of the
        // directions, against an extent of 0.1 and, of the small panel, 1e−3 or less.
        let density = 1.0 / by_u.cross(by_v).length();
        let relative = at(0.0, 0.0).pdf.unwrap() / density - 1.0;
        prop_assert!(relative.abs() < if small { 1e-5 } else { 1e-6 }, "{relative:e}");
    }

    #[test]
    fn drawn_directions_meet_the_front_of_the_light(
        from in points(),
        u in [0.0_f64..1.0, 0.0_f64..1.0],
        small in any::<bool>(),
    ) {
        let panel = if small { small_panel() } else { panel() };
        let light = Light::area(panel, 3.0).unwrap();
        let sample = light.sample(from, u).unwrap();
        let place = from + sample.distance * sample.direction - panel.centre();
        prop_assert!(place.dot(panel.normal()).abs() < 1e-13, "off the plane: {place}");
        let across = place.dot(panel.half_u()) / panel.half_u().length_squared();
        let along = place.dot(panel.half_v()) / panel.half_v().length_squared();
        prop_assert!(across.abs() < 1.0 + 1e-12 && along.abs() < 1.0 + 1e-12, "{across}, {along}");
        prop_assert!(light.radiance_along(sample.direction) > 2.9, "the lit side");
        let pdf = sample.pdf.unwrap();
        prop_assert!((sample.radiance_over_pdf * pdf / 3.0 - 1.0).abs() < 1e-15);
        // Just next to an edge by rounding there is no density.
        if across.abs().max(along.abs()) < 1.0 - 1e-9 {
            prop_assert!((light.pdf(from, sample.direction) / pdf - 1.0).abs() < 1e-11);
        }
    }
}

#[test]
fn a_panel_lights_a_surface_by_lamberts_formula() {
    let normal = DVec3::new(0.0, 0.6, 0.8);
    let light = Light::area(panel(), 1.0).unwrap();
    // Nearer and farther than its diagonal.
    for from in [DVec3::new(0.3, -0.1, 0.2), DVec3::new(0.3, -0.1, -0.3)] {
        // E = L/2 Σ γ Γ·n over the edges (Lambert 1760); γ the angle of an edge, Γ normal to its
        // plane.
        let corners = corners(&panel(), from);
        let expected: f64 = (0..4)
            .map(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % 4]);
                0.5 * a.angle_between(b) * a.cross(b).normalize().dot(normal)
            })
            .sum();
        let mut irradiance = 0.0;
        for index in 0..64 * 64_u32 {
            let u = [index % 64, index / 64].map(|i| (f64::from(i) + 0.5) / 64.0);
            let sample = light.sample(from, u).unwrap();
            irradiance += sample.radiance_over_pdf * sample.direction.dot(normal) / 4096.0;
        }
        // The midpoint rule errs by 1/(24 · 64²) = 1e−5 of a curvature of order 1.
        assert_relative(irradiance, expected.abs(), 2e-5);
    }
}

#[test]
fn no_light_comes_from_behind_or_from_dark_lights() {
    let light = Light::area(panel(), 1.0).unwrap();
    let beside = panel().centre() + 3.0 * panel().half_u();
    for from in [
        panel().centre() - panel().normal(),
        panel().point(0.3, 0.6),
        beside,
    ] {
        let sample = light.sample(from, [0.4, 0.9]);
        let seen = sample.map_or(0.0, |sample| sample.radiance_over_pdf);
        // From the plane, to rounding, the panel covers nothing.
        assert!(seen < 1e-13, "{sample:?}");
    }
    let below = panel().centre() - panel().normal();
    assert!(light.pdf(below, panel().normal()) <= 0.0, "from behind");
    assert!(light.radiance_along(panel().normal()) <= 0.0, "dark side");
    let before = panel().centre() + panel().normal();
    assert!(light.pdf(before, panel().normal()) <= 0.0, "turned away");
    assert!(light.pdf(before, -panel().normal()) > 0.0, "towards it");
    let past = (-panel().normal() + 1.01 * panel().half_u()).normalize();
    assert!(light.pdf(before, past) <= 0.0, "past the edge");
    let dark = Light::area(panel(), 0.0).unwrap();
    assert_eq!(dark.sample(before, [0.5, 0.5]), None, "dark light");
    assert!(dark.pdf(before, -panel().normal()) <= 0.0, "dark light");
    let point = Light::point(DVec3::X, 1.0).unwrap();
    assert_eq!(point.sample(DVec3::X, [0.5, 0.5]), None, "at the light");
    assert!(point.pdf(DVec3::ZERO, DVec3::X) <= 0.0, "no density");
}
