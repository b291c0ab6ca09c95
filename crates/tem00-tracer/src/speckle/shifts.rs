//! What has become of the speckle of many points of a surface, in loops that fill the vector units.

use std::sync::OnceLock;

use glam::{DVec2, DVec3};
use tem00_decorrelation::{
    ChangedPoint, ImagingGeometry, PointChange, RigidChange, pupil_overlap_correlation,
};
use tem00_numerics::{disc_overlap_inverse, vectorised};

use super::{SpecklePoint, axial_loss::AxialLoss, change::Change, upright};
use crate::laser::{WaveFrame, WaveShape};

/// Points that are worked out together.
pub(super) const BLOCK: usize = 64;

/// Points that share vector instructions: a block with fewer ends on a multiple of it.
const LANES: usize = 8;

/// The light whose speckle is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Light {
    /// Light straight from the laser.
    Direct,
    /// Light that keeps its phases where it meets the surface, however the laser moves.
    Carried,
}

/// Motion of the speckle of a point since the reference frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SpeckleShift {
    /// The displacement of the speckle in the image in perspective, in pixels with y down.
    pub displacement: DVec2,
    /// The displacement of the pupil over the speckle, in pupil diameters, never negative.
    pub pupil: f64,
    /// The part of it across the line of sight, to the right and up, in pupil diameters.
    pub across: DVec2,
}

impl SpeckleShift {
    /// Returns the displacement of the pupil as a vector: one without direction is to the right.
    pub(super) fn way(&self) -> DVec2 {
        self.pupil * self.across.try_normalize().unwrap_or(DVec2::X)
    }
}

/// What is the same for all points of a surface.
struct Shared<'a> {
    law: &'a RigidChange,
    /// The laser in the reference frame and now.
    lasers: [WaveFrame; 2],
    is_carried: bool,
    pixels_per_tangent: f64,
    per_diameter: f64,
    /// The axial displacement per change of 1/Z, in axial decorrelation lengths.
    axial_length: f64,
}

/// A block of points, component by component.
struct Block {
    position: [[f64; BLOCK]; 3],
    normal: [[f64; BLOCK]; 3],
    focus_vergence: [f64; BLOCK],
}

/// What has become of their speckle.
struct Changes {
    displacement: [[f64; BLOCK]; 2],
    across: [[f64; BLOCK]; 2],
    /// Across the pupil, in its diameters; infinite where the theory has no value.
    pupil: [f64; BLOCK],
    /// Along the axis, in axial decorrelation lengths.
    axial: [f64; BLOCK],
}

impl Change {
    /// Returns what has become of the speckle of a laser at a point.
    ///
    /// Where the theory has no value, every frame has speckle of its own.
    pub(super) fn speckle_shift(
        &self,
        laser: usize,
        geometry: &ImagingGeometry,
        point: &SpecklePoint,
    ) -> SpeckleShift {
        let shift = self.known_shift(laser, geometry, point, Light::Direct);
        shift.unwrap_or_else(|| self.new_speckle())
    }

    /// Returns what has become of the speckle of a laser at a point, if the theory has a value.
    pub(super) fn known_shift(
        &self,
        laser: usize,
        geometry: &ImagingGeometry,
        point: &SpecklePoint,
        light: Light,
    ) -> Option<SpeckleShift> {
        let mut shift = [None];
        let point = core::slice::from_ref(point);
        self.known_shifts((laser, light), geometry, point, &mut shift);
        shift[0]
    }

    /// Speckle that has nothing of that in the reference frame.
    pub(super) fn new_speckle(&self) -> SpeckleShift {
        SpeckleShift {
            pupil: self.frames().abs(),
            ..SpeckleShift::default()
        }
    }

    /// Writes what has become of the speckle of light of a laser at points of one surface, `None` where the theory has
    /// no value.
    ///
    /// # Panics
    ///
    /// Panics unless the slices have the same length, of [`BLOCK`] at most.
    pub(super) fn known_shifts(
        &self,
        (laser, light): (usize, Light),
        geometry: &ImagingGeometry,
        points: &[SpecklePoint],
        shifts: &mut [Option<SpeckleShift>],
    ) {
        assert_eq!(points.len(), shifts.len(), "a shift for each point");
        let Some(surface) = points.first().map(|point| point.surface) else {
            return;
        };
        if light == Light::Direct && self.is_still(laser, surface) {
            shifts.fill(Some(SpeckleShift::default()));
            return;
        }
        shifts.fill(None);
        let Some(law) = self.law(surface) else {
            return;
        };
        let diameter = geometry.pupil_diameter();
        let now = self.laser(laser);
        let shared = Shared {
            law,
            lasers: [self.laser_before(laser), now].map(|laser| laser.wave_frame()),
            is_carried: light == Light::Carried,
            pixels_per_tangent: geometry.principal_distance() / geometry.pixel_pitch(),
            per_diameter: diameter.recip(),
            axial_length: 0.125 * diameter * diameter / now.wavelength(),
        };
        let block = Block::new(points, |pixel| {
            self.perspective().focus_vergence(geometry, pixel)
        });
        let mut changes = shared.changes(&block, points.len(), &now.wave_shape());
        changes.add_axial(points.len());
        for (index, shift) in shifts.iter_mut().enumerate() {
            *shift = changes.shift(index, self.new_speckle().pupil);
        }
    }
}

impl Block {
    #[inline(always)] // It is filled in where it lies.
    fn new(points: &[SpecklePoint], focus_vergence: impl Fn(DVec2) -> f64) -> Self {
        let mut block = Self {
            position: [[0.0; BLOCK]; 3],
            normal: [[0.0; BLOCK]; 3],
            focus_vergence: [0.0; BLOCK],
        };
        for (i, point) in points.iter().enumerate() {
            for axis in 0..3 {
                block.position[axis][i] = point.position[axis];
                block.normal[axis][i] = point.normal[axis];
            }
            block.focus_vergence[i] = focus_vergence(point.pixel);
        }
        block
    }
}

