//! Rough surfaces only: both methods find all the light.

use tem00::camera::{Camera, CameraDescription, SensorTilt};
use tem00::tracer::{LaserEvents, Material, Method, Scene};

use crate::{
    means::{assert_mean, mean},
    renders,
};

use super::comparison::{Series, assert_agree, paint, sharp_scene};

const CAMERA: &str = r#"
    [camera]
    position = [0, 0.1, 0.3]
    look_at = [0, 0, 0]
    focal_length = "25 mm"
    f_number = 8
    pixel_pitch = "20 um"
    resolution = [24, 16]
"#;

/// A laser on a tilted plate of rough aluminium.
fn tilted_plate(shape: &str) -> String {
    format!(
        r#"{CAMERA}
        [[laser]]
        wavelength = "650 nm"
        power = "2 mW"
        position = [0.1, 0, 0.2]
        look_at = [0, 0, 0]
        line_direction = [1, 0.5, 0]
        {shape}
        [[surface]]
        rectangle = {{ centre = [0, 0, 0], normal = [-0.4, 0.3, 1], size = [0.1, 0.1] }}
        conductor = {{ metal = "aluminium", roughness = 0.3 }}
        "#
    )
}

/// Few samples suffice for a path tracer whose light is direct and varies only over the pixel.
fn assert_both_find(scene: &Scene) {
    assert_images_agree(scene, [16, 100]);
}

fn assert_images_agree(scene: &Scene, [of_paths, of_light]: [u32; 2]) {
    let path = Series::of(Method::Path, of_paths).render(scene, None);
    let light = Series::of(Method::Light, of_light).render(scene, None);
    assert_agree(&path, &light, |layers| &layers.single, 0.1);
}

#[test]
fn a_spot_on_a_tilted_plate_looks_the_same_from_both_ends() {
    let text = tilted_plate(r#"spot = { waist_radius = ["0.6 mm", "0.9 mm"], m_squared = 3 }"#);
    assert_both_find(&sharp_scene(&text));
}

#[test]
fn a_spot_out_of_focus_looks_the_same_from_both_ends() {
    let text = tilted_plate(r#"spot = { waist_radius = ["0.6 mm", "0.9 mm"], m_squared = 3 }"#);
    let mut scene = renders::scene(&text);
    // In focus 0.1 m in front of the plate: the spot is blurred over 4 mm, and the sensor is
    // tilted.
    let near = CameraDescription {
        f_number: 3.0,
        focus_distance: 0.2,
        tilt: SensorTilt {
            angle: 0.1,
            azimuth: 0.7,
        },
        ..*scene.camera.description()
    };
    scene.camera = Camera::new(near).expect("a valid camera");
    assert_images_agree(&scene, [120, 200]);
}

#[test]
fn beams_and_drawn_directions_light_a_surface_alike() {
    // A beam that spreads by 0.1 rad from a wide source, so that surfaces see it as a wide area
    // light.
    let text = tilted_plate(
        r#"spot = { waist_radius = "8 mm", waist_distance = "0.1 m", m_squared = 4000 }"#,
    );
    let scene = sharp_scene(&text);
    let sampled = Series {
        laser_events: LaserEvents::Sampled,
        ..Series::of(Method::Path, 64)
    };
    let light = Series::of(Method::Light, 1000);
    let (path, light) = (sampled.render(&scene, None), light.render(&scene, None));
    assert_agree(&path, &light, |layers| &layers.single, 0.1);
}

#[test]
fn a_line_of_any_profile_looks_the_same_from_both_ends() {
    let profiles = [
        r#""gaussian""#,
        r#""uniform_angle""#,
        r#""powell", edge = 0.3"#,
        r#"{ angles = ["-0.5 deg", 0, "0.7 deg"], powers = [0.5, 1, 0.2] }"#,
    ];
    for profile in profiles {
        let text = tilted_plate(&format!(
            r#"line = {{ fan_angle = "1 deg", thickness = "1 mm", profile = {profile} }}"#
        ));
        assert_both_find(&sharp_scene(&text));
    }
}

#[test]
fn interreflection_in_a_corner_looks_the_same_from_both_ends() {
    let mut scene = sharp_scene(&format!(
        r#"{CAMERA}
        [[laser]]
        wavelength = "650 nm"
        power = "2 mW"
        position = [0.1, 0, 0.2]
        look_at = [-0.3e-3, 0, 0]
        spot = {{ waist_radius = "1.5 mm" }}
        [[surface]]
        name = "floor"
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.1, 0.1] }}
        lambertian = {{ reflectance = 0.7 }}
        [[surface]]
        name = "wall"
        rectangle = {{ centre = [-1.5e-3, 0, 0.01], normal = [1, 0, 0], size = [0.1, 0.02] }}
        [[surface]]
        name = "side"
        rectangle = {{ centre = [0, -2e-3, 0.01], normal = [0, 1, 0.1], size = [0.1, 0.02] }}
        conductor = {{ metal = "copper", roughness = 0.4 }}
        "#
    ));
    let plastic = Material::plastic(0.6, 1.5, 0.2).expect("a valid material");
    paint(&mut scene, "wall", plastic);
    for max_depth in [Some(2), None] {
        scene.render.max_depth = max_depth;
        let path = Series::of(Method::Path, 128).render(&scene, None);
        let light = Series::of(Method::Light, 128).render(&scene, None);
        assert_agree(&path, &light, |layers| &layers.single, 0.1);
        assert_agree(&path, &light, |layers| &layers.multiple, 0.1);
    }
}

#[test]
fn lasers_in_an_integrating_sphere_lose_no_power() {
    const RADIUS: f64 = 0.5;
    const REFLECTANCE: f64 = 0.7;
    const POWERS: [f64; 3] = [2.0, 0.5, 1.0];
    let lasers: String = POWERS
        .iter()
        .zip([650, 532, 450])
        .map(|(power, wavelength)| {
            format!(
                r#"
                [[laser]]
                wavelength = "{wavelength} nm"
                power = {power}
                position = [0, 0, -0.45]
                look_at = [{x}, 0, 0.5]
                spot = {{ waist_radius = "0.5 um", waist_distance = 0 }}
                "#,
                x = f64::from(wavelength) * 1e-4
            )
        })
        .collect();
    let scene = sharp_scene(&format!(
        r#"
        [camera]
        position = [0.1, 0.2, 0]
        look_at = [0, 0.4, 0.1]
        focal_length = 0.025
        f_number = 8
        focus_distance = 0.3
        pixel_pitch = "3 mm"
        resolution = [16, 16]
        {lasers}
        [[surface]]
        sphere = {{ centre = [0, 0, 0], radius = {RADIUS} }}
        lambertian = {{ reflectance = {REFLECTANCE} }}
        "#
    ));
    let frames = Series::of(Method::Light, 250).render(&scene, None);
    // What a diffuse sphere reflects spreads evenly over it: after the first reflection ρP/A, and ρ
    // times less with every further one. All of P is absorbed: (1 − ρ)(P + A ρP/A (1 + ρ + …)) = P.
    let area = 4.0 * std::f64::consts::PI * RADIUS * RADIUS;
    for (index, power) in POWERS.into_iter().enumerate() {
        let irradiance = REFLECTANCE * power / (area * (1.0 - REFLECTANCE));
        let expected = REFLECTANCE * irradiance / std::f64::consts::PI;
        let means: Vec<f64> = frames
            .iter()
            .map(|frame| mean(frame.lasers[index].multiple.values()) / expected)
            .collect();
        assert_mean("sphere", &means, 1.0, 0.004);
    }
}
