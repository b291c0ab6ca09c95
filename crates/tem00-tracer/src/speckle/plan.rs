mod lines;

use tem00_decorrelation::ImagingGeometry;
use tem00_speckle::{IncoherentSum, SlicePath, StackNeeds, StackPlan};

use super::{
    allocation::{self, Part, PatternAllocation, Request},
    change::ReferencePoint,
    prescan::{LaserGroups, MotionPrescan, prescan},
};
use crate::{Formulas, Scene, SpeckleSettings, SurfaceSpeckle, TracerError, Trajectory};

/// The speckle patterns that a scene needs, chosen from its camera, image and motion.
///
/// Its `Display` has a line per laser, or one for each of its patterns, that states the choice and
/// its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecklePlan {
    patterns: Vec<PatternPlan>,
}

/// The patterns of one laser: sizes, path of the slices, and why.
///
/// Surfaces that move alike share a pattern, as one body would. Others have patterns of their own:
/// what a moving body uncovers shows speckle that has not been seen there before. A surface whose
/// light is a sum of patterns has several.
#[derive(Clone, Debug, PartialEq)]
pub struct PatternPlan {
    wavelength: f64,
    speckle_size: f64,
    allocations: Vec<PatternAllocation>,
    /// The patterns in which each surface looks up its speckle.
    surface_patterns: Vec<SurfacePatterns>,
    /// The names of the surfaces.
    names: Vec<String>,
    as_printed: bool,
    chosen: bool,
    seed: u64,
}

/// Patterns in which a surface looks up its speckle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SurfacePatterns {
    /// The patterns, among those of the laser.
    pub allocation: usize,
    /// The parts that add up.
    pub parts: Vec<Part>,
    /// The point that tells one side of the reference frame from the other.
    pub reference_point: Option<ReferencePoint>,
}

impl SpecklePlan {
    /// Chooses the patterns for a scene.
    ///
    /// Each is the [`StackPlan`] for the image, the part of the scene that moves into it, and the
    /// longest way by which the frames carry the pupil. What the scene file sets is kept. What the
    /// motion asks for beyond the memory is left out, and said so.
    ///
    /// # Errors
    ///
    /// Returns an error if C exceeds Q/2, if the imaging geometry is not possible, if the speckle of
    /// a surface is not a sum of patterns, or if the patterns do not fit the memory that the scene
    /// allows.
    pub fn new(scene: &Scene, formulas: Formulas, seed: u64) -> Result<Self, TracerError> {
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
        let prescans = prescan(scene, laser_groups)?;
        let lasers = prescans.iter().zip(&geometries).enumerate();
        let patterns = lasers
            .map(|(laser, (prescans, geometry))| {
                let planner = Planner {
                    scene,
                    laser,
                    formulas,
                    groups: &groups,
                };
                planner.plan(prescans, geometry, seed, memory)
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { patterns })
    }

    /// Returns the patterns, in the order of the lasers.
    pub fn patterns(&self) -> &[PatternPlan] {
        &self.patterns
    }
}

/// The group of each surface: those with the same motion have the same, and all that stand still.
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

/// Plans the patterns of one laser.
#[derive(Clone, Copy, Debug)]
struct Planner<'a> {
    scene: &'a Scene,
    laser: usize,
    formulas: Formulas,
    groups: &'a [usize],
}