impl Shared<'_> {
    /// Works out the first `count` points of a block.
    #[inline(always)] // They are written where they lie.
    fn changes(&self, block: &Block, count: usize, shape: &WaveShape) -> Changes {
        let end = count.next_multiple_of(LANES).min(BLOCK);
        let mut changes = Changes {
            displacement: [[0.0; BLOCK]; 2],
            across: [[0.0; BLOCK]; 2],
            pupil: [0.0; BLOCK],
            axial: [0.0; BLOCK],
        };
        vectorised(
            #[inline(always)]
            || match shape {
                WaveShape::Spot(wave) => {
                    self.run(block, end, |local| wave.slopes(local), &mut changes);
                }
                WaveShape::Line(wave) => {
                    self.run(block, end, |local| wave.slopes(local), &mut changes);
                }
            },
        );
        changes
    }

    #[inline(always)]
    fn run(
        &self,
        block: &Block,
        end: usize,
        slopes: impl Fn([f64; 3]) -> [f64; 2],
        changes: &mut Changes,
    ) {
        let ([px, py, pz], [nx, ny, nz]) = (&block.position, &block.normal);
        for i in 0..end {
            let position = DVec3::new(px[i], py[i], pz[i]);
            let [before, now] = &self.lasers;
            let source = before.direction_to_source(self.law.origin(position), &slopes);
            let direct = now.direction_to_source(position, &slopes);
            let carried = self.law.turned(source);
            let point = self.law.at(&ChangedPoint {
                position,
                normal: DVec3::new(nx[i], ny[i], nz[i]),
                to_source: [source, if self.is_carried { carried } else { direct }],
            });
            self.put(&point, block.focus_vergence[i], i, changes);
        }
    }

    /// Adds what defocus moves the pattern by to the image of the point: `∓ C A (W + W') / 2`.
    #[inline(always)]
    fn put(&self, point: &PointChange, focus_vergence: f64, i: usize, changes: &mut Changes) {
        let [before, now] = point.per_depth;
        let defocus = 0.5 * (before + now) - focus_vergence;
        let pupil = point.pupil_displacement;
        let is_known = pupil.x <= f64::MAX;
        let beside = |of_pupil: f64| if is_known { of_pupil * defocus } else { 0.0 };
        let tangents = point.tangent_displacement;
        changes.displacement[0][i] = (tangents.x - beside(pupil.x)) * self.pixels_per_tangent;
        changes.displacement[1][i] = (tangents.y - beside(pupil.y)) * self.pixels_per_tangent;
        changes.across[0][i] = pupil.x * self.per_diameter;
        changes.across[1][i] = pupil.y * self.per_diameter;
        changes.pupil[i] = pupil.length_squared().sqrt() * self.per_diameter;
        changes.axial[i] = (now - before) * self.axial_length;
    }
}

impl Changes {
    /// Adds what the first `count` points have moved along the line of sight to the shifts of the pupil.
    fn add_axial(&mut self, count: usize) {
        static LOSS: OnceLock<AxialLoss> = OnceLock::new();
        let end = count.next_multiple_of(LANES).min(BLOCK);
        if self.axial[..count]
            .iter()
            .all(|axial| axial.abs() < NO_AXIAL_SHIFT)
        {
            return;
        }
        let loss = LOSS.get_or_init(AxialLoss::new);
        let mut kept = [0.0; BLOCK];
        vectorised(
            #[inline(always)]
            || {
                loss.write(end, [&self.pupil, &self.axial], &mut kept);
                let axial = self.axial.iter().zip(&kept);
                for (pupil, (axial, kept)) in self.pupil[..end].iter_mut().zip(axial) {
                    *pupil = equivalent_shift(*pupil, axial.abs(), *kept);
                }
            },
        );
    }

    /// The shift of a point, or `None` where it has no value; `new` is that of the pupil for speckle that leaves elsewhere.
    fn shift(&self, index: usize, new: f64) -> Option<SpeckleShift> {
        let [x, y] = self.displacement.map(|along| along[index]);
        let displacement = upright(DVec2::new(x, y));
        let pupil = self.pupil[index];
        displacement.is_finite().then_some(SpeckleShift {
            displacement,
            pupil: if pupil.is_finite() { pupil } else { new },
            across: DVec2::from_array(self.across.map(|along| along[index])),
        })
    }
}

/// Axial shifts below this one take at most β²/4 = π² x² = 1e-13 of the correlation.
const NO_AXIAL_SHIFT: f64 = 1e-7;

/// The shift of the pupil, in its diameters, whose overlap leaves as much as a shift across and one along the line of
/// sight, which has `kept` a part of what the first has left.
///
/// Shifts beyond one diameter keep growing, which tells the speckle of two later frames apart: exactly so for motion
/// across the line of sight; along it, beyond the first zero of the correlation, by the unit of that
/// zero, without the revival of 4.7 % behind it.
#[inline(always)]
fn equivalent_shift(lateral: f64, axial: f64, kept: f64) -> f64 {
    let equivalent = disc_overlap_inverse((pupil_overlap_correlation(lateral) * kept).sqrt());
    let beyond_the_zero = if axial >= 1.0 { axial } else { 0.0 };
    let both = equivalent.max(lateral).max(beyond_the_zero);
    if axial < NO_AXIAL_SHIFT {
        lateral
    } else {
        both
    }
}

#[cfg(test)]
mod tests;
