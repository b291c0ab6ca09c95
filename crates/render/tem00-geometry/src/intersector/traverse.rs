use fearless_simd::{Simd, f32x8, prelude::*};

use super::{
    packet::{Packet, set},
    query::Query,
};
use crate::hierarchy::{Child, Hierarchy, LocalRay, Node, WIDTH};

/// Contents of the leaves of a hierarchy.
pub(super) trait Leaves {
    fn hierarchy(&self) -> &Hierarchy;

    /// Offers the content of a leaf to a query.
    fn ask_one<S: Simd, Q: Query>(
        &self,
        simd: S,
        leaf: usize,
        ray: &LocalRay,
        query: &mut Q,
        stacks: &mut Stacks,
    );

    /// Offers the content of a leaf to the queries in `lanes`.
    fn ask_many<S: Simd, Q: Query>(
        &self,
        simd: S,
        leaf: usize,
        packet: &mut Packet,
        lanes: u64,
        queries: &mut [Q],
        stacks: &mut Stacks,
    );
}

/// Nodes still to be visited, of all traversals that are under way.
#[derive(Debug, Default)]
pub(super) struct Stacks {
    /// Distances, as bits, and children.
    one: Vec<u64>,
    /// Boxes and the rays that may meet them.
    many: Vec<(usize, u64)>,
}

/// The number of rays below which each ray continues alone.
const FEW: u32 = 8;

/// Follows one ray through the node at `index` and everything below.
pub(super) fn follow_one<S: Simd, L: Leaves, Q: Query>(
    simd: S,
    leaves: &L,
    index: u32,
    ray: &LocalRay,
    query: &mut Q,
    stacks: &mut Stacks,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            let base = stacks.one.len();
            let nodes = leaves.hierarchy().nodes();
            let mut end = ray.scale.end(query.end());
            let mut lanes = ray.lanes(simd, end);
            let mut next = Child::node(index).entry(0.0);
            loop {
                match Child::of_entry(next).index() {
                    Ok(index) => {
                        let node = &nodes[index as usize];
                        let (near, met) = node.meet(&lanes);
                        push_sorted(&mut stacks.one, node, near, met);
                    }
                    Err(leaf) => {
                        leaves.ask_one(simd, leaf as usize, ray, query, stacks);
                        if query.is_over() {
                            break;
                        }
                        end = ray.scale.end(query.end());
                        lanes.end = f32x8::splat(simd, end);
                    }
                }
                let limit = Child::LAST.entry(end);
                next = loop {
                    if stacks.one.len() == base {
                        return;
                    }
                    match stacks.one.pop() {
                        Some(entry) if entry <= limit => break entry,
                        _ => {}
                    }
                };
            }
            stacks.one.truncate(base);
        },
    );
}

/// Adds the children of a node that are met to a stack, the nearest last.
///
/// The bits of numbers that are not negative have the order of the numbers.
#[inline(always)]
fn push_sorted<S: Simd>(stack: &mut Vec<u64>, node: &Node, near: f32x8<S>, met: u64) {
    let near: [f32; WIDTH] = near.into();
    let first = stack.len();
    for slot in set(met) {
        let entry = node.child(slot).entry(near[slot]);
        let mut place = stack.len();
        stack.push(entry);
        while place > first && stack[place - 1] < entry {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = entry;
    }
}

/// Follows the rays in `lanes` through a hierarchy together, until few meet the same boxes.
pub(super) fn follow_many<S: Simd, L: Leaves, Q: Query>(
    simd: S,
    leaves: &L,
    packet: &mut Packet,
    lanes: u64,
    queries: &mut [Q],
    stacks: &mut Stacks,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            let base = stacks.many.len();
            let nodes = leaves.hierarchy().nodes();
            let mut open = lanes;
            visit(simd, leaves, 0, packet, open, queries, stacks);
            while stacks.many.len() > base {
                let Some((address, lanes)) = stacks.many.pop() else {
                    break;
                };
                let (node, slot) = (&nodes[address / WIDTH], address % WIDTH);
                let lanes = packet.meet_box(simd, node.corners_of(slot), lanes & open);
                if lanes == 0 {
                    continue;
                }
                match node.child(slot).index() {
                    Ok(index) => visit(simd, leaves, index, packet, lanes, queries, stacks),
                    Err(leaf) => {
                        leaves.ask_many(simd, leaf as usize, packet, lanes, queries, stacks);
                    }
                }
                if Q::ANY {
                    for lane in set(lanes) {
                        open &= !(u64::from(queries[lane].is_over()) << lane);
                    }
                }
            }
        },
    );
}

/// Puts the children of a node that `lanes` may meet on the stack, or follows few rays alone.
#[inline(always)]
fn visit<S: Simd, L: Leaves, Q: Query>(
    simd: S,
    leaves: &L,
    index: u32,
    packet: &mut Packet,
    lanes: u64,
    queries: &mut [Q],
    stacks: &mut Stacks,
) {
    if lanes.count_ones() < FEW {
        for lane in set(lanes) {
            let query = &mut queries[lane];
            follow_one(simd, leaves, index, &packet.ray(lane), query, stacks);
            packet.set_end(lane, query.end());
        }
        return;
    }
    let node = &leaves.hierarchy().nodes()[index as usize];
    let (near, met) = packet.beam_meets(simd, node);
    let near: [f32; WIDTH] = near.into();
    let first = stacks.many.len();
    for slot in set(met) {
        let mut place = stacks.many.len();
        let entry = (index as usize * WIDTH + slot, lanes);
        stacks.many.push(entry);
        while place > first && near[stacks.many[place - 1].0 % WIDTH] < near[slot] {
            stacks.many[place] = stacks.many[place - 1];
            place -= 1;
        }
        stacks.many[place] = entry;
    }
}
