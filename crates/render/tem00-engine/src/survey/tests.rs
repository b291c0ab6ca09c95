//! A corner of two rough plates, whose multiple light is summed over the lit wall as the closed form.

use core::f64::consts::{PI, TAU};
use core::sync::atomic::AtomicBool;

use glam::{DVec2, DVec3};
use tem00_camera::Camera;
use tem00_coherence::{DelayedLight, LineShape, MixedLight, PathPairs, SpectralLine};
use tem00_decorrelation::pupil_overlap_correlation;
use tem00_tracer::{Frame, LaserDescription, Rotation, Trajectory};

use super::*;
use crate::{SpeckleModel, render_frame, testing};

const WAVELENGTH: f64 = 650e-9;

/// Plates at right angles: the floor, which the camera sees, and a wall, which a beam of the given waist radius lights
/// from the side.
fn corner(line: SpectralLine, waist_radius: f64) -> Scene {
    let aim = DVec3::new(0.0, 0.0, 15e-3);
    let position = DVec3::new(0.4, 0.0, 0.2);
    let laser = LaserDescription {
        line,
        look_at: aim,
        ..testing::spot(position, waist_radius)
    };
    let floor = testing::plate(DVec3::new(25e-3, 0.0, 0.0), DVec3::Z, [50e-3, 50e-3]);
    let mut wall = testing::plate(DVec3::new(0.0, 0.0, 25e-3), DVec3::X, [50e-3, 50e-3]);
    wall.name = "wall".into();
    let seen = DVec3::new(12e-3, 0.0, 0.0);
    let mut camera = testing::camera(seen + DVec3::new(0.1, 0.0, 0.28), [160, 120]);
    camera.look_at = seen;
    camera.focus_distance = (camera.position - seen).length();
    camera.pixel_pitch = 1.2e-6;
    camera.depth_of_field = false;
    let mut scene = testing::scene(camera, &[laser], floor);
    scene.surfaces.push(wall);
    // The closed form is that of one further surface.
    scene.render.max_depth = Some(2);
    scene
}

fn gaussian(linewidth: f64) -> SpectralLine {
    if linewidth == 0.0 {
        return SpectralLine::monochromatic(WAVELENGTH).unwrap();
    }
    SpectralLine::new(WAVELENGTH, linewidth, LineShape::Gaussian).unwrap()
}

fn render(scene: &Scene, frame: u32, seed: u64) -> Frame {
    let plan = SpecklePlan::new(scene, seed).unwrap();
    let model = SpeckleModel::generate(scene, &plan).unwrap();
    let options = RenderOptions {
        samples_per_pixel: 4,
        seed,
        ..scene.render
    };
    render_frame(
        scene,
        Some(&model),
        frame,
        &options,
        |_| (),
        &AtomicBool::new(false),
    )
    .unwrap()
}

/// The speckle factors of the frames of several seeds.
fn factors(scene: &Scene, frame: u32) -> Vec<f64> {
    // Some 5000 speckles: standard errors of variances and covariances are below 0.02.
    let frames = (0..6).map(|seed| render(scene, frame, seed));
    let layers = frames.flat_map(|frame| frame.lasers[0].speckle.values().to_vec());
    layers.map(f64::from).collect()
}

/// The covariance of factors, whose means are 1.
fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let products: f64 = a.iter().zip(b).map(|(a, b)| (a - 1.0) * (b - 1.0)).sum();
    products / a.len() as f64
}

/// The light of points all over the wall at a point of the floor: position, radiance and length of its way.
fn wall_light(scene: &Scene, floor: DVec3) -> Vec<(DVec3, f64, f64)> {
    const STEPS: i32 = 30;
    const SIDE: f64 = 50e-3;
    let laser = &scene.lasers[0];
    let centre = |index: i32| SIDE * ((f64::from(index) + 0.5) / f64::from(STEPS));
    let points =
        (0..STEPS).flat_map(|j| (0..STEPS).map(move |i| (centre(i) - 0.5 * SIDE, centre(j))));
    let light = points.filter_map(|(y, z)| {
        let point = DVec3::new(0.0, y, z);
        let lit = laser.next_event(point)?;
        let way = floor - point;
        let distance = way.length();
        let cosines = way.x * -way.z / distance.powi(2);
        let irradiance = lit.e_perp * lit.wi.x;
        let area = (SIDE / f64::from(STEPS)).powi(2);
        // Two reflectances of 0.8.
        let radiance = irradiance * (0.8 / PI).powi(2) * cosines / distance.powi(2) * area;
        Some((point, radiance, laser.path_to(point)? + distance))
    });
    light.collect()
}

/// What the law says of the light at a point of the floor.
fn law(scene: &Scene, floor: DVec3) -> MixedLight {
    let laser = &scene.lasers[0];
    let light = wall_light(scene, floor);
    let direct = laser.path_to(floor).unwrap();
    let single = laser
        .next_event(floor)
        .map_or(0.0, |lit| lit.e_perp * lit.wi.z * 0.8 / PI);
    let paths: Vec<_> = light
        .iter()
        .map(|&(_, weight, length)| DelayedLight {
            weight,
            delay: length - direct,
        })
        .collect();
    let mut pairs = PathPairs::default();
    pairs.add(laser.spectral_line(), &paths, &paths);
    let multiple: f64 = light.iter().map(|(_, radiance, _)| radiance).sum();
    let degree = scene.surfaces[0].speckle.polarisation;
    MixedLight {
        multiple: multiple / (multiple + single),
        with_single: pairs.coherence_with_single().unwrap(),
        within_multiple: pairs.self_coherence().unwrap(),
        polarisation: [degree, degree * degree],
        ..MixedLight::default()
    }
}

