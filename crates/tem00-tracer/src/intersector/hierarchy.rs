mod build;

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::DVec3;

use super::lanes::{RayLanes, meet_boxes};
use crate::Ray;

/// The number of children of a node.
pub(super) const WIDTH: usize = 8;

/// A tree of boxes in single precision around things that rays may meet.
///
/// Its unit and origin are radius and centre of a sphere around everything. The boxes are padded by
/// more than single precision errs, so that no ray that meets a thing misses its box.
#[derive(Clone, Debug)]
pub(super) struct Hierarchy {
    nodes: Vec<Node>,
    centre: DVec3,
    radius: f64,
}

/// Up to eight boxes, and what is in them.
#[repr(align(64))]
#[derive(Clone, Debug)]
pub(super) struct Node {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
    children: [Child; WIDTH],
}

/// What is in a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Child {
    Node(u32),
    Leaf(u32),
}

impl Node {
    /// A node without children: boxes far away that no ray reaches.
    const EMPTY: Self = Self {
        low: [[1e30; WIDTH]; 3],
        high: [[1e30; WIDTH]; 3],
        children: [Child::Leaf(u32::MAX); WIDTH],
    };

    pub(super) fn child(&self, slot: usize) -> Child {
        self.children[slot]
    }

    /// Returns the distances at which a ray enters the boxes, and the boxes that it meets.
    #[inline(always)]
    pub(super) fn meet<S: Simd>(&self, ray: &RayLanes<f32x8<S>>) -> (f32x8<S>, u64) {
        let simd = ray.end.token();
        let [low, high] = [&self.low, &self.high].map(|corners| load(simd, corners));
        meet_boxes(ray, low, high)
    }

    /// Returns the corners of all boxes, one in each lane.
    #[inline(always)]
    pub(super) fn corners<S: Simd>(&self, simd: S) -> [[f32x8<S>; 3]; 2] {
        [load(simd, &self.low), load(simd, &self.high)]
    }

    /// Returns the lowest and the highest corner of one box.
    #[inline(always)]
    pub(super) fn corners_of(&self, slot: usize) -> [[f32; 3]; 2] {
        [&self.low, &self.high].map(|corners| corners.map(|axis| axis[slot]))
    }
}

#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, values: &[[f32; WIDTH]; 3]) -> [f32x8<S>; 3] {
    values.map(|axis| axis.simd_into(simd))
}

/// A ray in the unit of a hierarchy.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalRay {
    pub origin: [f32; 3],
    pub direction: [f32; 3],
    pub inverse: [f32; 3],
    pub scale: Scale,
}

/// How distances along a ray turn into the unit of a hierarchy.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scale {
    /// The unit of the hierarchy, in metres.
    unit: f64,
    /// The distance at which the traversal starts, in that unit.
    start: f64,
}

impl Scale {
    /// Returns a distance from the ray's origin, in metres, as one from the start of the traversal
    /// in the unit of the hierarchy. Everything in it ends before 4.
    #[inline(always)]
    pub(super) fn end(&self, distance: f64) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "the padding allows for it")]
        let end = (distance / self.unit - self.start).min(4.0) as f32;
        end
    }
}

/// How far the boxes extend beyond what they hold, in the unit of the hierarchy.
///
/// With u = 2⁻²⁴ the rounding of single precision, origins within √2 of the centre, boxes within 1
/// and distances up to 2.5, the plane of a box is met at its true distance once it is moved by
///
/// ```text
/// 1.5 u          rounding of the origin
/// 5.0 u          rounding of the direction, and its components below 2⁻²³, which count as 2⁻²³
/// 11 u           (plane − origin) / direction, in four operations
/// 1 u            rounding of the boxes
/// 2 u            rounding of the distance at which the traversal ends
/// ```
///
/// which is 21 u. The padding is between 64 u and 128 u, different for each face of each box: the
/// builder chains boxes that coincide, and pairs boxes that differ at random.
const PADDING: f64 = 1.0 / (1 << 18) as f64;

/// Components of directions below this count as this: their reciprocals stay finite.
const SMALLEST_COMPONENT: f32 = 1.0 / (1 << 23) as f32;

impl Hierarchy {
    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Returns a point in the unit and about the centre of the hierarchy.
    pub(super) fn to_local(&self, point: DVec3) -> DVec3 {
        (point - self.centre) / self.radius
    }

    /// Returns a ray in the unit of the hierarchy, from where it enters the surroundings of the
    /// bounding sphere; nothing if it passes by or is no ray.
    ///
    /// The unit of the ray's own coordinates is `scale` metres.
    pub(super) fn enter(&self, ray: &Ray, scale: f64) -> Option<LocalRay> {
        const REACH: f64 = 1.0 + 2.0 * PADDING;
        let Ray { origin, direction } = *ray;
        if !(origin.is_finite() && direction.is_finite()) {
            return None;
        }
        let offset = (self.centre - origin) / self.radius;
        let middle = offset.dot(direction);
        let miss = offset - middle * direction;
        if !(miss.length_squared() <= REACH * REACH && middle >= -REACH) {
            return None;
        }
        let start = (middle - 1.0).max(0.0);
        let direction = direction.as_vec3().to_array();
        Some(LocalRay {
            origin: (start * ray.direction - offset).as_vec3().to_array(),
            direction,
            inverse: direction.map(|component| {
                component
                    .abs()
                    .max(SMALLEST_COMPONENT)
                    .copysign(component)
                    .recip()
            }),
            scale: Scale {
                unit: self.radius * scale,
                start,
            },
        })
    }
}
