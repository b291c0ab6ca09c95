use std::sync::Arc;

use glam::{DVec2, DVec3};
use tem00_camera::Camera;
use tem00_decorrelation::ImagingGeometry;
use tem00_speckle::{SpeckleStack, StackNeeds, StackPlan, incoherent_fractions};

use crate::{
    Laser, Motion, Perspective, Pose, PreparedSpeckle, ShadingError,
    prepared::{Part, Patterns},
    state::{ReferencePoint, State},
};

/// What speckle is wanted: of a laser, in the image of a camera, for the motions of some frames.
///
/// [`prepare`](Self::prepare) chooses the sizes and generates the patterns; its `Display` says what it chose and why.
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
}

impl Speckle {
    /// Asks for the speckle of a laser in the image of a camera, both as they stand in the reference state, with the
    /// phasors of `seed`: one look, polarised, in at most 256 MiB, of bodies that stand still.
    ///
    /// Two lasers want two seeds.
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
        }
    }

    /// Adds frames in which a body has these poses, and camera and laser stand still.
    pub fn for_poses<'a>(self, poses: impl IntoIterator<Item = &'a Pose>) -> Self {
        self.for_motions(poses.into_iter().map(|&pose| pose.into()))
    }

    /// Adds frames with these motions.
    pub fn for_motions(mut self, motions: impl IntoIterator<Item = Motion>) -> Self {
        self.motions.extend(motions);
        self
    }

    /// Sets points with their normals, in the reference state, from which the largest shift of the speckle is found.
    ///
    /// Without them it is found where the light of the laser crosses the plane in focus, or all over the image if it is
    /// seen nowhere, on a surface that faces the camera, the laser or the direction between both.
    pub fn at_points(mut self, points: impl IntoIterator<Item = (DVec3, DVec3)>) -> Self {
        self.points.extend(points);
        self
    }

    /// Sets the bytes that the patterns may take.
    pub const fn within(mut self, bytes: u64) -> Self {
        self.memory = bytes;
        self
    }

    /// Sets the number of equal independent patterns that add up, which lowers the contrast to `1/√looks`: of several
    /// exposures, places or modes that the detector adds.
    pub const fn looks(mut self, looks: usize) -> Self {
        self.looks = looks;
        self
    }

    /// Sets the degree of polarisation of the light that reaches the sensor: 1 behind a polariser, near 0 for laser light
    /// off white paper without one.
    pub const fn polarisation(mut self, degree: f64) -> Self {
        self.polarisation = degree;
        self
    }

    /// Chooses sizes, slices and seeds, and generates the patterns.
    ///
    /// # Errors
    ///
    /// Returns an error if the image or the motions need more memory than allowed, if the number of looks or the degree
    /// of polarisation is out of range, if no frame shows a point from which to find the largest shift, or if the laser is not monochromatic or no point: looks stand for what that takes
    /// of the contrast.
    pub fn prepare(mut self) -> Result<PreparedSpeckle, ShadingError> {
        self.check_coherence()?;
        self.motions.retain(|motion| !motion.is_still());
        let geometry = self.camera.imaging_geometry(self.laser.wavelength())?;
        let fractions = incoherent_fractions(self.looks, self.polarisation, &[1.0])?;
        let demand = self.demand(&geometry)?;
        // The reference state is one of them.
        let frames = 1 + self.motions.len();
        let of_each = self.memory / fractions.len() as u64;
        let needs = demand.needs(frames, geometry.speckle_size_in_pixels(), of_each);
        let plan = StackPlan::new(&needs)?;
        if !(plan.holds_motion(&needs) && plan.holds_region(&needs)) {
            return Err(ShadingError::OutOfRange {
                parameter: "memory",
                value: self.memory as f64,
                allowed: "enough for slices over the whole motion of the poses (in bytes)",
            });
        }
        let fields = plan.field(self.seed)?.independent(fractions.len())?;
        let parts = fields.iter().zip(fractions).map(|(field, fraction)| {
            let stack = SpeckleStack::generate(field, plan.path())?;
            Ok(Part { fraction, stack })
        });
        Ok(PreparedSpeckle(Arc::new(Patterns {
            camera: self.camera,
            laser: self.laser,
            geometry,
            parts: parts.collect::<Result<_, ShadingError>>()?,
            needs,
            plan,
            shifts: demand.shifts,
            farthest: demand.farthest,
            points: self.points,
        })))
    }

    fn check_coherence(&self) -> Result<(), ShadingError> {
        let length = self.laser.spectral_line().coherence_length();
        if length.is_finite() {
            return Err(ShadingError::OutOfRange {
                parameter: "coherence_length",
                value: length,
                allowed: "infinite (in metres): monochromatic light",
            });
        }
        if !self.laser.source_extent().is_point() {
            return Err(ShadingError::Direction {
                parameter: "source_extent",
                allowed: "that of a point",
            });
        }
        Ok(())
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
            largest.map(|(state, (point, shift))| state.reference_point(point, shift.way()));
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

/// What the frames ask of the patterns.
struct Demand {
    /// Width and height of the image, in pixels.
    image: DVec2,
    /// The corners of the region of the reference image from which speckle is looked up, in pixels.
    region: [DVec2; 2],
    /// The largest shifts of the pupil to either side of the reference, in its diameters; the second to the side of
    /// the farthest.
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
