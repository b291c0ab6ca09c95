//! Rough surfaces only: both methods find all the light.

use tem00::tracer::{Material, Method};

use super::comparison::{Series, assert_agree, assert_mean, paint, sharp_scene};

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

/// Few samples for the path tracer: its light is direct, and only varies over the pixel.
fn assert_both_find(scene: &str) {
    let scene = sharp_scene(scene);
    let path = Series {
        method: Method::Path,
        samples_per_pixel: 16,
        seeds: 16,
    };
    let light = Series {
        method: Method::Light,
        samples_per_pixel: 100,
        seeds: 16,
    };
    let (path, light) = (path.render(&scene, None), light.render(&scene, None));
    assert_agree(&path, &light, |layers| &layers.coherent_before, 0.1);
}

#[test]
fn a_spot_on_a_tilted_plate_looks_the_same_from_both_ends() {
    assert_both_find(&tilted_plate(
        r#"spot = { waist_radius = ["0.6 mm", "0.9 mm"], m_squared = 3 }"#,
    ));
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
        assert_both_find(&tilted_plate(&format!(
            r#"line = {{ fan_angle = "1 deg", thickness = "1 mm", profile = {profile} }}"#
        )));
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
    let [path, light] = [(Method::Path, 128), (Method::Light, 128)].map(|(method, samples)| {
        let series = Series {
            method,
            samples_per_pixel: samples,
            seeds: 16,
        };
        series.render(&scene, None)
    });
    assert_agree(&path, &light, |layers| &layers.coherent_before, 0.1);
    assert_agree(&path, &light, |layers| &layers.incoherent, 0.1);
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
    let series = Series {
        method: Method::Light,
        samples_per_pixel: 250,
        seeds: 16,
    };
    let frames = series.render(&scene, None);
    // What a diffuse sphere reflects spreads evenly over it: after the first reflection ρP/A, and ρ
    // times less with every further one. All of P is absorbed: (1 − ρ)(P + A ρP/A (1 + ρ + …)) = P.
    let area = 4.0 * std::f64::consts::PI * RADIUS * RADIUS;
    for (index, power) in POWERS.into_iter().enumerate() {
        let irradiance = REFLECTANCE * power / (area * (1.0 - REFLECTANCE));
        let expected = REFLECTANCE * irradiance / std::f64::consts::PI;
        let means: Vec<f64> = frames
            .iter()
            .map(|frame| {
                let values = frame.lasers[index].incoherent.values();
                let sum: f64 = values.iter().map(|&value| f64::from(value)).sum();
                sum / values.len() as f64 / expected
            })
            .collect();
        assert_mean(&means, 1.0, 0.004);
    }
}
