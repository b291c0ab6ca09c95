mod lines;

use glam::DVec2;
use tem00_decorrelation::ImagingGeometry;
use tem00_numerics::seed::{Purpose, derived};
use tem00_shading::{Bandwidth, SurfaceLight};
use tem00_speckle::{StackNeeds, StackPlan, incoherent_fractions};
use tem00_tracer::{Scene, SpeckleSettings, SurfaceSpeckle, TracerError, Trajectory};

use super::{
    allocation::{self, FrameRequest, Part, PatternAllocation, Request},
    bandwidth::laser_lights,
    change::ReferencePoint,
    crossing::{CorrelationNote, Followed, Following, Tracks, Waves},
    prescan::{LaserGroups, MotionPrescan, SurveyOfFrame, prescan},
};

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
    notes: Vec<CorrelationNote>,
    chosen: bool,
    seed: u64,
}

/// Patterns in which a surface looks up its speckle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SurfacePatterns {
    /// The patterns, among those of the laser.
    pub allocation: usize,
    /// The parts that add up: for each equal pattern, for each component of polarisation, for each mode.
    pub parts: Vec<Part>,
    /// The degree of polarisation, and the number of components that have light.
    pub polarisation: f64,
    pub components: usize,
    /// The number of modes.
    pub modes: usize,
    /// The point that tells one side of the reference frame from the other.
    pub reference_point: Option<ReferencePoint>,
    /// How the slices follow a motion.
    pub following: Following,
    /// What the linewidth of the laser asks. Each part is then several, one after the other, whose fields add.
    pub bandwidth: Option<Bandwidth>,
}

impl SurfacePatterns {
    /// Returns the parts of one component of polarisation, so many whose fields add together.
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

    /// Returns a note for each laser and each group of surfaces that move alike whose frames correlate otherwise, by
    /// more than 0.05, than by the law.
    pub fn correlation_notes(&self) -> impl Iterator<Item = &CorrelationNote> {
        self.patterns.iter().flat_map(|pattern| &pattern.notes)
    }

    /// Returns the patterns, in the order of the lasers.
    pub fn patterns(&self) -> &[PatternPlan] {
        &self.patterns
    }
}

fn way_across(moving: Option<&ReferencePoint>) -> DVec2 {
    moving.map_or(DVec2::ZERO, ReferencePoint::way_across)
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
    groups: &'a [usize],
    /// The light of the laser on each surface.
    lights: &'a [SurfaceLight],
}

/// The largest change of the motion of the pupil from speckle to speckle, in its diameters, that leaves their size.
const WIDEST_SPREAD: f64 = 0.25;

/// The patterns that the speckle of a surface is the sum of.
#[derive(Clone, Debug)]
struct Sum {
    /// Fractions of the light whose intensities add.
    fractions: Vec<f64>,
    /// The number of patterns of each whose fields add.
    fields: usize,
    polarisation: f64,
    components: usize,
    modes: usize,
}

impl Sum {
    const fn parts(&self) -> usize {
        self.fractions.len() * self.fields
    }
}

