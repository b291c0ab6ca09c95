//! Scenes that several tests share.

use glam::DVec3;
use tem00_camera::{Camera, CameraDescription};
use tem00_geometry::{Rectangle, Shape};
use tem00_tracer::{BeamShape, Laser, LaserDescription, Material, Scene, Spectrum, Surface};

use crate::{SpeckleModel, SpecklePlan};

/// A camera of 25 mm at f/8 that looks at the origin, in focus there.
pub(crate) fn camera(position: DVec3, resolution: [usize; 2]) -> CameraDescription {
    CameraDescription {
        position,
        focus_distance: position.length(),
        resolution,
        ..CameraDescription::default()
    }
}

/// A round spot of 650 nm and 1 mW whose waist lies at the origin, where it is aimed at.
pub(crate) fn spot(position: DVec3, waist_radius: f64) -> LaserDescription {
    LaserDescription {
        spectrum: Spectrum::monochromatic(650e-9).unwrap(),
        power: 1e-3,
        position,
        look_at: DVec3::ZERO,
        line_direction: DVec3::X,
        shape: BeamShape::Spot {
            waist_radius: [waist_radius; 2],
            waist_distance: [position.length(); 2],
            m_squared: [1.0; 2],
        },
    }
}

/// A diffuse plate of two edge lengths that faces along a normal.
pub(crate) fn plate(centre: DVec3, normal: DVec3, size: [f64; 2]) -> Surface {
    let right = DVec3::Y.cross(normal).normalize();
    let up = normal.cross(right).normalize();
    let rectangle = Rectangle::new(centre, 0.5 * size[0] * right, 0.5 * size[1] * up).unwrap();
    Surface::new(
        "plate",
        Shape::Rectangle(rectangle),
        Material::lambertian(0.8).unwrap(),
    )
}

/// The speckle of a scene, of patterns by a seed.
pub(crate) fn speckle(scene: &Scene, seed: u64) -> SpeckleModel {
    let plan = SpecklePlan::new(scene, seed).unwrap();
    SpeckleModel::generate(scene, &plan).unwrap()
}

/// A scene of one plate in one frame.
pub(crate) fn scene(
    camera: CameraDescription,
    lasers: &[LaserDescription],
    plate: Surface,
) -> Scene {
    let lasers = lasers
        .iter()
        .map(|laser| Laser::new(laser.clone()).unwrap());
    Scene {
        lasers: lasers.collect(),
        surfaces: vec![plate],
        ..Scene::new(Camera::new(camera).unwrap())
    }
}
