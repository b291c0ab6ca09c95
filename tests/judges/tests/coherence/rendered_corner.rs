//! A rendered corner: contrasts and frames against the law, over sums of the light of the wall.

use core::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use tem00::camera::{Camera, CameraDescription, RadialDistortion, SensorTilt};
use tem00::coherence::{
    CellGeometry, DelayedLight, MixedLight, PathPairs, PeakShape, PolychromaticSpeckle,
    ResolutionCell, Spectrum,
};
use tem00::decorrelation::pupil_overlap_correlation;
use tem00::engine::{FollowedPoint, SpeckleChange};
use tem00::geometry::{Rectangle, Shape};
use tem00::tracer::{
    BeamShape, Laser, LaserDescription, Material, RenderOptions, Rotation, Scene, Surface,
    Trajectory,
};

use crate::renders;

const WAVELENGTH: f64 = 450e-9;
const DISTANCE: f64 = 0.2;
/// The reflectances of the floor and the wall.
const FLOOR: f64 = 0.5;
const WALL: f64 = 0.9;
/// The middle of what is seen, half a millimetre from the edge.
const SEEN: DVec3 = DVec3::new(0.5e-3, 0.0, 0.0);

/// Directions to the laser and to the camera, 50° and 40° from the normal of the floor on the side
/// of the wall.
fn directions() -> [DVec3; 2] {
    [50.0_f64, 40.0].map(|angle| {
        let (sin, cos) = angle.to_radians().sin_cos();
        DVec3::new(sin, 0.0, cos)
    })
}

/// A lens of f/5 whose pupil fills sin u = 0.025, in front of a floor with a wall of 0.7 by 0.7 mm²
/// beside it, in collimated light.
fn corner(line: Spectrum, polarisation: f64) -> Scene {
    let [to_source, to_camera] = directions();
    let camera = Camera::new(CameraDescription {
        position: SEEN + DISTANCE * to_camera,
        look_at: SEEN,
        up: DVec3::Y,
        focal_length: 50e-3,
        f_number: 5.0,
        focus_distance: DISTANCE,
        pixel_pitch: 1e-6,
        resolution: [26, 200],
        principal_point: None,
        tilt: SensorTilt::default(),
        distortion: RadialDistortion::default(),
        depth_of_field: false,
    });
    let laser = Laser::new(LaserDescription {
        spectrum: line,
        power: 1e-3,
        position: SEEN + 0.5 * to_source,
        look_at: SEEN,
        line_direction: DVec3::Y,
        shape: BeamShape::Spot {
            waist_radius: [50e-3; 2],
            waist_distance: [0.5; 2],
            m_squared: [1.0; 2],
        },
    });
    let plate = |name: &str, centre: DVec3, edges: [DVec3; 2], reflectance: f64| {
        let shape = Rectangle::new(centre, edges[0], edges[1]).expect("a rectangle");
        let material = Material::lambertian(reflectance).expect("a material");
        let mut plate = Surface::new(name, Shape::Rectangle(shape), material);
        plate.speckle.polarisation = polarisation;
        plate
    };
    let mut scene = Scene::new(camera.expect("a camera"));
    scene.lasers.push(laser.expect("a laser"));
    let edges = [0.4e-3 * DVec3::X, 0.5e-3 * DVec3::Y];
    scene.surfaces.push(plate("floor", SEEN, edges, FLOOR));
    let edges = [0.35e-3 * DVec3::Y, 0.35e-3 * DVec3::Z];
    let centre = DVec3::new(0.0, 0.0, 0.4e-3);
    scene.surfaces.push(plate("wall", centre, edges, WALL));
    // Of each path the closed forms know one wall.
    scene.render.max_depth = Some(2);
    scene
}

/// The speckle factors of a frame, of many seeds.
fn factors(scene: &Scene, frame: u32) -> Vec<f64> {
    const SEEDS: u64 = 32;
    let of_seed = |seed: u64| {
        let options = RenderOptions {
            // Each draws a wave number.
            samples_per_pixel: 16,
            seed,
            ..scene.render
        };
        let frame = renders::frame(scene, Some(&renders::speckle(scene, seed)), frame, &options);
        frame.lasers[0].speckle.values().to_vec()
    };
    (0..SEEDS).flat_map(of_seed).map(f64::from).collect()
}

/// The covariance of factors of the mean 1.
fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let products: f64 = a.iter().zip(b).map(|(a, b)| (a - 1.0) * (b - 1.0)).sum();
    products / a.len() as f64
}

/// Places all over the image, of which the wall is longer by a little only: less of its light
/// reaches the ends.
fn seen() -> [DVec3; 6] {
    [-0.25e-3, -0.15e-3, -0.05e-3, 0.05e-3, 0.15e-3, 0.25e-3].map(|y| SEEN + y * DVec3::Y)
}

/// The mean over the image.
fn mean(of_place: impl Fn(DVec3) -> f64) -> f64 {
    seen().map(of_place).iter().sum::<f64>() / 6.0
}

