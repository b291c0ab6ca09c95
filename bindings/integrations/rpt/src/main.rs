//! A laser spot with its speckle in rpt, a path tracer that knows nothing of lasers.
//!
//! ```sh
//! cargo run --release --manifest-path bindings/integrations/rpt/Cargo.toml
//! ```
//!
//! Prints `measured | theory` from rpt's own pictures and fails if they disagree. Writes a picture
//! with a ball, and a point light, which has no speckle, to `out/rpt_spot.png`.

use std::{error::Error, f64::consts::PI, fs};

use rand::rngs::StdRng;
use rpt::{glm, glm::vec3, image::RgbImage, *};
use tem00_shading::{CameraDescription, DVec3, Laser, Motion, Speckle, SpeckleFrame};
use tem00_statistics::{Contrast, pixel_contrast};

const WIDTH: u32 = 600;
const HEIGHT: u32 = 450;
/// Radius (1/e²) of the beam, in metres, and its power, in watts.
const RADIUS: f64 = 3e-3;
const POWER: f64 = 5e-3;
const ALBEDO: f64 = 0.8;
/// Irradiance, in W/m², at which rpt's pictures clip: ten times that of the spot at its middle.
const WHITE: f64 = 10.0 * 2.0 * POWER / (PI * RADIUS * RADIUS);

/// The laser as rpt meets it: an invisible shape that names a point to be lit from.
struct Lamp {
    laser: Laser,
    speckle: Option<SpeckleFrame>,
}

impl Shape for Lamp {
    /// No ray meets a delta light.
    fn intersect(&self, _: &Ray, _: f64, _: &mut HitRecord) -> bool {
        false
    }

    /// rpt multiplies by cos/distance² and divides by this density: e_perp is left, times the
    /// speckle.
    fn sample(&self, target: &glm::DVec3, _: &mut StdRng) -> (glm::DVec3, glm::DVec3, f64) {
        let point = DVec3::from_array((*target).into());
        let Some(event) = self.laser.next_event(point) else {
            return (target + glm::DVec3::z(), -glm::DVec3::z(), f64::INFINITY);
        };
        // Where nothing has moved the normal does not count.
        let speckle = self.speckle.as_ref();
        let factor = speckle.map_or(1.0, |frame| frame.factor(point, DVec3::Z));
        let pdf = 1.0 / (event.e_perp * factor * event.point.distance_squared(point));
        let vector = |v: DVec3| glm::DVec3::from(v.to_array());
        (vector(event.point), -vector(event.wi), pdf)
    }
}

/// A sheet of paper in the plane z = 0, lit by the laser.
fn paper_under(laser: &Laser, speckle: Option<SpeckleFrame>) -> Scene {
    let mut scene = Scene::new();
    let mut paper = Material::diffuse(vec3(ALBEDO, ALBEDO, ALBEDO));
    paper.index = 1.0; // no gloss
    scene.add(Object::new(plane(vec3(0.0, 0.0, 1.0), 0.0)).material(paper));
    let red = Material::light(vec3(1.0, 0.03, 0.02), PI / (ALBEDO * WHITE));
    let laser = laser.clone();
    scene.add(Light::Object(
        Object::new(Lamp { laser, speckle }).material(red),
    ));
    scene
}

fn photograph(scene: &Scene, fov: f64, exposure: f64) -> RgbImage {
    let CameraDescription {
        position,
        look_at,
        up,
        ..
    } = CameraDescription::default();
    let [eye, ahead, up] = [position, look_at, up].map(|v| v.to_array().into());
    let camera = Camera::look_at(eye, ahead, up, fov);
    let renderer = Renderer::new(scene, camera).width(WIDTH).height(HEIGHT);
    renderer.exposure_value(exposure).num_samples(32).render()
}

/// Irradiance of the paper, in W/m², from the bytes that rpt rounds down to.
fn irradiance(picture: &RgbImage) -> Vec<f64> {
    let linear = |byte: u8| ((f64::from(byte) + 0.5) / 255.0).powf(2.2);
    picture.pixels().map(|p| WHITE * linear(p[0])).collect()
}

fn agree(what: &str, [measured, theory]: [f64; 2], tolerance: f64) -> Result<(), String> {
    println!("{what:<20} {measured:.4} | {theory:.4}");
    let fine = (measured - theory).abs() <= tolerance;
    fine.then_some(()).ok_or(format!("{what} disagrees"))
}

fn main() -> Result<(), Box<dyn Error>> {
    // 25 mm at f/8, which looks down from 0.3 m.
    let camera = tem00_shading::Camera::new(CameraDescription {
        resolution: [WIDTH as usize, HEIGHT as usize],
        ..CameraDescription::default()
    })?;
    let laser = Laser::spot(650e-9, RADIUS).power(POWER);
    let laser = laser.placed(DVec3::new(-0.2, 0.0, 0.2), DVec3::ZERO, DVec3::Y)?;
    let speckle = Speckle::new(&camera, &laser, 1).prepare()?;
    println!("{speckle}");

    let geometry = speckle.geometry();
    let half_width = 0.5 * f64::from(WIDTH) * geometry.pixel_pitch();
    let fov = 2.0 * (half_width / geometry.principal_distance()).atan();
    let smooth = irradiance(&photograph(&paper_under(&laser, None), fov, 0.0));
    let mut scene = paper_under(&laser, Some(speckle.frame(&Motion::default())?));
    let speckled = irradiance(&photograph(&scene, fov, 0.0));
    scene.add(Light::Point(vec3(2e-3, 2e-3, 2e-3), vec3(-0.1, 0.2, 0.2)));
    let ball = sphere().scale(&vec3(1e-3, 1e-3, 1e-3));
    scene.add(Object::new(ball.translate(&vec3(-2e-3, 1e-3, 1e-3))));
    fs::create_dir_all("out")?;
    photograph(&scene, fov, 2.0).save("out/rpt_spot.png")?;

    let pixel_area = (geometry.pixel_pitch() / geometry.magnification()).powi(2);
    let power = smooth.iter().sum::<f64>() * pixel_area;
    // Bytes in place of numbers raise the power by some 0.03 %.
    agree("power / 1 mW", [1e3 * power, 1e3 * POWER], POWER)?;

    let pairs = smooth.iter().zip(speckled);
    let lit = pairs.filter(|(mean, _)| **mean > 0.02 * WHITE);
    let speckle: Vec<f64> = lit.map(|(mean, value)| value / mean).collect();
    let size = geometry.speckle_size_in_pixels();
    let contrast = Contrast::from_samples(&speckle)?.with_speckle_size(size)?;
    let pair = [contrast.value(), pixel_contrast(1.0 / size)];
    Ok(agree(
        "speckle contrast",
        pair,
        4.0 * contrast.standard_error(),
    )?)
}
