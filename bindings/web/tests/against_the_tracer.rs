//! The pass of the page and the reference tracer see the same plate under the same laser line.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

use std::sync::atomic::AtomicBool;

use glam::DVec3;
use tem00_engine::{SpeckleModel, SpecklePlan, render_frame};
use tem00_geometry::{Rectangle, Shape};
use tem00_gpu::{Gpu, wgpu};
use tem00_tracer::{Frame, Material, RenderOptions, Scene, Surface, Trajectory};
use tem00_web::{
    Passes, measure,
    optics::{self, SENSOR},
    scene,
    settings::Values,
    speckle::Speckle,
};

const WIDTH: usize = SENSOR[0] as usize;

/// Light with speckle, light without, the lamp, the correlation with the part at rest, of each
/// pixel.
type Film = Vec<[f32; 4]>;

/// The plate nearly from above, so that a slide of 24 pixel pitches moves its image by one pixel.
fn values(light: f64, line_width: f64) -> Values {
    Values {
        light,
        line_width,
        part: 0.0,
        azimuth: -90.0,
        elevation: 80.0,
        lamp: 0.0,
        ..Values::default()
    }
}
const SLIDE: f64 = 24.0 * 3.45;

fn film_of_the_page(gpu: &Gpu, values: &Values) -> Film {
    let passes = Passes::new(gpu, wgpu::TextureFormat::Rgba8Unorm);
    let speckle = Speckle::new(gpu, values).unwrap();
    let rows = scene::rows(values, &speckle, measure::SAMPLES).unwrap();
    assert_eq!(rows.len() as u64, scene::COUNT, "as many as the struct has");
    passes.show(gpu, &rows);
    let mut encoder = gpu.device().create_command_encoder(&<_>::default());
    passes.expose(&mut encoder, &speckle);
    let buffer = passes.copy(gpu, &mut encoder);
    gpu.queue().submit([encoder.finish()]);
    gpu.read(&buffer).unwrap()
}

fn frames_of_the_tracer(values: &Values) -> [Film; 2] {
    let mut scene = Scene::new(optics::camera(values).unwrap());
    scene.lasers.push(optics::laser(values).unwrap());
    let plate = Rectangle::new(DVec3::ZERO, 0.035 * DVec3::X, 0.025 * DVec3::Y).unwrap();
    scene.surfaces.push(Surface {
        trajectory: Trajectory::steady(1e-6 * SLIDE * DVec3::X).unwrap(),
        ..Surface::new(
            "plate",
            Shape::Rectangle(plate),
            Material::lambertian(0.8).unwrap(),
        )
    });
    scene.frames = 2;
    let options = RenderOptions {
        samples_per_pixel: 9,
        max_depth: Some(2),
        ..RenderOptions::default()
    };
    let plan = SpecklePlan::new(&scene, options.seed).unwrap();
    let speckle = SpeckleModel::generate(&scene, &plan).unwrap();
    [0, 1].map(|frame| {
        let end = AtomicBool::new(false);
        film_of(&render_frame(&scene, Some(&speckle), frame, &options, &|_| (), &end).unwrap())
    })
}

fn film_of(frame: &Frame) -> Film {
    let layers = &frame.lasers[0];
    let (with, without) = (layers.radiance.values(), layers.single.values());
    with.iter()
        .zip(without)
        .map(|(with, without)| [*with, *without, 0.0, 1.0])
        .collect()
}

/// Σ over the pixels of the light without speckle, and the standard deviation of its rows, in
/// pixels.
fn power_and_width(film: &Film) -> [f64; 2] {
    let mut moments = [0.0; 3];
    for (index, pixel) in film.iter().enumerate() {
        let (row, light) = ((index / WIDTH) as f64, f64::from(pixel[1]));
        for (moment, power) in moments.iter_mut().zip([1.0, row, row * row]) {
            *moment += light * power;
        }
    }
    let mean = moments[1] / moments[0];
    [moments[0], (moments[2] / moments[0] - mean * mean).sqrt()]
}

/// The correlation of the speckle of lit pixels with that of the frame before, one pixel to the
/// left.
fn correlation(before: &Film, after: &Film) -> f64 {
    let brightest = before.iter().fold(0.0_f32, |max, pixel| max.max(pixel[1]));
    let factor = |pixel: &[f32; 4]| {
        (pixel[1] > 0.1 * brightest).then(|| f64::from(pixel[0] / pixel[1]) - 1.0)
    };
    let pairs = before
        .iter()
        .zip(&after[1..])
        .filter_map(|(a, b)| Some([factor(a)?, factor(b)?]));
    let [ab, aa, bb] = pairs.fold([0.0; 3], |[ab, aa, bb], [a, b]| {
        [ab + a * b, aa + a * a, bb + b * b]
    });
    ab / (aa * bb).sqrt()
}

#[test]
fn the_page_and_the_tracer_see_the_same_line_and_the_same_speckle() {
    agree(values(0.0, 1.0));
}

#[test]
fn the_page_and_the_tracer_see_the_same_spot_and_the_same_speckle() {
    agree(values(1.0, 15.0));
}

fn agree(at_rest: Values) {
    let gpu = Gpu::new().unwrap();
    let page = [
        at_rest,
        Values {
            slide: SLIDE,
            ..at_rest
        },
    ]
    .map(|values| film_of_the_page(&gpu, &values));
    let tracer = frames_of_the_tracer(&at_rest);

    let ([power, width], [power_there, width_there]) =
        (power_and_width(&page[0]), power_and_width(&tracer[0]));
    assert!(
        (power / power_there - 1.0).abs() < 2e-3,
        "power {power}, not {power_there}"
    );
    assert!(
        (width / width_there - 1.0).abs() < 2e-3,
        "width {width}, not {width_there}"
    );

    let size = optics::geometry(&at_rest).unwrap().speckle_size_in_pixels();
    let [here, there] =
        [&page[0], &tracer[0]].map(|film| measure::measure(film, WIDTH, size).unwrap());
    // A speckle covers some size² pixels. Both samples scatter by about √(2 / speckles).
    let speckles = f64::from(here.pixels) / (size * size);
    let scatter = 2.0 / speckles.sqrt();
    let [contrast, other] = [here, there].map(|found| found.contrast);
    assert!(
        (contrast - other).abs() < 3.0 * scatter,
        "contrast {contrast}, not {other}"
    );
    let theory = here.contrast_in_theory;
    assert!(
        (contrast - theory).abs() < 2.0 * scatter,
        "contrast {contrast}, not {theory}"
    );

    let [here, there] = [&page, &tracer].map(|frames| correlation(&frames[0], &frames[1]));
    let moved = page[1]
        .iter()
        .filter(|pixel| pixel[1] > 0.0)
        .map(|pixel| f64::from(pixel[3]));
    let theory = moved.clone().sum::<f64>() / moved.count() as f64;
    assert!(
        (here - there).abs() < 2.0 * scatter,
        "correlation {here}, not {there}"
    );
    assert!(
        (here - theory).abs() < 2.0 * scatter,
        "correlation {here}, not {theory}"
    );
}
