use core::f64::consts::PI;

use glam::{DVec2, DVec3};
use tem00_camera::CameraDescription;
use tem00_geometry::{Intersector, Rectangle, Shape, TriangleMesh};
use tem00_numerics::Grid;
use tem00_statistics::{Moments, kolmogorov_smirnov, t_test_mean};
use tem00_testkit::{assert_absolute, on_threads};
use tem00_tracer::{
    Crop, LaserDescription, Material, Scene, Surface,
    film::{Film, FilmLayout},
};

use super::*;
use crate::testing;

/// A correct light tracer fails a comparison with this probability at the fixed seeds.
const SIGNIFICANCE: f64 = 1e-4;

const POWER: f64 = 2e-3;
const REFLECTANCE: f64 = 0.5;

/// A spot on an upright plate, seen by a camera that is sharp everywhere.
fn plate() -> Scene {
    let camera = CameraDescription {
        pixel_pitch: 20e-6,
        depth_of_field: false,
        ..testing::camera(DVec3::new(0.0, 0.1, 0.3), [24, 16])
    };
    let laser = LaserDescription {
        power: POWER,
        ..testing::spot(DVec3::new(0.1, 0.0, 0.2), 0.5e-3)
    };
    let plate = Surface {
        material: Material::lambertian(REFLECTANCE).unwrap(),
        ..testing::plate(DVec3::ZERO, DVec3::Z, [0.1, 0.1])
    };
    testing::scene(camera, &[laser], plate)
}

/// Traces light of a scene that is changed from all of it in the whole image.
fn try_trace(
    scene: &Scene,
    change: impl Fn(&mut LightTracer<'_>),
    [paths, seed]: [u64; 2],
    cancelled: bool,
) -> Result<LaserLayers, RenderError> {
    let intersector = Intersector::build(&scene.shapes_at(0)).unwrap();
    let mut tracer = LightTracer {
        scene,
        camera: &scene.camera,
        intersector: &intersector,
        speckle: None,
        frame: 0,
        max_depth: None,
        selection: LightSelection::All,
        area: scene.render.area(&scene.camera).unwrap(),
        paths,
        seed,
    };
    change(&mut tracer);
    let film = Film::new(&FilmLayout {
        wavelengths: &[650e-9],
        area: tracer.area,
        strips: 1,
        has_pilot: false,
        light_traced: true,
    });
    let mut layers = film.unwrap().into_frame().lasers.remove(0);
    let cancel = AtomicBool::new(cancelled);
    tracer.trace(0, &mut layers, &|_| (), &cancel)?;
    Ok(layers)
}

fn trace(scene: &Scene, paths: u64, seed: u64) -> LaserLayers {
    try_trace(scene, |_| (), [paths, seed], false).unwrap()
}

/// The light of paths of seeds from 0 on.
fn traces(scene: &Scene, paths: u64, seeds: u64) -> Vec<LaserLayers> {
    (0..seeds).map(|seed| trace(scene, paths, seed)).collect()
}

/// The power of each, as a fraction of the power of the laser.
fn powers(layers: &[LaserLayers]) -> Vec<f64> {
    layers.iter().map(|l| l.power_on_target / POWER).collect()
}

/// The point of the plate z = 0 that an image point shows.
fn on_plate(scene: &Scene, image_point: DVec2) -> DVec3 {
    let ray = scene.camera.ray(image_point);
    ray.origin - ray.origin.z / ray.direction.z * ray.direction
}

/// The radiance of a diffuse plate that is shaded with `normal`, averaged over a pixel.
fn lit(scene: &Scene, pixel: DVec2, normal: DVec3) -> f64 {
    const SIDE: u32 = 6;
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE);
    let cells = (0..SIDE * SIDE).map(|k| DVec2::new(middle(k % SIDE), middle(k / SIDE)));
    let irradiance = |cell: DVec2| {
        let light = scene.lasers[0].next_event(on_plate(scene, pixel + cell));
        light.map_or(0.0, |light| light.e_perp * light.wi.dot(normal))
    };
    let sum: f64 = cells.map(irradiance).sum();
    REFLECTANCE / PI * sum / f64::from(SIDE * SIDE)
}

/// The fraction of the laser's light that falls on the surface that a pixel shows.
fn fraction_of_light(scene: &Scene, pixel: DVec2) -> f64 {
    let centre = pixel + 0.5;
    let towards = on_plate(scene, centre) - scene.camera.position();
    let solid_angle = scene.camera.solid_angle_per_pixel(centre);
    let area = solid_angle * towards.length().powi(3) / -towards.z;
    lit(scene, pixel, DVec3::Z) * PI / REFLECTANCE * area / POWER
}

