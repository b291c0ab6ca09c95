use glam::DVec3;
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, reinsertion::ReinsertionOptimizer},
    ploc::PlocBuilder,
};

use super::{Child, Hierarchy, Node, PADDING, WIDTH};

/// Contents of the leaves of a hierarchy: indices of things, leaf after leaf.
#[derive(Debug, Default)]
pub(in super::super) struct Leaves {
    things: Vec<u32>,
    ends: Vec<usize>,
}

impl Leaves {
    /// Returns the indices in each leaf, in the order of the leaves.
    pub(in super::super) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts
            .zip(&self.ends)
            .map(|(start, &end)| &self.things[start..end])
    }
}

impl Hierarchy {
    /// Builds a hierarchy of leaves of up to `capacity` things, given the lowest and the highest
    /// corner of the box around each, at least one.
    pub(in super::super) fn build(boxes: &[(DVec3, DVec3)], capacity: u32) -> (Self, Leaves) {
        let (low, high) = boxes.iter().fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), corners| (low.min(corners.0), high.max(corners.1)),
        );
        let half = 0.5 * (high - low);
        let longest = half.max_element().max(f64::MIN_POSITIVE);
        let mut hierarchy = Self {
            nodes: Vec::new(),
            centre: low + half,
            radius: longest * (half / longest).length(),
        };
        let padded: Vec<Aabb> = (0_u64..)
            .zip(boxes)
            .map(|(index, corners)| hierarchy.padded(*corners, index))
            .collect();
        let binary = binary_tree(&padded);
        let mut wide = Widening {
            counts: counts(&binary),
            binary: &binary,
            capacity,
            leaves: Leaves::default(),
        };
        hierarchy.nodes = wide.nodes();
        (hierarchy, wide.leaves)
    }

    fn padded(&self, (low, high): (DVec3, DVec3), index: u64) -> Aabb {
        Aabb::new(
            (self.to_local(low) - padding(2 * index)).as_vec3a(),
            (self.to_local(high) + padding(2 * index + 1)).as_vec3a(),
        )
    }
}

/// Returns a scattered padding for each axis.
fn padding(corner: u64) -> DVec3 {
    const BITS: u64 = 1 << 20;
    // The finaliser of SplitMix64 (Steele, Lea and Flood 2014) spreads neighbouring numbers.
    let mut bits = corner.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    let excess = [bits, bits >> 20, bits >> 40].map(|word| (word % BITS) as f64 / BITS as f64);
    PADDING * (1.0 + DVec3::from_array(excess))
}

fn binary_tree(boxes: &[Aabb]) -> Bvh2 {
    let preset = BvhBuildParams::slow_build();
    let mut tree = PlocBuilder::with_capacity(boxes.len()).build(
        preset.ploc_search_distance,
        boxes,
        (0_u32..).take(boxes.len()).collect(),
        preset.sort_precision,
        preset.search_depth_threshold,
    );
    ReinsertionOptimizer::default().run(&mut tree, preset.reinsertion_batch_ratio, None);
    tree
}

/// Returns the number of things below each node.
fn counts(tree: &Bvh2) -> Vec<u32> {
    let mut order = vec![0];
    let mut next = 0;
    while let Some(&index) = order.get(next) {
        let node = &tree.nodes[index];
        if !node.is_leaf() {
            order.extend([node.first_index as usize, node.first_index as usize + 1]);
        }
        next += 1;
    }
    let mut counts = vec![0; tree.nodes.len()];
    for &index in order.iter().rev() {
        let node = &tree.nodes[index];
        let first = node.first_index as usize;
        counts[index] = if node.is_leaf() {
            node.prim_count
        } else {
            counts[first] + counts[first + 1]
        };
    }
    counts
}

/// Turns a binary tree into one of eight children per node.
struct Widening<'a> {
    binary: &'a Bvh2,
    counts: Vec<u32>,
    capacity: u32,
    leaves: Leaves,
}

impl Widening<'_> {
    fn nodes(&mut self) -> Vec<Node> {
        let mut nodes = vec![Node::EMPTY];
        // The binary nodes whose children the wide nodes take over.
        let mut sources = vec![0];
        let mut next = 0;
        while let Some(&source) = sources.get(next) {
            for (slot, index) in self.children(source).into_iter().enumerate() {
                let child = if self.counts[index] <= self.capacity {
                    Child::leaf(self.leaf(index))
                } else {
                    sources.push(index);
                    nodes.push(Node::EMPTY);
                    Child::node(number(nodes.len() - 1))
                };
                let corners = self.binary.nodes[index].aabb();
                let (low, high) = (corners.min.to_array(), corners.max.to_array());
                let node = &mut nodes[next];
                node.children[slot] = child;
                for axis in 0..3 {
                    node.low[axis][slot] = low[axis];
                    node.high[axis][slot] = high[axis];
                }
            }
            next += 1;
        }
        nodes
    }

    /// Returns up to eight nodes of the binary tree below `index`: the largest are opened first.
    fn children(&self, index: usize) -> Vec<usize> {
        let mut children = vec![index];
        loop {
            let largest = (0..children.len())
                .filter(|&slot| self.can_open(children[slot], children.len()))
                .max_by(|&a, &b| self.area(children[a]).total_cmp(&self.area(children[b])));
            let Some(slot) = largest else {
                return children;
            };
            let first = self.binary.nodes[children[slot]].first_index as usize;
            children[slot] = first;
            children.push(first + 1);
        }
    }

    /// Tells whether a node may be opened: the first one if it has children at all, others while
    /// there is room and they do not fit into one leaf.
    fn can_open(&self, index: usize, children: usize) -> bool {
        let fits = self.counts[index] <= self.capacity;
        !self.binary.nodes[index].is_leaf() && children < WIDTH && !fits
    }

    fn area(&self, index: usize) -> f32 {
        self.binary.nodes[index].aabb().half_area()
    }

    /// Gathers the things below a node into a leaf, in ascending order.
    fn leaf(&mut self, index: usize) -> u32 {
        let start = self.leaves.things.len();
        let mut open = vec![index];
        while let Some(index) = open.pop() {
            let node = &self.binary.nodes[index];
            let first = node.first_index as usize;
            if node.is_leaf() {
                let things = first..first + node.prim_count as usize;
                let things = &self.binary.primitive_indices[things];
                self.leaves.things.extend_from_slice(things);
            } else {
                open.extend([first, first + 1]);
            }
        }
        self.leaves.things[start..].sort_unstable();
        self.leaves.ends.push(self.leaves.things.len());
        number(self.leaves.ends.len() - 1)
    }
}

/// Returns the number of a node or leaf, of which there are fewer than things.
fn number(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}
