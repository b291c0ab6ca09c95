//! Scenes whose radiance is known in closed form: an integrating sphere, and plates under lamps.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

use std::{path::Path, sync::atomic::AtomicBool};

use tem00::{
    statistics::t_test_mean,
    tracer::{Frame, RenderOptions, parse_scene, render_frame},
};

/// A correct renderer fails a comparison with this probability at a given set of seeds.
const SIGNIFICANCE: f64 = 1e-3;

fn render(scene: &str, seed: u64, samples_per_pixel: u32) -> Frame {
    let scene = parse_scene(scene, Path::new(".")).expect("a valid scene");
    let options = RenderOptions {
        samples_per_pixel,
        seed,
        ..RenderOptions::default()
    };
    let cancel = AtomicBool::new(false);
    render_frame(&scene, None, 0, &options, |_| (), &cancel).expect("a render")
}

fn mean(values: &[f32]) -> f64 {
    values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64
}

#[test]
fn light_in_an_integrating_sphere_is_the_sum_of_all_its_reflections() {
    const RADIUS: f64 = 0.5;
    const REFLECTANCE: f64 = 0.7;
    const POWER: f64 = 2.0;
    // A strongly divergent beam from one side of the sphere lights much of the other.
    let scene = format!(
        r#"
        [camera]
        position = [0.1, 0.2, 0]
        look_at = [0, 0.4, 0.1]
        focal_length = 0.025
        f_number = 8
        focus_distance = 0.3
        pixel_pitch = "200 um"
        resolution = [16, 16]
        [[laser]]
        wavelength = "650 nm"
        power = {POWER}
        position = [0, 0, -0.45]
        look_at = [0, 0, 0.5]
        spot = {{ waist_radius = "0.5 um", waist_distance = 0 }}
        [[surface]]
        sphere = {{ centre = [0, 0, 0], radius = {RADIUS} }}
        lambertian = {{ reflectance = {REFLECTANCE} }}
        "#
    );
    // What a diffuse sphere reflects spreads evenly over it: after the first reflection ρP/A, and
    // ρ times less with every further one.
    let area = 4.0 * std::f64::consts::PI * RADIUS * RADIUS;
    let irradiance = REFLECTANCE * POWER / (area * (1.0 - REFLECTANCE));
    let expected = REFLECTANCE * irradiance / std::f64::consts::PI;
    let radiances: Vec<f64> = (0..20)
        .map(|seed| mean(render(&scene, seed, 16).lasers[0].incoherent.values()))
        .collect();
    let test = t_test_mean(&radiances, expected).expect("renders with noise");
    assert!(
        test.p_value > SIGNIFICANCE,
        "p = {:e}, {radiances:?} | {expected}",
        test.p_value
    );
    // The test can tell the 2 % of the light that has been reflected more than ten times.
    let spread = radiances
        .iter()
        .map(|r| (r / expected - 1.0).powi(2))
        .sum::<f64>()
        / 20.0;
    assert!(
        (spread / 20.0).sqrt() < 0.01,
        "standard error {}",
        (spread / 20.0).sqrt()
    );
}

/// A plate seen from above in its middle, under a lamp.
fn plate_under(lamp: &str) -> String {
    format!(
        r#"
        [camera]
        position = [0, 0, 1]
        look_at = [0, 0, 0]
        focal_length = 0.1
        f_number = 8
        pixel_pitch = "1 um"
        resolution = [4, 4]
        [[laser]]
        wavelength = "650 nm"
        power = "1 mW"
        position = [0.5, 0, 1]
        look_at = [0, 0, 0]
        spot = {{ waist_radius = "1 mm" }}
        [[surface]]
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [1, 1] }}
        lambertian = {{ reflectance = 0.6 }}
        [[lamp]]
        {lamp}
        "#
    )
}

#[test]
fn a_point_lamp_obeys_the_inverse_square_and_the_cosine() {
    let frame = render(
        &plate_under("point = { position = [0.3, 0, 0.4], power = 5 }"),
        0,
        4,
    );
    // Intensity P/4π at 0.5 m under cos θ = 0.8, reflected with ρ/π.
    let pi = std::f64::consts::PI;
    let expected = 0.6 / pi * 5.0 / (4.0 * pi) / 0.25 * 0.8;
    let measured = mean(frame.lamps.values());
    // The plate's points lie within 0.04 mm of the middle: relative change below 1e-4.
    assert!(
        (measured / expected - 1.0).abs() < 2e-4,
        "{measured} | {expected}"
    );
}

#[test]
fn an_area_lamp_lights_by_its_form_factor() {
    let scene = plate_under(
        "rectangle = { centre = [0, 0, 0.2], normal = [0, 0, -1], size = [0.3, 0.3], radiance = 10 }",
    );
    // The lamp would hide the plate from a camera above it: look from the side.
    let scene = scene.replace("position = [0, 0, 1]\n", "position = [0.5, 0, 0.2]\n");
    // The form factor from a point to a parallel square of half side a at height h, for all four
    // quarters: (2/π) · 2 · X/√(1+X²) atan(X/√(1+X²)) with X = a/h (Howell, Mengüç, Daun & Siegel).
    let x: f64 = 0.15 / 0.2;
    let root = (1.0 + x * x).sqrt();
    let form_factor = 4.0 / std::f64::consts::PI * (x / root) * (x / root).atan();
    let expected = 0.6 * 10.0 * form_factor;
    let radiances: Vec<f64> = (0..20)
        .map(|seed| mean(render(&scene, seed, 64).lamps.values()))
        .collect();
    let test = t_test_mean(&radiances, expected).expect("renders with noise");
    assert!(
        test.p_value > SIGNIFICANCE,
        "p = {:e}, {radiances:?} | {expected}",
        test.p_value
    );
}
