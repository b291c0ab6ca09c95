//! A rendered laser spot has the power and the profile of its beam, with and without speckle.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use tem00::{
    beam::GaussianBeam,
    engine::render_frame,
    tracer::{Frame, RenderError, Scene},
};

use crate::{
    means::assert_mean,
    renders::{self, options, speckle},
};

const SEEDS: u64 = 20;
const WAIST: f64 = 0.2e-3;
const POWER: f64 = 2e-3;

/// A spot that comes in at an angle, in degrees, to a plate that is seen at another.
fn scene(incidence: f64, view: f64) -> Scene {
    let (sin, cos) = incidence.to_radians().sin_cos();
    let (view_sin, view_cos) = view.to_radians().sin_cos();
    renders::scene(&format!(
        r#"
        [camera]
        position = [0, {camera_y}, {camera_z}]
        look_at = [0, 0, 0]
        focal_length = 25e-3
        f_number = 8
        pixel_pitch = "3.45 um"
        resolution = [128, 48]

        [[laser]]
        wavelength = "650 nm"
        power = {POWER}
        position = [{x}, 0, {z}]
        look_at = [0, 0, 0]
        spot = {{ waist_radius = {WAIST} }}

        [[surface]]
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.02, 0.02] }}
        lambertian = {{ reflectance = 0.5 }}
        "#,
        x = 0.25 * sin,
        z = 0.25 * cos,
        camera_y = 0.3 * view_sin,
        camera_z = 0.3 * view_cos,
    ))
}

fn render(scene: &Scene, has_speckle: bool, seed: u64) -> Frame {
    let model = has_speckle.then(|| speckle(scene, seed));
    renders::frame(scene, model.as_ref(), 0, &options(3, seed))
}

#[test]
fn the_target_receives_the_power_of_the_beam() {
    for (incidence, view) in [(0.0, 0.0), (30.0, 0.0), (60.0, 0.0), (30.0, 40.0)] {
        let scene = scene(incidence, view);
        let power: Vec<f64> = (0..SEEDS)
            .map(|seed| render(&scene, false, seed).lasers[0].power_on_target)
            .collect();
        let name = format!("at {incidence}°, seen at {view}°");
        assert_mean(&name, &power, POWER, 0.02 * POWER);
    }
}

#[test]
fn the_spot_has_the_radius_and_the_radiance_of_the_beam() {
    let incidence = 30.0_f64;
    let scene = scene(incidence, 0.0);
    let camera = &scene.camera;
    // One pixel on the plate, in metres.
    let pixel = 3.45e-6 * 0.3 / camera.image_distance();
    let beam = GaussianBeam::from_waist(650e-9, WAIST).expect("a valid beam");
    let expected_across = beam.radius_at(0.0);
    let expected_along = expected_across / incidence.to_radians().cos();
    let (mut along, mut across, mut flux) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..SEEDS {
        let layer = render(&scene, false, seed).lasers.remove(0).single;
        let (mut sum, mut xx, mut yy) = (0.0, 0.0, 0.0);
        for (y, row) in layer.rows().enumerate() {
            for (x, &radiance) in row.iter().enumerate() {
                let radiance = f64::from(radiance);
                sum += radiance;
                xx += radiance * (x as f64 + 0.5 - 64.0).powi(2);
                yy += radiance * (y as f64 + 0.5 - 24.0).powi(2);
            }
        }
        // The variance of the pixel's own box, 1/12, is taken off.
        let radius = |moment: f64| 2.0 * (moment / sum - 1.0 / 12.0).sqrt() * pixel;
        along.push(radius(xx));
        across.push(radius(yy));
        // A Lambertian surface turns irradiance E into radiance ρ E / π.
        flux.push(sum * pixel * pixel * std::f64::consts::PI / 0.5);
    }
    for (name, measured, expected) in [
        ("radius across", across, expected_across),
        ("radius along", along, expected_along),
        ("reflected power", flux, POWER),
    ] {
        assert_mean(name, &measured, expected, 0.02 * expected);
    }
}

#[test]
fn speckle_moves_light_about_but_keeps_its_power() {
    let scene = scene(0.0, 0.0);
    let ratio: Vec<f64> = (0..SEEDS)
        .map(|seed| {
            let layers = render(&scene, true, seed).lasers.remove(0);
            let sum = |values: &[f32]| values.iter().map(|&v| f64::from(v)).sum::<f64>();
            sum(layers.radiance.values()) / sum(layers.single.values())
        })
        .collect();
    assert_mean("with speckle", &ratio, 1.0, 0.05);
    let spread = ratio.iter().map(|r| (r - 1.0).powi(2)).sum::<f64>() / SEEDS as f64;
    assert!(spread > 1e-4, "speckle leaves no trace: {ratio:?}");
}

#[test]
fn a_render_stops_within_a_pixel_when_it_is_told_to() {
    let scene = scene(0.0, 0.0);
    let options = options(1 << 22, 0);
    let (cancel, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let progress = |samples| {
        done.fetch_add(samples, Ordering::Relaxed);
        cancel.store(true, Ordering::Relaxed);
    };
    let result = render_frame(&scene, None, 0, &options, &progress, &cancel);
    assert_eq!(result, Err(RenderError::Cancelled));
    let done = done.load(Ordering::Relaxed);
    assert!(done < 1 << 22, "{done} samples until the stop");
}
