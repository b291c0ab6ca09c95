use super::{
    GROUPS, PATHS, SEED, Survey, WayPoints,
    way::{Way, WayPoint},
};
use crate::{light_tracer::LightGroup, sampler::DrawKey, vertex::Vertex};
use rayon::prelude::*;

impl<'a> Survey<'a> {
    /// Follows light from the lasers, and returns the rough surfaces that each path meets.
    pub(super) fn way_points(&self) -> WayPoints<'a> {
        let groups = |laser: usize| {
            let groups = (0..GROUPS as u64).into_par_iter();
            groups
                .map(|group| self.way_points_of(laser, group))
                .collect()
        };
        (0..self.scene.lasers.len()).map(groups).collect()
    }

    fn way_points_of(&self, laser: usize, group: u64) -> Vec<Vec<WayPoint<'a>>> {
        let group = LightGroup {
            scene: self.scene,
            intersector: self.intersector,
            laser: self.change.laser(laser),
            // The surface that the camera sees is one more.
            max_depth: self.max_depth.map(|depth| depth.saturating_sub(1)),
            key: DrawKey {
                seed: self.seed ^ SEED,
                frame: self.frame,
                laser,
                group,
            },
            paths: PATHS,
        };
        let mut ways: Vec<Option<Way>> = vec![None; PATHS];
        let mut points = vec![Vec::new(); PATHS];
        group.follow(|_, met, _| {
            for &met in &*met {
                let last = &mut ways[met.walker.number];
                let Some(way) = self.way_on(*last, &met.vertex, met.walker.index(), laser) else {
                    continue;
                };
                *last = Some(way);
                if !met.vertex.is_specular() {
                    points[met.walker.number].push(WayPoint { met, way });
                }
            }
        });
        points
    }

    /// Returns the path of light to a surface, continued from the last surface, or from the phase
    /// of the beam itself.
    fn way_on(
        &self,
        last: Option<Way>,
        vertex: &Vertex<'_>,
        index: f64,
        laser: usize,
    ) -> Option<Way> {
        let here = self.places(vertex);
        let polarisation = match vertex.is_specular() {
            true => 1.0,
            false => self.polarisation_of(vertex.hit.surface),
        };
        let Some(last) = last else {
            let hit = &vertex.hit;
            let [now, before] = self.change.paths_to(laser, hit.surface, hit.position)?;
            return Some(Way {
                length: now,
                change: now - before,
                polarisation,
                last: here,
            });
        };
        let way = last.on_to(here, index);
        Some(Way {
            polarisation: last.polarisation * polarisation,
            ..way
        })
    }
}
