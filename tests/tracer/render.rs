use core::sync::atomic::AtomicBool;

use tem00::{
    engine::render_frame,
    numerics::Grid,
    tracer::{Crop, Filter, Frame, Material, RenderOptions, Sampling, Scene},
};
use tem00_testkit::{on_threads, refuses};

use super::integrator::{INSIDE, ball};
use crate::{
    means::render as render_smooth,
    renders::{self, speckle},
};

/// Two lasers and a light on two plates.
fn scene() -> Scene {
    renders::scene(
        r#"
        [camera]
        position = [0, 0.05, 0.3]
        look_at = [0, 0, 0]
        focal_length = 0.025
        f_number = 8
        pixel_pitch = "60 um"
        resolution = [40, 9]
        [[laser]]
        wavelength = "650 nm"
        power = 1
        position = [0.1, 0, 0.2]
        look_at = [0, 0, 0]
        spot = { waist_radius = "2 mm" }
        [[laser]]
        wavelength = "532 nm"
        power = 2
        position = [-0.1, 0.1, 0.2]
        look_at = [0.01, 0, 0]
        spot = { waist_radius = "1 mm" }
        [[surface]]
        rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = [0.1, 0.1] }
        [[surface]]
        rectangle = { centre = [0, -0.02, 0.02], normal = [0, 1, 0.2], size = [0.1, 0.03] }
        [[light]]
        rectangle = { centre = [0, 0.2, 0.2], normal = [0, -1, -1], size = [0.05, 0.05], radiance = 10 }
        "#,
    )
}

fn options() -> RenderOptions {
    renders::options(7, 3)
}

fn render(scene: &Scene, options: &RenderOptions) -> Frame {
    renders::frame(scene, Some(&speckle(scene, 1)), 0, options)
}

/// All layers of a frame.
fn layers(frame: &Frame) -> Vec<&Grid<f32>> {
    let mut all = vec![
        &frame.lights,
        &frame.lights_variance,
        &frame.depth,
        &frame.samples,
    ];
    all.extend(&frame.normal);
    for laser in &frame.lasers {
        all.extend([&laser.single, &laser.multiple, &laser.speckle]);
        all.extend([&laser.radiance, &laser.variance]);
    }
    all
}

#[test]
fn frames_have_the_same_bits_for_any_number_of_threads() {
    let scene = scene();
    let (radius, standard_deviation) = (1.5, 0.5);
    let filter = Filter::Gaussian {
        radius,
        standard_deviation,
    };
    for (sampling, filter) in [
        (Sampling::Even, Filter::default()),
        (Sampling::TargetError(0.2), filter),
        (Sampling::Adaptive, Filter::default()),
    ] {
        let options = RenderOptions {
            sampling,
            filter,
            ..options()
        };
        let one = on_threads(1, || render(&scene, &options));
        for threads in [2, 7] {
            let many = on_threads(threads, || render(&scene, &options));
            assert!(one == many, "{threads} threads, {options:?}");
        }
    }
}

#[test]
fn a_crop_has_the_bits_of_the_whole_image() {
    let scene = scene();
    let crop = Crop {
        x: 5,
        y: 2,
        width: 34,
        height: 4,
    };
    let whole = render(&scene, &options());
    let cropped = RenderOptions {
        crop: Some(crop),
        ..options()
    };
    let part = render(&scene, &cropped);
    assert_eq!(part.origin, [5, 2], "origin");
    assert_eq!(part.lights.width(), 34, "width");
    for (whole, part) in layers(&whole).into_iter().zip(layers(&part)) {
        for (y, row) in part.rows().enumerate() {
            let same = &whole.row(y + crop.y)[crop.x..][..crop.width];
            assert_eq!(row, same, "row {y}");
        }
    }
}

#[test]
fn all_but_speckle_in_the_dark_is_the_same_without_it() {
    let scene = scene();
    for max_depth in [1, 3] {
        let (max_depth, speckle_in_the_dark) = (Some(max_depth), false);
        let all = RenderOptions {
            max_depth,
            ..options()
        };
        let light_only = RenderOptions {
            speckle_in_the_dark,
            ..all
        };
        let [mut with, without] = [all, light_only].map(|options| render(&scene, &options));
        let is_even = |factor: f32| factor.to_bits() == 1.0_f32.to_bits();
        let mut changed = 0;
        for (with, without) in with.lasers.iter_mut().zip(&without.lasers) {
            for y in 0..with.speckle.height() {
                for at in (0..with.speckle.width()).map(|x| (x, y)) {
                    let is_dark = with.single[at] == 0.0 && with.multiple[at] == 0.0;
                    assert!(!is_dark || is_even(without.speckle[at]), "{at:?}");
                    changed += u32::from(is_dark && !is_even(with.speckle[at]));
                }
            }
            with.speckle = without.speckle.clone();
        }
        assert!(max_depth > Some(1) || changed > 20, "{changed} dark pixels");
        assert!(with == without, "a layer of light, depth {max_depth:?}");
    }
}

