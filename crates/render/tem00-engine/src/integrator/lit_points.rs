//! Light of lasers over one rough surface to another, found by connecting the second to a point
//! that a laser lights.
//!
//! A direction drawn from a rough surface seldom meets a thin line of light on another; a point
//! drawn where a laser lights a surface always lies on it. Both estimates are weighted by how
//! likely each is to draw the same path.

use core::iter;

use glam::{DVec3, UVec3};
use tem00_camera::Ray;
use tem00_geometry::{Hit, Intersector};
use tem00_numerics::cast::to_usize;
use tem00_shading::LaserEvent;
use tem00_tracer::{Laser, Material, Scene};

use super::weights::power_heuristic;
use crate::{
    sampler::{DrawKey, Draws},
    vertex::Vertex,
};

/// Points of a frame that a laser lights.
#[derive(Debug)]
pub(super) struct LitPoints<'a> {
    points: Vec<LitPoint<'a>>,
    /// The fraction of the drawn rays that have met one.
    share: f64,
}

/// Point where the light of a laser first meets a rough surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct LitPoint<'a> {
    pub(super) hit: Hit,
    material: &'a Material,
    light: LaserEvent,
    /// The density with which points are drawn there, per square metre.
    density: f64,
}

impl<'a> LitPoints<'a> {
    /// Draws points by the power of a laser as it stands in the frame: several for each sample of a
    /// pixel, since all pixels share them.
    pub(super) fn new(
        scene: &'a Scene,
        laser: &Laser,
        key: DrawKey,
        intersector: &Intersector,
        samples: u32,
    ) -> Self {
        let rays = samples.saturating_mul(8).clamp(1 << 10, 1 << 16);
        let rays = rays.next_power_of_two();
        let points = first_hits(laser, rays as usize, Draws::new(key), intersector);
        let points = points.filter_map(|hit| {
            let material = &scene.surfaces.get(hit.surface)?.material;
            let light = laser.next_event(hit.position)?;
            let density = density(laser, &light, hit.normal);
            (!material.is_specular() && density > 0.0).then_some(LitPoint {
                hit,
                material,
                light,
                density,
            })
        });
        let mut points: Vec<_> = points.collect();
        order_along_curve(&mut points);
        let share = points.len() as f64 / f64::from(rays);
        Self { points, share }
    }

    /// Chooses a point by a number in [0, 1), with the fraction of the drawn rays that have met
    /// one.
    pub(super) fn choose(&self, u: f64) -> Option<(&LitPoint<'a>, f64)> {
        let point = self.points.get(to_usize(u * self.points.len() as f64))?;
        Some((point, self.share))
    }
}

/// Returns where rays that are drawn from a laser first meet surfaces.
fn first_hits(
    laser: &Laser,
    rays: usize,
    mut draws: Draws,
    intersector: &Intersector,
) -> impl Iterator<Item = Hit> {
    let rays: Vec<_> = iter::repeat_with(|| laser.sample_ray(draws.start()).ray)
        .map(|ray| intersector.ray_from(ray.origin, ray.direction, ray.direction))
        .take(rays)
        .collect();
    let mut hits = vec![None; rays.len()];
    intersector.intersect_batch(&rays, &mut hits);
    hits.into_iter().flatten()
}

/// Orders points along Morton's curve: where numbers are spread evenly, so are the points that they
/// choose.
fn order_along_curve(points: &mut [LitPoint<'_>]) {
    const CELLS: f64 = (1 << 16) as f64 - 1.0;
    let positions = || points.iter().map(|point| point.hit.position);
    let low = positions().fold(DVec3::INFINITY, DVec3::min);
    let high = positions().fold(DVec3::NEG_INFINITY, DVec3::max);
    let scale = CELLS / (high - low).max_element().max(f64::MIN_POSITIVE);
    points.sort_by_cached_key(|point| {
        let cell = (scale * (point.hit.position - low)).as_uvec3();
        (0..16_u32).fold(0_u64, |key, bit| {
            let digit: UVec3 = (cell >> bit) & UVec3::ONE;
            key | (u64::from(digit.x | digit.y << 1 | digit.z << 2) << (3 * bit))
        })
    });
}

/// Returns the density of points that are drawn by the power of a laser, on a surface of this
/// normal, per square metre.
pub(super) fn density(laser: &Laser, light: &LaserEvent, normal: DVec3) -> f64 {
    light.e_perp * light.wi.dot(normal).abs() / laser.power()
}

impl<'a> LitPoint<'a> {
    /// Returns the weighted radiance that comes from the point over a vertex, by the density of
    /// points, if nothing lies between them.
    pub(super) fn radiance_over(&self, vertex: &Vertex<'a>, wavelength: f64) -> Option<f64> {
        let offset = self.hit.position - vertex.hit.position;
        let distance = offset.length();
        let direction = offset / distance;
        let wi = vertex.towards(direction)?;
        let ray = Ray {
            origin: vertex.hit.position,
            direction,
        };
        let hit = Hit {
            distance,
            ..self.hit
        };
        let lit = Vertex::seen(&ray, &hit, self.material)?;
        // Points of one plane send each other nothing but rounding errors.
        if (wi.z * lit.cosine).abs() < 1e-12 {
            return None;
        }
        let from_laser = lit.towards(self.light.wi)?;
        let sent = self.light.e_perp * lit.reflected(from_laser, wavelength);
        if sent <= 0.0 {
            return None;
        }
        let weight = power_heuristic(self.density, lit.area_pdf(vertex.pdf(wi)));
        let solid_angle = lit.area_pdf(1.0) / self.density;
        Some(weight * sent * solid_angle * vertex.reflected(wi, wavelength))
    }
}
