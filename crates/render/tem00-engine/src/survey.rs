//! A survey of the light that has met several rough surfaces, before a frame is rendered.

mod from_camera;
mod from_laser;
mod path;

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use tem00_camera::Ray;
use tem00_geometry::Intersector;
use tem00_numerics::parallel;
use tem00_tracer::{RenderOptions, Scene, TracerError};

use self::path::PathPoint;
use crate::{
    SpecklePlan,
    integrator::is_plate,
    sampler::{pixel_key, point_in_square},
    speckle::{
        CascadeNote, CellGrid, Change, LightKey, MultipleMap, MultiplePath, MultipleSums,
        SpecklePoint, moves,
    },
    vertex::Vertex,
};

/// Survey of a frame at some resolution.
pub(crate) struct Survey<'a> {
    pub scene: &'a Scene,
    pub frame: u32,
    /// The surfaces as they stand in the frame.
    pub intersector: &'a Intersector,
    /// The motion since the reference frame.
    pub change: &'a Change,
    pub seed: u64,
    /// The maximum number of surfaces that light may meet between laser and camera; `None` for no
    /// limit.
    pub max_depth: Option<u32>,
    /// The number of cells along the longer side of the image.
    pub cells: usize,
}

/// Separates the random numbers of a survey from the random numbers of a render.
const SEED: u64 = 0x005e_ed0f;

/// Returns whether a frame shows multiple light whose speckle differs from the speckle of the
/// single light: its paths differ by a length that counts, by a motion, or by polarisation.
pub(crate) fn asks_for_survey(scene: &Scene, frame: u32, options: &RenderOptions) -> bool {
    let is_broad = scene
        .lasers
        .iter()
        .any(|l| !l.spectrum().is_monochromatic());
    let is_depolarised = scene.surfaces.iter().any(|s| s.speckle.polarisation < 1.0);
    let is_other_frame = frame != scene.reference_frame && moves(scene);
    !is_single(scene, options) && (is_broad || is_depolarised || is_other_frame)
}

/// Returns whether light cannot meet more than one rough surface.
fn is_single(scene: &Scene, options: &RenderOptions) -> bool {
    is_plate(scene) || options.max_depth == Some(1)
}

/// The number of cells along the longer side of the image in a survey that plans the slices.
const PLANNED_CELLS: usize = 16;

impl SpecklePlan {
    /// Chooses the patterns for a scene.
    ///
    /// Each is the [`StackPlan`](tem00_speckle::StackPlan) for the image, the part of the scene
    /// that moves into it, and the longest displacement of the pupil in the frames, which rays find
    /// in every frame. Where the slices of all frames do not fit the memory, or do not lie along
    /// one line, each frame has its own slices, a part of a path without end. Settings of the scene
    /// file are kept.
    ///
    /// # Errors
    ///
    /// Returns an error if C exceeds Q/2, if the imaging geometry is not possible, if the speckle
    /// of a surface is not a sum of patterns, if something moves in more than 262,144 frames, or if
    /// the patterns of no frame fit the memory that the scene allows.
    pub fn new(scene: &Scene, seed: u64) -> Result<Self, TracerError> {
        let max_depth = scene.render.max_depth;
        Self::with_survey(scene, seed, &|frame, intersector, change| {
            let survey = Survey {
                scene,
                frame,
                intersector,
                change,
                seed,
                max_depth,
                cells: PLANNED_CELLS,
            };
            asks_for_survey(scene, frame, &scene.render).then(|| survey.map())?
        })
    }
}

/// The groups of light paths of a laser, and the paths in each. A point of the image sees two
/// groups, which are independent of each other; neighbouring points see other groups.
const GROUPS: usize = 16;
const PATHS: usize = 32;

/// Side of a block of cells, one of which is surveyed by both methods.
const PROBE: usize = 4;

/// Starting point of paths.
///
/// Paths that start at the camera miss a beam that is narrow compared with the visible surface, and
/// paths that start at the laser miss small objects in a wide beam.
#[derive(Clone, Copy)]
enum PathStart {
    Laser,
    Camera,
}

/// Rough surfaces along paths, by laser, group and path.
type PathPoints<'a> = Vec<Vec<Vec<Vec<PathPoint<'a>>>>>;

