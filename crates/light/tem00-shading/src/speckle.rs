use std::sync::Arc;

use glam::{DVec2, DVec3};
use tem00_camera::Camera;
use tem00_coherence::Relief;
use tem00_decorrelation::ImagingGeometry;
use tem00_numerics::{Refusal, check};
use tem00_speckle::{
    PupilField, SpeckleError, SpeckleStack, StackNeeds, StackPlan, incoherent_fractions,
};

use crate::{
    Bandwidth, Laser, Motion, Perspective, Pose, PreparedSpeckle, ShadingError, SurfaceLight,
    patterns::{Field, Part, Patterns},
    state::{ReferencePoint, State},
};

/// Description of the speckle of a laser in the image of a camera, for the motions of some frames.
///
/// [`prepare`](Self::prepare) chooses the sizes and generates the patterns; the `Display` of the
/// result reports the choice and its reasons.
///
/// # Examples
///
/// A plane under a laser spot slides by 0.1 mm:
///
/// ```
/// use tem00_shading::{Camera, CameraDescription, DVec3, Laser, Pose, Speckle};
///
/// let camera = Camera::new(CameraDescription {
///     position: DVec3::new(0.1, 0.0, 0.3),
///     resolution: [64, 48],
///     ..CameraDescription::default()
/// })?;
/// let laser = Laser::spot(650e-9, 0.2e-3).placed(DVec3::Z * 0.5, DVec3::ZERO, DVec3::X)?;
/// let pose = Pose::along(DVec3::X * 1e-4)?;
///
/// let speckle = Speckle::new(&camera, &laser, 1).for_poses(&[pose]).within(64 << 20).prepare()?;
/// let frame = speckle.frame(&pose.into())?;
/// let (point, normal) = (DVec3::new(1e-4, 0.0, 0.0), DVec3::Z);
/// let light = laser.next_event(point).expect("a lit point");
/// let radiance = 0.8 / std::f64::consts::PI
///     * light.e_perp
///     * light.wi.dot(normal)
///     * frame.factor(point, normal);
/// assert!(radiance > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct Speckle {
    camera: Camera,
    laser: Laser,
    seed: u64,
    motions: Vec<Motion>,
    points: Vec<(DVec3, DVec3)>,
    memory: u64,
    looks: usize,
    polarisation: f64,
    relief: Relief,
}

impl Speckle {
    /// Describes the speckle of a laser in the image of a camera, both in the reference state, with
    /// the phasors of `seed`. The defaults are one look, polarised light, at most 256 MiB, and
    /// bodies at rest.
    ///
    /// A laser that is tuned while it is watched is not followed: patterns of one seed at two
    /// wavelengths do not correlate by the law.
    ///
    /// Two lasers need two seeds: [`derived`](tem00_numerics::seed::derived) derives them from one.
    pub fn new(camera: &Camera, laser: &Laser, seed: u64) -> Self {
        Self {
            camera: *camera,
            laser: laser.clone(),
            seed,
            motions: Vec::new(),
            points: Vec::new(),
            memory: 256 << 20,
            looks: 1,
            polarisation: 1.0,
            relief: Relief::default(),
        }
    }

