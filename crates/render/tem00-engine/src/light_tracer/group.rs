use tem00_geometry::Intersector;
use tem00_tracer::{EmittedRay, Laser, Scene};

use crate::{
    sampler::{DrawKey, Draws},
    walk::{Carried, Met, Roulette, Visitor, Walk, Walker},
};

/// Russian roulette: a light path always leaves this number of surfaces before it may end by
/// chance.
const ROULETTE: Roulette = Roulette { certain: 1 };

/// A group of light paths from a laser as it stands in a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightGroup<'a> {
    pub scene: &'a Scene,
    pub intersector: &'a Intersector,
    pub laser: &'a Laser,
    /// The maximum number of surfaces that light may meet; `None` for no limit.
    pub max_depth: Option<u32>,
    pub key: DrawKey,
    pub paths: usize,
}

/// A visitor of light paths, all of which draw from the numbers of their group.
struct Numbered<V> {
    draws: Draws,
    visit: V,
}

impl<'a> LightGroup<'a> {
    /// Draws rays from the phase space of the beam, and shows `visit` the surfaces that they meet,
    /// one bounce after the other; paths that it removes end.
    pub(crate) fn follow(&self, visit: impl FnMut(u32, &mut Vec<Met<'a>>, &mut Draws)) {
        let mut draws = Draws::new(self.key);
        let emit = |number| {
            let EmittedRay { ray, flux } = self.laser.sample_ray(draws.start());
            // The aperture may lie in a surface.
            let start = (self.intersector).ray_from(ray.origin, ray.direction, ray.direction);
            Walker::new(number, start, flux)
        };
        let walkers = (0..self.paths).map(emit).collect();
        let walk = Walk {
            scene: self.scene,
            intersector: self.intersector,
            wavelength: self.laser.wavelength(),
            max_depth: self.max_depth.unwrap_or(u32::MAX),
            carried: Carried::Power {
                start: self.laser.power(),
            },
            roulette: ROULETTE,
        };
        walk.follow(walkers, &mut Numbered { draws, visit });
    }
}

impl<'a, V: FnMut(u32, &mut Vec<Met<'a>>, &mut Draws)> Visitor<'a> for Numbered<V> {
    fn meet(&mut self, depth: u32, met: &mut Vec<Met<'a>>) {
        (self.visit)(depth, met, &mut self.draws);
    }

    fn direction(&mut self, _: usize, _: u32) -> [f64; 2] {
        self.draws.uniform_2d()
    }

    fn survival(&mut self, _: usize, _: u32) -> f64 {
        self.draws.uniform()
    }
}
