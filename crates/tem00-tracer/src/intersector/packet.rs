use fearless_simd::{Simd, f32x8, f32x16, prelude::*};

use super::{
    hierarchy::{LocalRay, Node, Scale, WIDTH},
    lanes::{Met, RayLanes, TriangleLanes, meet_boxes, meet_triangles},
};

/// The number of rays that are followed together.
pub(super) const LANES: usize = 64;

/// The number of rays in one vector.
const CHUNK: usize = 16;

/// Rays in the unit of a hierarchy, of which each has a bit in a set.
#[repr(align(64))]
pub(super) struct Packet {
    origin: [[f32; LANES]; 3],
    direction: [[f32; LANES]; 3],
    inverse: [[f32; LANES]; 3],
    end: [f32; LANES],
    scale: [Scale; LANES],
    beam: Beam,
}

impl Packet {
    /// Gathers the rays that enter a hierarchy, and returns their set.
    #[inline(always)]
    pub(super) fn gather(
        lanes: u64,
        mut enter: impl FnMut(usize) -> Option<LocalRay>,
    ) -> (Self, u64) {
        let mut packet = Self {
            origin: [[0.0; LANES]; 3],
            direction: [[0.0; LANES]; 3],
            inverse: [[0.0; LANES]; 3],
            end: [0.0; LANES],
            scale: [Scale::default(); LANES],
            beam: Beam::NONE,
        };
        let mut inside = 0;
        for lane in set(lanes) {
            let Some(ray) = enter(lane) else { continue };
            inside |= 1 << lane;
            for axis in 0..3 {
                packet.origin[axis][lane] = ray.origin[axis];
                packet.direction[axis][lane] = ray.direction[axis];
                packet.inverse[axis][lane] = ray.inverse[axis];
            }
            packet.scale[lane] = ray.scale;
            packet.beam.hold(&ray);
        }
        (packet, inside)
    }

    /// Sets where a ray ends, in metres from its origin in the world.
    #[inline(always)]
    pub(super) fn set_end(&mut self, lane: usize, distance: f64) {
        self.end[lane] = self.scale[lane].end(distance);
    }

    /// Returns a single ray.
    #[inline(always)]
    pub(super) fn ray(&self, lane: usize) -> LocalRay {
        let pick = |values: &[[f32; LANES]; 3]| values.map(|axis| axis[lane]);
        LocalRay {
            origin: pick(&self.origin),
            direction: pick(&self.direction),
            inverse: pick(&self.inverse),
            scale: self.scale[lane],
        }
    }

    /// Returns how far the beam of all rays is from the boxes of a node at least, and which of them
    /// it may meet.
    #[inline(always)]
    pub(super) fn beam_meets<S: Simd>(&self, simd: S, node: &Node) -> (f32x8<S>, u64) {
        self.beam.meet(simd, node)
    }

    /// Returns those of `lanes` whose rays meet a box.
    #[inline(always)]
    pub(super) fn meet_box<S: Simd>(&self, simd: S, [low, high]: [[f32; 3]; 2], lanes: u64) -> u64 {
        let low = low.map(|corner| f32x16::splat(simd, corner));
        let high = high.map(|corner| f32x16::splat(simd, corner));
        let mut met = 0;
        for chunk in 0..LANES / CHUNK {
            if part(lanes, chunk) != 0 {
                let (_, bits) = meet_boxes(&self.chunk(simd, chunk), low, high);
                met |= bits << (chunk * CHUNK);
            }
        }
        met & lanes
    }

    /// Returns those of `lanes` whose rays meet a triangle.
    #[inline(always)]
    pub(super) fn meet_triangle<S: Simd>(
        &self,
        simd: S,
        triangle: &TriangleLanes<f32x16<S>>,
        lanes: u64,
    ) -> Met {
        let (mut possibly, mut certainly) = (0, 0);
        for chunk in 0..LANES / CHUNK {
            if part(lanes, chunk) != 0 {
                let met = meet_triangles(&self.chunk(simd, chunk), triangle);
                possibly |= met.possibly << (chunk * CHUNK);
                certainly |= met.certainly << (chunk * CHUNK);
            }
        }
        Met {
            possibly: possibly & lanes,
            certainly: certainly & lanes,
        }
    }

    #[inline(always)]
    fn chunk<S: Simd>(&self, simd: S, chunk: usize) -> RayLanes<f32x16<S>> {
        let first = chunk * CHUNK;
        let load = |values: &[f32; LANES]| f32x16::from_slice(simd, &values[first..first + CHUNK]);
        let loads =
            |values: &[[f32; LANES]; 3]| [load(&values[0]), load(&values[1]), load(&values[2])];
        RayLanes {
            origin: loads(&self.origin),
            direction: loads(&self.direction),
            inverse: loads(&self.inverse),
            end: load(&self.end),
        }
    }
}

#[inline(always)]
const fn part(lanes: u64, chunk: usize) -> u64 {
    (lanes >> (chunk * CHUNK)) & ((1 << CHUNK) - 1)
}

/// Returns the members of a set of rays.
#[inline(always)]
pub(super) fn set(mut lanes: u64) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

/// Intervals that hold the origins of all rays and the reciprocals of their directions.
///
/// Operations of single precision preserve order, so that what they give for the ends of an interval
/// holds what they give for the rays in it.
#[derive(Clone, Copy, Debug)]
struct Beam {
    origin: [[f32; 2]; 3],
    inverse: [[f32; 2]; 3],
}

impl Beam {
    const NONE: Self = Self {
        origin: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
        inverse: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
    };

    #[inline(always)]
    fn hold(&mut self, ray: &LocalRay) {
        for axis in 0..3 {
            extend(&mut self.origin[axis], ray.origin[axis]);
            extend(&mut self.inverse[axis], ray.inverse[axis]);
        }
    }

    #[inline(always)]
    fn meet<S: Simd>(&self, simd: S, node: &Node) -> (f32x8<S>, u64) {
        let [low, high] = node.corners(simd);
        let splat = |value: f32| f32x8::splat(simd, value);
        let (mut near, mut far) = (splat(0.0), splat(4.0));
        for axis in 0..3 {
            let [first, last] = self.origin[axis].map(splat);
            let [least, most] = self.inverse[axis];
            let (enter, leave) = if least > 0.0 {
                (low[axis] - last, high[axis] - first)
            } else if most < 0.0 {
                (high[axis] - first, low[axis] - last)
            } else {
                // Rays to both sides leave nothing out.
                continue;
            };
            let (least, most) = (splat(least), splat(most));
            near = near.max((enter * least).min(enter * most));
            far = far.min((leave * least).max(leave * most));
        }
        let there = low[0].simd_lt(splat(1e29));
        (near, (near.simd_le(far) & there).to_bitmask())
    }
}

#[inline(always)]
const fn extend([least, most]: &mut [f32; 2], value: f32) {
    *least = least.min(value);
    *most = most.max(value);
}

const _: () = assert!(WIDTH == 8 && LANES.is_multiple_of(CHUNK), "the vectors fit");