    /// Adds frames in which a body has these poses, and camera and laser are at rest.
    pub fn for_poses<'a>(self, poses: impl IntoIterator<Item = &'a Pose>) -> Self {
        self.for_motions(poses.into_iter().map(|&pose| pose.into()))
    }

    /// Adds frames with these motions.
    pub fn for_motions(mut self, motions: impl IntoIterator<Item = Motion>) -> Self {
        self.motions.extend(motions);
        self
    }

    /// Sets points with their normals, in the reference state, from which the largest shift of the
    /// speckle is found.
    ///
    /// Without such points the largest shift is found where the light of the laser crosses the
    /// plane in focus, or over the whole image if this light is outside of it, on surfaces that
    /// face the camera, the laser or the direction between both.
    pub fn at_points(mut self, points: impl IntoIterator<Item = (DVec3, DVec3)>) -> Self {
        self.points.extend(points);
        self
    }

    /// Sets the memory limit of the patterns, in bytes.
    pub const fn within(mut self, bytes: u64) -> Self {
        self.memory = bytes;
        self
    }

    /// Sets the number of equal independent patterns that add up, which lowers the contrast to
    /// `1/√looks`: several exposures, positions or modes that the detector adds.
    pub const fn looks(mut self, looks: usize) -> Self {
        self.looks = looks;
        self
    }

    /// Sets the degree of polarisation of the light that reaches the sensor: 1 behind a polariser,
    /// near 0 for laser light from white paper without one.
    pub const fn polarisation(mut self, degree: f64) -> Self {
        self.polarisation = degree;
        self
    }

    /// Sets the surface relief finer than a resolution cell. The path differences of the relief
    /// lower the contrast of a laser with a linewidth.
    pub const fn relief(mut self, relief: Relief) -> Self {
        self.relief = relief;
        self
    }

    /// Chooses sizes, slices and seeds, and generates the patterns.
    ///
    /// # Errors
    ///
    /// Returns an error if the image or the motions need more memory than the limit, if the number
    /// of looks or the degree of polarisation is out of range, or if no frame shows a point from
    /// which the largest shift can be found.
    ///
    /// A laser with a linewidth or an extended source needs [`at_points`](Self::at_points), one of
    /// which the camera sees in the reference state. With a linewidth, motions must displace the
    /// pupil in the direction in which other wavelengths displace it: it is an error if the
    /// correlation of two frames would differ from the law by more than 0.05.
    pub fn prepare(self) -> Result<PreparedSpeckle, ShadingError> {
        let motions = self.motions.clone();
        let (mut patterns, fields) = self.planned()?;
        let stacks = fields.iter();
        let stacks = stacks.map(|field| SpeckleStack::generate(field, patterns.plan.path()));
        patterns.stacks = stacks.collect::<Result<_, _>>()?;
        let has_line = patterns.bandwidth.is_some();
        let speckle = PreparedSpeckle(Arc::new(patterns));
        for motion in motions.iter().filter(|_| has_line) {
            speckle.frame(motion)?;
        }
        Ok(speckle)
    }

    /// Chooses sizes, slices and seeds. Returns the patterns without their stacks, and the fields
    /// of the stacks.
    pub(crate) fn planned(mut self) -> Result<(Patterns, Vec<PupilField>), ShadingError> {
        self.motions.retain(|motion| !motion.is_still());
        let geometry = self.camera.imaging_geometry(self.laser.wavelength())?;
        let light = self.light(&geometry)?;
        check::that(self.looks > 0, "looks", self.looks, "", "at least 1")?;
        let fractions = incoherent_fractions(self.looks, self.polarisation, &light.modes)?;
        let mut demand = self.demand(&geometry)?;
        let bandwidth = light.bandwidth.map(|bandwidth| demand.beside(&bandwidth));
        let heights = bandwidth.as_ref().map_or(1, |b| b.heights.len());
        let fields = fractions.len() * heights;
        // The reference state counts as a frame; the wave numbers of a line need a path as long as
        // for many frames.
        let frames = 1 + self.motions.len();
        let frames = if bandwidth.is_some() {
            frames.max(3)
        } else {
            frames
        };
        let needs = demand.needs(frames, geometry.speckle_size_in_pixels(), self.memory);
        let Layout { plan, stacks } = Layout::new(&needs, fields)?;
        let line = self.laser.spectrum();
        let bandwidth = bandwidth.map(|bandwidth| bandwidth.on_slices(line, plan.path()));
        let waves = bandwidth.as_ref().map_or(1, |b| b.waves(line));
        let size = plan.size().map(|samples| samples as f64);
        let field = |number: usize| match stacks {
            1 => Field {
                stack: 0,
                offset: DVec2::from_array(StackPlan::place(number)) * DVec2::from_array(size),
            },
            _ => Field {
                stack: number,
                offset: DVec2::ZERO,
            },
        };
        let parts = fractions.into_iter().enumerate();
        let parts = parts.map(|(index, fraction)| Part {
            fraction,
            fields: (heights * index..heights * (index + 1))
                .map(field)
                .collect(),
        });
        let patterns = Patterns {
            waves,
            camera: self.camera,
            laser: self.laser,
            geometry,
            parts: parts.collect(),
            in_a_stack: fields / stacks,
            stacks: Vec::new(),
            bandwidth,
            needs,
            plan,
            shifts: demand.shifts,
            farthest: demand.farthest,
            points: self.points,
        };
        Ok((patterns, plan.field(self.seed)?.independent(stacks)?))
    }

    /// Finds the fractions and the bandwidth of the surface's speckle due to linewidth and extent
    /// of the laser.
    fn light(&self, geometry: &ImagingGeometry) -> Result<SurfaceLight, ShadingError> {
        if self.laser.is_coherent() {
            return Ok(SurfaceLight::single());
        }
        let state = State::new((&self.camera, &self.laser), &Motion::default())?;
        let seen = match self.points.is_empty() {
            true => Vec::new(),
            false => state.scouted(geometry, &self.points),
        };
        let seen = seen.into_iter().map(|(point, _)| point);
        let light = state.spectral_law(geometry).light(seen, self.relief);
        light.ok_or(ShadingError::Missing(
            "one of `at_points` in the image of the reference state, for a laser with a linewidth \
             or an extent",
        ))
    }

    /// Finds how far the speckle moves in the frames.
    fn demand(&self, geometry: &ImagingGeometry) -> Result<Demand, ShadingError> {
        let [low, high] = Perspective::new(self.camera).image();
        let mut demand = Demand {
            image: high - low,
            region: [low, high],
            shifts: [0.0; 2],
            farthest: None,
        };
        let motions = self.motions.iter();
        let states = motions.map(|motion| State::new((&self.camera, &self.laser), motion));
        let states = states.collect::<Result<Vec<_>, _>>()?;
        let seen: Vec<_> = states
            .iter()
            .map(|state| state.scouted(geometry, &self.points))
            .collect();
        if !seen.is_empty() && seen.iter().all(Vec::is_empty) {
            return Err(ShadingError::Missing(
                "one of `at_points` in the image of some frame",
            ));
        }
        let largest = states.iter().zip(&seen);
        let largest =
            largest.flat_map(|(state, seen)| seen.iter().map(move |found| (state, found)));
        let largest = largest.filter(|(_, (_, shift))| shift.pupil.is_finite());
        let largest = largest.max_by(|(_, a), (_, b)| a.1.pupil.total_cmp(&b.1.pupil));
        demand.farthest =
            largest.map(|(state, (point, shift))| state.reference_point(point, shift.pupil_path()));
        for (state, seen) in states.iter().zip(&seen) {
            let side = state.side(geometry, demand.farthest.as_ref());
            for (point, shift) in seen {
                let origin = state.perspective().point(point.pixel) - shift.displacement;
                demand.add(side, shift.pupil, origin);
            }
        }
        Ok(demand)
    }
}