/// Returns a note for each laser and surface where multiple light comes from so small a part of
/// another surface that the speckle of that part is as coarse as the resolution of the camera: this
/// speckle of speckle is left out.
///
/// The notes judge the reference frame, where the light is not faint.
///
/// # Errors
///
/// Returns an error if the geometry cannot be built.
pub fn cascade_notes(scene: &Scene) -> Result<Vec<CascadeNote>, TracerError> {
    if is_single(scene, &scene.render) {
        return Ok(Vec::new());
    }
    let frame = scene.reference_frame;
    let intersector = Intersector::build(&scene.shapes_at(frame))?;
    let change = Change::new(scene, frame);
    let survey = Survey {
        scene,
        frame,
        intersector: &intersector,
        change: &change,
        seed: 0,
        max_depth: scene.render.max_depth,
        cells: PLANNED_CELLS,
    };
    let map = survey.map();
    let notes = map.iter().flat_map(MultipleMap::strongest_cascades);
    Ok(notes
        .filter(|(_, variance)| *variance > CASCADE)
        .map(|((laser, surface), variance)| CascadeNote {
            surface: scene.surfaces[surface].name.clone(),
            laser,
            contrast: (1.0 + variance).sqrt(),
        })
        .collect())
}

/// The excess of the squared contrast from which speckle of speckle is worth a note.
const CASCADE: f64 = 0.05;

impl<'a> Survey<'a> {
    /// Follows light from the lasers, connects the surfaces that it meets with points that the
    /// camera sees, and returns the multiple light found there, if any.
    pub(crate) fn map(&self) -> Option<MultipleMap> {
        let camera = self.change.camera();
        let lit = self.path_points();
        let grid = CellGrid::over([camera.width(), camera.height()], self.cells);
        let starts = parallel::map(self.scene.lasers.len(), |laser| {
            self.better_start(laser, &lit[laser], grid)
        });
        let sums = parallel::map(grid.columns * grid.rows, |cell| {
            let Some(seen) = self.seen(grid, cell) else {
                return CellSums::new();
            };
            let lasers = starts.iter().zip(&lit).enumerate();
            lasers
                .map(|(laser, (&start, groups))| {
                    let sums = self.sums(laser, start, groups, (grid, cell, &seen));
                    ((laser, seen.point.surface), sums)
                })
                .collect()
        });
        MultipleMap::new(grid, &sums)
    }

