//! Paths through a scene, surface by surface, for a visitor: of light from a laser, or of sight
//! from the camera.

use glam::DVec3;
use tem00_camera::Ray;
use tem00_geometry::{Hit, Intersector};
use tem00_tracer::{LocalFrame, Scene};

use crate::vertex::Vertex;

/// Transport of paths of one wavelength through a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk<'a> {
    pub scene: &'a Scene,
    /// The surfaces, and the area lights behind them.
    pub intersector: &'a Intersector,
    /// In metres.
    pub wavelength: f64,
    /// The maximum number of surfaces that a path meets.
    pub max_depth: u32,
    pub carried: Carried,
    pub roulette: Roulette,
}

/// Quantity that a path carries.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Carried {
    /// Power from a laser, in watts; `start` is the power at the start.
    Power { start: f64 },
    /// Radiance back to the camera, as a fraction of the radiance without surfaces.
    Radiance,
}

/// The chance by which long and dark paths end, without bias.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roulette {
    /// The number of surfaces that a path always leaves again.
    pub certain: u32,
}

/// A path between two surfaces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walker {
    /// Its number among those that are followed together.
    pub number: usize,
    pub ray: Ray,
    /// Carried quantity, as if the path were the only one.
    pub carries: f64,
    /// The product of the changes of radiance by refraction: the square of the index of the medium.
    pub compression: f64,
    /// The number of rough surfaces that it has left.
    pub rough: u32,
}

/// A path at a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Met<'a> {
    pub walker: Walker,
    pub vertex: Vertex<'a>,
}

/// Observer of paths, which also supplies their random numbers.
pub(crate) trait Visitor<'a> {
    /// Looks at the surfaces that paths meet, the `depth`-th of each; a path that is removed ends.
    fn meet(&mut self, depth: u32, met: &mut Vec<Met<'a>>);

    /// Looks at a path that leaves the scene, or ends on a light.
    fn lose(&mut self, _walker: &Walker, _light: Option<&Hit>) {}

    /// Returns two numbers in [0, 1) that draw the direction in which a path leaves its `depth`-th
    /// surface.
    fn direction(&mut self, path: usize, depth: u32) -> [f64; 2];

    /// Returns a number in [0, 1) that decides whether a path leaves its `depth`-th surface.
    fn survival(&mut self, path: usize, depth: u32) -> f64;
}

impl Roulette {
    /// Returns the probability with which a path survived its `depth`-th surface, by which its
    /// carried quantity is divided, or `None` if it ends there. `left` is the fraction of its light
    /// that is left.
    pub(crate) fn survived(self, depth: u32, left: f64, draw: impl FnOnce() -> f64) -> Option<f64> {
        if depth <= self.certain {
            return Some(1.0);
        }
        let survival = left.min(0.95);
        (draw() < survival).then_some(survival)
    }
}

impl Walker {
    /// Starts a path with the carried quantity `carries`.
    pub(crate) const fn new(number: usize, ray: Ray, carries: f64) -> Self {
        Self {
            number,
            ray,
            carries,
            compression: 1.0,
            rough: 0,
        }
    }

    /// Returns the index of the medium.
    pub(crate) fn index(&self) -> f64 {
        self.compression.sqrt()
    }
}

impl Met<'_> {
    /// Returns the fraction of the power that goes on towards the unit vector `out`, per steradian,
    /// where light is scattered in these `axes`.
    pub(crate) fn sent(&self, out: DVec3, axes: &LocalFrame, wavelength: f64) -> f64 {
        let back = -self.walker.ray.direction;
        self.vertex.sent(back, out, axes, wavelength)
    }
}

impl<'a> Walk<'a> {
    /// Follows paths from bounce to bounce, all together.
    pub(crate) fn follow(&self, mut walkers: Vec<Walker>, visitor: &mut impl Visitor<'a>) {
        for depth in 1..=self.max_depth {
            let mut met = self.arrive(&walkers, visitor);
            if met.is_empty() {
                break;
            }
            visitor.meet(depth, &mut met);
            walkers.clear();
            walkers.extend(met.iter().filter_map(|met| self.leave(met, depth, visitor)));
        }
    }

    /// Finds the surfaces that paths meet.
    fn arrive(&self, walkers: &[Walker], visitor: &mut impl Visitor<'a>) -> Vec<Met<'a>> {
        let rays: Vec<_> = walkers.iter().map(|walker| walker.ray).collect();
        let mut hits = vec![None; rays.len()];
        self.intersector.intersect_batch(&rays, &mut hits);
        let met = walkers.iter().zip(&hits).filter_map(|(&walker, hit)| {
            let surface = hit.and_then(|hit| self.scene.surfaces.get(hit.surface));
            let (Some(hit), Some(surface)) = (hit, surface) else {
                visitor.lose(&walker, hit.as_ref());
                return None;
            };
            let vertex = match self.carried {
                Carried::Power { .. } => Vertex::lit(&walker.ray, hit, &surface.material),
                Carried::Radiance => Vertex::seen(&walker.ray, hit, &surface.material)?,
            };
            Some(Met { walker, vertex })
        });
        met.collect()
    }

    /// Sends a path on in a direction drawn from the material, or ends it.
    fn leave(&self, met: &Met<'a>, depth: u32, visitor: &mut impl Visitor<'a>) -> Option<Walker> {
        let Met { walker, vertex } = met;
        let u = visitor.direction(walker.number, depth);
        let event = match self.carried {
            Carried::Power { .. } => vertex.draw(u, self.wavelength)?,
            Carried::Radiance => vertex.sample(u, self.wavelength)?,
        };
        let compression = walker.compression * event.eta_squared;
        let (mut carries, left) = match self.carried {
            Carried::Power { start } => {
                let power = walker.carries * event.weight * event.eta_squared;
                let power = power * vertex.adjoint_factor_of(&event);
                (power, power / start)
            }
            Carried::Radiance => {
                let radiance = walker.carries * vertex.weight(&event, self.wavelength);
                (radiance, radiance * compression)
            }
        };
        let draw = || visitor.survival(walker.number, depth);
        carries /= self.roulette.survived(depth, left, draw)?;
        (carries > 0.0).then(|| Walker {
            ray: vertex.leave(self.intersector, event.wi),
            carries,
            compression,
            rough: walker.rough + u32::from(!event.specular),
            ..*walker
        })
    }
}