/// Layout of the fields: a stack for each field, or one stack for all.
struct Layout {
    plan: StackPlan,
    stacks: usize,
}

impl Layout {
    /// Returns the plan that a memory limit allows, or `None` if no plan within the limit holds the
    /// motion and the region.
    fn plan(needs: &StackNeeds, memory_limit: u64) -> Result<Option<StackPlan>, ShadingError> {
        let needs = StackNeeds {
            memory_limit,
            ..*needs
        };
        match StackPlan::new(&needs) {
            Ok(plan) => {
                let holds = plan.holds_motion(&needs) && plan.holds_region(&needs);
                Ok(holds.then_some(plan))
            }
            Err(SpeckleError::MemoryLimit { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    fn new(needs: &StackNeeds, fields: usize) -> Result<Self, ShadingError> {
        let of = |stacks: usize| {
            let plan = Self::plan(needs, needs.memory_limit / stacks as u64)?;
            if let Some(plan) = plan {
                return Ok(Self { plan, stacks });
            }
            let enough = (1..u64::BITS).find_map(|doublings| {
                let limit = (needs.memory_limit / stacks as u64).max(1);
                Self::plan(needs, limit.saturating_mul(1 << doublings)).ok()?
            });
            let limit = needs.memory_limit;
            let Some(plan) = enough else {
                let allowed = "enough for slices over the whole motion of the poses (in bytes)";
                return Err(Refusal::new("memory", limit as f64, allowed).into());
            };
            let needed = plan.memory_bytes().saturating_mul(stacks as u64);
            Err(SpeckleError::MemoryLimit { needed, limit }.into())
        };
        let is_good = |layout: &Self| needs.motion.is_none() || layout.plan.blends_closely();
        match of(fields) {
            Ok(layout) if fields == 1 || is_good(&layout) => Ok(layout),
            _ => of(1),
        }
    }
}

/// Requirements of the frames on the patterns.
struct Demand {
    /// Width and height of the image, in pixels.
    image: DVec2,
    /// The corners of the region of the reference image from which speckle is looked up, in pixels.
    region: [DVec2; 2],
    /// The largest shifts of the pupil to either side of the reference, in pupil diameters; the
    /// second is on the side of the largest shift of all.
    shifts: [f64; 2],
    farthest: Option<ReferencePoint>,
}

impl Demand {
    fn add(&mut self, side: f64, shift: f64, origin: DVec2) {
        let [low, high] = self.region;
        self.region = [low.min(origin), high.max(origin)];
        if shift.is_finite() {
            let shifts = &mut self.shifts[usize::from(side > 0.0)];
            *shifts = shifts.max(shift);
        }
    }

    /// Extends the demand by the displacements of a linewidth, and returns the bandwidth oriented
    /// to the side of the largest shift.
    fn beside(&mut self, bandwidth: &Bandwidth) -> Bandwidth {
        let [before, after] = self.shifts;
        self.shifts = [before.max(after) + bandwidth.reach; 2];
        let [low, high] = self.region;
        // The region is rotated so that the slices lie along the axis.
        let size = (high - low).max(turned((high - low).abs(), bandwidth.axis.abs()));
        self.region = [low, low + size];
        let path = self
            .farthest
            .as_ref()
            .map(ReferencePoint::pupil_path_across);
        bandwidth.beside(path.unwrap_or(DVec2::ZERO))
    }

    fn needs(&self, frames: usize, speckle_size: f64, memory: u64) -> StackNeeds {
        let [low, high] = self.region;
        let [before, after] = self.shifts;
        StackNeeds {
            image: self.image.to_array(),
            region: (high - low).to_array(),
            speckle_size,
            motion: (frames > 1).then_some(before + after),
            frames: u32::try_from(frames).unwrap_or(u32::MAX),
            memory_limit: memory,
        }
    }
}

/// The width and height of a region along an axis and across it, both with positive parts.
fn turned(size: DVec2, axis: DVec2) -> DVec2 {
    DVec2::new(axis.dot(size), DVec2::new(axis.y, axis.x).dot(size))
}