#[test]
fn many_lasers_in_one_pass_are_the_lasers_one_by_one() {
    let all = scene();
    let together = render(&all, &options());
    for index in 0..2 {
        let mut alone = all.clone();
        alone.lasers = vec![all.lasers[index].clone()];
        let one = render_smooth(&alone, &options());
        let (one, together) = (&one.lasers[0], &together.lasers[index]);
        // White surfaces leave the paths of all wavelengths the same.
        assert_eq!(one.single, together.single, "{index}");
        assert_eq!(one.multiple, together.multiple, "{index}");
        let relative = one.power_on_target / together.power_on_target - 1.0;
        assert!(relative.abs() < 1e-15, "{index}: {relative:e}");
    }
}

#[test]
fn depth_and_normal_are_those_of_the_plate() {
    let mut scene = scene();
    scene.surfaces.truncate(1);
    scene.lights.clear();
    let frame = render(&scene, &options());
    // The axis is (0, −0.05, −0.3) / |…|; the plate is met where it meets z = 0.
    let middle = f64::from(frame.depth[(20, 4)]);
    let distance = 0.05_f64.hypot(0.3);
    // The pixel is 0.7 mm wide there, and the axis leans by 0.16.
    assert!((middle / distance - 1.0).abs() < 1e-3, "{middle} m");
    let [x, y, z] = frame.normal.each_ref().map(|layer| layer[(20, 4)]);
    assert!(
        x == 0.0 && y == 0.0 && (z - 1.0).abs() < 1e-6,
        "({x}, {y}, {z})"
    );
    let is_even = |layer: &Grid<f32>, value: f32| {
        let mut values = layer.values().iter();
        values.all(|v| v.to_bits() == value.to_bits())
    };
    assert!(is_even(&frame.samples, 7.0), "samples");
    let none = render(&with_nothing_in_view(), &options());
    assert!(is_even(&none.depth, 0.0), "nothing");
    assert!(
        none.normal.iter().all(|n| is_even(n, 0.0)),
        "nothing has a normal"
    );
    assert!(is_even(&none.lasers[0].speckle, 1.0), "no speckle");
}

fn with_nothing_in_view() -> Scene {
    let mut scene = scene();
    let away = tem00::decorrelation::RigidMotion::along(glam::DVec3::new(0.0, 0.0, 10.0)).unwrap();
    for surface in &mut scene.surfaces {
        surface.shape = surface.shape.moved(&away);
    }
    scene.lights.clear();
    scene
}

/// A closed white sphere, whose incoherent radiance is known and the same in every pixel.
fn sphere() -> (Scene, f64) {
    let mut scene = ball(INSIDE, 24);
    scene.surfaces[0].material = Material::lambertian(0.5).unwrap();
    // ρ²P / (πA (1 − ρ)) after all reflections but the first.
    let area = 4.0 * core::f64::consts::PI * 0.01;
    let radiance = 0.25 * 2.0 / (core::f64::consts::PI * area * 0.5);
    (scene, radiance)
}

#[test]
fn stated_variances_are_those_between_renders() {
    const SEEDS: u64 = 40;
    let (scene, radiance) = sphere();
    let (mut stated, mut squares) = (0.0, 0.0);
    for seed in 0..SEEDS {
        let frame = render_smooth(&scene, &renders::options(16, seed));
        let laser = &frame.lasers[0];
        let pixels = laser.multiple.values().len() as f64;
        for (value, variance) in laser.multiple.values().iter().zip(laser.variance.values()) {
            squares += (f64::from(*value) - radiance).powi(2) / pixels;
            stated += f64::from(*variance) / pixels;
        }
    }
    // The coherent light varies little over a pixel. 23 040 pixels give either variance to 1 %;
    // the evenness of the samples takes some of it away.
    let ratio = squares / stated;
    assert!((0.3..1.03).contains(&ratio), "actual by stated: {ratio}");
}

#[test]
fn light_over_two_surfaces_is_found_with_few_samples() {
    let (scene, multiple) = sphere();
    let mut squares = Vec::new();
    for seed in 0..4 {
        let frame = render_smooth(&scene, &renders::options(16, seed));
        let values = frame.lasers[0].multiple.values().iter();
        squares.extend(values.map(|&value| (f64::from(value) / multiple - 1.0).powi(2)));
    }
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    // 0.13; directions alone, which seldom meet the spot, leave 0.40.
    assert!(rms < 0.16, "error {rms}");
}

