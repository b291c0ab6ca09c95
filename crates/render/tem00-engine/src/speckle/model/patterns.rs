//! The patterns of a laser, and the slices of them that a frame looks up.

use std::sync::{Arc, Mutex, PoisonError};

use tem00_decorrelation::ImagingGeometry;
use tem00_shading::SpeckleShift;
use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
use tem00_tracer::TracerError;

use super::super::{PatternPlan, allocation::PatternAllocation, plan::SurfacePatterns};

/// The patterns of one laser.
#[derive(Clone, Debug)]
pub(super) struct LaserPatterns {
    pub(super) geometry: ImagingGeometry,
    pub(super) patterns: Vec<Pattern>,
    /// The patterns in which each surface looks up its speckle.
    pub(super) surface_patterns: Vec<SurfacePatterns>,
}

/// Independent patterns of one size.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    /// Slices per pupil diameter.
    pub(super) slices_per_diameter: f64,
    /// The largest shifts to either side of the reference frame that the slices hold, in pupil
    /// diameters.
    reaches: [f64; 2],
    /// Pupil field of each stack.
    fields: Vec<PupilField>,
    path: SlicePath,
    /// The lattice points about which the slices of each frame lie; empty where one stack holds the
    /// slices of all frames.
    middles: Vec<[i64; 2]>,
    /// The slices that the last frame has looked up.
    last: Arc<Mutex<Option<Arc<Window>>>>,
}

/// The slices of a pattern that a frame looks up.
#[derive(Clone, Debug)]
pub(super) struct Window {
    /// The lattice point about which they lie, and the slice there.
    pub(super) middle: [i64; 2],
    middle_slice: f64,
    /// The slices that are looked up to either side.
    reach: f64,
    pub(super) stacks: Vec<SpeckleStack>,
}

impl LaserPatterns {
    pub(super) fn generate(
        geometry: ImagingGeometry,
        plan: &PatternPlan,
    ) -> Result<Self, TracerError> {
        let allocations = plan.allocations.iter().zip(0_u64..);
        let patterns = allocations
            .map(|(allocation, number)| Pattern::generate(allocation, plan.seed_of(number)))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            geometry,
            patterns,
            surface_patterns: plan.surface_patterns.to_vec(),
        })
    }
}

impl Pattern {
    fn generate(allocation: &PatternAllocation, seed: u64) -> Result<Self, TracerError> {
        let first = allocation.stack.field(seed)?;
        let pattern = Self {
            slices_per_diameter: allocation.stack.slices_per_diameter(),
            reaches: allocation.reaches(),
            fields: first.independent(allocation.count)?,
            path: allocation.stack.path(),
            middles: allocation.middles.clone(),
            last: Arc::default(),
        };
        // The memory is asked for before anything is rendered.
        pattern.window(0)?;
        Ok(pattern)
    }

    /// Returns the slices that a frame looks up: the slices of the last frame, or new ones.
    pub(super) fn window(&self, frame: u32) -> Result<Arc<Window>, TracerError> {
        let middle = self.middles.get(frame as usize).copied();
        let middle = middle.unwrap_or([0; 2]);
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(window) = last.as_ref().filter(|window| window.middle == middle) {
            return Ok(Arc::clone(window));
        }
        // This frees the memory for the new slices.
        *last = None;
        let window = Arc::new(self.generate_window(middle)?);
        *last = Some(Arc::clone(&window));
        Ok(window)
    }

    fn generate_window(&self, middle: [i64; 2]) -> Result<Window, TracerError> {
        let stacks = self.fields.iter().map(|field| {
            let field = field.clone().displaced(middle);
            SpeckleStack::generate(&field, self.path)
        });
        let diameter = self.fields.first().map_or(1.0, |field| field.diameter()[0]);
        let slices = self.path.slice_count() as f64;
        Ok(Window {
            middle,
            middle_slice: middle[0] as f64 / diameter * self.slices_per_diameter,
            reach: match self.middles.is_empty() {
                true => f64::INFINITY,
                // The pupil itself takes a diameter of the path.
                false => 0.5 * (slices - self.slices_per_diameter),
            },
            stacks: stacks.collect::<Result<_, _>>()?,
        })
    }

    /// Writes the coordinates in slices where the pupil has moved by the shifts to one side.
    pub(super) fn coordinates_of(
        &self,
        stack: &SpeckleStack,
        shifts: &[SpeckleShift],
        sign: f64,
        coordinates: &mut [f64],
    ) {
        // Beyond the reach the speckle is independent of the reference frame, wherever the pupil
        // stands.
        let reach = self.reaches[usize::from(sign > 0.0)];
        for (u, shift) in coordinates.iter_mut().zip(shifts) {
            *u = shift.pupil;
        }
        stack.coordinates_within(reach, coordinates);
        coordinates.iter_mut().for_each(|u| *u *= sign);
    }
}

impl Window {
    /// Returns the coordinate within its stacks that belongs to a coordinate in slices.
    pub(super) fn local(&self, u: f64) -> f64 {
        (u - self.middle_slice).clamp(-self.reach, self.reach)
    }
}
