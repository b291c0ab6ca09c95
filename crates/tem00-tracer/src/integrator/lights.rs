use tem00_camera::Ray;

use super::{
    Integrator,
    batch::{Arrival, Batch, Path},
    rules::LAMP_WAVELENGTH,
    weights::{power_heuristic, random_number},
};
use crate::{Hit, Lamp, LampEvents, sampler::Use};

impl<'a> Integrator<'a> {
    /// Connects every rough surface point to a point of every lamp.
    pub(super) fn connect_to_lamps(&self, batch: &mut Batch<'a>) {
        if self.rules.lamp_events == LampEvents::Scattering {
            return self.connect_to_points(batch);
        }
        for (index, lamp) in self.scene.lamps.iter().enumerate() {
            self.connect_all(index, lamp, batch);
        }
    }

    /// Connects to the lamps that no ray can meet.
    fn connect_to_points(&self, batch: &mut Batch<'a>) {
        for (index, lamp) in self.scene.lamps.iter().enumerate() {
            if !can_be_met(lamp) {
                self.connect_all(index, lamp, batch);
            }
        }
    }

    fn connect_all(&self, index: usize, lamp: &Lamp, batch: &mut Batch<'a>) {
        for path in 0..batch.paths.len() {
            if !batch.vertices[path].is_specular() {
                self.connect_to_lamp(index, lamp, path, batch);
            }
            if batch.connections.is_full() {
                batch.resolve_connections(self.intersector);
            }
        }
        batch.resolve_connections(self.intersector);
    }

    fn connect_to_lamp(&self, index: usize, lamp: &Lamp, path: usize, batch: &mut Batch<'a>) {
        let (path, vertex) = (batch.paths[path], &batch.vertices[path]);
        let stream = batch.samples[path.sample].stream;
        let u = self
            .sequence
            .pair(stream, Use::Lamp(path.depth, random_number(index)));
        let Some(light) = lamp.sample(vertex.position, u) else {
            return;
        };
        let Some(wi) = vertex.towards(light.direction) else {
            return;
        };
        let reflected = vertex.reflected(wi, LAMP_WAVELENGTH);
        let radiance = self.lamp_throughput(&path, batch) * light.radiance_over_pdf * reflected;
        if radiance <= 0.0 {
            return;
        }
        // Weigh the connection against the chance to meet the lamp by itself.
        let weight = match (light.pdf, self.rules.lamp_events) {
            (Some(pdf), LampEvents::Both) => power_heuristic(pdf, vertex.pdf(wi)),
            _ => 1.0,
        };
        let segment = if light.distance.is_finite() {
            vertex.segment_to(vertex.position + light.distance * light.direction)
        } else {
            vertex.segment_along(light.direction)
        };
        let arrival = Arrival::Lamp {
            sample: path.sample,
            radiance: weight * radiance,
        };
        batch.connections.push(segment, arrival);
    }

    /// Takes the light of the lamp that a ray meets, or of the environment.
    pub(super) fn meet_lamps(
        &self,
        path: &Path,
        ray: &Ray,
        hit: Option<&Hit>,
        batch: &mut Batch<'a>,
    ) {
        let met = match hit {
            Some(hit) => self.lamp_at(hit),
            None => self.environments.as_slice(),
        };
        for &index in met {
            let lamp = &self.scene.lamps[index];
            // Weigh the chance against the connection to the lamp.
            let weight = match (path.scattering_pdf, self.rules.lamp_events) {
                (None, _) | (_, LampEvents::Scattering) => 1.0,
                (Some(_), LampEvents::NextEvent) => 0.0,
                (Some(pdf), LampEvents::Both) => {
                    power_heuristic(pdf, lamp.pdf(ray.origin, ray.direction))
                }
            };
            let radiance = self.lamp_throughput(path, batch) * lamp.radiance_along(ray.direction);
            batch.samples[path.sample].lamps += weight * radiance;
        }
    }

    /// Returns the index of the lamp to which the shape belongs, if it is one.
    fn lamp_at(&self, hit: &Hit) -> &[usize] {
        let shape = hit.surface.checked_sub(self.scene.surfaces.len());
        let lamp = shape.and_then(|shape| self.lamp_shapes.get(shape..=shape));
        lamp.unwrap_or_default()
    }

    /// Tells whether a ray can find lamps that connections do not, behind a mirror or not.
    pub(super) fn rays_meet_lamps(&self, specular: bool) -> bool {
        let is_needed = specular || self.rules.lamp_events != LampEvents::NextEvent;
        is_needed && self.scene.lamps.iter().any(can_be_met)
    }

    /// Tells whether a ray meets light of a lamp if nothing is in its way.
    pub(super) fn may_meet_lamp(&self, ray: &Ray) -> bool {
        self.scene.lamps.iter().any(|lamp| match lamp {
            Lamp::Point { .. } => false,
            Lamp::Area { .. } => lamp.pdf(ray.origin, ray.direction) > 0.0,
            Lamp::Environment(_) => true,
        })
    }

    fn lamp_throughput(&self, path: &Path, batch: &Batch<'_>) -> f64 {
        let first = path.sample * self.spectrum.wavelengths.len();
        batch.throughput[first + self.spectrum.of_lamps]
    }
}

/// Tells whether a ray can meet the lamp.
const fn can_be_met(lamp: &Lamp) -> bool {
    !matches!(lamp, Lamp::Point { .. })
}
