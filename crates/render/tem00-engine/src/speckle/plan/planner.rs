//! The plan of the patterns of one laser.

use glam::DVec2;
use tem00_decorrelation::ImagingGeometry;
use tem00_numerics::seed::{Purpose, derived};
use tem00_shading::SurfaceLight;
use tem00_speckle::{StackNeeds, StackPlan, incoherent_fractions};
use tem00_tracer::{Scene, SpeckleSettings, SurfaceSpeckle, TracerError};

use super::{
    super::{
        allocation::{self, FrameRequest, Part, PatternAllocation, Request},
        change::ReferencePoint,
        crossing::{Followed, Following, Tracks, Waves},
        prescan::MotionPrescan,
    },
    PatternPlan, SurfacePatterns,
};

/// Plans the patterns of one laser.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planner<'a> {
    pub scene: &'a Scene,
    pub laser: usize,
    pub groups: &'a [usize],
    /// The light of the laser on each surface.
    pub lights: &'a [SurfaceLight],
}

/// The largest change of the pupil's motion from speckle to speckle, in pupil diameters, that
/// preserves the speckle size.
const WIDEST_SPREAD: f64 = 0.25;

/// The patterns that the speckle of a surface is the sum of.
#[derive(Clone, Debug)]
struct Sum {
    /// Fractions of the light whose intensities add.
    fractions: Vec<f64>,
    /// The number of patterns in each fraction whose fields add.
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
    pub(super) fn plan(
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
            // Surfaces that share a stack follow one line.
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

    /// Returns how slices can follow the motion of a group: by its length, and by the best method.
    fn followed(
        &self,
        group: usize,
        prescan: &MotionPrescan,
        geometry: &ImagingGeometry,
    ) -> [Followed; 2] {
        if prescan.frames.is_empty() {
            return [Followed::default(); 2];
        }
        let line = self.scene.lasers[self.laser].spectrum();
        let surfaces = self.surfaces_of(group);
        let waves = surfaces.iter().filter_map(|&surface| {
            let bandwidth = self.lights[surface].bandwidth.as_ref()?;
            let bandwidth = bandwidth.beside(pupil_path_across(prescan.reference_point.as_ref()));
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
        // A wider span makes its own grains in an image with this many speckles.
        let widest = WIDEST_SPREAD * prescan.image.length() / geometry.speckle_size_in_pixels();
        let needs = prescan.frames.iter();
        let spans: Vec<_> = needs
            .clone()
            .map(|frame| axis.map_or(frame.span, |axis| frame.pupil_shifts.along(axis)))
            .map(|[low, high]| {
                let (middle, half) = (0.5 * (low + high), 0.5 * (high - low).min(widest));
                [middle - half - reach, middle + half + reach]
            })
            .collect();
        let across = axis.map(|axis| {
            let middles = needs.map(|frame| frame.pupil_shifts.middle());
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
        let line = self.scene.lasers[self.laser].spectrum();
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
                    Following::Length => bandwidth.beside(pupil_path_across(moving.as_ref())),
                    Following::Axis(axis) => bandwidth.along(axis),
                });
                let allocation = if shared { 0 } else { group };
                let path = allocations[allocation].stack.path();
                let bandwidth = bandwidth.map(|bandwidth| bandwidth.on_slices(line, path));
                SurfacePatterns {
                    polarisation: sum.polarisation,
                    components: sum.components,
                    modes: sum.modes,
                    allocation,
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
                allowed: "few enough for at most 1024 in total with the patterns of linewidth and \
                    extent of the laser",
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

fn pupil_path_across(moving: Option<&ReferencePoint>) -> DVec2 {
    moving.map_or(DVec2::ZERO, ReferencePoint::pupil_path_across)
}

/// Returns the plan with the settings of the scene file.
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
