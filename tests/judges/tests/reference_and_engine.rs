//! The reference integrator judges the engine: both render the same scenes, and agree within their
//! standard errors.
//!
//! They share the scene, its materials and the intersector, and no code that follows light: the
//! reference follows one sample at a time with random numbers of its own, and has its speckle from
//! the call per hit.

use std::{fs, path::Path, sync::atomic::AtomicBool};

use tem00::{
    camera::{Camera, CameraDescription},
    numerics::Grid,
    scene::read_scene,
    statistics::{pearson_correlation, t_test_mean},
    tracer::{
        Frame, LaserEvents, LightEvents, Material, Medium, Method, ReferenceSpeckle, RenderOptions,
        Sampling, Scene, render_reference,
    },
};

use crate::renders;

/// Images of each scene, by seeds from 0.
const SEEDS: u64 = 20;

/// Pixels along the side of a block.
const BLOCK: usize = 8;

/// The probability with which a comparison of correct images fails: some ten thousand of this file
/// fail with 0.001 together. A block may differ by some eight standard errors of 20 pairs.
const SIGNIFICANCE: f64 = 1e-7;

/// The scene with so many columns and the same view.
fn coarse(mut scene: Scene, columns: usize) -> Scene {
    let description = *scene.camera.description();
    let [width, height] = description.resolution;
    let rows = (height * columns).div_ceil(width).next_multiple_of(BLOCK);
    scene.camera = Camera::new(CameraDescription {
        resolution: [columns, rows],
        pixel_pitch: description.pixel_pitch * width as f64 / columns as f64,
        ..description
    })
    .expect("a coarser sensor");
    scene
}

/// Means of a layer over blocks of pixels.
fn blocks(layer: &Grid<f32>) -> Vec<f64> {
    let [across, down] = [layer.width(), layer.height()].map(|pixels| pixels / BLOCK);
    let block = |index: usize| {
        let corner = [index % across * BLOCK, index / across * BLOCK];
        let pixels = (0..BLOCK * BLOCK).map(|i| {
            let at = (corner[0] + i % BLOCK, corner[1] + i / BLOCK);
            f64::from(layer[at])
        });
        pixels.sum::<f64>() / (BLOCK * BLOCK) as f64
    };
    (0..across * down).map(block).collect()
}

/// What is compared of a frame: named layers by block, and the powers.
fn compared(frame: &Frame) -> Vec<(String, Vec<f64>)> {
    let mut all = vec![
        ("lights".to_owned(), blocks(&frame.lights)),
        ("depth".to_owned(), blocks(&frame.depth)),
    ];
    for (axis, normal) in frame.normal.iter().enumerate() {
        all.push((format!("normal {axis}"), blocks(normal)));
    }
    for (number, laser) in frame.lasers.iter().enumerate() {
        let layers = [
            ("single", blocks(&laser.single)),
            ("multiple", blocks(&laser.multiple)),
            ("radiance", blocks(&laser.radiance)),
            ("power", vec![laser.power_on_target]),
        ];
        all.extend(layers.map(|(name, values)| (format!("{name} of laser {number}"), values)));
    }
    all
}

/// Tells whether no few images hold most of what the reference has found: otherwise they tell no
/// mean. It finds thin lines of light on other surfaces by chance alone.
fn is_found_often(pairs: &[[f64; 2]]) -> bool {
    let sum = |power: i32| pairs.iter().map(|pair| pair[1].powi(power)).sum::<f64>();
    sum(1).powi(2) > 0.6 * pairs.len() as f64 * sum(2)
}

/// Tests that values of pairs of images have the same expectation.
fn assert_same_mean(what: &str, pairs: &[[f64; 2]]) {
    let differences: Vec<f64> = pairs
        .iter()
        .map(|[engine, reference]| engine - reference)
        .collect();
    if differences.iter().all(|difference| difference.abs() == 0.0) {
        return;
    }
    let mean =
        |which: usize| pairs.iter().map(|pair| pair[which]).sum::<f64>() / pairs.len() as f64;
    let [engine, reference] = [mean(0), mean(1)];
    // What differs by less than single precision tells nothing.
    let rounding = 1e-6 * (engine.abs() + reference.abs());
    let p = t_test_mean(&differences, 0.0).map_or(0.0, |test| test.p_value);
    assert!(
        p > SIGNIFICANCE || (engine - reference).abs() < rounding,
        "{what}: engine {engine:e}, reference {reference:e}, p = {p:e}: {pairs:?}"
    );
}

