use glam::DVec3;
use tem00_geometry::Hit;

use super::{PATHS, SEED, SeenPoint, Survey, path::SurveyedPath};
use crate::{
    sampler::{pixel_key, point_in_square},
    speckle::MultiplePath,
    vertex::Vertex,
    walk::{Carried, Met, Roulette, Visitor, Walk, Walker},
};

/// Russian roulette: a path always leaves this number of surfaces before it may end by chance.
const ROULETTE: Roulette = Roulette { certain: 2 };

/// The paths back from a point that the camera sees, and the light of a laser on the surfaces that
/// they meet.
struct Sight<'s, 'a> {
    survey: &'s Survey<'a>,
    laser: usize,
    seen: &'s SeenPoint<'a>,
    /// The key of the first path.
    first: u64,
    paths: Vec<SurveyedPath>,
    /// Displacement of the field in the pupil per change of the first direction of each path.
    pupils: Vec<DVec3>,
    found: Vec<Vec<MultiplePath>>,
}

impl<'a> Survey<'a> {
    /// Follows a group of paths back from a point that the camera sees and returns the light of a
    /// laser on the further rough surfaces that they meet.
    pub(super) fn multiple_from_camera(
        &self,
        laser: usize,
        seen: &SeenPoint<'a>,
        first: u64,
    ) -> Vec<MultiplePath> {
        let Hit {
            surface, position, ..
        } = seen.vertex.hit;
        let [now, before] = self
            .change
            .paths_to(laser, surface, position)
            .unwrap_or_default();
        let start = SurveyedPath {
            length: -now,
            change: before - now,
            polarisation: self.polarisation_of(surface),
            last: self.places(&seen.vertex),
        };
        let mut sight = Sight {
            survey: self,
            laser,
            seen,
            first,
            paths: vec![start; PATHS],
            pupils: vec![DVec3::ZERO; PATHS],
            found: vec![Vec::new(); PATHS],
        };
        let walk = Walk {
            scene: self.scene,
            intersector: self.intersector,
            wavelength: self.change.laser(laser).wavelength(),
            max_depth: self.max_depth.unwrap_or(u32::MAX),
            carried: Carried::Radiance,
            roulette: ROULETTE,
        };
        let walkers = (0..PATHS).map(|number| Walker::new(number, seen.ray, 1.0));
        walk.follow(walkers.collect(), &mut sight);
        sight.found.concat()
    }
}

impl<'a> Visitor<'a> for Sight<'_, 'a> {
    fn meet(&mut self, depth: u32, met: &mut Vec<Met<'a>>) {
        // The first surface is the one that the camera sees.
        for Met { walker, vertex } in met.iter().filter(|_| depth > 1) {
            let number = walker.number;
            if depth == 2 {
                self.pupils[number] = self.seen.pupil_of(walker.ray.direction);
            }
            let path = &mut self.paths[number];
            *path = path.on_to(self.survey.places(vertex), walker.index());
            if !vertex.is_specular() {
                path.polarisation *= self.survey.polarisation_of(vertex.hit.surface);
                let found = self.lit(number, walker.carries, vertex);
                self.found[number].extend(found);
            }
        }
    }

    fn direction(&mut self, path: usize, depth: u32) -> [f64; 2] {
        self.draw(path, depth, 1)
    }

    fn survival(&mut self, path: usize, depth: u32) -> f64 {
        self.draw(path, depth, 2)[0]
    }
}

impl Sight<'_, '_> {
    fn draw(&self, path: usize, depth: u32, purpose: u64) -> [f64; 2] {
        let key = self.first + path as u64;
        point_in_square(pixel_key(
            self.survey.seed ^ SEED,
            [key, depth.into(), purpose],
        ))
    }

    /// The light of the laser that a path finds at a vertex.
    fn lit(&self, number: usize, carries: f64, vertex: &Vertex<'_>) -> Option<MultiplePath> {
        let Hit {
            surface, position, ..
        } = vertex.hit;
        let radiance = carries * self.survey.single(self.laser, vertex);
        let [now, before] = self.survey.change.paths_to(self.laser, surface, position)?;
        let path = &self.paths[number];
        (radiance > 0.0).then_some(MultiplePath {
            radiance,
            delay: path.length + now,
            added: path.change + now - before,
            polarisation: path.polarisation,
            pupil: self.pupils[number],
        })
    }
}
