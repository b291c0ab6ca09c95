//! Lights that are no lasers: white, incoherent, without speckle.

use tem00_camera::Ray;
use tem00_geometry::Hit;

use super::{Path, Point, Random, Reference, WHITE, power_heuristic};
use crate::{Light, LightEvents};

/// A distance beyond all shapes, in metres.
const BEYOND: f64 = 1e10;

impl Reference<'_> {
    /// Returns the radiance of lights that a rough point finds by a drawn point of each.
    pub(super) fn light_connected(
        &self,
        path: &mut Path,
        point: &Point<'_>,
        random: &mut Random,
    ) -> f64 {
        let mut sum = 0.0;
        for light in &self.scene.lights {
            let by_chance = self.options.light_events == LightEvents::Scattering;
            if by_chance && !matches!(light, Light::Point { .. }) {
                continue;
            }
            let position = point.hit.position;
            let Some(drawn) = light.sample(position, random.pair()) else {
                continue;
            };
            let Some(wi) = point.towards(drawn.direction) else {
                continue;
            };
            let distance = drawn.distance.min(BEYOND);
            let end = position + distance * drawn.direction;
            path.rays += 1;
            if !self.intersector.visible(position, point.hit.normal, end) {
                continue;
            }
            let weight = match (drawn.pdf, self.options.light_events) {
                (Some(pdf), LightEvents::Both) => power_heuristic(pdf, point.pdf(wi)),
                _ => 1.0,
            };
            sum += weight * drawn.radiance_over_pdf * point.reflected(wi, WHITE);
        }
        sum * path.throughput[self.lasers.len()]
    }

    /// Returns the radiance of the light that a ray meets, or of the environment if it meets
    /// nothing.
    pub(super) fn lights_met(&self, path: &Path, hit: Option<&Hit>) -> f64 {
        let lights = self.scene.lights.iter();
        let areas = lights
            .clone()
            .filter(|light| matches!(light, Light::Area { .. }));
        let met: Vec<_> = match hit {
            None => lights
                .filter(|light| matches!(light, Light::Environment(_)))
                .collect(),
            Some(hit) => {
                let first = self.scene.surfaces.len();
                let shapes = areas.zip(first..);
                let met = shapes.filter(|(_, shape)| *shape == hit.surface);
                met.map(|(light, _)| light).collect()
            }
        };
        let Ray { origin, direction } = path.ray;
        let weighted = met.into_iter().map(|light| {
            let weight = match (path.pdf, self.options.light_events) {
                (None, _) | (_, LightEvents::Scattering) => 1.0,
                (Some(_), LightEvents::NextEvent) => 0.0,
                (Some(pdf), LightEvents::Both) => {
                    power_heuristic(pdf, light.pdf(origin, direction))
                }
            };
            weight * light.radiance_along(direction)
        });
        weighted.sum::<f64>() * path.throughput[self.lasers.len()]
    }
}
