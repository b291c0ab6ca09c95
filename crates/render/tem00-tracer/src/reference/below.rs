//! Light of a laser that enters a body beside the point where the camera sees it.

use glam::{DVec2, DVec3};
use tem00_camera::Ray;
use tem00_geometry::Hit;

use super::{Path, Point, Random, Reference};
use crate::film::LaserSample;

impl Reference<'_> {
    /// Connects the first rough point of a path to every laser through the body below it.
    pub(super) fn connect_below(
        &self,
        path: &mut Path,
        point: &Point<'_>,
        random: &mut Random,
        lasers: &mut [LaserSample],
    ) {
        if path.rough > 0 || point.material.below().is_none() || !self.finds_lasers() {
            return;
        }
        for (index, laser) in self.lasers.iter().enumerate() {
            let position = point.hit.position;
            let Some(wi) = point.towards(laser.wave_direction_at(position)) else {
                continue;
            };
            // A path below the surface, and the place of one of its collisions.
            let place = |offset: DVec3| position + point.axes.to_world(offset);
            let irradiance = |offset| laser.next_event(place(offset)).map_or(0.0, |e| e.e_perp);
            let seed = random.number().to_bits();
            let distance = laser.distance_beside(position);
            let directions = [point.back, wi];
            let entry = point.material.entry(directions, distance, seed, irradiance);
            let Some((offset, radiance)) = entry else {
                continue;
            };
            let (Some(entered), Some(event)) = (
                self.surface_beside(point, offset),
                laser.next_event(place(offset)),
            ) else {
                continue;
            };
            path.rays += 2;
            if self
                .intersector
                .visible(entered.position, entered.normal, event.point)
            {
                lasers[index].add_below(path.throughput[index] * radiance);
            }
        }
    }

    /// Returns the speckle factor of the light from below a point, as [`factor`](Self::factor) does
    /// for the boundary.
    pub(super) fn factor_below(
        &self,
        laser: usize,
        surface: usize,
        (pixel, position, normal): (DVec2, DVec3, DVec3),
    ) -> f64 {
        let frame = (&self.below[laser][surface], &self.speckle[laser][surface]);
        let (Some(below), Some(frame)) = frame else {
            return 1.0;
        };
        below.factor(frame.factor_at(below.pixel(pixel), position, normal))
    }

    /// Returns where the surface itself lies at an offset along its tangent plane, unless it ends
    /// before.
    fn surface_beside(&self, point: &Point<'_>, offset: DVec3) -> Option<Hit> {
        let height = 0.5 * offset.length();
        let normal = point.seen_normal();
        let above = point.hit.position + point.axes.to_world(offset) + height * normal;
        let hit = self.intersector.intersect(&Ray {
            origin: self.intersector.leave(above, normal),
            direction: -normal,
        })?;
        let is_same = hit.surface == point.hit.surface && hit.distance < 2.0 * height;
        is_same.then_some(hit)
    }
}
