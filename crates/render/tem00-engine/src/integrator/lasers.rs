use tem00_camera::Ray;
use tem00_geometry::Hit;
use tem00_shading::LaserEvent;

use super::{
    Integrator,
    batch::{Arrival, Batch, Path},
    lit_points::{LitPoints, density},
    weights::{power_heuristic, random_number},
};
use crate::{sampler::Use, vertex::Vertex};

impl<'a> Integrator<'a> {
    /// Connects every rough surface point to every laser.
    pub(super) fn connect_to_lasers(&self, batch: &mut Batch<'a>) {
        if !self.rules.finds_lasers {
            return;
        }
        let mean_direction = !self.rules.samples_beams;
        if mean_direction {
            let positions = batch.vertices.iter().map(|vertex| vertex.hit.position);
            batch.lit.place(positions);
        }
        for laser in 0..self.lasers.len() {
            if mean_direction {
                self.lasers[laser].next_events(&mut batch.lit);
            }
            for index in 0..batch.paths.len() {
                let light = if batch.vertices[index].is_specular() {
                    None
                } else if mean_direction {
                    batch.lit.at(index).map(|light| (light, None))
                } else {
                    self.illuminate(laser, index, batch)
                };
                if let Some(light) = light {
                    self.connect_to_laser(laser, index, light, batch);
                }
                if self.has_bodies && batch.paths[index].rough == 0 {
                    self.connect_below(laser, index, batch);
                }
                if batch.connections.is_full() {
                    batch.resolve_connections(self.intersector);
                }
            }
        }
        batch.resolve_connections(self.intersector);
    }

    #[inline(always)]
    fn connect_to_laser(
        &self,
        laser: usize,
        index: usize,
        (light, pdf): (LaserEvent, Option<f64>),
        batch: &mut Batch<'a>,
    ) {
        let (path, vertex) = (batch.paths[index], &batch.vertices[index]);
        let Some(wi) = vertex.towards(light.wi) else {
            return;
        };
        // Weigh the connection against the chance to meet the beam by itself.
        let weight = pdf.map_or_else(
            || self.weight_beside_lit_points(laser, &path, vertex, &light),
            |pdf| power_heuristic(pdf, vertex.pdf(wi)),
        );
        let wavelength = self.lasers[laser].wavelength();
        let reflected = if self.has_bodies && path.rough == 0 {
            vertex.reflected_by_boundary(wi, wavelength)
        } else {
            vertex.reflected(wi, wavelength)
        };
        let throughput = self.laser_throughput(laser, &path, batch);
        let radiance = weight * throughput * light.e_perp * reflected;
        let power = if path.depth == 1 && vertex.is_seen_side(wi) {
            let on_surface = light.e_perp * vertex.hit.normal.dot(light.wi).abs();
            let solid_angle = batch.solid_angles[path.sample];
            on_surface * solid_angle * vertex.hit.distance.powi(2) / vertex.cosine.abs()
        } else {
            0.0
        };
        if radiance > 0.0 || power > 0.0 {
            let arrival = Arrival::Laser {
                slot: path.sample * self.lasers.len() + laser,
                radiance,
                power,
                is_single: path.rough == 0,
            };
            let segment = vertex.segment_to(light.point);
            batch.connect(segment, arrival);
        }
    }

    /// Connects the first rough surface point of a path to a laser through the body below it.
    #[inline(never)] // It is rare beside what surrounds it.
    fn connect_below(&self, laser: usize, index: usize, batch: &mut Batch<'a>) {
        let path = batch.paths[index];
        if batch.vertices[index].below().is_none() {
            return;
        }
        let stream = batch.samples[path.sample].stream;
        let purpose = Use::Laser(path.depth, random_number(laser));
        let [first, second] = self.sequence(stream).pair(stream, purpose);
        let seed = first.to_bits().rotate_left(32) ^ second.to_bits();
        let entry = batch.vertices[index].entry(&self.lasers[laser], seed, self.intersector);
        batch.rays_followed += 1;
        if let Some((segment, radiance)) = entry {
            let radiance = self.laser_throughput(laser, &path, batch) * radiance;
            let slot = path.sample * self.lasers.len() + laser;
            batch.connect(segment, Arrival::Below { slot, radiance });
        }
    }

