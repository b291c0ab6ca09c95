//! Scenes that no sensible person sets up, and what is defined for them.

use tem00::tracer::{Environment, Frame, Light, Material, Method, RenderOptions, Scene};

use crate::{
    means::{self, mean},
    renders::{self, options},
};

const POWER: f64 = 2e-3;

/// A camera 0.1 m before a plate, with a laser beside it whose spot is in the image.
fn plate(more: &str) -> Scene {
    renders::scene(&format!(
        r#"
        [camera]
        position = [0, 0, 0.1]
        look_at = [0, 0, 0]
        focal_length = "10 mm"
        f_number = 2
        focus_distance = 0.08
        pixel_pitch = "50 um"
        resolution = [24, 24]
        [[laser]]
        wavelength = "650 nm"
        power = {POWER}
        position = [0.03, 0, 0.1]
        look_at = [0, 0, 0]
        spot = {{ waist_radius = "2 mm" }}
        [[surface]]
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.1, 0.1] }}
        {more}
        "#
    ))
}

/// A sphere about a point on the axis of the camera, or above the laser.
fn ball(x: f64, z: f64, radius: f64) -> String {
    format!("[[surface]]\nsphere = {{ centre = [{x}, 0, {z}], radius = {radius} }}")
}

fn render(scene: &Scene, method: Method) -> Frame {
    let options = RenderOptions {
        method,
        ..options(16, 5)
    };
    means::render(scene, &options)
}

fn radiance(frame: &Frame) -> f64 {
    let lasers = frame.lasers.iter();
    lasers
        .flat_map(|laser| laser.radiance.values())
        .map(|&value| f64::from(value))
        .sum()
}

#[test]
fn both_methods_bring_the_power_of_the_laser_to_a_blurred_target() {
    // However little of it comes back.
    let mut scene = plate("");
    scene.surfaces[0].material = Material::lambertian(0.0).unwrap();
    for method in [Method::Path, Method::Light] {
        let power = render(&scene, method).lasers[0].power_on_target;
        // All of the footprint but some 1e−6 is in the image. If they were independent, the 1050
        // samples in πw² would give the power within 1 / √1050, which is 3 %; strata do better.
        // Light paths lose what misses the image.
        let tolerance = if method == Method::Path { 0.06 } else { 1e-4 };
        assert!(
            (power / POWER - 1.0).abs() < tolerance,
            "{method:?}: {power}"
        );
    }
}

#[test]
fn a_camera_in_glass_sees_light_compressed_by_the_square_of_the_index() {
    let mut scene = plate(&ball(0.0, 0.1, 0.05));
    scene.lasers.clear();
    scene.surfaces.remove(0);
    scene.surfaces[0].material = Material::dielectric(1.5).unwrap();
    scene.lights = vec![Light::Environment(Environment::constant(4.0).unwrap())];
    let frame = render(&scene, Method::Path);
    let mean = mean(frame.lights.values());
    // From near the centre no ray is reflected totally, and what is reflected comes out later. The
    // chance to end a path scatters one of 9216 samples in twenty-five by a twentieth, at most.
    assert!((mean / (2.25 * 4.0) - 1.0).abs() < 2e-3, "{mean}");
}

#[test]
fn a_laser_in_a_ball_lights_only_its_inside() {
    for method in [Method::Path, Method::Light] {
        let frame = render(&plate(&ball(0.03, 0.1, 0.01)), method);
        let laser = &frame.lasers[0];
        assert!(radiance(&frame) <= 0.0, "{method:?} finds light");
        assert!(laser.power_on_target <= 0.0, "{method:?} finds power");
    }
}

#[test]
fn a_laser_in_the_face_of_a_block_shines() {
    // The aperture lies in a rectangle across the beam, as that of a laser built into a wall.
    let wall = "[[surface]]\n\
        rectangle = { centre = [0.03, 0, 0.1], normal = [0.03, 0, 0.1], size = [0.004, 0.004] }";
    for method in [Method::Path, Method::Light] {
        let [alone, built_in] = ["", wall].map(|more| render(&plate(more), method));
        let [alone, built_in] = [alone, built_in].map(|frame| frame.lasers[0].power_on_target);
        assert!(
            (built_in / alone - 1.0).abs() < 1e-12,
            "{method:?}: {built_in} of {alone}"
        );
    }
}

#[test]
fn of_two_faces_in_one_place_the_first_counts() {
    let again =
        "[[surface]]\nrectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = [0.1, 0.1] }";
    let mut twice = plate(again);
    twice.surfaces[1].material = Material::lambertian(0.0).unwrap();
    for method in [Method::Path, Method::Light] {
        let [once, mut twice] = [&plate(""), &twice].map(|scene| render(scene, method));
        assert!(radiance(&once) > 0.0, "{method:?} is dark");
        // From one plate alone no ray goes on.
        twice.rays = once.rays;
        assert_eq!(once, twice, "{method:?}");
    }
}

#[test]
fn a_camera_in_a_perfect_mirror_comes_to_an_end() {
    let mut scene = plate(&ball(0.0, 0.1, 0.05));
    for surface in &mut scene.surfaces {
        surface.material = Material::mirror(1.0).unwrap();
    }
    for method in [Method::Path, Method::Light] {
        let frame = render(&scene, method);
        assert!(radiance(&frame) <= 0.0, "{method:?} finds light");
    }
}

#[test]
fn a_plate_alone_is_lit_as_beside_what_nobody_sees() {
    // Behind the camera, and behind the aperture of the laser.
    let behind = ball(0.0, 1.0, 0.001);
    let lamp = "[[light]]\npoint = { position = [0.01, 0, 0.05], power = 0.1 }";
    let [alone, beside] = ["", &behind].map(|more| {
        let mut scene = plate(&format!("{more}\n{lamp}"));
        scene.lasers.push(scene.lasers[0].clone());
        let max_depth = Some(1);
        means::render(
            &scene,
            &RenderOptions {
                max_depth,
                ..options(9, 0)
            },
        )
    });
    assert!(radiance(&alone) > 0.0, "it is lit");
    assert_eq!(alone, beside, "layers and rays");
}
