use tem00_camera::Ray;
use tem00_geometry::Hit;
use tem00_tracer::{Light, LightEvents, WHITE_LIGHT_WAVELENGTH};

use super::{
    Integrator,
    batch::{Arrival, Batch, Path},
    weights::{power_heuristic, random_number},
};
use crate::sampler::Use;

impl<'a> Integrator<'a> {
    /// Connects every rough surface point to a point of every light.
    pub(super) fn connect_to_lights(&self, batch: &mut Batch<'a>) {
        let is_left_to_rays = self.rules.light_events == LightEvents::Scattering;
        for (index, light) in self.scene.lights.iter().enumerate() {
            if is_left_to_rays && can_be_met(light) {
                continue;
            }
            for path in 0..batch.paths.len() {
                if !batch.vertices[path].is_specular() {
                    self.connect_to_light(index, light, path, batch);
                }
                if batch.connections.is_full() {
                    batch.resolve_connections(self.intersector);
                }
            }
            batch.resolve_connections(self.intersector);
        }
    }

    fn connect_to_light(&self, index: usize, light: &Light, path: usize, batch: &mut Batch<'a>) {
        let (path, vertex) = (batch.paths[path], &batch.vertices[path]);
        let stream = batch.samples[path.sample].stream;
        let u = self
            .sequence(stream)
            .pair(stream, Use::Light(path.depth, random_number(index)));
        let Some(sample) = light.sample(vertex.hit.position, u) else {
            return;
        };
        let Some(wi) = vertex.towards(sample.direction) else {
            return;
        };
        let reflected = vertex.reflected(wi, WHITE_LIGHT_WAVELENGTH);
        let radiance = self.light_throughput(&path, batch) * sample.radiance_over_pdf * reflected;
        if radiance <= 0.0 {
            return;
        }
        // Weigh the connection against the chance to meet the light by itself.
        let weight = match (sample.pdf, self.rules.light_events) {
            (Some(pdf), LightEvents::Both) => power_heuristic(pdf, vertex.pdf(wi)),
            _ => 1.0,
        };
        let segment = if sample.distance.is_finite() {
            vertex.segment_to(vertex.hit.position + sample.distance * sample.direction)
        } else {
            vertex.segment_along(sample.direction)
        };
        let arrival = Arrival::Light {
            sample: path.sample,
            radiance: weight * radiance,
        };
        batch.connect(segment, arrival);
    }

    /// Adds the radiance of the light that a ray meets, or of the environment.
    pub(super) fn meet_lights(
        &self,
        path: &Path,
        ray: &Ray,
        hit: Option<&Hit>,
        batch: &mut Batch<'a>,
    ) {
        let met = match hit {
            Some(hit) => self.light_at(hit),
            None => self.environments.as_slice(),
        };
        for &index in met {
            let light = &self.scene.lights[index];
            // Weigh the chance against the connection to the light.
            let weight = match (path.scattering_pdf, self.rules.light_events) {
                (None, _) | (_, LightEvents::Scattering) => 1.0,
                (Some(_), LightEvents::NextEvent) => 0.0,
                (Some(pdf), LightEvents::Both) => {
                    power_heuristic(pdf, light.pdf(ray.origin, ray.direction))
                }
            };
            let radiance = self.light_throughput(path, batch) * light.radiance_along(ray.direction);
            batch.samples[path.sample].found.lights += weight * radiance;
        }
    }

    /// Returns the index of the light to which the shape belongs, if it is one.
    fn light_at(&self, hit: &Hit) -> &[usize] {
        let shape = hit.surface.checked_sub(self.scene.surfaces.len());
        let light = shape.and_then(|shape| self.light_shapes.get(shape..=shape));
        light.unwrap_or_default()
    }

    /// Returns whether a ray can find lights that connections do not, behind a mirror or not.
    pub(super) fn rays_meet_lights(&self, specular: bool) -> bool {
        let is_needed = specular || self.rules.light_events != LightEvents::NextEvent;
        is_needed && self.scene.lights.iter().any(can_be_met)
    }

    /// Returns whether a ray meets a light if nothing is in its way.
    pub(super) fn may_meet_light(&self, ray: &Ray) -> bool {
        self.scene.lights.iter().any(|light| match light {
            Light::Point { .. } => false,
            Light::Area { .. } => light.pdf(ray.origin, ray.direction) > 0.0,
            Light::Environment(_) => true,
        })
    }

    fn light_throughput(&self, path: &Path, batch: &Batch<'_>) -> f64 {
        let first = path.sample * self.bands.wavelengths.len();
        batch.throughput[first + self.bands.of_lights]
    }
}

/// Returns whether a ray can meet the light.
const fn can_be_met(light: &Light) -> bool {
    !matches!(light, Light::Point { .. })
}