/// A frame by the reference.
fn reference(
    scene: &Scene,
    speckle: Option<&ReferenceSpeckle>,
    frame: u32,
    options: &RenderOptions,
) -> Frame {
    let go_on = AtomicBool::new(false);
    render_reference(scene, speckle, frame, options, &|_| (), &go_on).expect("a render")
}

/// Renders a frame without speckle by both, once for each seed, and compares them block by block.
///
/// Returns the number of blocks in which light over several surfaces was compared.
fn assert_agree(name: &str, scene: &Scene, frame: u32, samples_per_pixel: u32) -> usize {
    let pairs = (0..SEEDS).map(|seed| {
        let options = RenderOptions {
            samples_per_pixel,
            sampling: Sampling::Even,
            seed,
            ..scene.render
        };
        let engine = renders::frame(scene, None, frame, &options);
        [engine, reference(scene, None, frame, &options)].map(|frame| compared(&frame))
    });
    let pairs: Vec<_> = pairs.collect();
    let (mut lit, mut multiple) = (0, 0);
    for (layer, (what, first)) in pairs[0][0].iter().enumerate() {
        for block in 0..first.len() {
            let values = pairs
                .iter()
                .map(|pair| pair.each_ref().map(|all| all[layer].1[block]));
            let values: Vec<[f64; 2]> = values.collect();
            lit += usize::from(values.iter().flatten().any(|value| *value != 0.0));
            if what.starts_with("multiple") || what.starts_with("radiance") {
                if !is_found_often(&values) {
                    continue;
                }
                multiple += usize::from(what.starts_with("multiple"));
            }
            assert_same_mean(&format!("{name}: {what}, block {block}"), &values);
        }
    }
    assert!(lit > 20, "{name}: {lit} blocks of layers are not dark");
    multiple
}

#[test]
fn reference_and_engine_agree_on_every_example() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let entries = fs::read_dir(folder).expect("a folder of scenes");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    paths.sort();
    assert!(paths.len() >= 7, "{paths:?}");
    for path in paths {
        let scene = coarse(read_scene(&path).expect("a valid scene"), 64);
        assert_agree(&path.display().to_string(), &scene, scene.frames - 1, 2);
    }
}

/// A plate and a wall that stands on it, in the light of a laser and of what `more` adds.
fn corner(more: &str) -> Scene {
    renders::scene(&format!(
        r#"
        [camera]
        position = [0.02, -0.1, 0.28]
        look_at = [0, 0, 0.005]
        focal_length = "25 mm"
        f_number = 4
        focus_distance = 0.3
        pixel_pitch = "60 um"
        resolution = [40, 32]
        [[laser]]
        wavelength = "650 nm"
        power = "2 mW"
        position = [0.1, -0.05, 0.2]
        look_at = [0, 0, 0.004]
        spot = {{ waist_radius = "8 mm" }}
        [[surface]]
        name = "plate"
        rectangle = {{ centre = [0, 0, 0], normal = [0, 0, 1], size = [0.05, 0.05] }}
        lambertian = {{ reflectance = 0.9 }}
        [[surface]]
        name = "wall"
        displacement_per_frame = ["0.1 mm", 0, 0]
        rectangle = {{ centre = [-0.012, 0, 0.01], normal = [1, 0, 0], size = [0.04, 0.02] }}
        conductor = {{ metal = "aluminium", roughness = 0.3 }}
        {more}
        "#
    ))
}

const LAMPS: &str = r#"
    [[light]]
    rectangle = { centre = [0.05, 0.05, 0.1], normal = [-1, -1, -1.5], size = [0.04, 0.03], radiance = 3 }
    [[light]]
    point = { position = [0.0, -0.06, 0.05], power = 0.02 }
    [[light]]
    environment = { radiance = 0.1 }
    "#;

const BALL: &str = r#"
    [[surface]]
    name = "ball"
    sphere = { centre = [0.006, 0.002, 0.008], radius = 0.005 }
    dielectric = { index = 1.5 }
    "#;

#[test]
fn reference_and_engine_agree_on_light_over_two_surfaces() {
    for laser_events in [LaserEvents::Beam, LaserEvents::Sampled] {
        let mut scene = corner("");
        scene.render.laser_events = laser_events;
        let multiple = assert_agree(&format!("corner, {laser_events:?}"), &scene, 0, 8);
        assert!(multiple > 15, "{multiple} blocks with light of the wall");
    }
    let mut scene = corner("");
    scene.render.max_depth = Some(2);
    assert_agree("corner, two surfaces at most", &scene, 0, 4);
}