impl Planner<'_> {
    fn plan(
        &self,
        prescans: &[MotionPrescan],
        geometry: &ImagingGeometry,
        seed: u64,
        memory: u64,
    ) -> Result<PatternPlan, TracerError> {
        let surfaces = self.scene.surfaces.iter();
        let sums = surfaces
            .map(|surface| fractions(&surface.speckle))
            .collect::<Result<Vec<_>, _>>()?;
        let requests = prescans.iter().enumerate();
        let requests: Vec<_> = requests
            .map(|(group, prescan)| self.request(group, prescan, &sums, geometry))
            .collect();
        let as_printed = self.formulas == Formulas::AsPrinted;
        let settings = &self.scene.speckle;
        let allocations = allocation::allocate(&requests, memory, |plan| {
            let plan = as_asked(plan, settings);
            if as_printed { plan.on_circle() } else { plan }
        })?;
        // Weyl steps keep the seeds of the lasers apart from each other and from the camera's.
        let number = self.laser as u64 + 1;
        Ok(PatternPlan {
            wavelength: geometry.wavelength(),
            speckle_size: geometry.speckle_size_in_pixels(),
            surface_patterns: self.surface_patterns(&requests, &allocations, &sums, prescans),
            allocations,
            names: self.scene.surfaces.iter().map(|s| s.name.clone()).collect(),
            as_printed,
            chosen: settings.size.is_none() && settings.diameter.is_none(),
            seed: seed.wrapping_add(number.wrapping_mul(0x9e37_79b9_7f4a_7c15)),
        })
    }

    /// Returns the requirements of the surfaces of a group.
    fn request(
        &self,
        group: usize,
        prescan: &MotionPrescan,
        sums: &[Vec<f64>],
        geometry: &ImagingGeometry,
    ) -> Request {
        let of_group = |&surface: &usize| self.groups[surface] == group;
        let surfaces: Vec<_> = (0..self.groups.len()).filter(of_group).collect();
        let moves = |&surface: &usize| self.scene.speckle_moves(self.laser, surface);
        let moves = surfaces.iter().any(moves);
        let parts = surfaces.iter().map(|&surface| sums[surface].len());
        Request {
            needs: StackNeeds {
                image: prescan.image.to_array(),
                region: prescan.region().to_array(),
                speckle_size: geometry.speckle_size_in_pixels(),
                motion: moves.then_some(prescan.shifts[0] + prescan.shifts[1]),
                frames: self.scene.frames,
                memory_limit: self.scene.speckle.memory,
            },
            shifts: prescan.shifts,
            parts: parts.max().unwrap_or(1),
            surfaces,
        }
    }

    /// Returns the patterns in which each surface looks up the parts of its speckle.
    fn surface_patterns(
        &self,
        requests: &[Request],
        allocations: &[PatternAllocation],
        sums: &[Vec<f64>],
        prescans: &[MotionPrescan],
    ) -> Vec<SurfacePatterns> {
        let shared = allocations
            .iter()
            .any(|allocation| allocation.positions > 1);
        let surfaces = self.groups.iter().zip(sums);
        surfaces
            .map(|(&group, fractions)| {
                let before = requests[..group].iter().map(|request| request.parts);
                let first: usize = before.sum();
                let parts = fractions.iter().enumerate();
                SurfacePatterns {
                    allocation: if shared { 0 } else { group },
                    reference_point: prescans[group].reference_point,
                    parts: parts
                        .map(|(number, &fraction)| match shared {
                            true => Part {
                                fraction,
                                stack: 0,
                                offset: allocation::offset(first + number),
                            },
                            false => Part {
                                fraction,
                                stack: number,
                                offset: [0.0; 2],
                            },
                        })
                        .collect(),
                }
            })
            .collect()
    }
}

/// The fractions of the light in the patterns that the speckle of a surface is the sum of.
fn fractions(speckle: &SurfaceSpeckle) -> Result<Vec<f64>, TracerError> {
    let patterns = IncoherentSum::equal(speckle.patterns as usize)?;
    let waves = IncoherentSum::partially_polarised(speckle.polarisation)?;
    Ok(patterns.split_by(&waves)?.weights().to_vec())
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

    pub(super) fn allocations(&self) -> &[PatternAllocation] {
        &self.allocations
    }

    pub(super) fn surface_patterns(&self) -> &[SurfacePatterns] {
        &self.surface_patterns
    }

    pub(super) const fn is_as_printed(&self) -> bool {
        self.as_printed
    }

    /// Returns the seed of allocation `number`: that of the laser for the first.
    pub(super) const fn seed_of(&self, number: u64) -> u64 {
        self.seed
            .wrapping_add(number.wrapping_mul(0xd1b5_4a32_d192_ed03))
    }
}

impl PatternAllocation {
    pub(super) const fn half_period(&self) -> usize {
        match self.stack.path() {
            SlicePath::Still => 1,
            SlicePath::Circle { half_period } | SlicePath::Straight { half_period, .. } => {
                half_period
            }
        }
    }
}

/// The plan with what the scene file sets.
fn as_asked(plan: StackPlan, settings: &SpeckleSettings) -> StackPlan {
    let plan = match (settings.size, settings.diameter) {
        (None, None) => plan,
        (Some(size), None) => plan.with_square(size, size / 2),
        (None, Some(diameter)) => plan.with_square(diameter.saturating_mul(2), diameter),
        (Some(size), Some(diameter)) => plan.with_square(size, diameter),
    };
    match settings.half_period {
        Some(half_period) => plan.with_half_period(half_period),
        None => plan,
    }
}

#[cfg(test)]
mod tests;