    /// Chooses the starting point from which more paths find the light of a laser, in one of
    /// `PROBE`² cells.
    fn better_start(
        &self,
        laser: usize,
        groups: &[Vec<Vec<PathPoint<'_>>>],
        grid: CellGrid,
    ) -> PathStart {
        let probed = |cell: &usize| {
            let place = [cell % grid.columns, cell / grid.columns];
            place.map(|i| i % PROBE) == [PROBE / 2; 2]
        };
        let mut found = [0.0; 2];
        for cell in (0..grid.columns * grid.rows).filter(probed) {
            let Some(seen) = self.seen(grid, cell) else {
                continue;
            };
            for (found, start) in found.iter_mut().zip([PathStart::Laser, PathStart::Camera]) {
                let sums = self.sums(laser, start, groups, (grid, cell, &seen));
                *found += sums.effective_paths();
            }
        }
        if found[1] > found[0] {
            PathStart::Camera
        } else {
            PathStart::Laser
        }
    }

    /// Sums over pairs of paths to the point of one cell that the camera sees.
    fn sums(
        &self,
        laser: usize,
        start: PathStart,
        groups: &[Vec<Vec<PathPoint<'_>>>],
        (grid, cell, seen): (CellGrid, usize, &SeenPoint<'_>),
    ) -> MultipleSums {
        let number = 2 * (cell % grid.columns + 3 * (cell / grid.columns));
        let paths = [0, 1].map(|i| match start {
            PathStart::Laser => self.multiple(laser, seen, &groups[(number + i) % GROUPS]),
            PathStart::Camera => {
                let first = (2 * cell + i) * PATHS + 1;
                self.multiple_from_camera(laser, seen, first as u64)
            }
        });
        let line = self.scene.lasers[laser].spectrum();
        let place = (seen.point, self.single(laser, &seen.vertex));
        let [first, second] = &paths;
        MultipleSums::of_groups(line, place, [first, second], PATHS)
    }

    /// The rough surface that the camera sees at some point of a cell.
    fn seen(&self, grid: CellGrid, cell: usize) -> Option<SeenPoint<'a>> {
        let camera = self.change.camera();
        let corner = DVec2::new((cell % grid.columns) as f64, (cell / grid.columns) as f64);
        let size = DVec2::new(camera.width() as f64, camera.height() as f64);
        // The same point in every frame.
        let within = point_in_square(pixel_key(self.seed ^ SEED, [0, cell as u64, 0]));
        let pixel = (grid.side as f64 * (corner + DVec2::from_array(within))).min(size);
        let ray = camera.ray(pixel);
        let hit = self.intersector.intersect(&ray)?;
        let material = &self.scene.surfaces.get(hit.surface)?.material;
        let vertex = Vertex::seen(&ray, &hit, material)?;
        let distance = (camera.position() - hit.position).length();
        (!vertex.is_specular()).then_some(SeenPoint {
            point: SpecklePoint {
                pixel,
                position: hit.position,
                normal: vertex.seen_normal(),
                surface: hit.surface,
                wave: 0.5,
            },
            vertex,
            ray,
            to_pupil: -ray.direction,
            sin_aperture: (0.5 * camera.pupil_diameter() / distance).min(1.0),
        })
    }

    /// Returns the radiance at a vertex of laser light that has met only the surface there.
    fn single(&self, laser: usize, vertex: &Vertex<'_>) -> f64 {
        let laser = self.change.laser(laser);
        let Some(light) = laser.next_event(vertex.hit.position) else {
            return 0.0;
        };
        let reflected = vertex.reflected_from(light.wi, laser.wavelength());
        let radiance = light.e_perp * reflected;
        let mut is_free = [false];
        let segment = vertex.segment_to(light.point);
        if radiance > 0.0 {
            self.intersector.visible_batch(&[segment], &mut is_free);
        }
        if is_free[0] { radiance } else { 0.0 }
    }

    /// The place of a vertex now, and in the reference frame.
    fn places(&self, vertex: &Vertex<'_>) -> [DVec3; 2] {
        let position = vertex.hit.position;
        [position, self.change.origin(vertex.hit.surface, position)]
    }

    fn polarisation_of(&self, surface: usize) -> f64 {
        self.scene.surfaces[surface].speckle.polarisation
    }

    /// The light of a group of paths from a laser that arrives over the rough surfaces they have
    /// met.
    fn multiple(
        &self,
        laser: usize,
        seen: &SeenPoint<'_>,
        group: &[Vec<PathPoint<'_>>],
    ) -> Vec<MultiplePath> {
        let (position, surface) = (seen.point.position, seen.point.surface);
        let origin = self.change.origin(surface, position);
        let [now, before] = self
            .change
            .paths_to(laser, surface, position)
            .unwrap_or_default();
        let wavelength = self.change.laser(laser).wavelength();
        let arriving = group.iter().flatten().filter_map(|lit| {
            let (irradiance, wi) = lit.irradiance_at(position, wavelength)?;
            let radiance = irradiance * seen.vertex.reflected_from(wi, wavelength);
            (radiance > 0.0).then_some((lit, wi, radiance))
        });
        let arriving: Vec<_> = arriving.collect();
        let segments = arriving.iter().map(|(lit, ..)| lit.segment_to(position));
        let mut free = vec![false; arriving.len()];
        self.intersector
            .visible_batch(&segments.collect::<Vec<_>>(), &mut free);
        let paths = arriving.into_iter().zip(free).filter(|(_, free)| *free);
        let paths = paths.map(|((lit, wi, radiance), _)| {
            let path = lit.path_to(position, origin);
            MultiplePath {
                radiance,
                delay: path.length - now,
                added: path.change - (now - before),
                polarisation: path.polarisation * self.polarisation_of(surface),
                pupil: seen.pupil_of(wi),
            }
        });
        paths.collect()
    }
}

/// The sums of a cell.
type CellSums = BTreeMap<LightKey, MultipleSums>;

/// A point that the camera sees.
struct SeenPoint<'a> {
    point: SpecklePoint,
    vertex: Vertex<'a>,
    /// The ray by which it is seen.
    ray: Ray,
    /// The unit direction to the pupil, and the sine of the half-angle that it fills.
    to_pupil: DVec3,
    sin_aperture: f64,
}

impl SeenPoint<'_> {
    /// Returns the displacement of the field in the pupil, in diameters, per change of the unit
    /// direction of incidence: its component across the line of sight, the other being along the
    /// normal.
    fn pupil_of(&self, direction: DVec3) -> DVec3 {
        let normal = self.point.normal;
        let along = direction.dot(self.to_pupil) / normal.dot(self.to_pupil);
        (direction - along * normal) / (2.0 * self.sin_aperture)
    }
}

#[cfg(test)]
mod tests;
