//! Which boxes overlap an area: level by level for all of them, depth first for a visitor that may stop.
//!
//! Level by level, one list has the nodes to test and another receives the nodes of the level below, so no
//! branch depends on the result of a test, and the loads of many nodes overlap. Depth first needs no memory,
//! and does not test what comes after the last box that is wanted.
//!
//! What runs in a kernel is written in plain loops: `array::from_fn` and `zip` are not inlined into functions
//! with target features, which makes the search two times slower.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::format::{INDEX_BYTES, Layout, MAX_LEVELS, indices, node_bytes};
use crate::memory::grow;
use crate::pairs::{LANES, Lanes, Relation, Work};
use crate::{Aabb, Scalar};

/// The memory of searches, kept from one to the next: see
/// [`Index::search_into`](crate::Index::search_into).
#[derive(Clone, Debug, Default)]
pub struct SearchBuffer {
    /// The nodes of a level and of the one below it that are tested. All vectors are as long as they ever had
    /// to be; their items are meaningless between searches.
    nodes: [Vec<u32>; 2],
    found: Vec<u32>,
    /// How many boxes were found.
    count: usize,
}

impl SearchBuffer {
    /// An empty buffer.
    pub const fn new() -> Self {
        Self { nodes: [Vec::new(), Vec::new()], found: Vec::new(), count: 0 }
    }

    /// The boxes that were found.
    pub(super) fn found(&self) -> &[u32] {
        &self.found[..self.count]
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Forgets what was found.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    pub(super) fn into_found(mut self) -> Vec<u32> {
        self.found.truncate(self.count);
        self.found
    }
}

/// Adds the boxes that overlap an area to those of the buffer.
pub struct Search<'a, const D: usize, T> {
    pub layout: &'a Layout,
    /// As long as the layout says.
    pub bytes: &'a [u8],
    pub area: Aabb<D, T>,
    pub buffer: &'a mut SearchBuffer,
}

impl<const D: usize, T: Scalar> Work for Search<'_, D, T> {
    type Output = Result<(), TryReserveError>;

    #[inline(always)]
    fn run(self, lanes: impl Lanes) -> Self::Output {
        let Self { layout, bytes, area, buffer } = self;
        let SearchBuffer { nodes: [first, second], found, count } = buffer;
        if layout.depth == 0 {
            return Ok(());
        }
        let last = layout.count as u32 - 1;
        let (mut now, mut next) = (first, second);
        // The last level has one node.
        grow(now, LANES, 0)?;
        now[0] = 0;
        let mut nodes = 1;
        for level in (1..layout.depth).rev() {
            grow(next, (nodes + 1) * LANES, 0)?;
            let (here, below) = (layout.level(level), layout.level(level - 1).nodes);
            let mut written = 0;
            for &node in &now[..nodes] {
                // Damaged bytes may lead to nodes that are not there.
                if node as usize >= here.nodes {
                    continue;
                }
                let at = here.start + node as usize * node_bytes::<D, T>();
                let Some(node_boxes) = bytes.get(at..at + node_bytes::<D, T>()) else { continue };
                let overlapping = lanes.test(node_boxes, &area, Relation::Overlaps);
                let mut inside = lanes.test(node_boxes, &area, Relation::Inside);
                let mut children = [0; LANES];
                for lane in 0..LANES {
                    children[lane] = node * LANES as u32 + lane as u32;
                }
                let partial = overlapping & !inside;
                let Some(to) = next[written..].first_chunk_mut() else { continue };
                lanes.compress(&children, partial, to);
                written += partial.count_ones() as usize;
                while inside != 0 {
                    let lane = inside.trailing_zeros();
                    let run = (inside >> lane).trailing_ones();
                    inside &= !(((1 << run) - 1) << lane);
                    // Damaged bytes may have boxes in lanes without a node.
                    let from = (node as usize * LANES + lane as usize).min(below);
                    let to = (from + run as usize).min(below);
                    add_leaves::<D, T>(layout, bytes, level - 1, from..to, found, count)?;
                }
            }
            (now, next) = (next, now);
            nodes = written;
        }
        let leaves = layout.level(0);
        let stride = layout.stride::<D, T>(0);
        grow(found, *count + (nodes + 1) * LANES, 0)?;
        let mut hits = *count;
        for &node in &now[..nodes] {
            if node as usize >= leaves.nodes {
                continue;
            }
            let at = leaves.start + node as usize * stride;
            let Some(leaf) = bytes.get(at..at + stride) else { continue };
            let (node_boxes, own) = leaf.split_at(node_bytes::<D, T>());
            let Some(own) = own.first_chunk::<INDEX_BYTES>() else { continue };
            let own = indices(own, last);
            let overlapping = lanes.test(node_boxes, &area, Relation::Overlaps);
            let Some(to) = found[hits..].first_chunk_mut() else { continue };
            lanes.compress(&own, overlapping, to);
            hits += overlapping.count_ones() as usize;
        }
        *count = hits;
        Ok(())
    }
}

