use super::{SEED, SeenPoint, Survey};
use crate::{
    integrator::Vertex,
    sampler::{pixel_key, point_in_square},
    speckle::MultiplePath,
};

/// Surfaces after which a path may end by chance.
const CERTAIN_BOUNCES: u32 = 3;

/// The way of a path back from the surface that the camera sees.
struct WayBack {
    /// The optical length, in metres, and what motion has added to it.
    length: f64,
    added: f64,
    polarisation: f64,
    throughput: f64,
    /// The product of the changes of radiance by refraction.
    compression: f64,
}

impl Survey<'_> {
    /// Follows a path back from a point that the camera sees and returns the light of a laser on the further rough
    /// surfaces that it meets.
    pub(super) fn multiple_from_camera(
        &self,
        laser: usize,
        seen: &SeenPoint<'_>,
        key: u64,
    ) -> Vec<MultiplePath> {
        let wavelength = self.change.laser(laser).wavelength();
        let direct = self
            .change
            .paths_to(laser, seen.point.surface, seen.point.position);
        let [now, before] = direct.unwrap_or_default();
        let mut way = WayBack {
            length: -now,
            added: before - now,
            polarisation: self.polarisation_of(seen.point.surface),
            throughput: 1.0,
            compression: 1.0,
        };
        let mut paths = Vec::new();
        let mut vertex = seen.vertex;
        let mut pupil = None;
        let depths = 1..self.max_depth.unwrap_or(u32::MAX);
        for depth in depths {
            let draw = |purpose: u64| {
                point_in_square(pixel_key(
                    self.seed ^ SEED,
                    [key, u64::from(depth), purpose],
                ))
            };
            // Choose the direction, and end long and dark paths by chance.
            let Some(event) = vertex.sample(draw(1), wavelength) else {
                break;
            };
            way.throughput *= vertex.weight(&event, wavelength);
            way.compression *= event.eta_squared;
            if depth >= CERTAIN_BOUNCES {
                let survival = (way.throughput * way.compression).min(0.95);
                if draw(2)[0] >= survival {
                    break;
                }
                way.throughput /= survival;
            }
            let ray = vertex.leave(self.intersector, event.wi);
            pupil = pupil.or(Some(seen.pupil_of(ray.direction)));
            // Find the next surface.
            let Some(hit) = self.intersector.intersect(&ray) else {
                break;
            };
            let Some(surface) = self.scene.surfaces.get(hit.surface) else {
                break;
            };
            let Some(next) = Vertex::new(&ray, &hit, &surface.material) else {
                break;
            };
            let index = way.compression.sqrt();
            let [here, last] =
                [&next, &vertex].map(|v| [v.position, self.change.origin(v.surface, v.position)]);
            let [now, before] = [0, 1].map(|time| here[time].distance(last[time]));
            way.length += index * now;
            way.added += index * (now - before);
            vertex = next;
            if !vertex.is_specular() {
                way.polarisation *= self.polarisation_of(vertex.surface);
                let pupil = pupil.unwrap_or_default();
                paths.extend(
                    self.lit(laser, &vertex, &way)
                        .map(|path| MultiplePath { pupil, ..path }),
                );
            }
        }
        paths
    }

    /// The light of a laser that a path finds at a vertex.
    fn lit(&self, laser: usize, vertex: &Vertex<'_>, way: &WayBack) -> Option<MultiplePath> {
        let radiance = way.throughput * self.single(laser, vertex);
        let [now, before] = self
            .change
            .paths_to(laser, vertex.surface, vertex.position)?;
        (radiance > 0.0).then_some(MultiplePath {
            radiance,
            delay: way.length + now,
            added: way.added + now - before,
            polarisation: way.polarisation,
            pupil: glam::DVec3::ZERO,
        })
    }
}
