mod mixes;
mod patterns;

use std::sync::Arc;

use glam::DVec2;
use tem00_shading::{BLOCK, LightPath, SpeckleShift};
use tem00_speckle::SpeckleStack;
use tem00_tracer::{Scene, SpeckleBelow, TracerError};

use self::patterns::{LaserPatterns, Pattern, Window};
use super::{
    SpecklePlan, SpecklePoint,
    change::Change,
    crossing::Following,
    multiple::{MultipleLight, MultipleMap},
};

/// The speckle patterns of a scene, ready to be looked up.
#[derive(Clone, Debug)]
pub struct SpeckleModel {
    lasers: Vec<LaserPatterns>,
}

/// The speckle of a scene in one frame.
#[derive(Clone, Debug)]
pub(crate) struct SpeckleFrame<'a> {
    model: &'a SpeckleModel,
    change: Change,
    /// On which side of the reference frame each surface is for each laser, as 1 or −1.
    sides: Vec<Vec<f64>>,
    /// The slices of each pattern of each laser.
    windows: Vec<Vec<Arc<Window>>>,
    /// The light that has met several rough surfaces, where its speckle differs from the speckle of
    /// the single light.
    multiple: Option<MultipleMap>,
    /// The speckle of the light from below translucent surfaces, by laser and surface.
    below: Vec<Vec<Option<SpeckleBelow>>>,
}

/// The mixture of multiple and single light at a point.
#[derive(Clone, Copy, Debug)]
struct Mix {
    multiple: MultipleLight,
    /// The fraction of the multiple light.
    fraction: f64,
    /// Whether the light is faint.
    is_faint: bool,
}

/// Coordinates in a stack: x and y in samples, u in slices.
#[derive(Clone, Copy, Debug)]
struct Block {
    x: [f64; BLOCK],
    y: [f64; BLOCK],
    u: [f64; BLOCK],
}

impl SpeckleModel {
    /// Generates the patterns of a plan.
    ///
    /// # Errors
    ///
    /// Returns an error if the memory for a stack cannot be allocated.
    pub fn generate(scene: &Scene, plan: &SpecklePlan) -> Result<Self, TracerError> {
        let lasers = scene.lasers.iter().zip(plan.patterns());
        let lasers = lasers
            .map(|(laser, plan)| {
                LaserPatterns::generate(scene.camera.imaging_geometry(laser.wavelength())?, plan)
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { lasers })
    }

    /// Returns the number of lasers that have patterns.
    pub(crate) const fn pattern_count(&self) -> usize {
        self.lasers.len()
    }

    /// Returns the speckle in a frame of the scene that the model was generated for.
    ///
    /// # Errors
    ///
    /// Returns an error if the memory for the slices of the frame cannot be allocated.
    pub(crate) fn in_frame(
        &self,
        scene: &Scene,
        frame: u32,
    ) -> Result<SpeckleFrame<'_>, TracerError> {
        let change = Change::new(scene, frame);
        let lasers = self.lasers.iter().enumerate();
        let sides = lasers.map(|(index, laser)| {
            let surface_patterns = laser.surface_patterns.iter();
            let sides = surface_patterns
                .map(|p| change.side(index, &laser.geometry, p.reference_point.as_ref()));
            sides.collect()
        });
        let windows = self.lasers.iter().map(|laser| {
            let patterns = laser.patterns.iter();
            patterns.map(|pattern| pattern.window(frame)).collect()
        });
        Ok(SpeckleFrame {
            model: self,
            sides: sides.collect(),
            windows: windows.collect::<Result<_, _>>()?,
            change,
            multiple: None,
            below: Vec::new(),
        })
    }
}