/// Tests that each pixel scatters about the radiance of a plate that is shaded with `normal`.
fn assert_lit(scene: &Scene, normal: DVec3) {
    const PATHS: u64 = 30_000;
    let images = traces(scene, PATHS, 24);
    let mut probabilities = Vec::new();
    for index in 0..images[0].single.values().len() {
        let (x, y) = (index % scene.camera.width(), index / scene.camera.width());
        let pixel = DVec2::new(x as f64, y as f64);
        // The sum of fewer paths is not normally distributed.
        if fraction_of_light(scene, pixel) * PATHS as f64 > 10.0 {
            let values: Vec<_> = images
                .iter()
                .map(|image| image.single.values()[index])
                .collect();
            let test = t_test_mean(&values, lit(scene, pixel, normal)).unwrap();
            probabilities.push(test.p_value);
        }
    }
    assert!(probabilities.len() > 40, "{} pixels", probabilities.len());
    let p = kolmogorov_smirnov(&probabilities, |p| p).unwrap().p_value;
    assert!(p > SIGNIFICANCE, "p = {p:e}: {probabilities:?}");
}

#[test]
fn a_spot_on_a_plate_has_the_radiance_of_its_closed_form_in_every_pixel() {
    assert_lit(&plate(), DVec3::Z);
}

#[test]
fn shading_normals_shade_as_seen_from_the_camera() {
    let mut scene = plate();
    // The plate as two triangles that are shaded as if tilted by 0.5 rad.
    let tilted = DVec3::new(0.5_f64.sin(), 0.0, 0.5_f64.cos());
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = corners.map(|(x, y)| 0.05 * DVec3::new(x, y, 0.0));
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    let mesh = TriangleMesh::with_normals(corners.to_vec(), vec![tilted; 4], triangles).unwrap();
    scene.surfaces[0].shape = Shape::from(mesh);
    assert_lit(&scene, tilted);
}

#[test]
fn the_stated_variance_is_that_from_seed_to_seed() {
    let images = traces(&plate(), 4_000, 200);
    let (mut stated, mut seen) = (0.0, 0.0);
    for index in 0..images[0].variance.values().len() {
        let at = |layer: &Grid<f32>| f64::from(layer.values()[index]);
        let values: Vec<_> = images.iter().map(|image| at(&image.radiance)).collect();
        seen += Moments::from_samples(&values)
            .unwrap()
            .standard_deviation()
            .powi(2);
        let variances = images.iter().map(|image| at(&image.variance));
        stated += variances.sum::<f64>() / images.len() as f64;
    }
    // Some 60 pixels and 200 seeds give a standard error of √(2 / 12 000) = 1.3 %, and what pixels
    // fraction of their paths raises it. Four times that, with as much again to spare.
    let ratio = stated / seen;
    assert!((ratio - 1.0).abs() < 0.1, "{stated:e}, seen {seen:e}");
}

#[test]
fn the_power_on_target_is_that_of_the_laser() {
    for power in powers(&traces(&plate(), 1_000, 5)) {
        // The whole spot is in the image, so that every path counts.
        assert_absolute(power, 1.0, 1e-12);
    }
}

#[test]
fn the_error_of_the_power_is_its_scatter_from_seed_to_seed() {
    let mut scene = plate();
    // A plate under one half of the spot, up to a plane that holds the axis of the beam.
    let along = scene.lasers[0]
        .description()
        .position
        .with_z(0.0)
        .normalize();
    let across = along.cross(DVec3::Z);
    let half = Rectangle::new(0.02 * across, 0.02 * across, 0.05 * along).unwrap();
    scene.surfaces[0].shape = Shape::Rectangle(half);
    let layers = traces(&scene, 4_096, 200);
    let powers = powers(&layers);
    let variances = layers.iter().map(|l| (l.power_error / POWER).powi(2));
    let stated = (variances.sum::<f64>() / layers.len() as f64).sqrt();
    let seen = Moments::from_samples(&powers).unwrap().standard_deviation();
    assert!(t_test_mean(&powers, 0.5).unwrap().p_value > SIGNIFICANCE);
    // Groups of equal size; standard deviations from 200 seeds are known to 5 %.
    assert_absolute(stated / seen, 1.0, 0.2);
}

