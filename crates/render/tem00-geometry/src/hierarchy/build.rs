use glam::DVec3;
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, reinsertion::ReinsertionOptimizer},
    ploc::PlocBuilder,
};
use tem00_numerics::parallel;
use tem00_numerics::seed::scattered;

use super::{Child, Hierarchy, Node, PADDING, WIDTH};

/// The maximum number of things that one thread builds into a tree as a whole.
///
/// It does not depend on the number of threads, and neither does the hierarchy.
const GROUP: usize = 1 << 15;

/// Contents of the leaves of a hierarchy: indices of things, leaf after leaf.
#[derive(Debug, Default)]
pub(in super::super) struct Leaves {
    things: Vec<u32>,
    ends: Vec<usize>,
}

impl Leaves {
    /// Returns the number of leaves.
    pub(in super::super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Returns all indices.
    pub(in super::super) fn into_things(self) -> Vec<u32> {
        self.things
    }

    /// Returns the indices in a leaf.
    pub(in super::super) fn things(&self, leaf: usize) -> &[u32] {
        let start = leaf.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.things[start..self.ends[leaf]]
    }

    fn append(&mut self, other: &Self) {
        let things = self.things.len();
        self.things.extend_from_slice(&other.things);
        self.ends.extend(other.ends.iter().map(|end| things + end));
    }
}

impl Hierarchy {
    /// Builds a hierarchy of leaves of up to `capacity` things, given their number, at least one,
    /// and the lowest and the highest corner of the box around each.
    pub(in super::super) fn build(
        count: usize,
        corners: impl Fn(usize) -> (DVec3, DVec3) + Sync,
        capacity: u32,
    ) -> (Self, Leaves) {
        let (low, high) = (0..count).map(&corners).fold(
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
        let boxes = parallel::map(count, |index| {
            hierarchy.padded(corners(index), index as u64)
        });
        let mut things: Vec<u32> = (0_u32..).take(count).collect();
        let tree = Tree::build(&mut things, &boxes, capacity);
        hierarchy.nodes = tree.nodes;
        (hierarchy, tree.leaves)
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
    let bits = scattered(corner);
    let excess = [bits, bits >> 20, bits >> 40].map(|word| (word % BITS) as f64 / BITS as f64);
    PADDING * (1.0 + DVec3::from_array(excess))
}

/// Separates things that are longer than a quarter of the box around all from the others.
///
/// Among small things, a large one makes the box of their half almost as large as the box around
/// all.
fn by_size<'a>(things: &'a mut [u32], boxes: &[Aabb]) -> (&'a mut [u32], &'a mut [u32]) {
    let length = |around: &Aabb| around.diagonal().max_element();
    let longest = 0.25 * length(&union(things, boxes));
    let is_small = |thing: u32| length(&boxes[thing as usize]) <= longest;
    things.sort_by_key(|&thing| is_small(thing));
    let large = things.partition_point(|&thing| !is_small(thing));
    things.split_at_mut(large)
}

/// Returns the box around things.
fn union(things: &[u32], boxes: &[Aabb]) -> Aabb {
    let boxes = things.iter().map(|&thing| &boxes[thing as usize]);
    boxes.fold(Aabb::empty(), |around, other| around.union(other))
}

/// Splits things into halves, at the median of their boxes' centres, again and again.
fn halves<'a>(things: &'a mut [u32], boxes: &[Aabb], times: u32) -> Vec<&'a mut [u32]> {
    if times == 0 {
        return vec![things];
    }
    let axis = union(things, boxes).largest_axis();
    let centre = |thing: u32| boxes[thing as usize].center()[axis];
    let middle = things.len() / 2;
    things.select_nth_unstable_by(middle, |&a, &b| centre(a).total_cmp(&centre(b)));
    let (below, above) = things.split_at_mut(middle);
    let parts = parallel::map_items_with(vec![below, above], |(), _, part| {
        halves(part, boxes, times - 1)
    });
    parts.into_iter().flatten().collect()
}

/// A box, and the nodes and leaves below it; the first node is the root.
struct Tree {
    around: Aabb,
    nodes: Vec<Node>,
    leaves: Leaves,
}

impl Tree {
    /// Builds a tree over the boxes of some things.
    fn build(things: &mut [u32], boxes: &[Aabb], capacity: u32) -> Self {
        if things.len() <= GROUP {
            return Self::of_group(things, boxes, capacity);
        }
        let (large, small) = by_size(things, boxes);
        let parts = if large.is_empty() || small.is_empty() {
            halves(things, boxes, WIDTH.ilog2())
        } else {
            vec![large, small]
        };
        let trees =
            parallel::map_items_with(parts, |(), _, part| Self::build(part, boxes, capacity));
        Self::join(&trees)
    }

    fn of_group(group: &[u32], boxes: &[Aabb], capacity: u32) -> Self {
        let boxes: Vec<Aabb> = group.iter().map(|&thing| boxes[thing as usize]).collect();
        let binary = binary_tree(&boxes);
        let mut wide = Widening {
            counts: counts(&binary),
            binary: &binary,
            group,
            capacity,
            leaves: Leaves::default(),
        };
        Self {
            around: *binary.nodes[0].aabb(),
            nodes: wide.nodes(),
            leaves: wide.leaves,
        }
    }

    /// Puts up to eight trees below one root.
    fn join(trees: &[Self]) -> Self {
        let mut joined = Self {
            around: Aabb::empty(),
            nodes: vec![Node::EMPTY],
            leaves: Leaves::default(),
        };
        for (slot, tree) in trees.iter().enumerate() {
            joined.around = joined.around.union(&tree.around);
            let root = joined.append(tree);
            joined.nodes[0].set(slot, &tree.around, Child::node(number(root)));
        }
        joined
    }

    /// Adds the nodes and leaves of another tree, and returns the index of its root.
    fn append(&mut self, other: &Self) -> usize {
        let (root, leaf) = (self.nodes.len(), self.leaves.len());
        self.nodes.extend_from_slice(&other.nodes);
        for child in self.nodes[root..]
            .iter_mut()
            .flat_map(|node| &mut node.children)
        {
            *child = match child.index() {
                Ok(index) => Child::node(index + number(root)),
                Err(index) => Child::leaf(index + number(leaf)),
            };
        }
        self.leaves.append(&other.leaves);
        root
    }
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

impl Node {
    fn set(&mut self, slot: usize, around: &Aabb, child: Child) {
        for axis in 0..3 {
            self.low[axis][slot] = around.min[axis];
            self.high[axis][slot] = around.max[axis];
        }
        self.children[slot] = child;
    }
}

/// Turns a binary tree into one of eight children per node.
struct Widening<'a> {
    binary: &'a Bvh2,
    /// The things, as the binary tree numbers them.
    group: &'a [u32],
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
                nodes[next].set(slot, self.binary.nodes[index].aabb(), child);
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

    /// Returns whether a node may be opened: the first one if it has children at all, others while
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
                let things = self.binary.primitive_indices[things].iter();
                let things = things.map(|&thing| self.group[thing as usize]);
                self.leaves.things.extend(things);
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
