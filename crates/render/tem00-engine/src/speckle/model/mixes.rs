//! Look-ups of points whose light is a sum of patterns, or of one wave number of a line.

use core::f64::consts::TAU;

use glam::DVec2;
use tem00_coherence::Recombination;
use tem00_shading::{BLOCK, SpeckleShift};
use tem00_speckle::{Complex, SpeckleStack, StackPlan};

use super::{
    super::{SpecklePoint, crossing::Following, plan::SurfacePatterns},
    Block, Mix, SpeckleFrame, Window, in_samples,
};

/// The fraction of light below which a pattern counts as even: many such patterns leave a contrast
/// below 0.04.
const FAINT_PATTERN: f64 = 0.02;

/// Look-up coordinates of a point.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// The image point in perspective, in pixels with y down.
    pixel: DVec2,
    /// The coordinate in slices.
    u: f64,
    /// The change of the phase with the height, in radians per metre.
    phase_per_height: f64,
}

impl SpeckleFrame<'_> {
    /// Looks up points in light of one wave number each, drawn from the line of the laser, and in
    /// sums of patterns.
    ///
    /// At another wave number the pupil is displaced along the axis of the surface, as after a
    /// motion, and the heights of the relief have other phases. Multiple light adds patterns, each
    /// at its own position.
    pub(super) fn look_up_mixes(
        &self,
        laser: usize,
        surface: &SurfacePatterns,
        (points, mixes): (&[SpecklePoint], &[Option<Mix>]),
        factors: &mut [f64],
    ) {
        let mut shifts = [SpeckleShift::default(); BLOCK];
        let shifts = &mut shifts[..points.len()];
        self.shifts(laser, (points, mixes), shifts);
        let shifted = points.iter().zip(&*shifts);
        let places: Vec<_> = shifted
            .map(|(point, motion)| self.place(laser, surface, point, motion))
            .collect();
        factors.fill(0.0);
        for component in [0, 1] {
            let sums: Vec<_> = mixes
                .iter()
                .map(|mix| recombined(surface.polarisation, mix.as_ref(), component))
                .collect();
            for (factor, sum) in factors.iter_mut().zip(&sums) {
                let faint = sum.patterns.iter().filter(|&&f| f < FAINT_PATTERN);
                *factor += sum.even + faint.sum::<f64>();
            }
            for number in 0..Recombination::PATTERNS {
                let fraction = |index: usize| sums[index].patterns[number];
                let lit: Vec<_> = (0..points.len())
                    .filter(|&index| fraction(index) >= FAINT_PATTERN)
                    .collect();
                let lit_places: Vec<_> = lit.iter().map(|&index| places[index]).collect();
                let pattern = [component, number];
                let intensities = self.intensities(laser, surface, &lit_places, pattern);
                for (index, intensity) in lit.into_iter().zip(intensities) {
                    factors[index] += fraction(index) * intensity;
                }
            }
        }
    }

    /// Returns the look-up coordinates of a point.
    fn place(
        &self,
        laser: usize,
        surface: &SurfacePatterns,
        point: &SpecklePoint,
        motion: &SpeckleShift,
    ) -> Place {
        let patterns = &self.model.lasers[laser];
        let (geometry, pattern) = (&patterns.geometry, &patterns.patterns[surface.allocation]);
        let sign = self.sides[laser].get(point.surface).copied().unwrap_or(1.0);
        let mut pixel = self.change.perspective().point(point.pixel) - motion.displacement;
        let along = match surface.following {
            Following::Length => sign * motion.pupil,
            Following::Axis(axis) => motion.pupil_vector().dot(axis),
        };
        let Some(bandwidth) = &surface.bandwidth else {
            let mut u = [pattern.slices_per_diameter * along];
            if surface.following == Following::Length {
                let stack = &self.windows[laser][surface.allocation].stacks[0];
                let motion = core::slice::from_ref(motion);
                pattern.coordinates_of(stack, motion, sign, &mut u);
            }
            return Place {
                pixel,
                u: u[0],
                phase_per_height: 0.0,
            };
        };
        let kappa = self.change.laser(laser).spectrum().draw(point.wave);
        let law = self.change.spectral_law(laser, geometry);
        let wave = law.shift(&point.seen(), kappa).unwrap_or_default();
        pixel -= wave.displacement;
        Place {
            pixel,
            u: pattern.slices_per_diameter
                * (bandwidth.stretch * wave.along(bandwidth.axis) + along),
            phase_per_height: wave.phase_per_height,
        }
    }

    /// Returns the intensities, of mean 1, of one of the independent patterns of a component of
    /// polarisation.
    fn intensities(
        &self,
        laser: usize,
        surface: &SurfacePatterns,
        places: &[Place],
        [component, number]: [usize; 2],
    ) -> Vec<f64> {
        let single = [[0.0, 1.0]];
        let (heights, axis) = match &surface.bandwidth {
            Some(bandwidth) => (bandwidth.heights.as_slice(), bandwidth.axis),
            None => (
                single.as_slice(),
                surface.following.axis().unwrap_or(DVec2::X),
            ),
        };
        let mut sums = vec![0.0; places.len()];
        if places.is_empty() {
            return sums;
        }
        let window = &self.windows[laser][surface.allocation];
        // A component that the single light does not have has its own positions.
        let planned = component.min(surface.components - 1);
        let number = number + (component - planned) * Recombination::PATTERNS;
        let beside = StackPlan::place(number);
        let mut whole = 0.0;
        for fields in surface.fields_of(planned, heights.len()) {
            let fraction = fields[0].fraction;
            whole += fraction;
            if let [part] = fields {
                let stack = &window.stacks[part.stack];
                let mut block = self.block(laser, (window, stack), places, axis);
                block.shift(part.offset, stack.size());
                block.shift(beside, stack.size());
                block.add(stack, fraction, &mut sums);
                continue;
            }
            let mut amplitudes = vec![Complex::<f64>::ZERO; places.len()];
            for (part, [height, root]) in fields.iter().zip(heights) {
                let stack = &window.stacks[part.stack];
                let mut block = self.block(laser, (window, stack), places, axis);
                block.shift(part.offset, stack.size());
                block.shift(beside, stack.size());
                // Each position sees the displacement of the pupil from the very first slice as its
                // own phase ramp.
                let [x0, y0] = in_samples(part.offset, stack.size());
                let turns: f64 = [0, 1]
                    .map(|axis| part.offset[axis] * window.middle[axis] as f64)
                    .iter()
                    .sum();
                for (i, (amplitude, place)) in amplitudes.iter_mut().zip(places).enumerate() {
                    let ramp = stack.ramp_at(x0, y0, block.u[i]) + TAU * turns;
                    let phase = Complex::cis(place.phase_per_height * height - ramp);
                    let field = stack.amplitude_at(block.x[i], block.y[i], block.u[i]);
                    *amplitude += field * phase * root;
                }
            }
            for (sum, amplitude) in sums.iter_mut().zip(&amplitudes) {
                *sum += fraction * amplitude.norm_sqr();
            }
        }
        sums.iter_mut().for_each(|sum| *sum /= whole);
        sums
    }

    /// Coordinates of places in a stack whose slices stand along an axis.
    fn block(
        &self,
        laser: usize,
        (window, stack): (&Window, &SpeckleStack),
        places: &[Place],
        axis: DVec2,
    ) -> Block {
        let geometry = &self.model.lasers[laser].geometry;
        let mut block = Block::default();
        for (i, place) in places.iter().enumerate() {
            let c = geometry.pattern_coordinate(place.pixel, DVec2::ZERO, stack.speckle_size());
            (block.x[i], block.y[i]) = (axis.dot(c), axis.perp().dot(c));
            block.u[i] = window.local(place.u);
        }
        block
    }
}

/// The patterns of a component of polarisation, as fractions of all light.
fn recombined(polarisation: f64, mix: Option<&Mix>, component: usize) -> Recombination {
    let of_component = |degree: f64| 0.5 * (1.0 + if component == 0 { degree } else { -degree });
    let single = of_component(polarisation);
    let Some(mix) = mix else {
        return Recombination::new([single, 0.0], 1.0, 1.0);
    };
    let light = &mix.multiple;
    let multiple = mix.fraction * of_component(light.polarisation);
    let radiances = [(1.0 - mix.fraction) * single, multiple];
    let recombination = match mix.is_faint {
        true => Recombination::of_two,
        false => Recombination::new,
    };
    recombination(radiances, light.with_single, light.within)
}