#[test]
fn a_target_is_reached_without_bias() {
    const TARGET: f64 = 0.1;
    let (scene, multiple) = sphere();
    let max_depth = Some(1);
    let direct = RenderOptions {
        max_depth,
        ..renders::options(256, 0)
    };
    let single = render_smooth(&scene, &direct).lasers.remove(0);
    let (mut squares, mut biases) = (Vec::new(), Vec::new());
    for seed in 0..12 {
        let sampling = Sampling::TargetError(TARGET);
        let options = RenderOptions {
            sampling,
            ..renders::options(16, seed)
        };
        let frame = render_smooth(&scene, &options);
        let laser = &frame.lasers[0];
        let mut samples = frame.samples.values().iter();
        assert!(
            samples.all(|n| (16.0..=1024.0).contains(n)),
            "numbers of samples"
        );
        let errors: Vec<f64> = (0..laser.multiple.values().len())
            .map(|i| {
                let truth = multiple + f64::from(single.single.values()[i]);
                f64::from(laser.radiance.values()[i]) / truth - 1.0
            })
            .collect();
        let n = errors.len() as f64;
        squares.push((errors.iter().map(|e| e * e).sum::<f64>() / n).sqrt());
        biases.push(errors.iter().sum::<f64>() / n);
    }
    let rms = squares.iter().sum::<f64>() / squares.len() as f64;
    // The rest of the target is for the uncertainty of the estimated error, and for samples that
    // are more even than the independent ones for which it is asked.
    assert!((0.4 * TARGET..TARGET).contains(&rms), "error {rms}");
    let bias = biases.iter().sum::<f64>() / biases.len() as f64;
    // 4 standard errors of the mean over 6912 pixels: what a pilot finds, the image does not see.
    assert!(bias.abs() < 0.0021, "bias {bias}");
}

#[test]
fn adaptive_samples_find_edges_with_fewer_samples_and_without_bias() {
    const SEEDS: u64 = 16;
    let scene = scene();
    let render = |sampling, samples_per_pixel, seed| {
        let mut options = renders::options(samples_per_pixel, seed);
        (options.sampling, options.max_depth) = (sampling, Some(1));
        render_smooth(&scene, &options)
    };
    let truth = render(Sampling::Even, 1 << 13, 100);
    // The mean square error of the light of both lasers and of the lamp, and the error of the mean.
    let errors = |sampling, samples_per_pixel| {
        let (mut squares, mut bias, mut samples) = (0.0, 0.0, 0.0);
        for seed in 0..SEEDS {
            let frame = render(sampling, samples_per_pixel, seed);
            let layers = |frame: &Frame| {
                let lasers = frame.lasers.iter().map(|laser| laser.radiance.clone());
                lasers.chain([frame.lights.clone()]).collect::<Vec<_>>()
            };
            for (found, wanted) in layers(&frame).iter().zip(&layers(&truth)) {
                for (found, wanted) in found.values().iter().zip(wanted.values()) {
                    let error = f64::from(found - wanted);
                    squares += error * error;
                    bias += error;
                }
            }
            let of_pixels = frame.samples.values().iter();
            samples += of_pixels.map(|&n| f64::from(n)).sum::<f64>();
        }
        let pixels = (SEEDS * 40 * 9) as f64;
        (squares / pixels, bias / pixels, samples / pixels)
    };
    for samples in [4, 32] {
        let (even, _, of_even) = errors(Sampling::Even, samples);
        let (adaptive, bias, of_adaptive) = errors(Sampling::Adaptive, samples);
        let asked = f64::from(samples);
        assert!((of_even - asked).abs() < 1e-9, "{of_even} of a pixel");
        // The pilot takes a quarter, and what it leaves is used.
        let about = 0.73 * asked..=0.75 * asked;
        assert!(about.contains(&of_adaptive), "{of_adaptive} of a pixel");
        assert!(adaptive < 0.25 * even, "{adaptive:e} for {even:e}");
        // The standard error of the mean, were pixels independent.
        let deviation = (adaptive / (SEEDS * 40 * 9) as f64).sqrt();
        assert!(bias.abs() < 4.0 * deviation, "{bias:e}, {deviation:e}");
    }
}

#[test]
fn options_out_of_range_are_refused() {
    let (scene, go_on) = (scene(), AtomicBool::new(false));
    let crop = |x, width| {
        let (y, height) = (0, 1);
        Some(Crop {
            x,
            y,
            width,
            height,
        })
    };
    refuses!(options = options() => render_frame(&scene, None, 0, &options, &|_| (), &go_on);
        options.samples_per_pixel: [0],
        options.crop as "crop (columns)": [crop(39, 2), crop(0, 0), crop(usize::MAX, 2)],
        options.sampling as "target_error":
            [Sampling::TargetError(0.0), Sampling::TargetError(f64::NAN)],
    );
}
