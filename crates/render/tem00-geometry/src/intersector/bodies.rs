use fearless_simd::Simd;
use glam::DVec3;

use super::{
    packet::{Packet, set},
    primitive::{Primitive, ShearedRay},
    query::{PrimitiveIndex, Query},
    traverse::{Leaves, Stacks, follow_many, follow_one},
};
use crate::{
    Hit, MeshInstance, Shape,
    hierarchy::{Hierarchy, LocalRay, MeshHierarchy, Placement, lanes::meet_triangles},
    mesh,
};

/// A part of a scene, and the shape to which it belongs.
#[derive(Clone, Debug)]
pub(super) struct Body {
    content: Content,
    surface: usize,
}

#[derive(Clone, Debug)]
enum Content {
    Primitive(Primitive),
    Mesh(MeshInstance),
    /// A triangle stored in the hierarchy of the scene, because its mesh is too small for a
    /// hierarchy of its own.
    Triangle(MeshInstance, u32),
}

impl Body {
    /// Returns the parts of a shape in a scene where no coordinate exceeds `reach`, in metres.
    pub(super) fn parts_of(surface: usize, shape: &Shape, reach: f64) -> Vec<Self> {
        let body = |content| Self { content, surface };
        match shape {
            Shape::Rectangle(shape) => vec![body(Content::Primitive(Primitive::Rectangle(*shape)))],
            Shape::Sphere(shape) => vec![body(Content::Primitive(Primitive::Sphere(*shape)))],
            Shape::Cylinder(shape) => vec![body(Content::Primitive(Primitive::Cylinder(*shape)))],
            Shape::Mesh(instance) if is_tiny(instance, reach) => {
                let triangles = 0_u32..;
                triangles
                    .zip(instance.mesh().triangles())
                    .map(|(triangle, _)| body(Content::Triangle(instance.clone(), triangle)))
                    .collect()
            }
            Shape::Mesh(instance) => vec![body(Content::Mesh(instance.clone()))],
        }
    }

    /// Returns the lowest and the highest corner of the axis-parallel box around the body.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        match &self.content {
            Content::Primitive(primitive) => primitive.bounds(),
            Content::Mesh(instance) => instance.bounds(),
            Content::Triangle(instance, triangle) => {
                Primitive::triangle(instance, *triangle).bounds()
            }
        }
    }

    /// Returns where a ray meets the body that its query found.
    pub(super) fn hit(
        &self,
        query: &impl Query,
        (distance, index): (f64, PrimitiveIndex),
    ) -> Option<Hit> {
        let ray = query.ray();
        let (instance, triangle) = match &self.content {
            Content::Primitive(primitive) => {
                let (position, normal) = primitive.point_and_normal(ray)?;
                return Some(Hit {
                    distance,
                    position,
                    normal,
                    shading_normal: normal,
                    surface: self.surface,
                });
            }
            Content::Mesh(instance) => (instance, index.triangle),
            Content::Triangle(instance, triangle) => (instance, *triangle),
        };
        let corners = instance.corners(triangle as usize);
        let (_, weights) = ShearedRay::new(ray).triangle(&corners)?;
        let [a, b, c] = corners;
        let normal = mesh::normal(&corners)?;
        Some(Hit {
            distance,
            position: weights.x * a + weights.y * b + weights.z * c,
            normal,
            shading_normal: instance.shading_normal(triangle as usize, weights, normal),
            surface: self.surface,
        })
    }
}

fn placement(instance: &MeshInstance) -> Placement {
    Placement {
        scale: instance.scale(),
        to_local: instance.rotation().transpose(),
        origin: instance.point(DVec3::ZERO),
    }
}

/// Returns whether the rounding of coordinates in the scene, 2⁻⁵³ `reach`, is not small compared
/// with the resolution of single precision in a mesh, 2⁻²⁴ of its size.
fn is_tiny(instance: &MeshInstance, reach: f64) -> bool {
    const LARGE_ENOUGH: f64 = 1.0 / (1 << 24) as f64;
    let (low, high) = instance.bounds();
    (high - low).max_element() <= LARGE_ENOUGH * reach
}

/// The parts of a scene, as the content of the leaves of its hierarchy.
#[derive(Clone, Debug)]
pub(super) struct Bodies {
    hierarchy: Hierarchy,
    bodies: Vec<Body>,
    /// The body in each leaf.
    order: Vec<u32>,
}

