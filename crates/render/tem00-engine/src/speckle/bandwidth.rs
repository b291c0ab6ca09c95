//! The light of each laser on each surface, from the points that the camera sees.

use core::iter;

use glam::DVec2;
use tem00_geometry::Intersector;
use tem00_numerics::parallel;
use tem00_shading::SurfaceLight;
use tem00_tracer::{Laser, Scene, TracerError};

use super::{
    SpecklePoint,
    change::{Change, moves},
    prescan::{LaserGroups, RAYS_PER_SIDE, first_ray, pixels_of, rays_per_side},
};

/// Follows rays of the reference frame to the surfaces that the camera sees, and returns the light
/// of each laser on each surface. Rays of other frames find the surfaces that are not seen there.
pub(super) fn laser_lights(
    scene: &Scene,
    laser_groups: LaserGroups<'_>,
) -> Result<Vec<Vec<SurfaceLight>>, TracerError> {
    let mut lights = vec![vec![None; scene.surfaces.len()]; scene.lasers.len()];
    let others = if moves(scene) { 0..scene.frames } else { 0..0 };
    let frames = iter::once(scene.reference_frame).chain(others);
    let are_coherent = scene.lasers.iter().all(Laser::is_coherent);
    for frame in frames.take_while(|_| !are_coherent) {
        if lights.iter().flatten().all(Option::is_some) {
            break;
        }
        let change = Change::new(scene, frame);
        let points = points_seen(scene, &change, frame)?;
        parallel::for_each_chunk(&mut lights, 1, |laser, lights| {
            let law = change.spectral_law(laser, &laser_groups.geometries[laser]);
            for (surface, light) in lights[0].iter_mut().enumerate() {
                let points = points.iter().filter(|point| point.surface == surface);
                let relief = scene.surfaces[surface].relief;
                *light = light
                    .take()
                    .or_else(|| law.light(points.map(SpecklePoint::seen), relief));
            }
        });
    }
    let known = |light: Option<SurfaceLight>| light.unwrap_or_else(SurfaceLight::single);
    let lights = lights.into_iter();
    Ok(lights
        .map(|lights| lights.into_iter().map(known).collect())
        .collect())
}

/// The points that the camera sees.
fn points_seen(
    scene: &Scene,
    change: &Change,
    frame: u32,
) -> Result<Vec<SpecklePoint>, TracerError> {
    let intersector = Intersector::build(&scene.shapes_at(frame))?;
    let side = match frame == scene.reference_frame {
        true => RAYS_PER_SIDE,
        false => rays_per_side(scene.frames),
    };
    let point = |pixel: DVec2| {
        let hit = intersector.intersect(&change.camera().ray(pixel))?;
        Some(SpecklePoint::of_hit(pixel, &hit))
    };
    let pixels = pixels_of(change.camera(), side, first_ray(change, side));
    Ok(pixels.filter_map(point).collect())
}

#[cfg(test)]
mod tests;
