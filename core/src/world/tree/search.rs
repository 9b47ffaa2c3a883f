//! What a box overlaps, what many boxes overlap, and searches that pass over what cannot matter.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::edit::Tree;
use super::node::{FAN, Items, NONE, sort_few};
use crate::memory::reserve_for;
use crate::{Aabb, Scalar};

/// Random reads are prefetched this many at a time, so that their cache misses overlap. 4 instead takes 1.00
/// to 1.06 of the time.
pub const TOGETHER: usize = 16;

/// How many boxes are looked up at a time: what they find stays cached. 64 instead takes 0.97 to 1.03 of the
/// time.
pub const BATCH: usize = 256;

impl<const D: usize, T: Scalar> Tree<D, T> {
    /// Lists for each of up to [`BATCH`] boxes all bodies whose box overlaps it, as pairs of the
    /// position of the box in `queries` and a body.
    ///
    /// It first lists the leaves that any box overlaps and then reads these in turn: so they can be
    /// prefetched, several at once. `most` is how many leaves and bodies may still be listed, and becomes
    /// less; returns false, with some of the bodies missing, if that is not enough.
    #[must_use]
    #[inline(never)]
    pub fn overlapping_many(
        &self,
        queries: &[(u32, Aabb<D, T>)],
        scratch: &mut Vec<[u32; 2]>,
        found: &mut Vec<[u32; 2]>,
        most: &mut usize,
    ) -> bool {
        scratch.clear();
        found.clear();
        // Spare capacity, so that steady motion does not allocate.
        let spare = self.count.min(BATCH) * 4 * FAN;
        if reserve_for(scratch, spare).is_err() {
            return false;
        }
        if self.root == NONE {
            return true;
        }
        let bounds = self.nodes[self.root as usize].bounds();
        for (index, (_, area)) in queries.iter().enumerate() {
            if bounds.overlaps_branch_free(area)
                && !self.leaves_in(self.root, index as u32, area, scratch)
                || scratch.len() > *most
            {
                return false;
            }
        }
        *most -= scratch.len();
        for leaves in scratch.chunks(TOGETHER) {
            let capacity = (found.len() + TOGETHER * FAN).max(spare);
            if found.len() > *most || reserve_for(found, capacity).is_err() {
                return false;
            }
            leaves.iter().for_each(|&[_, leaf]| self.nodes[leaf as usize].prefetch());
            for &[index, leaf] in leaves {
                let node = &self.nodes[leaf as usize];
                for body in node.items_of(node.overlapping(&queries[index as usize].1)) {
                    found.push([index, body]);
                }
            }
        }
        *most = most.saturating_sub(found.len());
        true
    }

    /// Lists the leaves whose bounds overlap `area`. Returns false, with some of them missing, if there is no memory for them.
    fn leaves_in(
        &self,
        index: u32,
        number: u32,
        area: &Aabb<D, T>,
        leaves: &mut Vec<[u32; 2]>,
    ) -> bool {
        let node = &self.nodes[index as usize];
        if leaves.capacity() - leaves.len() < FAN
            && reserve_for(leaves, leaves.len() + FAN).is_err()
        {
            return false;
        }
        if node.is_leaf {
            leaves.push([number, index]);
            return true;
        }
        for child in node.items_of(node.overlapping(area)) {
            if node.has_leaves {
                leaves.push([number, child]);
            } else if !self.leaves_in(child, number, area, leaves) {
                return false;
            }
        }
        true
    }

    /// The bodies whose boxes overlap `area`, in no particular order, without allocating: the way back
    /// up the tree is that of the parents.
    pub fn overlapping(&self, area: Aabb<D, T>) -> impl Iterator<Item = u32> {
        let mut node = self.root;
        let mut bits = self.nodes.get(node as usize).map_or(0, |node| node.overlapping(&area));
        core::iter::from_fn(move || {
            loop {
                let current = self.nodes.get(node as usize)?;
                if bits == 0 {
                    let above = self.nodes.get(current.parent as usize)?;
                    bits = above.overlapping(&area) & (u32::MAX << above.lane_of(node) << 1);
                    node = current.parent;
                    continue;
                }
                let item = current.items[bits.trailing_zeros() as usize];
                bits &= bits - 1;
                if current.is_leaf {
                    return Some(item);
                }
                node = item;
                bits = self.nodes[node as usize].overlapping(&area);
            }
        })
    }

    /// Visits the bodies whose boxes overlap `area`, those of a leaf at a time, in no particular order, until `visit` breaks. It
    /// tests each node once, where [`overlapping`](Self::overlapping) tests those above again on the way back.
    pub fn visit_overlapping(
        &self,
        area: &Aabb<D, T>,
        visit: &mut dyn FnMut(Items<'_>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.root == NONE {
            return ControlFlow::Continue(());
        }
        self.visit_overlapping_in(self.root, area, visit)
    }

    fn visit_overlapping_in(
        &self,
        index: u32,
        area: &Aabb<D, T>,
        visit: &mut dyn FnMut(Items<'_>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let node = &self.nodes[index as usize];
        let overlapping = node.items_of(node.overlapping(area));
        if node.is_leaf {
            return visit(overlapping);
        }
        for child in overlapping {
            self.visit_overlapping_in(child, area, visit)?;
        }
        ControlFlow::Continue(())
    }

    /// Prefetches the leaf of a body.
    #[inline]
    pub fn prefetch_leaf_of(&self, body: u32) {
        if let Some(node) =
            self.leaves.get(body as usize).and_then(|&leaf| self.nodes.get(leaf as usize))
        {
            node.prefetch();
        }
    }

    /// Visits the bodies in boxes that `bound` does not exclude, the nearer of a node's parts first, until `visit` breaks.
    ///
    /// `bound` gives a lower bound of the distance of all bodies in a box, or `None` if none of them can
    /// matter.
    pub fn search(
        &self,
        bound: impl Fn(&Aabb<D, T>) -> Option<f64>,
        mut visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.root == NONE {
            return ControlFlow::Continue(());
        }
        self.search_in(self.root, &bound, &mut visit)
    }

    fn search_in(
        &self,
        index: u32,
        bound: &impl Fn(&Aabb<D, T>) -> Option<f64>,
        visit: &mut impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let node = &self.nodes[index as usize];
        let mut parts = [(0.0, 0); FAN];
        let mut count = 0;
        for lane in 0..node.count {
            if let Some(bound) = bound(&node.aabb(lane)) {
                parts[count] = (bound, lane);
                count += 1;
            }
        }
        let parts = &mut parts[..count];
        sort_few(parts);
        for &mut (_, lane) in parts {
            // What was seen since may exclude it now.
            if bound(&node.aabb(lane)).is_none() {
                continue;
            }
            if node.is_leaf {
                visit(node.items[lane])?;
            } else {
                self.search_in(node.items[lane], bound, visit)?;
            }
        }
        ControlFlow::Continue(())
    }
}
