//! A laser spot with its speckle in rpt, a path tracer that knows nothing of lasers.
//!
//! ```sh
//! cargo run --release --manifest-path integrations/rpt/Cargo.toml
//! ```
//!
//! Prints `measured | theory` from rpt's own pictures and fails if they disagree. Writes a picture with
//! a ball, and a point light, which has no speckle, to `out/rpt_spot.png`.

use std::{error::Error, f64::consts::PI, fs};

use rand::rngs::StdRng;
use rpt::{glm, glm::vec3, image::RgbImage, *};
use tem00_beam::{DVec3, Emitter, GaussianBeam, Placement, SpotLight};
use tem00_decorrelation::{
    CameraFrame, FieldSetup, ImageOrientation, ImagingGeometry, LensData, MotionField,
};
use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
use tem00_statistics::{Contrast, pixel_contrast};

const WIDTH: u32 = 600;
const HEIGHT: u32 = 450;
/// The camera looks along −z, with x to the right and y up.
const EYE: DVec3 = DVec3::new(0.0, 0.0, 0.3);
/// Radius (1/e²) of the beam, in metres, and its power, in watts.
const RADIUS: f64 = 3e-3;
const POWER: f64 = 5e-3;
const ALBEDO: f64 = 0.8;
/// Irradiance, in W/m², at which rpt's pictures clip: ten times that of the spot at its middle.
const WHITE: f64 = 10.0 * 2.0 * POWER / (PI * RADIUS * RADIUS);

type Speckle = (SpeckleStack, MotionField);

/// The laser as rpt meets it: an invisible shape that names a point to be lit from.
struct Laser {
    light: SpotLight<f64>,
    speckle: Option<Speckle>,
}

impl Laser {
    /// The speckle at the place where the camera sees `point`.
    fn speckle_at(&self, point: [f64; 3]) -> f64 {
        let Some((stack, field)) = &self.speckle else {
            return 1.0;
        };
        let at = field.pattern_coordinate(DVec3::from(point));
        at.map_or(1.0, |at| stack.intensity_at(at.x, at.y, 0.0))
    }
}

impl Shape for Laser {
    /// No ray meets a delta light.
    fn intersect(&self, _: &Ray, _: f64, _: &mut HitRecord) -> bool {
        false
    }

    /// rpt multiplies by cos/distance² and divides by this density: e_perp is left.
    fn sample(&self, target: &glm::DVec3, _: &mut StdRng) -> (glm::DVec3, glm::DVec3, f64) {
        let point: [f64; 3] = (*target).into();
        let Some(event) = self.light.next_event(point) else {
            let axis = glm::DVec3::from(self.light.ez);
            return (target - axis, axis, f64::INFINITY);
        };
        let e_perp = event.e_perp * self.speckle_at(point);
        let pdf = 1.0 / (e_perp * event.distance.powi(2));
        (event.point.into(), -glm::DVec3::from(event.wi), pdf)
    }
}

/// A sheet of paper in the plane z = 0, lit by the laser.
fn paper_under(light: SpotLight<f64>, speckle: Option<Speckle>) -> Scene {
    let mut scene = Scene::new();
    let mut paper = Material::diffuse(vec3(ALBEDO, ALBEDO, ALBEDO));
    paper.index = 1.0; // no gloss
    scene.add(Object::new(plane(vec3(0.0, 0.0, 1.0), 0.0)).material(paper));
    let red = Material::light(vec3(1.0, 0.03, 0.02), PI / (ALBEDO * WHITE));
    scene.add(Light::Object(
        Object::new(Laser { light, speckle }).material(red),
    ));
    scene
}

fn photograph(scene: &Scene, geometry: &ImagingGeometry, exposure: f64) -> RgbImage {
    let half_width = 0.5 * f64::from(WIDTH) * geometry.pixel_pitch();
    let fov = 2.0 * (half_width / geometry.principal_distance()).atan();
    let [eye, ahead, up] = [EYE, DVec3::ZERO, DVec3::Y].map(|v| v.to_array().into());
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
    let geometry = ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: EYE.z,
        pixel_pitch: 3.45e-6,
    })?;
    let placement = Placement {
        origin: DVec3::new(-0.2, 0.0, 0.2),
        direction: DVec3::new(1.0, 0.0, -1.0),
        fan_axis: DVec3::Y,
    };
    let beam = GaussianBeam::from_waist(geometry.wavelength(), RADIUS)?;
    let light = SpotLight::place(&beam, 0.28, &placement, POWER)?;
    // 384 speckles of 1.6 pixels along a side: more than the picture has.
    let stack = SpeckleStack::generate(&PupilField::new(768, 384, 1)?, SlicePath::Still)?;

    let smooth = irradiance(&photograph(&paper_under(light, None), &geometry, 0.0));
    let field = MotionField::new(FieldSetup {
        geometry,
        camera: CameraFrame::look_at(EYE, DVec3::ZERO, DVec3::Y)?,
        pupil_centre: EYE,
        orientation: ImageOrientation::ScreenUpright,
        pattern_speckle_size: stack.speckle_size(),
    })?;
    let mut scene = paper_under(light, Some((stack, field)));
    let speckled = irradiance(&photograph(&scene, &geometry, 0.0));
    scene.add(Light::Point(vec3(2e-3, 2e-3, 2e-3), vec3(-0.1, 0.2, 0.2)));
    let ball = sphere().scale(&vec3(1e-3, 1e-3, 1e-3));
    scene.add(Object::new(ball.translate(&vec3(-2e-3, 1e-3, 1e-3))));
    fs::create_dir_all("out")?;
    photograph(&scene, &geometry, 2.0).save("out/rpt_spot.png")?;

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
