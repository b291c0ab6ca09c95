use core::f64::consts::PI;

use glam::DVec3;
use tem00::tracer::{Environment, Frame, Light, LightEvents, Material, RenderOptions, Scene};

use crate::{
    means::{assert_mean, mean, render},
    renders::{options, scene},
};

const SEEDS: u64 = 20;

fn over_seeds(value: impl Fn(u64) -> f64) -> Vec<f64> {
    (0..SEEDS).map(value).collect()
}

/// A ball of 0.1 m before the camera, or around it, in a square image.
pub(super) fn ball(camera: &str, side: usize) -> Scene {
    scene(&format!(
        r#"
        [camera]
        {camera}
        focal_length = 0.025
        f_number = 8
        focus_distance = 0.4
        pixel_pitch = "200 um"
        resolution = [{side}, {side}]
        [[laser]]
        wavelength = "650 nm"
        power = 2
        position = [0, 0, -0.09]
        look_at = [0, 0, 0.5]
        spot = {{ waist_radius = "0.5 um", waist_distance = 0 }}
        [[surface]]
        sphere = {{ centre = [0, 0, 0], radius = 0.1 }}
        "#
    ))
}

const OUTSIDE: &str = "position = [0, 0, 0.5]\nlook_at = [0, 0, 0]";
pub(super) const INSIDE: &str = "position = [0.02, 0.04, 0]\nlook_at = [0, 0.08, 0.02]";

#[test]
fn lossless_bodies_vanish_in_uniform_light() {
    let materials = [
        ("white", Material::lambertian(1.0).unwrap(), 2e-3),
        ("mirror", Material::mirror(1.0).unwrap(), 1e-6),
        ("glass", Material::dielectric(1.5).unwrap(), 5e-3),
    ];
    for (name, material, precision) in materials {
        let mut furnace = ball(OUTSIDE, 16);
        furnace.lasers.clear();
        furnace.lights = vec![Light::Environment(Environment::constant(3.0).unwrap())];
        furnace.surfaces[0].material = material;
        for events in [LightEvents::Both, LightEvents::Scattering] {
            let images: Vec<Frame> = (0..SEEDS)
                .map(|seed| {
                    let light_events = events;
                    let options = RenderOptions {
                        light_events,
                        ..options(16, seed)
                    };
                    render(&furnace, &options)
                })
                .collect();
            // A material that throws its direction away in proportion to what it reflects is exact.
            let is_exact = name == "mirror" || name == "white" && events == LightEvents::Scattering;
            if is_exact {
                for value in images.iter().flat_map(|frame| frame.lights.values()) {
                    // Roundings to single precision.
                    assert!((value / 3.0 - 1.0).abs() < 2e-7, "{name}: {value}");
                }
            } else {
                let means: Vec<f64> = images.iter().map(|f| mean(f.lights.values())).collect();
                assert_mean(name, &means, 3.0, 3.0 * precision);
            }
        }
    }
}

#[test]
fn a_sphere_keeps_each_reflection_of_the_series() {
    const REFLECTANCE: f64 = 0.7;
    let mut sphere = ball(INSIDE, 16);
    sphere.surfaces[0].material = Material::lambertian(REFLECTANCE).unwrap();
    // What a diffuse sphere reflects spreads evenly over it: ρᵏP / (πA) for each k-th reflection.
    let once = 2.0 / (PI * 4.0 * PI * 0.01);
    let layers = |max_depth: Option<i32>, samples, seed| {
        let max_depth = max_depth.map(i32::unsigned_abs);
        let options = RenderOptions {
            max_depth,
            ..options(samples, seed)
        };
        render(&sphere, &options).lasers.remove(0)
    };
    for depth in [Some(2), Some(3), Some(5), None] {
        let radiances = over_seeds(|seed| mean(layers(depth, 16, seed).multiple.values()));
        let left_out = depth.map_or(0.0, |depth| REFLECTANCE.powi(depth - 1));
        let all = once * REFLECTANCE.powi(2) / (1.0 - REFLECTANCE);
        let expected = all * (1.0 - left_out);
        // The next reflection would add at least 8 %, those beyond the tenth 4 %.
        assert_mean("series", &radiances, expected, 0.01 * expected);
    }
    let direct = layers(Some(1), 4, 0);
    assert!(
        direct.multiple.values().iter().all(|&v| v == 0.0),
        "one surface"
    );
    assert!(mean(direct.single.values()) > 0.0, "lit");
}