/// Points of the wall, each with the light that it sends to a place of the floor, over the single
/// light there.
fn wall(seen: DVec3) -> Vec<(DVec3, f64)> {
    const STEPS: i32 = 40;
    const SIDE: f64 = 0.7e-3;
    let [to_source, _] = directions();
    let middle = |index: i32| SIDE * (f64::from(index) + 0.5) / f64::from(STEPS);
    let points = (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (middle(i), middle(j))));
    let area = (SIDE / f64::from(STEPS)).powi(2);
    points
        .map(|(y, z)| {
            let point = DVec3::new(0.0, y - 0.5 * SIDE, 0.05e-3 + z);
            let way = seen - point;
            let cosines = way.x * -way.z / way.length_squared();
            let form = WALL / PI * cosines / way.length_squared() * area;
            (point, form * to_source.x / to_source.z)
        })
        .collect()
}

/// The law of the light at a place.
fn law(line: &Spectrum, polarisation: f64, seen: DVec3) -> MixedLight {
    let [to_source, to_pupil] = directions();
    let paths: Vec<_> = wall(seen)
        .into_iter()
        .map(|(point, weight)| DelayedLight {
            weight,
            delay: (seen - point).length() - to_source.dot(point - seen),
        })
        .collect();
    let mut pairs = PathPairs::default();
    pairs.add(line, &paths, &paths);
    let ratio: f64 = paths.iter().map(|path| path.weight).sum();
    let cell = ResolutionCell::new(CellGeometry {
        to_source,
        to_pupil,
        normal: DVec3::Z,
        sin_aperture: 0.025,
        wavelength: WAVELENGTH,
    });
    let cell = cell.expect("a cell");
    let of_cell = PolychromaticSpeckle {
        spectrum: line,
        cell: &cell,
    }
    .contrast()
    .powi(2);
    MixedLight {
        multiple: ratio / (1.0 + ratio),
        within_single: of_cell,
        with_single: of_cell * pairs.coherence_with_single().expect("light"),
        within_multiple: of_cell * pairs.self_coherence().expect("light"),
        polarisation: [polarisation, polarisation * polarisation],
    }
}

fn line(linewidth: f64) -> Spectrum {
    let line = match linewidth {
        0.0 => Spectrum::monochromatic(WAVELENGTH),
        _ => Spectrum::new(WAVELENGTH, linewidth, PeakShape::Gaussian),
    };
    line.expect("a line")
}

/// Over the contrast in light of one wavelength, from which pixels of a third of a speckle take 3
/// %. Patterns are the same, so that the ratio of some 14 000 speckles scatters by 0.01.
#[test]
fn a_rendered_corner_has_the_contrast_of_its_linewidth() {
    let linewidths = [0.1e-9, 0.05e-9, 0.2e-9, 0.8e-9];
    // The waves judge the law of depolarised light at all of them.
    for (polarisation, linewidths) in [(1.0, &linewidths[..]), (0.0, &linewidths[..1])] {
        let contrast = |linewidth: f64| {
            let factors = factors(&corner(line(linewidth), polarisation), 0);
            covariance(&factors, &factors).sqrt()
        };
        let law = |linewidth| {
            let line = line(linewidth);
            let contrast = |seen| law(&line, polarisation, seen).contrast();
            mean(|seen| contrast(seen).expect("a contrast"))
        };
        let whole = contrast(0.0);
        assert!((whole / law(0.0) - 0.97).abs() < 0.02, "{whole}");
        for &linewidth in linewidths {
            let (found, law) = (contrast(linewidth) / whole, law(linewidth) / law(0.0));
            assert!(
                (found / law - 1.0).abs() < 0.015,
                "{linewidth:e} m, {polarisation}: {found} for {law}"
            );
        }
    }
}

#[test]
fn frames_of_a_rendered_corner_correlate_as_its_light_does() {
    for angle in [0.3e-3, 3e-3] {
        let mut scene = corner(line(0.0), 1.0);
        scene.frames = 2;
        let turn = Rotation {
            axis: DVec3::Y,
            angle,
        };
        let trajectory = Trajectory::turning(DVec3::ZERO, turn, DVec3::ZERO).expect("a turn");
        for surface in &mut scene.surfaces {
            surface.trajectory = trajectory.clone();
        }
        let [before, after] = [0, 1].map(|frame| factors(&scene, frame));
        let found = covariance(&before, &after) / covariance(&before, &before);
        // Of the single light by itself.
        let point = FollowedPoint {
            surface: 0,
            position: SEEN,
            normal: DVec3::Z,
        };
        let single = SpeckleChange::between(&scene, 0, &point, [0, 1]).expect("a change");
        // The turn of the floor for light that turns with it, and what the wall adds to the phase.
        let multiple = pupil_overlap_correlation(DISTANCE * angle / 10e-3).sqrt();
        let (to_source, pose) = (directions()[0], trajectory.pose_at(1));
        let change = |point: DVec3| -to_source.dot(pose.point(point) - point);
        let law = mean(|seen| {
            let (mut phases, mut ratio) = (DVec2::ZERO, 0.0);
            for (point, weight) in wall(seen) {
                let phase = TAU / WAVELENGTH * (change(point) - change(seen));
                phases += weight * DVec2::from_angle(phase);
                ratio += weight;
            }
            let field = single.correlation.sqrt() * DVec2::X + multiple * phases;
            field.length_squared() / (1.0 + ratio).powi(2)
        });
        // The standard error of some 14 000 speckles is 0.012.
        assert!((found - law).abs() < 0.04, "{angle} rad: {found} for {law}");
    }
}
