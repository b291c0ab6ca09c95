//! Rough surfaces that the light of a laser has met, as sources of the light that they send to others.

use glam::DVec3;
use tem00_geometry::Segment;

use super::{
    LightJob, LightTracer,
    walk::{Vertex, Walk},
};
use crate::speckle::Change;

/// A point of a rough surface that the light of a laser has met, and its way there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WayPoint<'a> {
    vertex: Vertex<'a>,
    way: Way,
}

/// The way of light from a laser.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    /// The optical length, in metres.
    pub length: f64,
    /// The length less that of the same way in the reference frame.
    pub change: f64,
    /// The degree of polarisation that the rough surfaces leave.
    pub polarisation: f64,
    /// The last point: now, and in the reference frame.
    last: [DVec3; 2],
}

impl<'a> LightTracer<'a> {
    /// Follows a group of paths from a laser and returns, for each path, the rough surfaces that it meets.
    pub(crate) fn way_points(
        &'a self,
        job: &LightJob,
        group: u64,
        change: &Change,
    ) -> Vec<Vec<WayPoint<'a>>> {
        let count = usize::try_from(job.paths).unwrap_or(0);
        let mut ways: Vec<Option<Way>> = vec![None; count];
        let mut points = vec![Vec::new(); count];
        Walk::new(self, job).follow(group, job.paths, |vertices, _| {
            for vertex in vertices {
                let number = vertex.photon.number;
                let Some(way) = self.way_to(vertex, ways[number], job.laser, change) else {
                    continue;
                };
                ways[number] = Some(way);
                if vertex.is_rough() {
                    points[number].push(WayPoint {
                        vertex: *vertex,
                        way,
                    });
                }
            }
        });
        points
    }

    /// The way of light to a surface, on from the last.
    fn way_to(
        &self,
        vertex: &Vertex<'_>,
        last: Option<Way>,
        laser: usize,
        change: &Change,
    ) -> Option<Way> {
        let (surface, position) = (vertex.hit.surface, vertex.hit.position);
        let here = [position, change.origin(surface, position)];
        let polarisation = match vertex.is_rough() {
            true => self.scene.surfaces[surface].speckle.polarisation,
            false => 1.0,
        };
        let Some(last) = last else {
            // On from the phase of the beam itself.
            let [now, before] = change.paths_to(laser, surface, position)?;
            return Some(Way {
                length: now,
                change: now - before,
                polarisation,
                last: here,
            });
        };
        let [now, before] = [0, 1].map(|time| here[time].distance(last.last[time]));
        Some(Way {
            length: last.length + vertex.photon.index * now,
            change: last.change + vertex.photon.index * (now - before),
            polarisation: last.polarisation * polarisation,
            last: here,
        })
    }
}

impl WayPoint<'_> {
    /// Returns the irradiance that the point sends to another across the direction between them, in W/m², as if its path
    /// were the only one, and the unit direction towards it.
    pub(crate) fn irradiance_at(&self, point: DVec3, wavelength: f64) -> Option<(f64, DVec3)> {
        let way = point - self.vertex.hit.position;
        let out = way.try_normalize()?;
        let intensity = self.vertex.intensity_towards(out, wavelength);
        let irradiance = intensity / way.length_squared();
        (irradiance > 0.0 && irradiance.is_finite()).then_some((irradiance, -out))
    }

    /// Returns the way of the light on to a point, which stood at `origin` in the reference frame.
    pub(crate) fn way_to(&self, point: DVec3, origin: DVec3) -> Way {
        let here = [point, origin];
        let [now, before] = [0, 1].map(|time| here[time].distance(self.way.last[time]));
        Way {
            length: self.way.length + now,
            change: self.way.change + now - before,
            ..self.way
        }
    }

    /// Returns the segment from the point to another.
    pub(crate) fn segment_to(&self, point: DVec3) -> Segment {
        Segment {
            from: self.vertex.hit.position,
            from_normal: self.vertex.hit.normal,
            to: point,
        }
    }
}