#[test]
fn reference_and_engine_agree_on_lamps() {
    for light_events in [
        LightEvents::Both,
        LightEvents::NextEvent,
        LightEvents::Scattering,
    ] {
        let mut scene = corner(LAMPS);
        scene.lasers.clear();
        scene.render.light_events = light_events;
        scene.surfaces[0].material = Material::plastic(0.5, 1.5, 0.2).expect("plastic");
        assert_agree(&format!("lamps, {light_events:?}"), &scene, 0, 4);
    }
}

#[test]
fn reference_and_engine_agree_on_light_through_glass_and_off_mirrors() {
    let mut mirrored = corner(LAMPS);
    mirrored.surfaces[1].material = Material::mirror(0.9).expect("a mirror");
    for (name, scene) in [("a glass ball", corner(BALL)), ("a mirror", mirrored)] {
        assert_agree(name, &scene, 0, 4);
        for method in [Method::Light, Method::Path] {
            let mut scene = scene.clone();
            scene.render.method = method;
            scene.render.laser_events = match method {
                Method::Light => LaserEvents::Beam,
                Method::Path => LaserEvents::Sampled,
            };
            assert_agree(&format!("{name}, by {method:?}"), &scene, 0, 4);
        }
    }
}

#[test]
fn reference_and_engine_agree_on_light_from_below_a_surface() {
    let medium = Medium::new(1.4, 5e2, 20.0).expect("a medium");
    let body = Material::translucent(medium, 0.2).expect("a body");
    let mut scene = corner(LAMPS);
    scene.surfaces[0].material = body;
    assert_agree("a translucent plate", &scene, 0, 4);
    let mut scene = corner(BALL);
    scene.surfaces[0].material = body.one_sided();
    assert_agree("a translucent plate under glass", &scene, 0, 4);
}

/// The speckle of the corner: what both draw differs, and its laws are the same.
#[test]
fn reference_and_engine_have_the_same_speckle() {
    let mut scene = corner("");
    scene.frames = 2;
    // The wall is a plate that fills the image, and slides in its plane.
    let fine = CameraDescription {
        pixel_pitch: 1.2e-6,
        f_number: 8.0,
        ..*scene.camera.description()
    };
    scene.camera = Camera::new(fine).expect("a finer sensor");
    scene.surfaces.remove(1);
    scene.surfaces[0].trajectory =
        tem00::tracer::Trajectory::steady(tem00::DVec3::new(15e-6, 0.0, 0.0)).expect("a motion");
    let laws = |frames: [Frame; 2]| {
        let factors = frames.each_ref().map(|frame| &frame.lasers[0].speckle);
        let count = factors[0].values().len() as f64;
        let moment = |power: i32| {
            let powers = factors[0]
                .values()
                .iter()
                .map(|&v| f64::from(v).powi(power));
            powers.sum::<f64>() / count
        };
        let shared = pearson_correlation(factors[0], factors[1]).expect("two patterns");
        [moment(1), moment(2), shared]
    };
    let pairs = (0..SEEDS).map(|seed| {
        let options = RenderOptions {
            samples_per_pixel: 4,
            seed,
            ..scene.render
        };
        let model = renders::speckle(&scene, seed);
        let prepared = ReferenceSpeckle::prepare(&scene, seed).expect("small patterns");
        let engine = [0, 1].map(|frame| renders::frame(&scene, Some(&model), frame, &options));
        let reference = [0, 1].map(|frame| reference(&scene, Some(&prepared), frame, &options));
        [laws(engine), laws(reference)]
    });
    let pairs: Vec<_> = pairs.collect();
    for (law, what) in ["mean", "second moment"].into_iter().enumerate() {
        let values: Vec<_> = pairs
            .iter()
            .map(|pair| pair.map(|laws| laws[law]))
            .collect();
        assert_same_mean(what, &values);
    }
    let mean = |law: usize| pairs.iter().map(|pair| pair[1][law]).sum::<f64>() / SEEDS as f64;
    assert!(mean(1) > 1.5, "there is speckle: {}", mean(1));
    assert!((0.2..0.95).contains(&mean(2)), "{} is left", mean(2));
}
