use fearless_simd::{Simd, f32x8, f32x16, prelude::*};
use glam::DVec3;
use tem00_camera::Ray;

use super::query::Query;
use crate::hierarchy::{
    Hierarchy, LocalRay, Node, Placement, Scale, WIDTH,
    lanes::{Met, RayLanes, TriangleLanes, meet_boxes, meet_triangles},
    pick, splat,
};

/// The number of rays that are followed together.
pub(super) const LANES: usize = 64;

/// The number of rays in one vector.
const CHUNK: usize = 16;

/// Rays in the unit of a hierarchy, each with a bit in a set.
#[repr(align(64))]
pub(super) struct Packet {
    origin: [[f32; LANES]; 3],
    direction: [[f32; LANES]; 3],
    inverse: [[f32; LANES]; 3],
    end: [f32; LANES],
    /// The distance at which the traversal of each ray starts, in the unit of the hierarchy.
    start: [f64; LANES],
    /// Unit of the scaled coordinates, in metres.
    unit: f64,
    beam: Beam,
}

impl Packet {
    /// Gathers the rays that enter a placed hierarchy, and returns their set.
    #[inline(always)]
    pub(super) fn gather<Q: Query>(
        hierarchy: &Hierarchy,
        placement: &Placement,
        lanes: u64,
        queries: &[Q],
    ) -> (Self, u64) {
        let mut origins = [[0.0; LANES]; 3];
        let mut directions = [[0.0; LANES]; 3];
        let mut ends = [0.0; LANES];
        for lane in set(lanes) {
            let Ray { origin, direction } = queries[lane].ray();
            for axis in 0..3 {
                origins[axis][lane] = origin[axis];
                directions[axis][lane] = direction[axis];
            }
            ends[lane] = queries[lane].end();
        }
        let mut packet = Self {
            origin: [[0.0; LANES]; 3],
            direction: [[0.0; LANES]; 3],
            inverse: [[0.0; LANES]; 3],
            end: [0.0; LANES],
            start: [0.0; LANES],
            unit: hierarchy.unit(placement),
            beam: Beam::NONE,
        };
        let mut inside = [false; LANES];
        for lane in 0..LANES {
            let ray = Ray {
                origin: vector(&origins, lane),
                direction: vector(&directions, lane),
            };
            let (ray, enters) = hierarchy.enter(placement, &ray);
            for axis in 0..3 {
                packet.origin[axis][lane] = ray.origin[axis];
                packet.direction[axis][lane] = ray.direction[axis];
                packet.inverse[axis][lane] = ray.inverse[axis];
            }
            packet.start[lane] = ray.scale.start;
            packet.end[lane] = ray.scale.end(ends[lane]);
            inside[lane] = enters;
        }
        let mut entering = 0;
        for lane in set(lanes) {
            entering |= u64::from(inside[lane]) << lane;
        }
        packet.beam = packet.beam_of(entering);
        (packet, entering)
    }

    #[inline(always)]
    fn beam_of(&self, lanes: u64) -> Beam {
        let mut beam = Beam::NONE;
        for lane in set(lanes) {
            for axis in 0..3 {
                extend(&mut beam.origin[axis], self.origin[axis][lane]);
                extend(&mut beam.inverse[axis], self.inverse[axis][lane]);
            }
        }
        beam
    }

    #[inline(always)]
    const fn scale(&self, lane: usize) -> Scale {
        Scale {
            unit: self.unit,
            start: self.start[lane],
        }
    }

    /// Sets where a ray ends, in metres from its origin in the world.
    #[inline(always)]
    pub(super) fn set_end(&mut self, lane: usize, distance: f64) {
        self.end[lane] = self.scale(lane).end(distance);
    }

    /// Returns a single ray.
    #[inline(always)]
    pub(super) fn ray(&self, lane: usize) -> LocalRay {
        LocalRay {
            origin: pick(&self.origin, lane),
            direction: pick(&self.direction, lane),
            inverse: pick(&self.inverse, lane),
            scale: self.scale(lane),
        }
    }

    /// Returns the minimum distances of the beam of all rays from the boxes of a node, and the
    /// boxes that it may meet.
    #[inline(always)]
    pub(super) fn beam_meets<S: Simd>(&self, simd: S, node: &Node) -> (f32x8<S>, u64) {
        self.beam.meet(simd, node)
    }

    /// Returns the lanes among `lanes` whose rays meet a box.
    #[inline(always)]
    pub(super) fn meet_box<S: Simd>(&self, simd: S, [low, high]: [[f32; 3]; 2], lanes: u64) -> u64 {
        let (low, high) = (splat(simd, low), splat(simd, high));
        let mut met = 0;
        for chunk in 0..LANES / CHUNK {
            if part(lanes, chunk) != 0 {
                let (_, bits) = meet_boxes(&self.chunk(simd, chunk), low, high);
                met |= bits << (chunk * CHUNK);
            }
        }
        met & lanes
    }

    /// Returns the lanes among `lanes` whose rays meet a triangle.
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
        RayLanes {
            origin: load(simd, &self.origin, chunk),
            direction: load(simd, &self.direction, chunk),
            inverse: load(simd, &self.inverse, chunk),
            end: load_one(simd, &self.end, chunk),
        }
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, values: &[[f32; LANES]; 3], chunk: usize) -> [f32x16<S>; 3] {
    [
        load_one(simd, &values[0], chunk),
        load_one(simd, &values[1], chunk),
        load_one(simd, &values[2], chunk),
    ]
}

#[inline(always)]
fn load_one<S: Simd>(simd: S, values: &[f32; LANES], chunk: usize) -> f32x16<S> {
    f32x16::from_slice(simd, &values[chunk * CHUNK..(chunk + 1) * CHUNK])
}

#[inline(always)]
pub(super) const fn vector(values: &[[f64; LANES]; 3], lane: usize) -> DVec3 {
    DVec3::new(values[0][lane], values[1][lane], values[2][lane])
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
/// Operations in single precision preserve order, so that their results for the ends of an interval
/// enclose their results for the rays in it.
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
    fn meet<S: Simd>(&self, simd: S, node: &Node) -> (f32x8<S>, u64) {
        let [low, high] = node.corners(simd);
        let all = |value: f32| f32x8::splat(simd, value);
        let (mut near, mut far) = (all(0.0), all(4.0));
        for axis in 0..3 {
            let [first, last] = self.origin[axis];
            let (first, last) = (all(first), all(last));
            let [min, max] = self.inverse[axis];
            let (enter, leave) = if min > 0.0 {
                (low[axis] - last, high[axis] - first)
            } else if max < 0.0 {
                (high[axis] - first, low[axis] - last)
            } else {
                // Rays to both sides exclude no box.
                continue;
            };
            let (min, max) = (all(min), all(max));
            near = near.max((enter * min).min(enter * max));
            far = far.min((leave * min).max(leave * max));
        }
        let there = low[0].simd_lt(all(1e29));
        (near, (near.simd_le(far) & there).to_bitmask())
    }
}

#[inline(always)]
const fn extend([min, max]: &mut [f32; 2], value: f32) {
    *min = min.min(value);
    *max = max.max(value);
}

const _: () = assert!(WIDTH == 8 && LANES.is_multiple_of(CHUNK), "the vectors fit");
