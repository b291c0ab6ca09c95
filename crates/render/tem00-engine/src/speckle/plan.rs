mod lines;
mod planner;

use tem00_numerics::seed::{Purpose, derived};
use tem00_shading::Bandwidth;
use tem00_speckle::StackPlan;
use tem00_tracer::{Scene, TracerError, Trajectory};

use self::planner::Planner;
use super::{
    allocation::{Part, PatternAllocation},
    bandwidth::laser_lights,
    change::ReferencePoint,
    crossing::{CorrelationNote, Following},
    prescan::{LaserGroups, SurveyOfFrame, prescan},
};

/// The speckle patterns that a scene needs, chosen from its camera, image and motion.
///
/// Its `Display` has a line per laser, or one for each of its patterns, that states the choice and
/// its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecklePlan {
    patterns: Vec<PatternPlan>,
}

/// The patterns of one laser: their sizes, the path of the slices, and the reasons.
///
/// Surfaces that move alike share a pattern, as one body would. Other surfaces have their own
/// patterns: a surface that a moving body uncovers shows speckle that has not been seen there
/// before. A surface whose light is a sum of patterns has several.
#[derive(Clone, Debug, PartialEq)]
pub struct PatternPlan {
    wavelength: f64,
    speckle_size: f64,
    pub(super) allocations: Vec<PatternAllocation>,
    /// The patterns in which each surface looks up its speckle.
    pub(super) surface_patterns: Vec<SurfacePatterns>,
    /// The names of the surfaces.
    names: Vec<String>,
    notes: Vec<CorrelationNote>,
    chosen: bool,
    seed: u64,
}

/// Patterns in which a surface looks up its speckle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SurfacePatterns {
    /// The index of the patterns among the patterns of the laser.
    pub allocation: usize,
    /// The parts that add up: for each equal pattern, for each component of polarisation, for each
    /// mode.
    pub parts: Vec<Part>,
    /// The degree of polarisation, and the number of components that have light.
    pub polarisation: f64,
    pub components: usize,
    /// The number of modes.
    pub modes: usize,
    /// The point that distinguishes one side of the reference frame from the other.
    pub reference_point: Option<ReferencePoint>,
    /// Assignment of slices to a motion.
    pub following: Following,
    /// Treatment of the laser's linewidth. Each part then consists of several, in sequence, whose
    /// fields add.
    pub bandwidth: Option<Bandwidth>,
}

impl SurfacePatterns {
    /// Returns the parts of one component of polarisation in groups of `fields`, whose fields add.
    pub(super) fn fields_of(
        &self,
        component: usize,
        fields: usize,
    ) -> impl Iterator<Item = &[Part]> {
        let groups = self.parts.chunks(fields).enumerate();
        let of_component = move |index: usize| index / self.modes % self.components == component;
        groups
            .filter(move |(index, _)| of_component(*index))
            .map(|(_, parts)| parts)
    }
}

impl SpecklePlan {
    /// Chooses the patterns for a scene as [`new`](Self::new) does.
    ///
    /// `survey` finds the multiple light in a frame.
    pub(crate) fn with_survey(
        scene: &Scene,
        seed: u64,
        survey: &SurveyOfFrame<'_>,
    ) -> Result<Self, TracerError> {
        let geometries = scene
            .lasers
            .iter()
            .map(|laser| scene.camera.imaging_geometry(laser.wavelength()))
            .collect::<Result<Vec<_>, _>>()?;
        let groups = groups(scene);
        let laser_groups = LaserGroups {
            geometries: &geometries,
            groups: &groups,
        };
        let memory = scene.speckle.memory / scene.lasers.len().max(1) as u64;
        let prescans = prescan(scene, laser_groups, survey)?;
        let lights = laser_lights(scene, laser_groups)?;
        let lasers = prescans.iter().zip(&geometries).enumerate();
        let patterns = lasers
            .map(|(laser, (prescans, geometry))| {
                let planner = Planner {
                    scene,
                    laser,
                    groups: &groups,
                    lights: &lights[laser],
                };
                planner.plan(prescans, geometry, seed, memory)
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { patterns })
    }

    /// Returns a note for each laser and each group of surfaces that move alike whose rendered
    /// correlation between frames differs by more than 0.05 from the law.
    pub fn correlation_notes(&self) -> impl Iterator<Item = &CorrelationNote> {
        self.patterns.iter().flat_map(|pattern| &pattern.notes)
    }

    /// Returns the patterns, in the order of the lasers.
    pub fn patterns(&self) -> &[PatternPlan] {
        &self.patterns
    }
}

/// Returns the group of each surface: surfaces with the same motion share a group, and so do all
/// that stand still.
fn groups(scene: &Scene) -> Vec<usize> {
    let mut motions: Vec<&Trajectory> = Vec::new();
    let surfaces = scene.surfaces.iter();
    surfaces
        .map(|surface| {
            let motion = &surface.trajectory;
            let alike =
                |known: &&Trajectory| *known == motion || (known.is_still() && motion.is_still());
            motions.iter().position(alike).unwrap_or_else(|| {
                motions.push(motion);
                motions.len() - 1
            })
        })
        .collect()
}

impl PatternPlan {
    /// Returns the sizes of the stack of the first surface.
    pub fn stack(&self) -> &StackPlan {
        &self.first().stack
    }

    /// Returns the speckle size in the image, in pixels.
    pub const fn speckle_size_in_pixels(&self) -> f64 {
        self.speckle_size
    }

    /// Returns the largest motion of the pupil over the speckle that the scene asks for, in pupil
    /// diameters.
    pub fn largest_shift(&self) -> f64 {
        let motions = self
            .allocations
            .iter()
            .map(|a| a.needs.motion.unwrap_or(0.0));
        motions.fold(0.0, f64::max)
    }

    /// Returns the bytes that all patterns of the laser take.
    pub fn memory_bytes(&self) -> u64 {
        self.allocations
            .iter()
            .map(PatternAllocation::memory_bytes)
            .sum()
    }

    /// The patterns of the first group of surfaces, of which there is always one.
    fn first(&self) -> &PatternAllocation {
        &self.allocations[0]
    }

    /// Returns the largest requirement of the linewidth among the surfaces of an allocation.
    fn bandwidth(&self, allocation: &PatternAllocation) -> Option<&Bandwidth> {
        let surfaces = allocation.surfaces.iter();
        let bandwidths =
            surfaces.filter_map(|&index| self.surface_patterns[index].bandwidth.as_ref());
        bandwidths.max_by(|a, b| a.reach.total_cmp(&b.reach))
    }

    /// Returns the seed of allocation `number`: the first has the seed of the laser.
    pub(super) const fn seed_of(&self, number: u64) -> u64 {
        derived(self.seed, Purpose::Body, number)
    }
}

#[cfg(test)]
mod tests;