impl SpeckleFrame<'_> {
    /// Returns the motion since the reference frame.
    pub(crate) const fn change(&self) -> &Change {
        &self.change
    }

    /// Looks up the speckle of multiple light with the results of a survey.
    pub(crate) fn with_multiple_light(mut self, map: Option<MultipleMap>) -> Self {
        self.multiple = map;
        self
    }

    /// Gives the light from below translucent surfaces its speckle, by laser and surface.
    pub(crate) fn with_light_below(mut self, below: Vec<Vec<Option<SpeckleBelow>>>) -> Self {
        self.below = below;
        self
    }

    /// Returns the speckle of the light of a laser from below a surface.
    pub(crate) fn below(&self, laser: usize, surface: usize) -> Option<&SpeckleBelow> {
        self.below.get(laser)?.get(surface)?.as_ref()
    }

    /// Returns the speckle factor of laser `laser` at a surface point, for the local ratio of
    /// single to multiple light.
    pub(crate) fn factor(&self, laser: usize, point: &SpecklePoint) -> f64 {
        let key = (laser, point.surface);
        let map = self.multiple.as_ref();
        let layer = map.and_then(|map| map.layer(key));
        let light = layer.map(|layer| layer.at(point.pixel));
        let mut factor = [0.0];
        let single = light.map_or(0.0, |light| light.single);
        self.factors(laser, core::slice::from_ref(point), &[single], &mut factor);
        factor[0]
    }

    /// Writes the speckle factors of laser `laser` at many surface points into `factors`, the same
    /// bits as one by one.
    ///
    /// `singles` are the radiances of the light that has met only this surface.
    ///
    /// Neighbouring points of one surface, one after the other, are looked up fastest.
    ///
    /// # Panics
    ///
    /// Panics unless the slices have the same length and the model has patterns for the laser.
    pub(crate) fn factors(
        &self,
        laser: usize,
        points: &[SpecklePoint],
        singles: &[f64],
        factors: &mut [f64],
    ) {
        assert!(
            points.len() == factors.len() && singles.len() == points.len(),
            "{} points for {} factors",
            points.len(),
            factors.len()
        );
        let mut done = 0;
        for run in points.chunk_by(|a, b| a.surface == b.surface) {
            for points in run.chunks(BLOCK) {
                let block = done..done + points.len();
                done = block.end;
                self.look_up(laser, points, &singles[block.clone()], &mut factors[block]);
            }
        }
    }

    /// Looks up a block of points on one surface.
    fn look_up(&self, laser: usize, points: &[SpecklePoint], singles: &[f64], factors: &mut [f64]) {
        factors.fill(1.0);
        let patterns = &self.model.lasers[laser];
        let Some(surface) = points
            .first()
            .and_then(|p| patterns.surface_patterns.get(p.surface))
        else {
            return;
        };
        let pattern = &patterns.patterns[surface.allocation];
        let window = &self.windows[laser][surface.allocation];
        let map = self.multiple.as_ref();
        let layer = map.and_then(|map| map.layer((laser, points[0].surface)));
        let mut mixes = [const { None }; BLOCK];
        if let Some(layer) = layer {
            for ((mix, point), single) in mixes.iter_mut().zip(points).zip(singles) {
                let multiple = layer.at(point.pixel);
                *mix = Some(Mix {
                    multiple,
                    fraction: multiple.fraction_beside(*single),
                    is_faint: multiple.radiance + single < layer.faint,
                });
            }
        }
        let mixes = &mixes[..points.len()];
        let is_one_pattern = |mix: &Option<Mix>| {
            mix.is_none_or(|mix| mix.multiple.is_coherent(surface.polarisation))
        };
        let follows_axis = surface.following != Following::Length;
        if surface.bandwidth.is_some() || follows_axis || !mixes.iter().all(is_one_pattern) {
            self.look_up_mixes(laser, surface, (points, mixes), factors);
            return;
        }
        factors.fill(0.0);
        for part in &surface.parts {
            let stack = &window.stacks[part.stack];
            let mut block = self.coordinates(laser, pattern, stack, (points, mixes));
            block.u.iter_mut().for_each(|u| *u = window.local(*u));
            block.shift(part.offset, stack.size());
            block.add(stack, part.fraction, factors);
        }
    }

    /// Writes the shifts of the speckle of points of one surface since the reference frame.
    fn shifts(
        &self,
        laser: usize,
        (points, mixes): (&[SpecklePoint], &[Option<Mix>]),
        shifts: &mut [SpeckleShift],
    ) {
        let (change, geometry) = (&self.change, &self.model.lasers[laser].geometry);
        let new = change.new_speckle();
        let mut known = [None; BLOCK];
        let known = &mut known[..points.len()];
        change.known_shifts((laser, LightPath::Direct), geometry, points, known);
        for (shift, known) in shifts.iter_mut().zip(&*known) {
            *shift = known.unwrap_or(new);
        }
        if change.is_reference() || mixes.iter().all(Option::is_none) {
            return;
        }
        change.known_shifts((laser, LightPath::Carried), geometry, points, known);
        for ((shift, known), mix) in shifts.iter_mut().zip(&*known).zip(mixes) {
            if let (Some(mix), Some(carried)) = (mix, known) {
                *shift = mix.multiple.shift([*shift, *carried], mix.fraction);
            }
        }
    }

    /// Coordinates of the points of a surface in its pattern.
    fn coordinates(
        &self,
        laser: usize,
        pattern: &Pattern,
        stack: &SpeckleStack,
        (points, mixes): (&[SpecklePoint], &[Option<Mix>]),
    ) -> Block {
        let mut shifts = [SpeckleShift::default(); BLOCK];
        let shifts = &mut shifts[..points.len()];
        self.shifts(laser, (points, mixes), shifts);
        let geometry = &self.model.lasers[laser].geometry;
        let per_pixel = geometry.pattern_coordinate(DVec2::ONE, DVec2::ZERO, stack.speckle_size());
        let sides = &self.sides[laser];
        let side = points.first().and_then(|p| sides.get(p.surface));
        let sign = side.copied().unwrap_or(1.0);
        let mut block = Block::default();
        for (i, (point, shift)) in points.iter().zip(&*shifts).enumerate() {
            let pixel = self.change.perspective().point(point.pixel) - shift.displacement;
            [block.x[i], block.y[i]] = (pixel * per_pixel).to_array();
        }
        let u = &mut block.u[..points.len()];
        pattern.coordinates_of(stack, shifts, sign, u);
        block
    }
}

impl Default for Block {
    fn default() -> Self {
        Self {
            x: [0.0; BLOCK],
            y: [0.0; BLOCK],
            u: [0.0; BLOCK],
        }
    }
}

impl Block {
    /// Moves the coordinates by an offset in periods of a stack of `size` samples.
    fn shift(&mut self, offset: [f64; 2], size: [usize; 2]) {
        let [x0, y0] = in_samples(offset, size);
        self.x.iter_mut().for_each(|x| *x += x0);
        self.y.iter_mut().for_each(|y| *y += y0);
    }

    /// Adds the intensities at the coordinates, times a fraction, to `sums`.
    fn add(&self, stack: &SpeckleStack, fraction: f64, sums: &mut [f64]) {
        let count = sums.len();
        let mut intensities = [0.0; BLOCK];
        stack.intensity_batch(
            &self.x[..count],
            &self.y[..count],
            &self.u[..count],
            &mut intensities[..count],
        );
        let pairs = sums.iter_mut().zip(&intensities);
        pairs.for_each(|(sum, intensity)| *sum += fraction * intensity);
    }
}

/// Converts an offset in periods of a stack to samples.
fn in_samples(offset: [f64; 2], size: [usize; 2]) -> [f64; 2] {
    [0, 1].map(|axis| offset[axis] * size[axis] as f64)
}

#[cfg(test)]
mod tests;
