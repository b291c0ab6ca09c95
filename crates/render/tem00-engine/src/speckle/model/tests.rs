use glam::DVec3;
use tem00_tracer::{LaserDescription, Spectrum, Surface, SurfaceSpeckle, Trajectory};

use super::*;
use crate::testing;

/// Two plates that move apart under two lasers, one of them with a sum of patterns.
fn scene() -> Scene {
    let red = testing::spot(DVec3::new(0.1, 0.0, 0.25), 2e-3);
    let green = LaserDescription {
        spectrum: Spectrum::monochromatic(532e-9).unwrap(),
        position: DVec3::new(-0.1, 0.0, 0.25),
        ..red.clone()
    };
    let plate = |z: f64, displacement: DVec3| Surface {
        trajectory: Trajectory::steady(displacement).unwrap(),
        ..testing::plate(z * DVec3::Z, DVec3::Z, [0.02, 0.02])
    };
    let camera = testing::camera(0.3 * DVec3::Z, [64, 48]);
    let mut scene = testing::scene(camera, &[red, green], plate(0.0, 0.1e-3 * DVec3::X));
    scene.surfaces.push(plate(1e-3, 0.2e-3 * DVec3::Y));
    scene.frames = 4;
    scene.reference_frame = 1;
    scene.surfaces[1].speckle = SurfaceSpeckle {
        patterns: 2,
        polarisation: 0.5,
    };
    scene
}

fn model(scene: &Scene) -> SpeckleModel {
    testing::speckle(scene, 7)
}

/// Points all over the image, on either plate by turns that get longer.
fn points(scene: &Scene, count: u32) -> Vec<SpecklePoint> {
    (0..count)
        .map(|i| {
            let (x, y) = (f64::from(i * 37 % 101), f64::from(i * 53 % 89));
            let surface = usize::from(f64::from(i).sqrt().fract() < 0.5);
            let position = DVec3::new(1e-5 * x, 1e-5 * y, 1e-3 * surface as f64);
            SpecklePoint {
                pixel: scene.camera.project(position).unwrap(),
                position,
                normal: DVec3::Z,
                surface,
                wave: 0.5,
            }
        })
        .collect()
}

#[test]
fn many_points_have_the_bits_of_one_by_one() {
    let scene = scene();
    let model = model(&scene);
    let points = points(&scene, 1000);
    for frame in 0..4 {
        let speckle = model.in_frame(&scene, frame).unwrap();
        for laser in 0..2 {
            let mut factors = vec![f64::NAN; points.len()];
            speckle.factors(laser, &points, &vec![0.0; points.len()], &mut factors);
            for (point, factor) in points.iter().zip(&factors) {
                let alone = speckle.factor(laser, point);
                assert_eq!(alone.to_bits(), factor.to_bits(), "{frame}: {point:?}");
                assert!(alone >= 0.0 && alone.is_finite(), "{alone}: {point:?}");
            }
        }
    }
}

#[test]
fn the_reference_frame_needs_no_motion() {
    let mut scene = scene();
    let model = model(&scene);
    let moving = model.in_frame(&scene, 1).unwrap();
    for surface in &mut scene.surfaces {
        surface.trajectory = Trajectory::default();
    }
    let still = model.in_frame(&scene, 1).unwrap();
    for point in points(&scene, 200) {
        let pair = [&moving, &still].map(|frame| frame.factor(0, &point).to_bits());
        assert_eq!(pair[0], pair[1], "{point:?}");
    }
}

#[test]
fn extreme_points_have_finite_factors() {
    let scene = scene();
    let model = model(&scene);
    let speckle = model.in_frame(&scene, 3).unwrap();
    for far in [0.0, 0.3, 0.3 + 1e-15, 1e3, 1e9] {
        for direction in [DVec3::Z, DVec3::X, -DVec3::Z, DVec3::new(1.0, 1.0, 0.3)] {
            for normal in [DVec3::Z, DVec3::X, DVec3::new(0.0, 1.0, 1e-12)] {
                let point = SpecklePoint {
                    pixel: DVec2::new(1e3, -2e3),
                    position: far * direction,
                    normal,
                    surface: 1,
                    wave: 0.5,
                };
                let factor = speckle.factor(0, &point);
                assert!(factor.is_finite() && factor >= 0.0, "{factor}: {point:?}");
            }
        }
    }
}
