use glam::{DVec2, DVec3};
use tem00_camera::Ray;
use tem00_geometry::{Hit, Segment};
use tem00_tracer::{Crop, EmittedRay, Laser, LocalFrame, Material};

use super::{
    LightJob, LightSelection, LightTracer,
    draws::{DrawKey, Draws},
    splats::{Splat, Splats},
};
use crate::speckle::SpecklePoint;

/// Surfaces that a light path always leaves again before it may end by chance.
const CERTAIN_BOUNCES: u32 = 2;

/// Follows the light of one laser, group by group.
#[derive(Debug)]
pub(super) struct Walk<'a> {
    tracer: &'a LightTracer<'a>,
    job: LightJob,
    /// The laser as it stands in the frame.
    laser: Laser,
}

/// Light on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Photon {
    /// Its number in the group.
    pub number: usize,
    ray: Ray,
    /// The power, in watts, as if the path were the only one.
    flux: f64,
    /// The number of rough surfaces it has met.
    rough: u32,
    /// The index of the medium.
    pub index: f64,
}

/// Light at a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex<'a> {
    pub photon: Photon,
    pub hit: Hit,
    /// Local axes whose z is the normal with which light is scattered.
    axes: LocalFrame,
    /// The direction back along the path, in local axes.
    back: DVec3,
    material: &'a Material,
}

/// Light that reaches the camera unless something stands in the way.
struct Connection<'a> {
    vertex: &'a Vertex<'a>,
    pixel: DVec2,
    /// The unit normal with which light is scattered, on the side that the camera sees.
    normal: DVec3,
    /// The number of the pixel in the part of the image that is rendered.
    index: usize,
    /// Draws the wave number from the line of the laser.
    wave: f64,
    /// In W/(m² sr).
    radiance: f64,
    /// The power on the first rough surface, on the side that the camera sees, in watts.
    power: f64,
}

impl<'a> Walk<'a> {
    pub(super) fn new(tracer: &'a LightTracer<'a>, job: &LightJob) -> Self {
        Self {
            tracer,
            job: *job,
            laser: tracer.scene.lasers[job.laser].in_frame(tracer.frame),
        }
    }

    /// Follows a group of `paths` light paths and returns what they bring to the image.
    pub(super) fn group(&self, group: u64, paths: u64) -> Splats {
        let mut splats = Splats::default();
        self.follow(group, paths, |vertices, draws| {
            // Connect those that scatter to the camera.
            self.connect(vertices, draws, &mut splats);
        });
        splats.merge();
        splats
    }

    /// Follows a group of `paths` light paths, and shows `visit` the surfaces that they meet, one bounce after the other.
    pub(super) fn follow(
        &self,
        group: u64,
        paths: u64,
        mut visit: impl FnMut(&[Vertex<'a>], &mut Draws),
    ) {
        let mut draws = Draws::new(DrawKey {
            seed: self.job.seed,
            frame: self.tracer.frame,
            laser: self.job.laser,
            group,
        });
        // Draw rays from the phase space of the beam.
        let mut photons: Vec<_> = (0..paths).map(|_| self.emit(&mut draws)).collect();
        for (number, photon) in photons.iter_mut().enumerate() {
            photon.number = number;
        }
        for depth in 1..=self.tracer.max_depth.unwrap_or(u32::MAX) {
            // Find the surfaces that they meet.
            let vertices = self.arrive(&photons, depth);
            if vertices.is_empty() {
                break;
            }
            visit(&vertices, &mut draws);
            // Choose where the light goes on.
            photons.clear();
            photons.extend(
                vertices
                    .iter()
                    .filter_map(|vertex| self.scatter(vertex, depth, &mut draws)),
            );
        }
    }

    fn emit(&self, draws: &mut Draws) -> Photon {
        let EmittedRay { ray, flux } = self.laser.sample_ray(draws.start());
        // The aperture may lie in a surface.
        let intersector = self.tracer.intersector;
        Photon {
            number: 0,
            ray: intersector.ray_from(ray.origin, ray.direction, ray.direction),
            flux,
            rough: 0,
            index: 1.0,
        }
    }

    /// Returns the light that has met a surface, the `depth`-th of its path; area lights absorb it.
    fn arrive(&self, photons: &[Photon], depth: u32) -> Vec<Vertex<'a>> {
        let rays: Vec<_> = photons.iter().map(|photon| photon.ray).collect();
        let mut hits = vec![None; rays.len()];
        self.tracer.intersector.intersect_batch(&rays, &mut hits);
        let met = photons.iter().zip(hits);
        met.filter_map(|(photon, hit)| self.vertex(*photon, hit?))
            .filter(|vertex| depth > 1 || self.belongs(vertex.material))
            .collect()
    }

    /// Returns whether light that has met this material first is to be followed.
    fn belongs(&self, first: &Material) -> bool {
        match self.tracer.selection {
            LightSelection::All => true,
            LightSelection::SpecularFirst => first.is_specular(),
        }
    }

    fn vertex(&self, photon: Photon, hit: Hit) -> Option<Vertex<'a>> {
        let surface = self.tracer.scene.surfaces.get(hit.surface)?;
        let axes = LocalFrame::from_normal(hit.shading_normal);
        let back = axes.to_local(-photon.ray.direction);
        Some(Vertex {
            photon,
            hit,
            axes,
            back,
            material: &surface.material,
        })
    }