impl Bodies {
    pub(super) fn build(bodies: Vec<Body>) -> Self {
        let corners = |body: usize| bodies[body].bounds();
        let (hierarchy, leaves) = Hierarchy::build(bodies.len(), corners, 1);
        Self {
            hierarchy,
            bodies,
            order: leaves.into_things(),
        }
    }

    pub(super) fn body(&self, index: PrimitiveIndex) -> &Body {
        &self.bodies[index.body as usize]
    }
}

impl Leaves for Bodies {
    fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    #[inline(always)]
    fn ask_one<S: Simd, Q: Query>(
        &self,
        simd: S,
        leaf: usize,
        _: &LocalRay,
        query: &mut Q,
        stacks: &mut Stacks,
    ) {
        let body = self.order[leaf];
        let index = PrimitiveIndex { body, triangle: 0 };
        match &self.bodies[body as usize].content {
            Content::Primitive(primitive) => query.offer(primitive, index),
            Content::Triangle(instance, triangle) => {
                query.offer(&Primitive::triangle(instance, *triangle), index);
            }
            Content::Mesh(instance) => {
                let hierarchy = instance.hierarchy();
                let (local, enters) = hierarchy.boxes().enter(&placement(instance), query.ray());
                if enters {
                    let part = Part {
                        hierarchy,
                        instance,
                        body,
                    };
                    follow_one(simd, &part, 0, &local, query, stacks);
                }
            }
        }
    }

    #[inline(always)]
    fn ask_many<S: Simd, Q: Query>(
        &self,
        simd: S,
        leaf: usize,
        packet: &mut Packet,
        lanes: u64,
        queries: &mut [Q],
        stacks: &mut Stacks,
    ) {
        let body = self.order[leaf];
        if let Content::Mesh(instance) = &self.bodies[body as usize].content {
            let hierarchy = instance.hierarchy();
            let boxes = hierarchy.boxes();
            let (mut local, inside) = Packet::gather(boxes, &placement(instance), lanes, queries);
            let part = Part {
                hierarchy,
                instance,
                body,
            };
            follow_many(simd, &part, &mut local, inside, queries, stacks);
        } else {
            for lane in set(lanes) {
                self.ask_one(simd, leaf, &packet.ray(lane), &mut queries[lane], stacks);
            }
        }
        for lane in set(lanes) {
            packet.set_end(lane, queries[lane].end());
        }
    }
}

/// A placed mesh, as the content of the leaves of its hierarchy.
struct Part<'a> {
    hierarchy: &'a MeshHierarchy,
    instance: &'a MeshInstance,
    body: u32,
}

impl Part<'_> {
    #[inline(always)]
    fn offer(&self, triangle: u32, query: &mut impl Query) {
        let index = PrimitiveIndex {
            body: self.body,
            triangle,
        };
        query.offer(&Primitive::triangle(self.instance, triangle), index);
    }
}

impl Leaves for Part<'_> {
    fn hierarchy(&self) -> &Hierarchy {
        self.hierarchy.boxes()
    }

    #[inline(always)]
    fn ask_one<S: Simd, Q: Query>(
        &self,
        simd: S,
        leaf: usize,
        ray: &LocalRay,
        query: &mut Q,
        _: &mut Stacks,
    ) {
        let block = self.hierarchy.block(leaf);
        let end = ray.scale.end(query.end());
        let met = meet_triangles(&ray.lanes(simd, end), &block.all(simd));
        if Q::ANY && met.certainly != 0 {
            query.settle();
            return;
        }
        for lane in set(met.possibly) {
            if let Some(triangle) = block.triangle(lane) {
                self.offer(triangle, query);
            }
        }
    }

    #[inline(always)]
    fn ask_many<S: Simd, Q: Query>(
        &self,
        simd: S,
        leaf: usize,
        packet: &mut Packet,
        mut lanes: u64,
        queries: &mut [Q],
        _: &mut Stacks,
    ) {
        let block = self.hierarchy.block(leaf);
        for (slot, triangle) in block.triangles() {
            let met = packet.meet_triangle(simd, &block.one(simd, slot), lanes);
            let mut unsure = met.possibly;
            if Q::ANY {
                unsure &= !met.certainly;
                lanes &= !met.certainly;
                for lane in set(met.certainly) {
                    queries[lane].settle();
                }
            }
            for lane in set(unsure) {
                self.offer(triangle, &mut queries[lane]);
                packet.set_end(lane, queries[lane].end());
            }
        }
    }
}