impl Planner<'_> {
    fn plan(
        &self,
        prescans: &[MotionPrescan],
        geometry: &ImagingGeometry,
        seed: u64,
        memory: u64,
    ) -> Result<PatternPlan, TracerError> {
        let surfaces = self.scene.surfaces.iter().zip(self.lights);
        let sums = surfaces
            .map(|(surface, light)| Sum::new(&surface.speckle, light))
            .collect::<Result<Vec<_>, _>>()?;
        let settings = &self.scene.speckle;
        let allocate = |followed: &[Followed]| {
            let requests = prescans.iter().zip(followed).enumerate();
            let requests: Vec<_> = requests
                .map(|(group, (prescan, followed))| {
                    self.request(group, prescan, followed.following, &sums, geometry)
                })
                .collect();
            let allocations =
                allocation::allocate(&requests, memory, |plan| as_asked(plan, settings))?;
            Ok::<_, TracerError>((requests, allocations))
        };
        let candidates = prescans.iter().enumerate();
        let candidates: Vec<_> = candidates
            .map(|(group, prescan)| self.followed(group, prescan, geometry))
            .collect();
        let chosen = |number: usize| candidates.iter().map(move |followed| followed[number]);
        let mut followed: Vec<_> = chosen(1).collect();
        let (mut requests, mut allocations) = allocate(&followed)?;
        if allocations.len() < requests.len() && chosen(1).any(|f| f.following.axis().is_some()) {
            // What shares a stack has one line.
            followed = chosen(0).collect();
            (requests, allocations) = allocate(&followed)?;
        }
        Ok(PatternPlan {
            wavelength: geometry.wavelength(),
            speckle_size: geometry.speckle_size_in_pixels(),
            surface_patterns: self.surface_patterns(
                &requests,
                &allocations,
                &sums,
                (prescans, &followed),
            ),
            notes: followed
                .iter()
                .filter_map(|followed| followed.note(self.scene, self.laser))
                .collect(),
            allocations,
            names: self.scene.surfaces.iter().map(|s| s.name.clone()).collect(),
            chosen: settings.size.is_none() && settings.diameter.is_none(),
            seed: derived(seed, Purpose::Laser, self.laser as u64),
        })
    }

    /// Returns how slices can follow the motion of a group: by its length, and as well as they can.
    fn followed(
        &self,
        group: usize,
        prescan: &MotionPrescan,
        geometry: &ImagingGeometry,
    ) -> [Followed; 2] {
        if prescan.frames.is_empty() {
            return [Followed::default(); 2];
        }
        let line = self.scene.lasers[self.laser].spectral_line();
        let surfaces = self.surfaces_of(group);
        let waves = surfaces.iter().filter_map(|&surface| {
            let bandwidth = self.lights[surface].bandwidth.as_ref()?;
            let bandwidth = bandwidth.beside(way_across(prescan.reference_point.as_ref()));
            Some(Waves::of(line, surface, bandwidth))
        });
        let mut waves: Vec<_> = waves.collect();
        if waves.is_empty() {
            waves.push(Waves::single(surfaces[0]));
        }
        Tracks::new(self.scene, (self.laser, geometry), prescan).followed(&waves)
    }

    fn surfaces_of(&self, group: usize) -> Vec<usize> {
        let of_group = |&surface: &usize| self.groups[surface] == group;
        (0..self.groups.len()).filter(of_group).collect()
    }

    /// Returns the requirements of the surfaces of a group.
    fn request(
        &self,
        group: usize,
        prescan: &MotionPrescan,
        following: Following,
        sums: &[Sum],
        geometry: &ImagingGeometry,
    ) -> Request {
        let surfaces = self.surfaces_of(group);
        let moves = |&surface: &usize| self.scene.speckle_moves(self.laser, surface);
        let moves = surfaces.iter().any(moves);
        let parts = surfaces.iter().map(|&surface| sums[surface].parts());
        let bandwidths = surfaces
            .iter()
            .filter_map(|&surface| self.lights[surface].bandwidth.as_ref());
        let reach = bandwidths.clone().map(|b| b.reach).fold(0.0, f64::max);
        let axis = following.axis();
        let axes = bandwidths.map(|b| b.axis).chain(axis);
        // Turned so that the slices stand along each axis.
        let turned = |region: DVec2| {
            axes.clone().fold(region, |largest, axis| {
                let [along, across] = [axis.abs(), axis.perp().abs()];
                largest.max(DVec2::new(along.dot(region), across.dot(region)))
            })
        };
        let mut shifts = prescan.shifts;
        let moves = moves || shifts.iter().any(|shift| *shift > 0.0);
        if reach > 0.0 {
            shifts = [shifts[0].max(shifts[1]) + reach; 2];
        }
        let frames = self.scene.frames;
        let by_frame = frames > 2 && !prescan.frames.is_empty();
        // What spreads wider makes grains of its own in an image of so many speckles.
        let widest = WIDEST_SPREAD * prescan.image.length() / geometry.speckle_size_in_pixels();
        let needs = prescan.frames.iter();
        let spans: Vec<_> = needs
            .clone()
            .map(|frame| axis.map_or(frame.span, |axis| frame.ways.along(axis)))
            .map(|[low, high]| {
                let (middle, half) = (0.5 * (low + high), 0.5 * (high - low).min(widest));
                [middle - half - reach, middle + half + reach]
            })
            .collect();
        let across = axis.map(|axis| {
            let middles = needs.map(|frame| frame.ways.middle());
            middles.map(|middle| middle.dot(axis.perp())).collect()
        });
        Request {
            needs: StackNeeds {
                image: prescan.image.to_array(),
                region: turned(prescan.region()).to_array(),
                speckle_size: geometry.speckle_size_in_pixels(),
                motion: (moves || reach > 0.0).then_some(shifts[0] + shifts[1]),
                frames,
                memory_limit: self.scene.speckle.memory,
            },
            shifts,
            frames: (by_frame || across.is_some()).then(|| FrameRequest {
                region: turned(prescan.shared_region(&spans)).to_array(),
                spans,
                across,
            }),
            parts: parts.max().unwrap_or(1),
            surfaces,
        }
    }

    /// Returns the patterns in which each surface looks up the parts of its speckle.
    fn surface_patterns(
        &self,
        requests: &[Request],
        allocations: &[PatternAllocation],
        sums: &[Sum],
        (prescans, followed): (&[MotionPrescan], &[Followed]),
    ) -> Vec<SurfacePatterns> {
        let shared = allocations
            .iter()
            .any(|allocation| allocation.positions > 1);
        let surfaces = self.groups.iter().zip(sums).zip(self.lights);
        surfaces
            .map(|((&group, sum), light)| {
                let before = requests[..group].iter().map(|request| request.parts);
                let first: usize = before.sum();
                let fractions = sum.fractions.iter();
                let fields =
                    fractions.flat_map(|fraction| core::iter::repeat_n(fraction, sum.fields));
                let parts = fields.enumerate();
                let moving = prescans[group].reference_point;
                let bandwidth = light.bandwidth.as_ref();
                let following = followed[group].following;
                let bandwidth = bandwidth.map(|bandwidth| match following {
                    Following::Length => bandwidth.beside(way_across(moving.as_ref())),
                    Following::Axis(axis) => bandwidth.along(axis),
                });
                SurfacePatterns {
                    polarisation: sum.polarisation,
                    components: sum.components,
                    modes: sum.modes,
                    allocation: if shared { 0 } else { group },
                    reference_point: moving,
                    following,
                    bandwidth,
                    parts: parts
                        .map(|(number, &fraction)| match shared {
                            true => Part {
                                fraction,
                                stack: 0,
                                offset: StackPlan::place(first + number),
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

impl Sum {
    fn new(speckle: &SurfaceSpeckle, light: &SurfaceLight) -> Result<Self, TracerError> {
        let patterns = speckle.patterns as usize;
        let fractions = incoherent_fractions(patterns, speckle.polarisation, &light.modes);
        let fractions = fractions.map_err(|error| match light.modes.len() {
            1 => error.into(),
            _ => TracerError::OutOfRange {
                parameter: "patterns",
                value: f64::from(speckle.patterns),
                allowed: "so few that at most 1024 add up with those of the linewidth and the extent of the laser",
            },
        })?;
        let components = if speckle.polarisation < 1.0 { 2 } else { 1 };
        Ok(Self {
            polarisation: speckle.polarisation,
            components,
            modes: fractions.len() / (patterns * components),
            fractions,
            fields: light
                .bandwidth
                .as_ref()
                .map_or(1, |bandwidth| bandwidth.heights.len()),
        })
    }
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

    /// What the linewidth asks of the surface of an allocation that asks for most.
    fn bandwidth(&self, allocation: &PatternAllocation) -> Option<&Bandwidth> {
        let surfaces = allocation.surfaces.iter();
        let bandwidths =
            surfaces.filter_map(|&index| self.surface_patterns[index].bandwidth.as_ref());
        bandwidths.max_by(|a, b| a.reach.total_cmp(&b.reach))
    }

    pub(super) fn allocations(&self) -> &[PatternAllocation] {
        &self.allocations
    }

    pub(super) fn surface_patterns(&self) -> &[SurfacePatterns] {
        &self.surface_patterns
    }

    /// Returns the seed of allocation `number`: that of the laser for the first.
    pub(super) const fn seed_of(&self, number: u64) -> u64 {
        derived(self.seed, Purpose::Body, number)
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
