use glam::DVec2;
use tem00_camera::Ray;
use tem00_geometry::Intersector;
use tem00_tracer::{Scene, TracerError};

use crate::sampler::even;

/// The number of image points along each side of the search grid.
const SIDE: u32 = 64;
/// The number of rays of each laser that are followed to their first surface.
const RAYS: u32 = 256;

/// Returns whether, in `frame`, both a laser and the camera face a mirror or smooth glass.
///
/// Light that meets such objects on both sides of a rough surface, between laser and surface and
/// between surface and camera, is found neither by paths from the camera nor by paths from the
/// lasers: it is missing from the image, unless the lasers are
/// [sampled](tem00_tracer::LaserEvents::Sampled) and so wide that rays meet them by chance. The
/// search covers a grid of 64 × 64 image points and 256 rays of each laser, up to their first
/// surface.
///
/// # Errors
///
/// Returns an error if the geometry cannot be built.
pub fn has_specular_surfaces_on_both_sides(scene: &Scene, frame: u32) -> Result<bool, TracerError> {
    if !scene.has_specular_surfaces() {
        return Ok(false);
    }
    let intersector = Intersector::build(&scene.shapes_at(frame))?;
    let is_specular = |ray: Ray| {
        let hit = intersector.intersect(&ray);
        hit.and_then(|hit| scene.surfaces.get(hit.surface))
            .is_some_and(|surface| surface.material.is_specular())
    };
    let lasers = scene.lasers.iter().map(|laser| laser.in_frame(frame));
    let mut emitted =
        lasers.flat_map(|laser| (0..RAYS).map(move |i| laser.sample_ray(even(i)).ray));
    let camera = scene.camera_at(frame);
    let size = DVec2::new(camera.width() as f64, camera.height() as f64);
    let grid = (0..SIDE * SIDE).map(|i| DVec2::new(f64::from(i % SIDE), f64::from(i / SIDE)));
    let mut seen = grid.map(|cell| camera.ray((cell + 0.5) / f64::from(SIDE) * size));
    Ok(emitted.any(is_specular) && seen.any(is_specular))
}