    /// Adds the light that goes straight from rough surfaces to the camera.
    fn connect(&self, vertices: &[Vertex<'a>], draws: &mut Draws, splats: &mut Splats) {
        let (mut connections, mut segments) = (Vec::new(), Vec::new());
        let rough = |vertex: &&Vertex<'_>| !vertex.material.is_specular();
        for vertex in vertices.iter().filter(rough) {
            let lens = draws.uniform_2d();
            let is_single = self.laser.spectral_line().is_monochromatic();
            let wave = if is_single { 0.5 } else { draws.uniform() };
            if let Some((connection, segment)) = self.connection(vertex, lens, wave) {
                connections.push(connection);
                segments.push(segment);
            }
        }
        let mut visible = vec![false; segments.len()];
        self.tracer
            .intersector
            .visible_batch(&segments, &mut visible);
        for (connection, _) in connections.iter().zip(visible).filter(|&(_, free)| free) {
            self.add(connection, splats);
        }
    }

    fn connection<'v>(
        &self,
        vertex: &'v Vertex<'a>,
        lens: [f64; 2],
        wave: f64,
    ) -> Option<(Connection<'v>, Segment)> {
        let from = vertex.hit.position;
        let seen = self.tracer.camera.connect(from, lens)?;
        let index = pixel_index(seen.pixel, &self.tracer.area)?;
        let towards = (seen.lens_point - from).try_normalize()?;
        let axes = LocalFrame::from_normal(vertex.hit.normal_seen_from(towards));
        let scattered = vertex.scattered(towards, &axes, self.laser.wavelength());
        let radiance = vertex.photon.flux * scattered * seen.importance;
        let power = vertex.power_seen_from(towards);
        let connection = Connection {
            vertex,
            pixel: seen.pixel,
            normal: axes.normal() * axes.normal().dot(towards).signum(),
            index,
            wave,
            radiance,
            power,
        };
        let segment = Segment {
            from,
            from_normal: vertex.hit.normal,
            to: seen.lens_point,
        };
        // Power counts on black surfaces, too.
        (radiance > 0.0 || power > 0.0).then_some((connection, segment))
    }

    fn add(&self, connection: &Connection<'_>, splats: &mut Splats) {
        let Connection {
            vertex,
            index,
            radiance,
            power,
            ..
        } = *connection;
        let is_single = vertex.photon.rough == 0;
        let speckle = self.speckle_factor(connection);
        splats.push(Splat {
            pixel: index,
            single: if is_single { radiance } else { 0.0 },
            multiple: if is_single { 0.0 } else { radiance },
            radiance: radiance * speckle,
        });
        if is_single {
            splats.power += power;
        }
    }

    fn speckle_factor(&self, connection: &Connection<'_>) -> f64 {
        let tracer = self.tracer;
        let hit = connection.vertex.hit;
        let point = SpecklePoint {
            pixel: connection.pixel,
            position: hit.position,
            normal: connection.normal,
            surface: hit.surface,
            wave: connection.wave,
        };
        tracer
            .speckle
            .map_or(1.0, |speckle| speckle.factor(self.job.laser, &point))
    }

