//! Renders of a scene by either method, and tests that they agree.

use tem00::{
    camera::{Camera, CameraDescription},
    engine::SpeckleModel,
    numerics::Grid,
    statistics::{kolmogorov_smirnov, t_test_mean},
    tracer::{Frame, LaserEvents, LaserLayers, Material, Method, RenderOptions, Scene},
};

use crate::{means::assert_mean, renders};

/// Correct tracers fail a comparison of pixels with this probability at the fixed seeds.
const SIGNIFICANCE: f64 = 1e-4;

/// Reads a scene whose camera is sharp everywhere.
pub(crate) fn sharp_scene(text: &str) -> Scene {
    let mut scene = renders::scene(text);
    let sharp = CameraDescription {
        depth_of_field: false,
        ..*scene.camera.description()
    };
    scene.camera = Camera::new(sharp).expect("a valid camera");
    scene
}

/// Gives the surface called `name` another material.
pub(crate) fn paint(scene: &mut Scene, name: &str, material: Material) {
    let mut surfaces = scene.surfaces.iter_mut();
    let surface = surfaces.find(|surface| surface.name == name);
    surface.expect("a surface of that name").material = material;
}

/// How the images of a comparison are rendered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Series {
    pub method: Method,
    pub laser_events: LaserEvents,
    pub samples_per_pixel: u32,
    pub seeds: u64,
}

impl Series {
    /// Sixteen images by a method.
    pub(crate) const fn of(method: Method, samples_per_pixel: u32) -> Self {
        Self {
            method,
            laser_events: LaserEvents::Beam,
            samples_per_pixel,
            seeds: 16,
        }
    }

    /// Renders a scene once for each seed.
    pub(crate) fn render(&self, scene: &Scene, speckle: Option<&SpeckleModel>) -> Vec<Frame> {
        let render = |seed| {
            let options = RenderOptions {
                samples_per_pixel: self.samples_per_pixel,
                seed,
                method: self.method,
                laser_events: self.laser_events,
                ..scene.render
            };
            renders::frame(scene, speckle, 0, &options)
        };
        (0..self.seeds).map(render).collect()
    }
}

/// A layer of the first laser.
pub(crate) type Layer = fn(&LaserLayers) -> &Grid<f32>;

/// Tests that a layer of two series of images has the same expectation.
///
/// In the whole: a t-test of the sum over the image. In each pixel: a t-test of the differences;
/// the probabilities must be uniform. Pixels darker than `floor` times the brightest do not count:
/// sums of few paths are not normally distributed.
pub(crate) fn assert_agree(one: &[Frame], other: &[Frame], layer: Layer, floor: f64) {
    let images = |frames: &[Frame]| -> Vec<Vec<f64>> {
        let values = |frame: &Frame| {
            let values = layer(&frame.lasers[0]).values().iter();
            values.map(|&value| f64::from(value)).collect()
        };
        frames.iter().map(values).collect()
    };
    let (one, other) = (images(one), images(other));
    assert_same_sum(&one, &other);
    let means: Vec<f64> = (0..one[0].len())
        .map(|pixel| one.iter().map(|image| image[pixel]).sum::<f64>() / one.len() as f64)
        .collect();
    let brightest = means.iter().copied().fold(0.0, f64::max);
    let lit = (0..means.len()).filter(|&pixel| means[pixel] > floor * brightest);
    let probability = |pixel: usize| {
        let difference = one.iter().zip(&other).map(|(a, b)| a[pixel] - b[pixel]);
        t_test_mean(&difference.collect::<Vec<_>>(), 0.0).expect("images with noise")
    };
    let probabilities: Vec<f64> = lit.map(|pixel| probability(pixel).p_value).collect();
    assert!(probabilities.len() > 30, "{} pixels", probabilities.len());
    let p = kolmogorov_smirnov(&probabilities, |p| p).expect("probabilities");
    assert!(
        p.p_value > SIGNIFICANCE,
        "p = {:e}: {probabilities:?}",
        p.p_value
    );
}

fn assert_same_sum(one: &[Vec<f64>], other: &[Vec<f64>]) {
    let sums = |images: &[Vec<f64>]| -> Vec<f64> {
        images.iter().map(|image| image.iter().sum()).collect()
    };
    let (one, other) = (sums(one), sums(other));
    let ratios: Vec<f64> = one.iter().zip(&other).map(|(a, b)| a / b - 1.0).collect();
    assert_mean("sums", &ratios, 0.0, 0.004);
}