/// Adds all boxes below some nodes of a level.
#[inline(always)]
fn add_leaves<const D: usize, T: Scalar>(
    layout: &Layout,
    bytes: &[u8],
    level: usize,
    nodes: core::ops::Range<usize>,
    found: &mut Vec<u32>,
    count: &mut usize,
) -> Result<(), TryReserveError> {
    let shift = LANES.trailing_zeros() as usize * level;
    let leaves = layout.level(0);
    // Nodes of the level are there, so only the end can be beyond the last leaf.
    let (from, to) = (nodes.start << shift, nodes.end << shift);
    let to = to.min(leaves.nodes);
    let stride = layout.stride::<D, T>(0);
    let last = layout.count as u32 - 1;
    grow(found, *count + to.saturating_sub(from) * LANES, 0)?;
    for leaf in from..to {
        let at = leaves.start + leaf * stride + node_bytes::<D, T>();
        let Some(own) = bytes.get(at..at + INDEX_BYTES).and_then(|own| own.first_chunk()) else {
            continue;
        };
        let Some(space) = found[*count..].first_chunk_mut() else { continue };
        *space = indices(own, last);
        *count += layout.lanes(0, leaf);
    }
    Ok(())
}

/// Shows the boxes that overlap an area to a visitor.
pub struct Visit<'a, const D: usize, T, V> {
    pub layout: &'a Layout,
    /// As long as the layout says.
    pub bytes: &'a [u8],
    pub area: Aabb<D, T>,
    pub visit: V,
}

impl<const D: usize, T, V, B> Work for Visit<'_, D, T, V>
where
    T: Scalar,
    V: FnMut(u32) -> ControlFlow<B>,
{
    type Output = ControlFlow<B>;

    #[inline(always)]
    fn run(self, lanes: impl Lanes) -> ControlFlow<B> {
        let Self { layout, bytes, area, mut visit } = self;
        if layout.depth == 0 {
            return ControlFlow::Continue(());
        }
        let last = layout.count as u32 - 1;
        let stride = layout.stride::<D, T>(0);
        // Of each level down to the current one, the node and its lanes that are still to be visited.
        let mut path = [(0, 0); MAX_LEVELS];
        let mut level = layout.depth - 1;
        let mut node = 0;
        loop {
            // A node that damaged bytes made up overlaps nothing.
            let mut overlapping = 0;
            if node < layout.level(level).nodes {
                let at = layout.level(level).start + node * layout.stride::<D, T>(level);
                if let Some(node_boxes) = bytes.get(at..at + node_bytes::<D, T>()) {
                    overlapping = lanes.test(node_boxes, &area, Relation::Overlaps);
                }
                let own = at + node_bytes::<D, T>();
                if level == 0
                    && let Some(own) = bytes.get(own..at + stride).and_then(|own| own.first_chunk())
                {
                    let own = indices(own, last);
                    while overlapping != 0 {
                        visit(own[overlapping.trailing_zeros() as usize % LANES])?;
                        overlapping &= overlapping - 1;
                    }
                }
            }
            path[level] = (node, overlapping);
            // Up to the next node whose lanes are not done, and down to the first of them.
            while path[level].1 == 0 {
                level += 1;
                if level >= layout.depth {
                    return ControlFlow::Continue(());
                }
            }
            let (above, lanes_left) = &mut path[level];
            node = *above * LANES + lanes_left.trailing_zeros() as usize;
            *lanes_left &= *lanes_left - 1;
            level -= 1;
        }
    }
}