#[test]
fn environments_light_a_closed_sphere_from_nowhere() {
    let mut sphere = ball(INSIDE, 16);
    sphere.lasers.clear();
    sphere.lights = vec![Light::Environment(Environment::constant(1.0).unwrap())];
    let frame = render(&sphere, &options(4, 0));
    assert!(frame.lights.values().iter().all(|&v| v == 0.0), "dark");
}

/// The irradiance of a rectangle of radiance 1 on a point, by Lambert's formula for polygons.
fn polygon_irradiance(corners: [DVec3; 4], point: DVec3, normal: DVec3) -> f64 {
    let towards = corners.map(|corner| (corner - point).normalize());
    let edges = (0..4).map(|i| {
        let (a, b) = (towards[i], towards[(i + 1) % 4]);
        a.dot(b).acos() * a.cross(b).normalize().dot(normal)
    });
    0.5 * edges.sum::<f64>().abs()
}

#[test]
fn a_sphere_under_an_area_light_obeys_lamberts_formula() {
    // A few micrometres of a sphere, 40° from its top, under a light 0.2 m square.
    let (sin, cos) = 40.0_f64.to_radians().sin_cos();
    let normal = DVec3::new(sin, 0.0, cos);
    let point = 0.1 * normal;
    let eye = point + 0.3 * DVec3::new(0.8, 0.5, 0.2);
    let text = format!(
        r#"
        [camera]
        position = [{}, {}, {}]
        look_at = [{}, 0, {}]
        focal_length = 0.025
        f_number = 8
        pixel_pitch = "0.1 um"
        resolution = [4, 4]
        [[laser]]
        wavelength = "650 nm"
        power = "1 mW"
        position = [0.5, 0, 1]
        look_at = [0, 0, 0]
        spot = {{ waist_radius = "1 mm" }}
        [[surface]]
        sphere = {{ centre = [0, 0, 0], radius = 0.1 }}
        lambertian = {{ reflectance = 0.6 }}
        [[light]]
        rectangle = {{ centre = [0.05, 0, 0.25], normal = [0, 0, -1], size = [0.2, 0.2], radiance = 10 }}
        "#,
        eye.x, eye.y, eye.z, point.x, point.z
    );
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corners = corners.map(|[x, y]| DVec3::new(0.05 + 0.1 * x, 0.1 * y, 0.25));
    let expected = 0.6 / PI * 10.0 * polygon_irradiance(corners, point, normal);
    for events in [LightEvents::Both, LightEvents::NextEvent] {
        let scene = scene(&text);
        let radiances = over_seeds(|seed| {
            let light_events = events;
            let options = RenderOptions {
                light_events,
                ..options(64, seed)
            };
            mean(render(&scene, &options).lights.values())
        });
        assert_mean("sphere", &radiances, expected, 2e-3 * expected);
    }
}

#[test]
fn a_mirror_shows_coherent_light_dimmed_by_its_reflectance() {
    // The camera looks at the plate over a mirror at 45°, 0.1 m before it.
    let seen = |camera: &str, mirror: &str| {
        scene(&format!(
            r#"
            [camera]
            {camera}
            focal_length = 0.025
            f_number = 8
            focus_distance = 0.3
            pixel_pitch = "40 um"
            resolution = [24, 24]
            [[laser]]
            wavelength = "650 nm"
            power = 1
            position = [0.05, 0.05, 0.1]
            look_at = [0, 0, 0]
            spot = {{ waist_radius = "1 mm" }}
            [[surface]]
            rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.02, 0.02] }}
            {mirror}
            "#
        ))
    };
    let straight = seen("position = [0, 0, 0.3]\nlook_at = [0, 0, 0]", "");
    let mut over = seen(
        "position = [0.1, 0, 0.2]\nlook_at = [0, 0, 0.2]\nup = [0, 1, 0]",
        "[[surface]]\nrectangle = { centre = [0, 0, 0.2], normal = [1, 0, -1], size = [0.1, 0.1] }",
    );
    over.surfaces[1].material = Material::mirror(0.7).unwrap();
    let of = |scene: &Scene, depth, seed| {
        let max_depth = Some(depth);
        let options = RenderOptions {
            max_depth,
            ..options(16, seed)
        };
        let layers = render(scene, &options).lasers.remove(0);
        assert!(mean(layers.multiple.values()) == 0.0, "one rough surface");
        mean(layers.single.values())
    };
    let ratios = over_seeds(|seed| of(&over, 2, seed) / of(&straight, 2, 100 + seed));
    assert_mean("over a mirror", &ratios, 0.7, 2e-3);
    assert!(of(&over, 1, 0) == 0.0, "the mirror counts as a surface");
}
