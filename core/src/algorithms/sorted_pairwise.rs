//! Sorted pairwise: the simplified sweep and prune, Müller's ten lines.
//!
//! ```text
//! sort by left edge
//! for i in 0..n
//!     for j in i+1..n
//!         if boxes[j].left > boxes[i].right: break      everything further right is apart too
//!         if overlaps(boxes[i], boxes[j]): pair (i, j)
//! ```
//!
//! Time: the sort, plus O(n + m) where m is the number of overlaps *on the sweep axis* (not of
//! pairs: a tall stack swept from the side has m near n²/2 and hardly a pair). Memory: O(n) for
//! the order.
//!
//! Unlike the article's listing it sorts an array of its own, not the caller's; the order is
//! total, so ties stay where they are; the break and the box test share one closed rule; and the
//! order is kept from call to call, so that insertion sort finds it nearly sorted.

use alloc::vec::Vec;

use super::endpoint::Endpoint;
use super::observer::{Observer, Separation};
use super::sorts::Sort;
use crate::{Aabb, Scalar};

/// Sorted pairwise, with the order of its last call.
#[derive(Clone, Debug)]
pub struct SortedPairwise<T> {
    lefts: Vec<Endpoint<T>>,
}

impl<T: Scalar> SortedPairwise<T> {
    /// No order yet.
    pub fn new() -> Self {
        Self { lefts: Vec::new() }
    }

    /// Forgets the order of the last call; the next starts from the order of the indices.
    pub fn forget(&mut self) {
        self.lefts.clear();
    }

    /// The left endpoints in the order of the last call.
    pub fn order(&self) -> &[Endpoint<T>] {
        &self.lefts
    }

    /// Appends all overlapping pairs of `boxes`, in the order in which the sweep along `axis`
    /// finds them. The boxes must be valid and `axis < D`.
    ///
    /// If as many boxes are passed as in the last call, the sort starts from that call's order.
    pub fn find<const D: usize, O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        axis: usize,
        sort: Sort,
        observer: &mut O,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        self.refresh(boxes, axis);
        sort.sort(&mut self.lefts, observer);
        for (i, left) in self.lefts.iter().enumerate() {
            let a = left.edge.id;
            let right = boxes[a as usize].max[axis];
            observer.enter(a);
            for next in &self.lefts[i + 1..] {
                let b = next.edge.id;
                if next.at > right {
                    observer.prune(Separation { axis, left: a, right: b });
                    break;
                }
                observer.axis_overlap(axis, a, b);
                let separation = Separation::find(boxes, a, b, (axis + 1) % D);
                observer.test(a, b, separation);
                if separation.is_none() {
                    let pair = [a.min(b), a.max(b)];
                    observer.overlap(pair[0], pair[1]);
                    pairs.push(pair);
                }
            }
            observer.leave(a);
        }
    }

    /// Reads the left edges anew, in the order of the last call where there is one.
    fn refresh<const D: usize>(&mut self, boxes: &[Aabb<D, T>], axis: usize) {
        if self.lefts.len() != boxes.len() {
            self.lefts.clear();
            self.lefts.extend((0..boxes.len() as u32).map(|id| Endpoint::left(T::default(), id)));
        }
        for left in &mut self.lefts {
            left.at = boxes[left.edge.id as usize].min[axis];
        }
    }
}

impl<T: Scalar> Default for SortedPairwise<T> {
    fn default() -> Self {
        Self::new()
    }
}
