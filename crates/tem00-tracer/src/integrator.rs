use glam::{DVec2, DVec3};

use crate::{
    Camera, Formulas, Intersector, Lamp, Laser, LocalFrame, Material, Ray, Scene, SpeckleModel,
    film::Pixel, sampler::Sampler, speckle::SpecklePoint,
};

/// The wavelength at which materials are evaluated for lamps, in metres: lamps are white and
/// materials grey under them.
const LAMP_WAVELENGTH: f64 = 550e-9;

/// Bounces that are always followed before a path may end by chance.
const CERTAIN_BOUNCES: u32 = 2;

/// Everything that one frame needs to turn an image point into radiance.
#[derive(Debug)]
pub(crate) struct Integrator<'a> {
    pub scene: &'a Scene,
    pub camera: Camera,
    pub intersector: &'a Intersector,
    pub speckle: Option<&'a SpeckleModel>,
    pub formulas: Formulas,
    pub frame: u32,
}

/// A point of a surface, seen from one side.
struct Vertex<'a> {
    position: DVec3,
    distance: f64,
    surface: usize,
    /// Local axes whose z is the normal on the side that is seen.
    axes: LocalFrame,
    /// The direction back along the path, in local axes.
    wo: DVec3,
    material: &'a Material,
}

impl Integrator<'_> {
    /// Estimates the layers of laser `index` at the image point `pixel`.
    pub(crate) fn laser_sample(&self, index: usize, pixel: DVec2, sampler: &mut Sampler) -> Pixel {
        let laser = &self.scene.lasers[index];
        // Find the surface that the camera sees.
        let Some(vertex) = self.vertex(&self.camera.ray(pixel)) else {
            return Pixel {
                speckle: 1.0,
                ..Pixel::default()
            };
        };
        // Connect it to the laser: the first interaction, which stays coherent.
        let irradiance = self.laser_irradiance(laser, &vertex);
        let coherent = irradiance.map_or(0.0, |(irradiance, wi)| {
            irradiance * vertex.material.evaluate(vertex.wo, wi, laser.wavelength())
        });
        // Look up the speckle of that interaction.
        let speckle = self.speckle_factor(index, pixel, &vertex);
        // Follow the light that has met other surfaces before: it carries no speckle.
        let wavelength = laser.wavelength();
        let incoherent = self.indirect(&vertex, wavelength, sampler, |vertex, _| {
            self.laser_irradiance(laser, vertex)
                .map_or(0.0, |(irradiance, wi)| {
                    irradiance * vertex.material.evaluate(vertex.wo, wi, wavelength)
                })
        });
        let area = self.camera.solid_angle_per_pixel(pixel) * vertex.distance.powi(2) / vertex.wo.z;
        Pixel {
            coherent_before: coherent,
            speckle,
            coherent_after: coherent * speckle,
            incoherent,
            power: irradiance.map_or(0.0, |(irradiance, _)| irradiance * area),
        }
    }

    /// Estimates the radiance from the lamps at the image point `pixel`.
    pub(crate) fn lamp_sample(&self, pixel: DVec2, sampler: &mut Sampler) -> Pixel {
        let ray = self.camera.ray(pixel);
        let Some(vertex) = self.vertex(&ray) else {
            return Pixel {
                incoherent: self.emission(&ray),
                ..Pixel::default()
            };
        };
        let direct = self.lamp_light(&vertex, sampler);
        let indirect = self.indirect(&vertex, LAMP_WAVELENGTH, sampler, |vertex, sampler| {
            self.lamp_light(vertex, sampler)
        });
        Pixel {
            incoherent: direct + indirect,
            ..Pixel::default()
        }
    }

    /// Returns the surface point that a ray meets, or `None` where it meets nothing or a lamp.
    fn vertex(&self, ray: &Ray) -> Option<Vertex<'_>> {
        let hit = self.intersector.intersect(ray)?;
        let surface = self.scene.surfaces.get(hit.surface)?;
        let seen = if hit.normal.dot(ray.direction) > 0.0 {
            -hit.normal
        } else {
            hit.normal
        };
        let axes = LocalFrame::from_normal(seen);
        let wo = axes.to_local(-ray.direction);
        // A ray along the surface sees no area of it.
        (wo.z > 0.0).then_some(Vertex {
            position: hit.position,
            distance: hit.distance,
            surface: hit.surface,
            axes,
            wo,
            material: &surface.material,
        })
    }

    /// Returns the laser's irradiance on the surface, in W/m², and its local direction.
    fn laser_irradiance(&self, laser: &Laser, vertex: &Vertex<'_>) -> Option<(f64, DVec3)> {
        let light = match self.formulas {
            Formulas::Derived => laser.illuminate(vertex.position),
            Formulas::AsPrinted => {
                laser.illuminate_as_printed(vertex.position, vertex.axes.normal())
            }
        }?;
        let wi = vertex.axes.to_local(light.direction);
        if wi.z <= 0.0 || !self.visible(vertex, light.source) {
            return None;
        }
        Some((light.irradiance * wi.z, wi))
    }

    /// Estimates the radiance of the lamps that the vertex reflects directly.
    fn lamp_light(&self, vertex: &Vertex<'_>, sampler: &mut Sampler) -> f64 {
        let lamps = self.scene.lamps.iter();
        lamps
            .map(|lamp| {
                let (source, factor) = sample_lamp(lamp, vertex.position, sampler.uniform_2d());
                let Some(direction) = (source - vertex.position).try_normalize() else {
                    return 0.0;
                };
                let wi = vertex.axes.to_local(direction);
                if factor <= 0.0 || wi.z <= 0.0 || !self.visible(vertex, source) {
                    return 0.0;
                }
                let reflected = vertex.material.evaluate(vertex.wo, wi, LAMP_WAVELENGTH);
                factor * reflected * wi.z
            })
            .sum()
    }

    /// Estimates the radiance that arrives at the vertex after other surfaces, reflected by it.
    fn indirect(
        &self,
        first: &Vertex<'_>,
        wavelength: f64,
        sampler: &mut Sampler,
        direct: impl Fn(&Vertex<'_>, &mut Sampler) -> f64,
    ) -> f64 {
        let mut radiance = 0.0;
        let mut throughput = 1.0;
        let mut next = self.bounce(first, wavelength, sampler, &mut throughput);
        for bounces in 1_u32.. {
            let Some(vertex) = next else { break };
            // Connect the path to the light.
            radiance += throughput * direct(&vertex, sampler);
            // End long paths by chance, without bias.
            if bounces >= CERTAIN_BOUNCES {
                let survival = throughput.min(0.95);
                if sampler.uniform() >= survival {
                    break;
                }
                throughput /= survival;
            }
            // Choose where the path goes on.
            next = self.bounce(&vertex, wavelength, sampler, &mut throughput);
        }
        radiance
    }

    /// Follows a direction drawn from the material to the next surface.
    fn bounce(
        &self,
        vertex: &Vertex<'_>,
        wavelength: f64,
        sampler: &mut Sampler,
        throughput: &mut f64,
    ) -> Option<Vertex<'_>> {
        let sample = vertex
            .material
            .sample(vertex.wo, sampler.uniform_2d(), wavelength)?;
        *throughput *= sample.weight;
        self.vertex(&Ray {
            origin: self
                .intersector
                .leave(vertex.position, vertex.axes.normal()),
            direction: vertex.axes.to_world(sample.wi),
        })
    }

    /// Returns the radiance of the lamp that a ray meets, in W/(m² sr).
    fn emission(&self, ray: &Ray) -> f64 {
        let Some(hit) = self.intersector.intersect(ray) else {
            return 0.0;
        };
        let areas = self.scene.lamps.iter().filter_map(|lamp| match lamp {
            Lamp::Area { radiance, .. } => Some(*radiance),
            Lamp::Point { .. } | Lamp::Environment(_) => None,
        });
        let lit_side = hit.normal.dot(ray.direction) < 0.0;
        hit.surface
            .checked_sub(self.scene.surfaces.len())
            .filter(|_| lit_side)
            .and_then(|index| areas.clone().nth(index))
            .unwrap_or(0.0)
    }

    fn speckle_factor(&self, laser: usize, pixel: DVec2, vertex: &Vertex<'_>) -> f64 {
        self.speckle.map_or(1.0, |model| {
            model.factor(
                self.scene,
                laser,
                &SpecklePoint {
                    pixel,
                    position: vertex.position,
                    normal: vertex.axes.normal(),
                    surface: vertex.surface,
                },
                self.frame,
            )
        })
    }

    fn visible(&self, vertex: &Vertex<'_>, source: DVec3) -> bool {
        self.intersector
            .visible(vertex.position, vertex.axes.normal(), source)
    }
}

/// Draws a point of a lamp; returns it with the factor that turns f cos θ into radiance.
fn sample_lamp(lamp: &Lamp, receiver: DVec3, u: [f64; 2]) -> (DVec3, f64) {
    match lamp {
        Lamp::Point { position, power } => {
            let squared = position.distance_squared(receiver);
            let intensity = power / (4.0 * core::f64::consts::PI);
            (
                *position,
                if squared > 0.0 {
                    intensity / squared
                } else {
                    0.0
                },
            )
        }
        Lamp::Area {
            rectangle,
            radiance,
        } => {
            let point = rectangle.point(u[0], u[1]);
            let towards = receiver - point;
            let squared = towards.length_squared();
            let cosine = rectangle.normal().dot(towards) / squared.sqrt();
            let factor = if squared > 0.0 && cosine > 0.0 {
                radiance * cosine * rectangle.area() / squared
            } else {
                0.0
            };
            (point, factor)
        }
        Lamp::Environment(_) => (receiver, 0.0),
    }
}
