mod build;
pub(crate) mod lanes;
mod triangles;

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::{DMat3, DVec3};
use tem00_camera::Ray;

use self::lanes::{RayLanes, meet_boxes};
pub(crate) use self::triangles::MeshHierarchy;

/// The number of children of a node.
pub(crate) const WIDTH: usize = 8;

/// A tree of boxes in single precision around things that rays may meet.
///
/// Its unit and origin are radius and centre of a sphere around everything. The boxes are padded by
/// more than single precision errs, so that no ray that meets a thing misses its box.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Hierarchy {
    nodes: Vec<Node>,
    centre: DVec3,
    radius: f64,
}

/// Up to eight boxes, and their content.
#[repr(align(32))]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
    children: [Child; WIDTH],
}

/// Content of a box: a node, or a leaf where the highest bit is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    pub(crate) const fn node(index: u32) -> Self {
        Self(index)
    }

    pub(crate) const fn leaf(index: u32) -> Self {
        Self(Self::LEAF | index)
    }

    /// The child after which no other comes.
    pub(crate) const LAST: Self = Self(u32::MAX);

    /// Returns a number for the child at a distance that is not negative: the larger, the farther.
    ///
    /// The bits of such distances have the order of the distances.
    #[inline(always)]
    pub(crate) const fn entry(self, distance: f32) -> u64 {
        (distance.to_bits() as u64) << 32 | self.0 as u64
    }

    #[inline(always)]
    pub(crate) const fn of_entry(entry: u64) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the child is in the low bits"
        )]
        let bits = entry as u32;
        Self(bits)
    }

    /// Returns the index of the node, or the index of the leaf as the error.
    #[inline(always)]
    pub(crate) const fn index(self) -> Result<u32, u32> {
        if self.0 & Self::LEAF == 0 {
            Ok(self.0)
        } else {
            Err(self.0 & !Self::LEAF)
        }
    }
}

impl Node {
    /// A node without children: boxes far away that no ray reaches.
    const EMPTY: Self = Self {
        low: [[1e30; WIDTH]; 3],
        high: [[1e30; WIDTH]; 3],
        children: [Child::leaf(0); WIDTH],
    };

    pub(crate) fn child(&self, slot: usize) -> Child {
        self.children[slot]
    }

    /// Returns the distances at which a ray enters the boxes, and the boxes that it meets.
    #[inline(always)]
    pub(crate) fn meet<S: Simd>(&self, ray: &RayLanes<f32x8<S>>) -> (f32x8<S>, u64) {
        let simd = ray.end.token();
        meet_boxes(ray, load(simd, &self.low), load(simd, &self.high))
    }

    /// Returns the corners of all boxes, one in each lane.
    #[inline(always)]
    pub(crate) fn corners<S: Simd>(&self, simd: S) -> [[f32x8<S>; 3]; 2] {
        [load(simd, &self.low), load(simd, &self.high)]
    }

    /// Returns the lowest and the highest corner of one box.
    #[inline(always)]
    pub(crate) fn corners_of(&self, slot: usize) -> [[f32; 3]; 2] {
        [pick(&self.low, slot), pick(&self.high, slot)]
    }
}

#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, values: &[[f32; WIDTH]; 3]) -> [f32x8<S>; 3] {
    [
        f32x8::from_slice(simd, &values[0]),
        f32x8::from_slice(simd, &values[1]),
        f32x8::from_slice(simd, &values[2]),
    ]
}

/// Returns one lane of the values of three axes.
#[inline(always)]
pub(crate) const fn pick<const N: usize>(values: &[[f32; N]; 3], lane: usize) -> [f32; 3] {
    [values[0][lane], values[1][lane], values[2][lane]]
}

/// Returns the values of three axes in all lanes.
#[inline(always)]
pub(crate) fn splat<S: Simd, V: SimdFloat<S, Element = f32>>(
    simd: S,
    [x, y, z]: [f32; 3],
) -> [V; 3] {
    [V::splat(simd, x), V::splat(simd, y), V::splat(simd, z)]
}

/// A ray in the unit of a hierarchy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalRay {
    pub origin: [f32; 3],
    pub direction: [f32; 3],
    pub inverse: [f32; 3],
    pub scale: Scale,
}

/// Position and axes of a hierarchy in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    /// The unit of the hierarchy's own coordinates, in metres.
    pub scale: f64,
    /// The rotation into those coordinates.
    pub to_local: DMat3,
    /// The position of their origin, in metres.
    pub origin: DVec3,
}

impl Placement {
    /// The placement of a hierarchy that is given in coordinates of the world.
    pub(crate) const WORLD: Self = Self {
        scale: 1.0,
        to_local: DMat3::IDENTITY,
        origin: DVec3::ZERO,
    };
}

/// Conversion of distances along a ray into the unit of a hierarchy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    /// The unit of the hierarchy, in metres.
    pub unit: f64,
    /// The distance at which the traversal starts, in that unit.
    pub start: f64,
}

impl Scale {
    /// Converts a distance from the ray's origin, in metres, to a distance from the start of the
    /// traversal, in the unit of the hierarchy. Everything in it ends before 4.
    #[inline(always)]
    pub(crate) fn end(&self, distance: f64) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "the padding allows for it")]
        let end = (distance / self.unit - self.start).min(4.0) as f32;
        end
    }
}

/// Margin of the boxes around their content, in the unit of the hierarchy.
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

/// The smallest magnitude of a direction's component: smaller ones count as this, so that their
/// reciprocals stay finite.
const MIN_COMPONENT: f32 = 1.0 / (1 << 23) as f32;

impl Hierarchy {
    pub(crate) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Returns a point in the unit and about the centre of the hierarchy.
    pub(crate) fn to_local(&self, point: DVec3) -> DVec3 {
        (point - self.centre) / self.radius
    }

    /// Returns the unit of the placed hierarchy, in metres.
    pub(crate) fn unit(&self, placement: &Placement) -> f64 {
        self.radius * placement.scale
    }

    /// Returns a ray of the world in the unit of the hierarchy, from where it enters the
    /// surroundings of the bounding sphere, and whether it does so; a ray that is not finite never
    /// does.
    #[inline(always)]
    pub(crate) fn enter(&self, placement: &Placement, ray: &Ray) -> (LocalRay, bool) {
        const REACH: f64 = 1.0 + 2.0 * PADDING;
        let origin = placement.to_local * (ray.origin - placement.origin) / placement.scale;
        let direction = placement.to_local * ray.direction;
        let offset = (self.centre - origin) / self.radius;
        let middle = offset.dot(direction);
        let miss = offset - middle * direction;
        let enters = miss.length_squared() <= REACH * REACH && middle >= -REACH;
        let start = (middle - 1.0).max(0.0);
        let origin = (start * direction - offset).as_vec3();
        let direction = direction.as_vec3();
        let local = LocalRay {
            origin: [origin.x, origin.y, origin.z],
            direction: [direction.x, direction.y, direction.z],
            inverse: [
                inverse(direction.x),
                inverse(direction.y),
                inverse(direction.z),
            ],
            scale: Scale {
                unit: self.unit(placement),
                start,
            },
        };
        (local, enters)
    }
}

#[inline(always)]
fn inverse(component: f32) -> f32 {
    component
        .abs()
        .max(MIN_COMPONENT)
        .copysign(component)
        .recip()
}
