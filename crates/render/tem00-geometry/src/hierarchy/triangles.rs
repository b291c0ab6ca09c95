use fearless_simd::{Simd, SimdBase, SimdFloat, f32x8, f32x16};
use glam::DVec3;
use tem00_numerics::parallel;

use super::{
    Hierarchy, LocalRay, WIDTH,
    lanes::{RayLanes, TOLERANCE, TriangleLanes},
    load, pick, splat,
};

/// The hierarchy over the triangles of a mesh, in the mesh's own coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeshHierarchy {
    boxes: Hierarchy,
    blocks: Vec<Block>,
}

/// The triangles of a leaf in single precision.
#[repr(align(32))]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    corner: [[f32; WIDTH]; 3],
    edges: [[[f32; WIDTH]; 3]; 2],
    tolerance: [f32; WIDTH],
    /// The indices of the triangles in the mesh.
    triangles: [u32; WIDTH],
}

impl MeshHierarchy {
    /// Builds the hierarchy over `count` triangles by their corners, on all threads.
    pub(crate) fn build(count: usize, corners: impl Fn(usize) -> [DVec3; 3] + Sync) -> Self {
        let around = |triangle| {
            let [a, b, c] = corners(triangle);
            (a.min(b).min(c), a.max(b).max(c))
        };
        let (boxes, leaves) = Hierarchy::build(count, around, 8);
        let blocks = parallel::map(leaves.len(), |leaf| {
            Block::new(&corners, &boxes, leaves.things(leaf))
        });
        Self { boxes, blocks }
    }

    pub(crate) fn boxes(&self) -> &Hierarchy {
        &self.boxes
    }

    pub(crate) fn block(&self, leaf: usize) -> &Block {
        &self.blocks[leaf]
    }
}

/// Stands for the triangle of an empty lane: meshes have fewer triangles.
const NONE: u32 = u32::MAX;

impl Block {
    /// The shortest edge to which tolerances shrink: below, products of edges underflow.
    const SHORTEST: f64 = 1e-15;

    fn new(corners: &impl Fn(usize) -> [DVec3; 3], boxes: &Hierarchy, triangles: &[u32]) -> Self {
        // Empty lanes hold a triangle without area, far away, whose tolerance nothing passes.
        let mut block = Self {
            corner: [[1e9; WIDTH]; 3],
            edges: [[[0.0; WIDTH]; 3]; 2],
            tolerance: [-1.0; WIDTH],
            triangles: [NONE; WIDTH],
        };
        for (lane, &triangle) in triangles.iter().enumerate() {
            let [a, b, c] = corners(triangle as usize).map(|corner| boxes.to_local(corner));
            let (e1, e2) = (b - a, c - a);
            let longer = e1.length().max(e2.length()).max(Self::SHORTEST);
            for axis in 0..3 {
                block.corner[axis][lane] = single(a)[axis];
                block.edges[0][axis][lane] = single(e1)[axis];
                block.edges[1][axis][lane] = single(e2)[axis];
            }
            block.tolerance[lane] = TOLERANCE * single(DVec3::splat(longer))[0].next_up();
            block.triangles[lane] = triangle;
        }
        block
    }

    /// Returns the index of the triangle in a lane, if there is one.
    pub(crate) fn triangle(&self, lane: usize) -> Option<u32> {
        self.triangles
            .get(lane)
            .copied()
            .filter(|&triangle| triangle != NONE)
    }

    /// Returns the lanes that hold a triangle, and the triangles' indices.
    #[inline(always)]
    pub(crate) fn triangles(&self) -> impl Iterator<Item = (usize, u32)> {
        let triangles = self.triangles.iter().copied().enumerate();
        triangles.take_while(|&(_, triangle)| triangle != NONE)
    }

    /// Returns all triangles, one in each lane.
    #[inline(always)]
    pub(crate) fn all<S: Simd>(&self, simd: S) -> TriangleLanes<f32x8<S>> {
        TriangleLanes {
            corner: load(simd, &self.corner),
            edges: [load(simd, &self.edges[0]), load(simd, &self.edges[1])],
            tolerance: f32x8::from_slice(simd, &self.tolerance),
        }
    }

    /// Returns one triangle in all lanes.
    #[inline(always)]
    pub(crate) fn one<S: Simd>(&self, simd: S, lane: usize) -> TriangleLanes<f32x16<S>> {
        TriangleLanes {
            corner: splat(simd, pick(&self.corner, lane)),
            edges: [
                splat(simd, pick(&self.edges[0], lane)),
                splat(simd, pick(&self.edges[1], lane)),
            ],
            tolerance: f32x16::splat(simd, self.tolerance[lane]),
        }
    }
}

fn single(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}

impl LocalRay {
    /// Returns the ray in all lanes, up to a distance.
    #[inline(always)]
    pub(crate) fn lanes<S: Simd, V: SimdFloat<S, Element = f32>>(
        &self,
        simd: S,
        end: f32,
    ) -> RayLanes<V> {
        RayLanes {
            origin: splat(simd, self.origin),
            direction: splat(simd, self.direction),
            inverse: splat(simd, self.inverse),
            end: V::splat(simd, end),
        }
    }
}