#[test]
fn light_that_enters_glass_keeps_its_power() {
    const INDEX: f64 = 1.5;
    let mut scene = plate();
    // The plate lies in a block of glass whose face is square to the beam; so is the camera.
    let laser = scene.lasers[0].description();
    let mut face = scene.surfaces[0].clone();
    let (u, v) = laser.position.normalize().any_orthonormal_pair();
    let shape = Rectangle::new(0.7 * laser.position, 0.01 * u, 0.01 * v).unwrap();
    face.shape = Shape::Rectangle(shape);
    face.material = Material::dielectric(INDEX).unwrap();
    scene.surfaces.push(face);
    let powers = powers(&traces(&scene, 10_000, 20));
    // Fresnel at normal incidence. Radiance grows by n² in glass; power does not.
    let transmittance = 4.0 * INDEX / (INDEX + 1.0).powi(2);
    let p = t_test_mean(&powers, transmittance).unwrap().p_value;
    assert!(p > SIGNIFICANCE, "p = {p:e}: {powers:?}");
}

#[test]
fn threads_and_the_rest_of_the_image_change_no_bit() {
    let scene = plate();
    let image = trace(&scene, 20_000, 7);
    for threads in [1, 3] {
        let again = on_threads(threads, || trace(&scene, 20_000, 7));
        assert_eq!(again, image, "{threads} threads");
    }
    let area = Crop {
        x: 9,
        y: 5,
        width: 7,
        height: 4,
    };
    let part = try_trace(&scene, |tracer| tracer.area = area, [20_000, 7], false).unwrap();
    let pairs = [
        (&part.single, &image.single),
        (&part.variance, &image.variance),
    ];
    for (inside, outside) in pairs {
        for (index, value) in inside.values().iter().enumerate() {
            let at = (index / 7 + 5) * 24 + index % 7 + 9;
            let whole = outside.values()[at];
            assert_eq!(value.to_bits(), whole.to_bits(), "pixel {at}");
        }
    }
}

#[test]
fn a_cancelled_trace_stops() {
    let scene = plate();
    let cancelled = try_trace(&scene, |_| (), [1 << 40, 0], true);
    assert_eq!(cancelled, Err(RenderError::Cancelled));
}

#[test]
fn light_that_meets_a_rough_surface_first_is_left_to_the_path_tracer() {
    let mut scene = plate();
    assert!(!scene.has_specular_surfaces(), "a diffuse plate");
    let specular = |tracer: &mut LightTracer<'_>| tracer.selection = LightSelection::SpecularFirst;
    let dark = try_trace(&scene, specular, [1_000, 0], false).unwrap();
    assert!(dark.power_on_target <= 0.0, "{}", dark.power_on_target);
    scene.surfaces[0].material = Material::mirror(0.9).unwrap();
    assert!(scene.has_specular_surfaces(), "a mirror");
}

#[test]
fn mirrors_that_laser_and_camera_look_at_are_reported() {
    let mut scene = plate();
    let both = |scene: &Scene| has_specular_surfaces_on_both_sides(scene, 0).unwrap();
    assert!(!both(&scene), "a diffuse plate");
    scene.surfaces[0].material = Material::mirror(0.9).unwrap();
    assert!(both(&scene), "both look at the plate");
    // A diffuse screen before the mirror hides it from the camera, then from the laser.
    let screen = plate().surfaces.remove(0);
    for towards in [
        scene.camera.position(),
        scene.lasers[0].description().position,
    ] {
        let (u, v) = towards.normalize().any_orthonormal_pair();
        let shape = Rectangle::new(0.5 * towards, 0.02 * u, 0.02 * v).unwrap();
        let mut screened = scene.clone();
        screened.surfaces.push(screen.clone());
        screened.surfaces[1].shape = Shape::Rectangle(shape);
        assert!(!both(&screened), "a screen before {towards}");
    }
}

#[test]
fn groups_share_out_all_paths() {
    for paths in [0, 1, 2, 63, 64, 65, 1_000, 262_144, 262_145, 1_000_003] {
        let groups = Groups::new(paths);
        let sizes: Vec<_> = (0..groups.count).map(|index| groups.size(index)).collect();
        assert_eq!(sizes.iter().sum::<usize>() as u64, paths, "{groups:?}");
        let unequal = sizes.iter().max().zip(sizes.iter().min());
        assert!(unequal.is_none_or(|(a, b)| a - b <= 1), "{groups:?}");
        assert!(groups.count >= paths.min(64), "{groups:?}");
    }
}