/// The mean of a function over points of the floor all over the image.
fn mean_over_image(camera: &Camera, f: impl Fn(DVec3) -> f64) -> f64 {
    let pixels = [[40.0, 30.0], [120.0, 30.0], [40.0, 90.0], [120.0, 90.0]];
    let values = pixels.map(|pixel| {
        let ray = camera.ray(pixel.into());
        f(ray.origin - ray.direction * (ray.origin.z / ray.direction.z))
    });
    values.iter().sum::<f64>() / 4.0
}

#[test]
fn contrasts_of_a_corner_are_those_of_the_law() {
    // The narrow beam lights the wall alone: all that is seen is multiple light.
    for (waist_radius, linewidth, polarisation) in [
        (3e-3, 0.1e-9, 1.0),
        (3e-3, 0.3e-9, 1.0),
        (20e-3, 0.0, 1.0),
        (20e-3, 0.02e-9, 1.0),
        (20e-3, 0.05e-9, 0.5),
    ] {
        let mut scene = corner(gaussian(linewidth), waist_radius);
        for surface in &mut scene.surfaces {
            surface.speckle.polarisation = polarisation;
        }
        let values = factors(&scene, 0);
        let found = covariance(&values, &values).sqrt();
        let law = mean_over_image(&scene.camera, |point| {
            law(&scene, point).contrast().unwrap()
        });
        assert!(
            (found - law).abs() < 0.03,
            "{waist_radius} m, {linewidth:e} m, {polarisation}: {found} for {law}"
        );
    }
}

#[test]
fn frames_of_a_survey_have_the_same_bits_for_any_number_of_threads() {
    let scene = corner(gaussian(0.1e-9), 20e-3);
    let render_on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| render(&scene, 0, 3))
    };
    assert_eq!(render_on(1), render_on(3), "one thread and three");
}

#[test]
fn a_small_spot_on_the_wall_makes_speckle_of_speckle() {
    for waist_radius in [0.05e-3, 0.15e-3] {
        let scene = corner(gaussian(0.0), waist_radius);
        let floor = DVec3::new(12e-3, 0.0, 0.0);
        let to_pupil = scene.camera.position() - floor;
        let sin_aperture = 0.5 * scene.camera.pupil_diameter() / to_pupil.length();
        let l = to_pupil.normalize();
        // The spot on the wall, in steps of a quarter of its radius, as directions across the line of sight.
        let axis = || (-8..=8).map(|i| 0.25 * f64::from(i) * waist_radius);
        let spot: Vec<_> = axis()
            .flat_map(|y| axis().map(move |z| DVec3::new(0.0, y, 15e-3 + z)))
            .filter_map(|wall| {
                let lit = scene.lasers[0].next_event(wall)?;
                let direction = (wall - floor).normalize();
                let across = direction - direction.dot(l) / l.z * DVec3::Z;
                Some((across / (2.0 * sin_aperture), lit.e_perp))
            })
            .collect();
        let (mut sum, mut whole) = (0.0, 0.0);
        for (a, first) in &spot {
            for (b, second) in &spot {
                sum += first * second * pupil_overlap_correlation(a.distance(*b));
                whole += first * second;
            }
        }
        let law = (1.0 + 2.0 * sum / whole).sqrt();
        let notes = cascade_notes(&scene).unwrap();
        let [note] = notes.as_slice() else {
            panic!("{notes:?}")
        };
        assert_eq!((note.surface.as_str(), note.laser), ("plate", 0));
        // The note has the place where it is highest, of an image that is small against its distance from the wall.
        assert!((note.contrast - law).abs() < 0.05, "{note} for {law}");
    }
    let wide = corner(gaussian(0.0), 20e-3);
    assert_eq!(cascade_notes(&wide).unwrap(), []);
}

#[test]
fn light_from_a_wall_forgets_a_turn_faster_than_light_from_the_laser() {
    for angle in [50e-6, 100e-6] {
        let mut scene = corner(gaussian(0.0), 3e-3);
        let turn = Rotation {
            axis: DVec3::Y,
            angle,
        };
        let trajectory = Trajectory::turning(DVec3::ZERO, turn, DVec3::ZERO).unwrap();
        for surface in &mut scene.surfaces {
            surface.trajectory = trajectory.clone();
        }
        scene.frames = 2;
        let [before, after] = [0, 1].map(|frame| factors(&scene, frame));
        let found = covariance(&before, &after);
        let law = mean_over_image(&scene.camera, |point| {
            let laser = &scene.lasers[0];
            let pose = trajectory.pose_at(1);
            let (mut sum, mut whole) = (DVec2::ZERO, 0.0);
            for (wall, radiance, _) in wall_light(&scene, point) {
                let moved = laser.path_to(pose.point(wall)).unwrap();
                let change = moved - laser.path_to(wall).unwrap();
                sum += radiance * DVec2::from_angle(TAU / WAVELENGTH * change);
                whole += radiance;
            }
            (sum / whole).length_squared()
        });
        // The turn of the floor itself, as the camera sees it, leaves above 0.97.
        assert!((found - law).abs() < 0.05, "{angle} rad: {found} for {law}");
    }
}