    /// Connects every rough surface point to one that each laser lights.
    pub(super) fn connect_to_lit_points(&self, batch: &mut Batch<'a>) {
        for (laser, points) in self.lit_points.iter().enumerate() {
            for index in 0..batch.paths.len() {
                self.connect_to_lit_point(laser, points, index, batch);
                if batch.connections.is_full() {
                    batch.resolve_connections(self.intersector);
                }
            }
        }
        batch.resolve_connections(self.intersector);
    }

    #[inline(always)]
    fn connect_to_lit_point(
        &self,
        laser: usize,
        points: &LitPoints<'a>,
        index: usize,
        batch: &mut Batch<'a>,
    ) {
        let (path, vertex) = (batch.paths[index], &batch.vertices[index]);
        if vertex.is_specular() || path.depth >= self.rules.max_depth {
            return;
        }
        let stream = batch.samples[path.sample].stream;
        let purpose = Use::LitPoint(path.depth);
        let u = self.sequence(stream).uniform(stream, purpose);
        let Some((point, share)) = points.choose(u) else {
            return;
        };
        let wavelength = self.lasers[laser].wavelength();
        if let Some(radiance) = point.radiance_over(vertex, wavelength) {
            let arrival = Arrival::Laser {
                slot: path.sample * self.lasers.len() + laser,
                radiance: self.laser_throughput(laser, &path, batch) * share * radiance,
                power: 0.0,
                is_single: false,
            };
            let segment = vertex.segment_to(point.hit.position);
            batch.connect(segment, arrival);
        }
    }

    /// Returns the weight of laser light that a path finds by a direction drawn at the rough
    /// surface before.
    #[inline(always)]
    fn weight_beside_lit_points(
        &self,
        laser: usize,
        path: &Path,
        vertex: &Vertex<'a>,
        light: &LaserEvent,
    ) -> f64 {
        match path.scattering_pdf {
            Some(pdf) if !self.lit_points.is_empty() => {
                let density = density(&self.lasers[laser], light, vertex.hit.normal);
                power_heuristic(vertex.area_pdf(pdf), density)
            }
            _ => 1.0,
        }
    }

    /// Returns how a laser lights a surface point from a drawn direction, with its density.
    fn illuminate(
        &self,
        laser: usize,
        index: usize,
        batch: &Batch<'_>,
    ) -> Option<(LaserEvent, Option<f64>)> {
        let (source, vertex) = (&self.lasers[laser], &batch.vertices[index]);
        let path = &batch.paths[index];
        let purpose = Use::Laser(path.depth, random_number(laser));
        let stream = batch.samples[path.sample].stream;
        let u = self.sequence(stream).pair(stream, purpose);
        let event = source.next_event_sampled(vertex.hit.position, u)?;
        let light = LaserEvent {
            point: event.point,
            wi: event.wi,
            e_perp: event.value,
        };
        Some((light, Some(event.pdf)))
    }

    /// Adds the light of the sampled lasers whose beams a ray from a rough surface follows
    /// backwards.
    pub(super) fn meet_lasers(
        &self,
        path: &Path,
        ray: &Ray,
        hit: Option<&Hit>,
        batch: &mut Batch<'a>,
    ) {
        if !self.rays_meet_lasers() || path.rough == 0 || path.depth > self.rules.max_depth {
            return;
        }
        let intersector = self.intersector;
        let is_hidden = |distance| hit.is_some_and(|hit| intersector.hides(hit, ray, distance));
        for (index, laser) in self.lasers.iter().enumerate() {
            let aperture = laser.aperture_distance(ray.origin, ray.direction);
            if aperture.is_none_or(is_hidden) {
                continue;
            }
            let radiance = laser.radiance(ray.origin, ray.direction);
            if radiance <= 0.0 {
                continue;
            }
            let weight = path.scattering_pdf.map_or(1.0, |pdf| {
                power_heuristic(pdf, laser.next_event_pdf(ray.origin, ray.direction))
            });
            let throughput = self.laser_throughput(index, path, batch);
            let slot = path.sample * self.lasers.len() + index;
            batch.laser_samples[slot].add(weight * throughput * radiance, path.rough == 1);
        }
    }

    /// Returns whether rays can find lasers by chance.
    pub(super) fn rays_meet_lasers(&self) -> bool {
        self.rules.finds_lasers && self.rules.samples_beams && !self.lasers.is_empty()
    }

    fn laser_throughput(&self, laser: usize, path: &Path, batch: &Batch<'_>) -> f64 {
        let first = path.sample * self.bands.wavelengths.len();
        batch.throughput[first + self.bands.of_laser[laser]]
    }
}
