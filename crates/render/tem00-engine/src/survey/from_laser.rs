use super::{
    GROUPS, PATHS, PathPoints, SEED, Survey,
    path::{PathPoint, SurveyedPath},
};
use crate::{light_tracer::LightGroup, sampler::DrawKey, vertex::Vertex};
use tem00_numerics::parallel;

impl<'a> Survey<'a> {
    /// Follows light from the lasers, and returns the rough surfaces that each path meets.
    pub(super) fn path_points(&self) -> PathPoints<'a> {
        let groups =
            |laser| parallel::map(GROUPS, |group| self.path_points_of(laser, group as u64));
        (0..self.scene.lasers.len()).map(groups).collect()
    }

    fn path_points_of(&self, laser: usize, group: u64) -> Vec<Vec<PathPoint<'a>>> {
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
        let mut paths: Vec<Option<SurveyedPath>> = vec![None; PATHS];
        let mut points = vec![Vec::new(); PATHS];
        group.follow(|_, met, _| {
            for &met in &*met {
                let last = &mut paths[met.walker.number];
                let Some(path) = self.path_on(*last, &met.vertex, met.walker.index(), laser) else {
                    continue;
                };
                *last = Some(path);
                if !met.vertex.is_specular() {
                    points[met.walker.number].push(PathPoint { met, path });
                }
            }
        });
        points
    }

    /// Returns the path of light to a surface, continued from the last surface, or from the phase
    /// of the beam itself.
    fn path_on(
        &self,
        last: Option<SurveyedPath>,
        vertex: &Vertex<'_>,
        index: f64,
        laser: usize,
    ) -> Option<SurveyedPath> {
        let here = self.places(vertex);
        let polarisation = match vertex.is_specular() {
            true => 1.0,
            false => self.polarisation_of(vertex.hit.surface),
        };
        let Some(last) = last else {
            let hit = &vertex.hit;
            let [now, before] = self.change.paths_to(laser, hit.surface, hit.position)?;
            return Some(SurveyedPath {
                length: now,
                change: now - before,
                polarisation,
                last: here,
            });
        };
        let path = last.on_to(here, index);
        Some(SurveyedPath {
            polarisation: last.polarisation * polarisation,
            ..path
        })
    }
}