    /// Sends light on in a direction drawn from the material, or ends its path.
    fn scatter(&self, vertex: &Vertex<'_>, depth: u32, draws: &mut Draws) -> Option<Photon> {
        let wavelength = self.laser.wavelength();
        let u = draws.uniform_2d();
        let sample = vertex.material.sample(vertex.back, u, wavelength)?;
        let direction = vertex.axes.to_world(sample.wi);
        let mut flux = vertex.photon.flux
            * sample.weight
            * sample.eta_squared
            * vertex.adjoint_factor(direction, [vertex.back.z, sample.wi.z]);
        // End long paths by chance, without bias.
        if depth >= CERTAIN_BOUNCES {
            let survival = (flux / self.laser.power()).min(0.95);
            if draws.uniform() >= survival {
                return None;
            }
            flux /= survival;
        }
        let Hit {
            position, normal, ..
        } = vertex.hit;
        let ray = self
            .tracer
            .intersector
            .ray_from(position, normal, direction);
        (flux > 0.0).then_some(Photon {
            ray,
            flux,
            rough: vertex.photon.rough + u32::from(!sample.specular),
            // Refraction changes radiance by the square of the index.
            index: vertex.photon.index * sample.eta_squared.sqrt(),
            ..vertex.photon
        })
    }
}

impl Vertex<'_> {
    /// Tells whether the surface scatters light.
    pub(super) fn is_rough(&self) -> bool {
        !self.material.is_specular()
    }

    /// Returns the radiant intensity of the light that leaves towards the unit vector `out`, in W/sr.
    pub(super) fn intensity_towards(&self, out: DVec3, wavelength: f64) -> f64 {
        let axes = LocalFrame::from_normal(self.hit.normal_seen_from(out));
        self.photon.flux * self.scattered(out, &axes, wavelength)
    }

    /// Returns the power with which light that has met no rough surface before lights the side that
    /// is seen from the unit direction `out`, in watts.
    fn power_seen_from(&self, out: DVec3) -> f64 {
        let normal = self.hit.normal;
        let is_lit = -self.photon.ray.direction.dot(normal) * out.dot(normal) > 0.0;
        if is_lit && self.photon.rough == 0 {
            self.photon.flux
        } else {
            0.0
        }
    }

    /// Returns the fraction of the flux that goes towards the unit vector `out`, per steradian, where
    /// light is scattered in these `axes`.
    fn scattered(&self, out: DVec3, axes: &LocalFrame, wavelength: f64) -> f64 {
        let [wo, back] = [out, -self.photon.ray.direction].map(|v| axes.to_local(v));
        let reflected = self.material.evaluate(wo, back, wavelength) * wo.z.abs();
        reflected * self.adjoint_factor(out, [back.z, wo.z])
    }

    /// Returns what scattering towards `out` gains over scattering with the normal of the surface
    /// itself, so that light carries what a path from the camera would find.
    ///
    /// ```text
    /// |i·n_s| |o·n_g| / (|i·n_g| |o·n_s|)     i back along the path, n_s shading, n_g geometric
    /// ```
    ///
    /// The products with the shading normal are `shaded`. The factor is 1 without shading normals,
    /// and 0 where the two normals disagree about the side.
    ///
    /// # References
    ///
    /// - E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, §5.3.
    fn adjoint_factor(&self, out: DVec3, shaded: [f64; 2]) -> f64 {
        let back = -self.photon.ray.direction.dot(self.hit.normal);
        let out = out.dot(self.hit.normal);
        let agree = shaded[0] * back > 0.0 && shaded[1] * out > 0.0;
        let ratio = (shaded[0] / back) * (out / shaded[1]);
        if agree { ratio } else { 0.0 }
    }
}

/// Returns the number of the pixel at an image point, row by row in `area`, if it is there.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a point of the image is not negative and below 2²⁸"
)]
fn pixel_index(pixel: DVec2, area: &Crop) -> Option<usize> {
    let x = (pixel.x as usize).checked_sub(area.x)?;
    let y = (pixel.y as usize).checked_sub(area.y)?;
    (x < area.width && y < area.height).then_some(y * area.width + x)
}
