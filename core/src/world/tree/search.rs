//! What a box overlaps, what many boxes overlap, and searches that pass over what cannot matter.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::node::FAN;
use super::{NONE, Tree};
use crate::{Aabb, Scalar};

/// What is somewhere in memory is called from there so many at a time, before it is looked at: then
/// one waits for all instead of for each.
pub(in crate::world) const TOGETHER: usize = 16;

/// So many boxes are looked up at a time.
pub(in crate::world) const BATCH: usize = 256;

/// What a query looks for.
pub(in crate::world) trait Search<const D: usize, T> {
    /// How near the nearest body in `bounds` may be; `None` if none in there can matter.
    fn bound(&self, bounds: &Aabb<D, T>) -> Option<f64>;

    /// Looks at the body in a seat.
    fn visit(&mut self, seat: u32) -> ControlFlow<()>;
}

impl<const D: usize, T: Scalar> Tree<D, T> {
    /// Lists for each of up to [`BATCH`] boxes, which come with a number, all bodies whose box overlaps it, as
    /// pairs of the index of the query and a seat.
    ///
    /// First the leaves are listed that any box touches, and then these are gone through: it is known
    /// early which comes when, and so they are called from memory some time before they are needed,
    /// several at once.
    pub fn overlapping_many(
        &self,
        queries: &[(u32, Aabb<D, T>)],
        scratch: &mut Vec<[u32; 2]>,
        found: &mut Vec<[u32; 2]>,
    ) {
        scratch.clear();
        found.clear();
        // Room for more than are found, so that it need not be found later.
        let room = self.count.min(BATCH) * 4 * FAN;
        scratch.reserve(room);
        found.reserve(room);
        if self.root == NONE {
            return;
        }
        for (index, (_, area)) in queries.iter().enumerate() {
            self.leaves_in(self.root, index as u32, area, scratch);
        }
        for leaves in scratch.chunks(TOGETHER) {
            leaves.iter().for_each(|&[_, leaf]| self.nodes[leaf as usize].prefetch());
            for &[index, leaf] in leaves {
                let node = &self.nodes[leaf as usize];
                let mut bits = node.overlapping(&queries[index as usize].1);
                while bits != 0 {
                    found.push([index, node.items[bits.trailing_zeros() as usize]]);
                    bits &= bits - 1;
                }
            }
        }
    }

    /// Lists the leaves whose bounds overlap `area`.
    fn leaves_in(&self, index: u32, number: u32, area: &Aabb<D, T>, leaves: &mut Vec<[u32; 2]>) {
        let node = &self.nodes[index as usize];
        if node.is_leaf {
            leaves.push([number, index]);
            return;
        }
        let mut bits = node.overlapping(area);
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            if node.has_leaves {
                leaves.push([number, node.items[lane]]);
            } else {
                self.leaves_in(node.items[lane], number, area, leaves);
            }
        }
    }

    /// Calls the leaf of a body from memory.
    #[inline]
    pub fn call_leaf_of(&self, seat: u32) {
        if let Some(node) =
            self.leaves.get(seat as usize).and_then(|&leaf| self.nodes.get(leaf as usize))
        {
            node.prefetch();
        }
    }

    /// Goes through what a search does not exclude, the nearer of a node's parts first.
    pub fn search(&self, search: &mut impl Search<D, T>) -> ControlFlow<()> {
        if self.root == NONE {
            ControlFlow::Continue(())
        } else {
            self.search_in(self.root, search)
        }
    }

    fn search_in(&self, index: u32, search: &mut impl Search<D, T>) -> ControlFlow<()> {
        let node = &self.nodes[index as usize];
        let mut parts = [(0.0, 0); FAN];
        let mut count = 0;
        for lane in 0..node.count {
            if let Some(bound) = search.bound(&node.aabb(lane)) {
                parts[count] = (bound, lane);
                count += 1;
            }
        }
        let parts = &mut parts[..count];
        parts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &mut (_, lane) in parts {
            // What was seen since may exclude it now.
            if search.bound(&node.aabb(lane)).is_none() {
                continue;
            }
            if node.is_leaf {
                search.visit(node.items[lane])?;
            } else {
                self.search_in(node.items[lane], search)?;
            }
        }
        ControlFlow::Continue(())
    }
}
